"""The list of datasets, and one that is added to it from outside the package."""

import json
import sys

import pytest

from trueup.adapters import universal
from trueup.adapters.universal import DATASETS, DatasetKind, register_dataset
from trueup.cli.app import run
from trueup.core.errors import InputError


@pytest.fixture
def gauges(documented):
    """What docs/extending.md adds, gone again after the test."""
    before = list(DATASETS)
    yield documented("A universal dataset")
    DATASETS[:] = before


@pytest.fixture
def trueup_cli(monkeypatch, capsys):
    """The command line: what it prints where it ends well, what it says where it does not."""

    def called(*words):
        monkeypatch.setattr(sys, "argv", ["trueup", *map(str, words)])
        status = run()
        said = capsys.readouterr()
        return said.err if status else said.out

    return called


FACTORS = "         7                    2.05", "        12                    1.98"


def test_each_dataset_stands_once_in_the_list():
    numbers = [kind.number for kind in DATASETS]
    assert len(set(numbers)) == len(numbers) == 12


def test_a_number_that_is_taken_is_refused_and_so_is_no_dataset():
    with pytest.raises(InputError, match="what is registered is given as int"):
        register_dataset(3)
    with pytest.raises(InputError, match="dataset 15 is taken: nodes"):
        register_dataset(DatasetKind(15, "mine", lambda source, section, into: 0))


def test_a_dataset_from_outside_is_read_and_told(gauges, uff, write):
    path = write(uff.nodes_15([(7, 0.0, 0.0, 0.0), (12, 1.0, 0.0, 0.0)])
                 + uff.dataset(9911, *FACTORS))  # fmt: skip
    content = universal.read_universal(path)
    factor = gauges["GaugeFactor"]
    assert content.extensions == (factor(7, 2.05), factor(12, 1.98))
    assert len(content.geometry.ids) == 2
    (entry,) = [d for d in content.datasets if d.number == 9911]
    assert (entry.what, entry.count) == ("gauge factors", 2)
    assert not content.skipped


def test_inspect_shows_it(gauges, uff, write, trueup_cli):
    path = write(uff.nodes_15([(7, 0.0, 0.0, 0.0)]) + uff.dataset(9911, *FACTORS))
    (told,) = json.loads(trueup_cli("inspect", path, "--json", "-"))["files"]
    assert told["contents"]["gauge_factors"] == {"7": 2.05, "12": 1.98}
    assert "gauge factors" in trueup_cli("inspect", path)


def test_a_line_of_it_that_cannot_be_read_is_listed_with_its_number(gauges, uff, write):
    text = uff.nodes_15([(7, 0.0, 0.0, 0.0)]) + uff.dataset(9911, FACTORS[0], "    nonsense")
    content = universal.read_universal(write(text))
    (skipped,) = content.skipped
    assert (skipped.what, skipped.harm) == ("dataset 9911 (gauge factors)", "lost")
    assert text.splitlines()[skipped.line - 1] == "    nonsense"
    assert len(content.geometry.ids) == 1


def test_it_is_written_and_read_back(gauges, tmp_path):
    factor = gauges["GaugeFactor"]
    nouns = [factor(7, 2.05), factor(12, 1.0 / 3.0)]
    universal.write_universal(tmp_path / "gauges.unv", extensions=nouns)
    assert universal.read_universal(tmp_path / "gauges.unv").extensions == tuple(nouns)


def test_convert_carries_it_between_universal_files_and_says_where_it_cannot(
    gauges, uff, write, tmp_path, trueup_cli
):
    path = write(uff.nodes_15([(7, 0.0, 0.0, 0.0)]) + uff.dataset(9911, *FACTORS))
    trueup_cli("convert", path, tmp_path / "again.unv")
    again = universal.read_universal(tmp_path / "again.unv")
    assert again.extensions == universal.read_universal(path).extensions
    said = trueup_cli("convert", path, tmp_path / "again.h5")
    assert "the registered datasets GaugeFactor" in said


def test_without_it_the_dataset_is_skipped_by_name(uff, write):
    text = uff.nodes_15([(7, 0.0, 0.0, 0.0)]) + uff.dataset(9911, *FACTORS)
    content = universal.read_universal(write(text))
    assert [s.what for s in content.skipped] == ["dataset 9911 (unknown to trueup)"]
    assert content.extensions == ()
