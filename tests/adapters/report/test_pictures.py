"""Heat maps, charts, colours: what is drawn is what was given."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, strategies as st

from trueup.adapters.report.pictures.axes import Plot, decades, spread, ticks
from trueup.adapters.report.pictures.charts import Series, bars, lines
from trueup.adapters.report.pictures.colour import STEPS, oklch, ramp, series
from trueup.adapters.report.pictures.heatmap import heatmap
from trueup.core.results.correlation import MacTable

VALUES = np.array([[0.974, 0.02, np.nan], [0.0, 0.5, 1.0]])
TEST_HZ = np.array([10.0, 20.0])
ANALYSIS_HZ = np.arange(8.0, 15.0)
MATRIX = MacTable((1, 2), (4, 5, 7), VALUES)


def parsed(figure: str) -> ET.Element:
    return ET.fromstring(re.sub(r"<details>.*?</details>", "", figure))


def drawn() -> ET.Element:
    return parsed(
        heatmap(
            MATRIX,
            "As <measured>",
            test_hz=TEST_HZ,
            analysis_hz=ANALYSIS_HZ,
            pairs=[(1, 4), (2, 99)],
            clusters=[([1, 2], [4, 5])],
        )
    )


def test_every_cell_has_the_colour_of_its_value() -> None:
    svg = drawn().find("svg")
    assert svg is not None
    cell = int(svg.attrib["data-cell"])
    colour: dict[tuple[int, int], str] = {}
    for path in svg.iter("path"):
        name = path.get("class") or ""
        if re.fullmatch(r"c\d+|unknown", name):
            for x, y in re.findall(r"M(\d+) (\d+)h", path.attrib["d"]):
                colour[int(y) // cell, int(x) // cell] = name
    assert colour == {(0, 0): "c19", (0, 2): "unknown", (1, 1): "c10", (1, 2): "c19"}


def test_the_pointer_reads_the_values_back() -> None:
    svg = drawn().find("svg")
    assert svg is not None
    code = svg.attrib["data-v"]
    read = [None if c == "--" else int(c, 36) / 1000 for c in re.findall("..", code)]
    assert read == [0.974, 0.02, None, 0.0, 0.5, 1.0]
    assert svg.attrib["data-rows"] == "1 (10.00 Hz)|2 (20.00 Hz)"
    assert svg.attrib["data-cols"] == "4 (11.00 Hz)|5 (12.00 Hz)|7 (14.00 Hz)"


def test_pairs_are_ringed_and_unknown_ones_passed_over() -> None:
    rings = [r for g in drawn().iter("g") if g.get("class") == "rings" for r in g]
    assert [(r.attrib["x"], r.attrib["y"]) for r in rings] == [("0.75", "0.75")]


def test_clusters_are_framed_along_their_outer_edge_only() -> None:
    frames = [p for g in drawn().iter("g") if g.get("class") == "clusters" for p in g]
    assert frames[0].attrib["d"].count("M") == 8  # a block of 2 by 2: eight outer edges


def test_values_stand_in_a_table_too() -> None:
    html = heatmap(MATRIX, "x", test_hz=TEST_HZ, analysis_hz=ANALYSIS_HZ)
    assert "<tr><th>1</th><td>97<td>2<td>–</tr>" in html


def lightness(colour: str) -> float:
    """Oklab lightness of a hex colour, computed the other way round."""
    rgb = np.array([int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)])
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    lms = np.array([[0.4122214708, 0.5363325363, 0.0514459929],
                    [0.2119034982, 0.6806995451, 0.1073969566],
                    [0.0883024619, 0.2817188376, 0.6299787005]]) @ linear  # fmt: skip
    return float(np.array([0.2104542553, 0.7936177850, -0.0040720468]) @ np.cbrt(lms))


@pytest.mark.parametrize("dark", [False, True])
def test_equal_steps_of_the_value_look_equal(dark: bool) -> None:
    steps = np.diff([lightness(c) for c in ramp(dark=dark)])
    assert np.all(np.sign(steps) == (1 if dark else -1))
    np.testing.assert_allclose(steps, steps.mean(), atol=0.006)


def test_primaries_come_back_from_oklch() -> None:
    assert oklch(1.0, 0.0, 0.0) == "#ffffff"
    assert oklch(0.0, 0.0, 0.0) == "#000000"
    assert oklch(0.627955, 0.257683, 29.2339) == "#ff0000"
    assert len(set(series(8, dark=False))) == 8


@given(low=st.floats(-1e6, 1e6), span=st.floats(1e-2, 1e9), about=st.integers(1, 9))
def test_ticks_are_round_cover_and_are_few(low: float, span: float, about: int) -> None:
    found = ticks(low, low + span, about)
    step = found[1] - found[0]
    slack = 1e-6 * step + 1e-9 * abs(low)
    assert found[0] <= low + slack
    assert found[-1] >= low + span - slack
    assert len(found) <= 2.5 * about + 4
    mantissa = step / 10.0 ** math.floor(math.log10(step) + 1e-6)
    assert min(abs(mantissa - m) for m in (1, 2, 5, 10)) < 1e-3


def test_decades_cover() -> None:
    assert decades(3.2, 903.0) == [1.0, 10.0, 100.0, 1000.0]
    assert decades(1.0, 1.0) == [1.0, 10.0]


@given(st.lists(st.floats(0, 100), min_size=1, max_size=8))
def test_labels_keep_their_order_and_distance(wanted: list[float]) -> None:
    placed = spread(wanted, 12.5, 0.0, 100.0)
    order = sorted(range(len(wanted)), key=lambda k: wanted[k])
    assert all(placed[b] - placed[a] >= 12.5 - 1e-9 for a, b in pairwise(order))
    assert min(placed) >= 6.25 - 1e-9
    assert max(placed) <= 100.0 - 6.25 + 1e-9
    if len(wanted) == 1 and 6.25 <= wanted[0] <= 93.75:
        assert placed == pytest.approx(wanted)


def test_plot_scales() -> None:
    plot = Plot(10, 20, 100, 50, 0.0, 5.0, (1.0, 10.0, 100.0), log=True)
    assert [plot.x(0), plot.x(5)] == [10, 110]
    assert [plot.y(v) for v in (1.0, 10.0, 100.0)] == pytest.approx([70, 45, 20])


def test_lines_break_where_a_value_is_missing() -> None:
    figure = parsed(
        lines(
            "Deviations",
            [0, 1, 2, 3],
            [Series("a", (1.0, None, 3.0, 4.0)), Series("b", (0.0,) * 4)],
        )
    )
    first = next(p for g in figure.iter("g") if g.get("class") == "series" for p in g)
    assert re.sub(r"[\d.]+ [\d.]+", "·", first.attrib["d"]) == "M·M·L·"
    svg = figure.find("svg")
    assert svg is not None
    assert svg.attrib["data-v"] == "1  3 4|0 0 0 0"
    assert svg.attrib["data-names"] == "a|b"


def test_nothing_to_draw_is_no_chart() -> None:
    assert lines("x", [0], [Series("a", (1.0,))]) == ""
    assert lines("x", [0, 1], [Series("a", (None, None))]) == ""
    assert bars("x", [("1", "")], {"": [None]}, unit="%") == ""


def test_bars_are_as_high_as_their_values() -> None:
    states = {"before": [-4.0, None], "after": [2.0, 1.0]}
    figure = parsed(bars("d", [("1", "9.9"), ("2", "")], states, unit="%"))
    heights = {
        kind: [float(r.attrib["height"]) for r in figure.iter("rect") if r.get("class") == kind]
        for kind in ("then", "now")
    }
    assert heights["then"][0] == pytest.approx(2 * heights["now"][0], abs=0.2)
    assert heights["now"][0] == pytest.approx(2 * heights["now"][1], abs=0.2)
    assert [t.text for t in figure.iter("title")] == [
        "test mode 1, 9.9 Hz\nbefore: −4 %\nafter: 2 %",
        "test mode 2\nbefore: no partner\nafter: 1 %",
    ]
    assert len([c for c in figure.iter("circle") if c.get("class") == "none"]) == 1


def test_ramp_has_a_class_every_five_percent() -> None:
    assert STEPS == 20


def test_a_large_matrix_is_shown_in_parts_with_numbers() -> None:
    from trueup.adapters.report.pictures.heatmap import readable

    values = np.arange(70.0 * 60).reshape(70, 60)
    whole = MacTable(tuple(range(1, 71)), tuple(range(1, 61)), values)
    parts = list(readable(whole))
    assert [p.values.shape for p, _ in parts] == [(35, 30)] * 4
    assert parts[1][1] == ", modes 1 to 35 and 31 to 60"
    np.testing.assert_array_equal(np.hstack([p.values for p, _ in parts[:2]]), values[:35])
    small = MacTable((1, 2), (1,), values[:2, :1])
    assert [(p.test, said) for p, said in readable(small)] == [((1, 2), "")]
