"""The page: complete, self-contained, safe, and silent about what the run does not say."""

from __future__ import annotations

import copy
import json
import re
import shutil
import subprocess
from html import unescape
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import HealthCheck, given, settings, strategies as st

from trueup.adapters.report import headline, make_report, paired_film
from trueup.adapters.report.sections.deck_changes import deck_diff
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.modes import Modes
from trueup.core.errors import InputError
from trueup.verbs.runs.report import answer_of

VOID = {"meta", "br", "path", "rect", "circle", "line", "use"}


class Reader(HTMLParser):
    """Checks nesting; collects text, ids, links and attributes that could fetch."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.fetching: list[str] = []
        self.headings: list[str] = []
        self.scripts = 0
        self.feed(page)
        assert self.open == []

    def handle_starttag(self, name: str, attributes: list[tuple[str, str | None]]) -> None:
        given_ = dict(attributes)
        if "id" in given_:
            self.ids.append(given_["id"] or "")
        if name == "a":
            self.links.append(given_["href"] or "")
        self.fetching += [f"{name} {k}" for k in given_ if k in ("src", "srcset", "data", "action")]
        if name in ("link", "img", "iframe", "object", "embed", "base"):
            self.fetching.append(name)
        self.scripts += name == "script"
        if name not in VOID and name != "td":  # the end tag of a cell is optional
            self.open.append(name)

    def handle_startendtag(self, name: str, attributes: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(name, attributes)
        if name not in VOID and name != "td":
            self.open.pop()

    def handle_endtag(self, name: str) -> None:
        assert name == "td" or self.open.pop() == name

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "h2":
            self.headings.append(data)


SECTIONS = [
    "Pairs",
    "MAC matrices",
    "Modes without a partner",
    "Parameters and progress",
    "Alignment and sensors",
    "Changes to the deck",
]


def test_update_has_all_its_sections(update: dict[str, Any], cube: Geometry, diff: str) -> None:
    page = Reader(make_report(answer_of(update), diff, cube))
    assert page.headings == [h for h in SECTIONS if h != "Modes without a partner"]
    del update["after"]["pairs"][2]
    update["after"]["unpaired_test"] = [3]
    assert Reader(make_report(answer_of(update), diff, cube)).headings == SECTIONS


def test_discovery_has_all_its_sections(discovery: dict[str, Any], cube: Geometry) -> None:
    page = Reader(make_report(answer_of(discovery), None, cube))
    assert page.headings[:2] == ["What was found", "The gap"]
    assert "Also considered" in page.headings


def test_three_matrices_of_an_update(update: dict[str, Any]) -> None:
    captions = re.findall(r"<figcaption><b>([^<]*)</b>", make_report(answer_of(update)))
    assert captions[2:5] == ["As measured", "After rotation of close modes", "After updating"]


def test_stages_are_counted_through_and_their_objectives_kept_apart(
    update: dict[str, Any],
) -> None:
    for step, (stage, iteration) in zip(update["history"], [(1, 0), (1, 1), (2, 0)], strict=True):
        step |= {"stage": stage, "iteration": iteration}
    update["history"].append(update["history"][2] | {"iteration": 1, "objective": 1.0})
    charts = make_report(answer_of(update)).split('class="lines"')[1:]
    assert all('data-x="0 1 2 3"' in c for c in charts)
    assert all(">stage 2</text>" in c for c in charts)
    assert 'data-names="first stage|stage 2"' in charts[1]
    assert 'data-v="900 40  |  2 1"' in charts[1]


def test_the_page_needs_nothing_else(update: dict[str, Any], cube: Geometry, diff: str) -> None:
    html = make_report(answer_of(update), diff, cube)
    page = Reader(html)
    assert page.fetching == []
    assert page.scripts == 1
    assert not re.search(r"https?://|url\(|@import|fetch\(|XMLHttp|import\(", html)
    assert all(link.startswith("#") for link in page.links)
    assert {link[1:] for link in page.links} <= set(page.ids)
    assert len(page.ids) == len(set(page.ids))


def test_the_headline_comes_first(update: dict[str, Any]) -> None:
    html = make_report(answer_of(update))
    first = re.search(r"<h1>(.*?)</h1>", html)
    assert first is not None
    assert headline(answer_of(update)).startswith(first.group(1).replace("&nbsp;", " "))
    assert html.index("<h1>") < html.index("<table")


def test_a_run_of_which_a_table_is_missing_is_refused_by_its_name(update: dict[str, Any]) -> None:
    del update["after"]["pairs"]
    with pytest.raises(InputError, match=r"'after\.pairs' is missing"):
        answer_of(update)


def test_unknown_keys_are_passed_over(correlation: dict[str, Any]) -> None:
    before = make_report(answer_of(correlation))
    assert make_report(answer_of(correlation | {"colour": {"of": ["the", 1]}})) == before


def test_text_from_files_cannot_become_markup(update: dict[str, Any]) -> None:
    evil = '</script><script>alert("1")</script><img src=x onerror=y>'
    update["parameters"][0]["name"] = evil
    update["before"]["warnings"] = [evil]
    update["input_deck"] = evil
    page = Reader(make_report(answer_of(update), evil, title=evil))
    assert page.scripts == 1
    assert page.fetching == []


json_values = st.none() | st.text(max_size=5) | st.dictionaries(st.text(max_size=5), st.none())


def _paths(value: Any, at: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    items: Any = ()
    if isinstance(value, dict):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value)
    return [p for k, v in items for p in [(*at, k), *_paths(v, (*at, k))]]


@given(data=st.data())
@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_a_value_of_another_kind_is_refused_in_a_sentence_or_shown(
    data: st.DataObject,
    update: dict[str, Any],
    correlation: dict[str, Any],
    discovery: dict[str, Any],
    cube: Geometry,
) -> None:
    result = copy.deepcopy(data.draw(st.sampled_from([update, correlation, discovery])))
    *above, last = data.draw(st.sampled_from(_paths(result)))
    place = result
    for key in above:
        place = place[key]
    place[last] = data.draw(json_values)
    try:
        told = answer_of(result)
    except InputError:
        return
    Reader(make_report(told, None, cube))
    assert headline(told).endswith((".", "!", "?"))


def test_sensors_are_placed_where_they_are_told(update: dict[str, Any], cube: Geometry) -> None:
    def circles() -> list[str]:
        html = make_report(answer_of(update), None, cube)
        marks = re.findall(r'<g class="hot sensor">.*?(<circle[^>]*>)', html, re.DOTALL)
        return [re.sub(r' r=".*', "", c) for c in marks]

    first = circles()
    update["after"]["alignment"]["sensors"][2]["xyz"] = [1.0, 1.0, 0.0]
    moved = circles()
    assert moved[0] == first[0]
    assert moved[1] != first[1]


def test_effects_stand_at_their_place_with_those_that_explain_as_well(
    discovery: dict[str, Any], cube: Geometry
) -> None:
    html = make_report(answer_of(discovery), None, cube)
    front = html.split('class="scene"')[1]
    assert front.count('class="hot effect"') == 1
    assert front.count('class="hot credible"') == 2
    assert front.count('class="hot fault"') == 1
    assert "missing in the model" in html
    assert "fault of the test" in html


def test_a_typical_run_stays_small(update: dict[str, Any]) -> None:
    rng = np.random.default_rng(0)
    tests, modes = range(1, 25), range(1, 41)
    values = np.clip(0.9 * np.eye(24, 40) + 0.06 * np.abs(rng.normal(size=(24, 40))), 0.0, 1.0)
    matrix = {"test": list(tests), "analysis": list(modes), "values": values.tolist()}
    pairs = [
        {"test": t, "analysis": t, "test_hz": 10.0 * t, "analysis_hz": 10.1 * t, "mac": 0.9,
         "deviation_percent": 1.0, "cluster": 1, "rotation_deg": 12.0}
        for t in tests
    ]  # fmt: skip
    sensors = [
        {"node": n, "direction": d, "axis": axis, "xyz": rng.normal(size=3).tolist(),
         "nearest_grid": n, "distance": 1.0}
        for n in range(1, 101)
        for d, axis in zip(("+X", "+Y", "+Z"), np.eye(3).tolist(), strict=True)
    ]  # fmt: skip
    alignment = update["after"]["alignment"] | {"sensors": sensors}
    state = update["after"] | {
        "pairs": pairs, "mac": matrix, "mac_rotated": matrix, "unpaired_analysis": list(modes),
        "test_hz": [10.0 * t for t in tests], "analysis_hz": [10.1 * t for t in modes],
        "alignment": alignment,
    }  # fmt: skip
    history = [
        {"iteration": k, "stage": 1, "objective": 1.0 / (k + 1), "factors": [1.0] * 20,
         "deviations_percent": [1.0 / (k + 1)] * 24}
        for k in range(10)
    ]  # fmt: skip
    parameters = [update["parameters"][0] | {"name": f"skin {k}"} for k in range(20)]
    around, up = np.meshgrid(np.linspace(0, 2 * np.pi, 200, endpoint=False), np.linspace(0, 2, 100))
    xyz = np.stack([np.cos(around), np.sin(around), up], -1).reshape(-1, 3)
    at = np.arange(20000).reshape(100, 200)
    quad = np.stack([at[:-1], np.roll(at, -1, 1)[:-1], np.roll(at, -1, 1)[1:], at[1:]], -1)
    shell = Geometry(np.arange(1, 20001), xyz, "m", {"quad": quad.reshape(-1, 4)})
    run = update | {
        "before": state, "after": state, "history": history, "parameters": parameters,
    }  # fmt: skip
    assert len(make_report(answer_of(run), None, shell).encode()) < 300_000


def test_diff_marks_the_fields_that_changed(diff: str) -> None:
    html = deck_diff(diff)
    assert "<del>-PBAR    11      1       200.    <b>9000.   </b><b>9000.   </b>3000.</del>" in html
    assert "<b>15750.  </b><b>15750.  </b>3000.</ins>" in html
    assert "$ &lt;section &amp; more&gt;" in html
    assert '<span class="file">--- a/properties.bdf</span>' in html


def test_diff_of_free_fields_marks_characters() -> None:
    html = deck_diff("-PBAR,11,1,200.,9000.\n+PBAR,11,1,200.,9500.\n+$ new\n+$ newer\n")
    assert "<ins>+$ newer</ins>" in html
    html = deck_diff("-PBAR,11,1,200.,9000.\n+PBAR,11,1,200.,9500.\n")
    assert "<del>-PBAR,11,1,200.,9<b>0</b>00.</del>" in html


def test_diff_lines_that_look_like_headers_are_changes() -> None:
    html = deck_diff("@@ -1 +1 @@\n--5.\n++5.\n")
    assert html.count("<del>") == html.count("<ins>") == 1


def test_long_diffs_are_cut_aloud() -> None:
    html = deck_diff("".join(f"+GRID,{k}\n" for k in range(1000)))
    assert "… 400 more lines in changes.diff" in html
    assert html.count("<ins>") == 600


PROBE = """
const said = [];
const at = (node, type, x, y) => node.dispatchEvent(
  new PointerEvent(type, {clientX: x, clientY: y, bubbles: true}));
