"""The list of sections, and one that is added to it from outside the package."""

from __future__ import annotations

import json

import pytest

import trueup
from trueup.adapters.report import SECTIONS, Section, make_report, register_section
from trueup.adapters.report.sections.pairs import PAIRS
from trueup.cli import terminal_tables
from trueup.core.errors import InputError
from trueup.core.results.correlation import RunTables


@pytest.fixture
def far_off(documented):
    """What docs/extending.md adds, gone again after the test."""
    before = list(SECTIONS)
    yield documented("A section of the report")["FAR_OFF"]
    SECTIONS[:] = before


def headings(page: str) -> list[str]:
    return [part.split("</h2>")[0].split(">", 1)[1] for part in page.split("<h2")[1:]]


def test_each_section_stands_once_in_the_list():
    assert len({s.anchor for s in SECTIONS}) == len({s.title for s in SECTIONS}) == len(SECTIONS)


def test_an_anchor_that_is_taken_is_refused_and_so_is_no_section():
    with pytest.raises(InputError, match="what is registered is given as int"):
        register_section(3)
    with pytest.raises(InputError, match="'pairs' is no section of the report"):
        register_section(Section("Mine", "mine", RunTables), before="pairs")
    with pytest.raises(InputError, match="anchor 'pairs' is there already"):
        register_section(Section("Mine", "pairs", RunTables))


def test_a_section_from_outside_is_on_the_page_until_it_is_removed(far_off, answer, correlation):
    told = answer(correlation)
    page = make_report(told)
    assert headings(page)[-1] == "Far off"
    assert 'href="#far-off"' in page
    assert '<td class="r poor">-10.0</td>' in page
    SECTIONS.remove(far_off)
    assert "Far off" not in make_report(told)


def test_it_stands_where_it_is_put(far_off, answer, correlation):
    SECTIONS.remove(far_off)
    register_section(far_off, before=PAIRS)
    assert headings(make_report(answer(correlation)))[0] == "Far off"


def test_a_run_that_says_nothing_to_it_has_no_such_section(far_off, answer, update):
    assert "Far off" not in make_report(answer(update))


def test_the_terminal_shows_its_tables(far_off, answer, correlation):
    titles = [str(t.renderable.title) for t in terminal_tables.result_tables(answer(correlation))
              if hasattr(t.renderable, "title")]  # fmt: skip
    assert titles[-1] == "More than 5 % off"


def test_the_verb_report_shows_it_in_a_run_folder(far_off, correlation, tmp_path):
    (tmp_path / "result.json").write_text(json.dumps(correlation), encoding="utf-8")
    page = trueup.report(tmp_path)
    assert "Far off" in page.read_text(encoding="utf-8")