const tip = document.getElementById('tip');
const heat = document.querySelector('svg.heat');
heat.scrollIntoView();
let b = heat.getBoundingClientRect(), k = b.width / heat.viewBox.baseVal.width;
const cell = +heat.dataset.cell;
at(heat, 'pointermove', b.left + (84 + 1.5 * cell) * k, b.top + (8 + .5 * cell) * k);
said.push(tip.hidden ? '' : tip.textContent);
heat.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowDown'}));
said.push(tip.textContent);
at(heat, 'pointerleave', 0, 0);
said.push(tip.hidden);
const chart = document.querySelector('svg.lines');
chart.scrollIntoView();
b = chart.getBoundingClientRect(); k = b.width / chart.viewBox.baseVal.width;
at(chart, 'pointermove', b.left + +chart.dataset.px.split(' ')[2] * k, b.top + 20);
said.push(tip.textContent);
const bar = document.querySelector('svg.bars .hot');
at(bar, 'pointermove', 10, 10);
said.push(tip.textContent);
document.title = JSON.stringify(said);
"""


def titled(html: str, probe: str, folder: Path) -> Any:
    """What a probe script puts into the title, in a real browser."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        pytest.skip("no chromium on this machine")
    page = folder / "page.html"
    page.write_text(html.replace("</body>", f"<script>{probe}</script></body>"), encoding="utf-8")
    shown = subprocess.run(
        [browser, "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking",
         f"--user-data-dir={folder / 'profile'}", "--dump-dom", page.as_uri()],
        capture_output=True, text=True, timeout=120, check=True,
    )  # fmt: skip
    told = re.search(r"<title>(.*?)</title>", shown.stdout, re.DOTALL)
    assert told is not None
    return json.loads(unescape(told.group(1)))


@pytest.mark.slow
def test_values_appear_under_the_pointer(
    update: dict[str, Any], cube: Geometry, tmp_path: Path
) -> None:
    heat, down, hidden, line, bar = titled(
        make_report(answer_of(update), None, cube), PROBE, tmp_path
    )
    assert heat == "MAC 40.0 %\ntest 1 (10.00 Hz)\nanalysis 2 (9.00 Hz)"
    assert down == "MAC 10.0 %\ntest 2 (20.00 Hz)\nanalysis 2 (9.00 Hz)"
    assert hidden is True
    assert line.replace("▸ ", "") == "iteration 2\nfront flange: 1.75\nskin: 0.8"
    assert bar == "test mode 1, 10.00 Hz\nbefore: −10 %\nafter: 1 %"


SHAPES_PROBE = """
const said = [], strip = [...document.querySelectorAll('.strip button')];
const canvas = document.querySelector('.stage > canvas');
const inked = () => canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data
  .reduce((sum, v, k) => sum + (k % 4 === 3 && v > 0), 0);
document.querySelector('.controls button').click();
said.push(strip.length, inked() > 1000, document.querySelector('.stage svg') === null);
const before = canvas.toDataURL();
strip[1].click();
said.push(document.querySelector('.stage figcaption').textContent, canvas.toDataURL() !== before);
const pressed = strip.map(b => b.getAttribute('aria-pressed'));
canvas.dispatchEvent(new KeyboardEvent('keydown', {key: 'ArrowLeft'}));
said.push(pressed);
const ways = document.querySelector('.controls select');
said.push(['both', 'apart', 'test', 'analysis'].map(way => {
  ways.value = way; ways.dispatchEvent(new Event('change')); return canvas.toDataURL();
}));
strip[0].click();
const plain = document.querySelector('.controls input[type=checkbox]');
plain.checked = true; plain.dispatchEvent(new Event('change'));
said.push(document.querySelector('.stage > figcaption').textContent);
dispatchEvent(new Event('beforeprint'));
const stills = [...document.querySelectorAll('.stills figcaption')];
said.push([stills.length, stills[2].textContent]);
document.title = JSON.stringify(said);
"""


@pytest.mark.slow
def test_the_shapes_move_in_a_browser(
    correlation: dict[str, Any], cube: Geometry, tmp_path: Path
) -> None:
    at = Dofs(np.repeat(np.arange(1, 9), 3), np.tile(np.arange(1, 4), 8))
    analysis = Modes(np.arange(1.0, 5.0), np.random.default_rng(3).normal(size=(24, 4)), at)
    seen = sp.csr_matrix((np.ones(3), (range(3), (0, 2, 22))), shape=(3, 24))
    sensors = Dofs(np.array([101, 101, 108]), np.array([1, 3, 2]))
    test = Modes(np.arange(1.0, 4.0), (seen @ analysis.shapes)[:, :3], sensors)
    shapes = paired_film(answer_of(correlation).final, cube, analysis, test, seen)
    count, drawn, replaced, caption, changed, pressed, ways, plain, stills = titled(
        make_report(answer_of(correlation), None, cube, shapes=shapes), SHAPES_PROBE, tmp_path
    )
    assert count == 4
    assert drawn
    assert replaced
    assert caption.startswith("Test 2 (20.00 Hz) and analysis 1 (20.50 Hz), 2.5 %, MAC 92 %")
    assert changed
    assert pressed == ["false", "true", "false", "false"]
    assert len(set(ways)) == 4, "overlaid, side by side and each side alone are other pictures"
    assert plain.startswith("Test 1 (10.00 Hz) and analysis 2 (9.00 Hz), −10.0 %, MAC 40 %, before")
    assert stills == [4, "Test 3 (31.25 Hz), no partner"]
