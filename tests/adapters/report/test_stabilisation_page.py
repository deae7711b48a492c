"""The stabilisation chart as a self-contained page."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from trueup.adapters.report.pictures.function_overlay import function_overlay, identified_curves
from trueup.adapters.report.pictures.stabilisation_chart import stabilisation_chart
from trueup.adapters.report.stabilisation_page import modes_table, stabilisation_page
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.identification.identify import identify
from trueup.core.identification.rejected import Rejected
from trueup.core.identification.result import Identification

ROOTS = (20.0, 50.0, 80.0)


def survey(lines: int = 600, seed: int = 1, references: int = 1) -> Frfs:
    """Three modes at four sensors, the first of which are references, 0.5 % noise."""
    rng = np.random.default_rng(seed)
    f = np.linspace(5.0, 100.0, lines)
    s, shapes = 2j * np.pi * f, rng.standard_normal((4, 3))
    values = np.zeros((4, references, lines), complex)
    for k, hz in enumerate(ROOTS):
        w = 2.0 * np.pi * hz
        gain = s**2 / (s**2 + 0.02 * w * s + w**2)
        values += shapes[:, k, None, None] * shapes[:references, k, None] * gain
    noise = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values += 0.005 * np.sqrt(np.mean(np.abs(values) ** 2)) * noise
    nodes = Dofs(np.array([1, 2, 3, 4]), np.full(4, 3))
    return Frfs(f, nodes, nodes.take(np.arange(references)), values, "acceleration", "a < beam")


@pytest.fixture(scope="module")
def found() -> Identification:
    return identify(survey())


def svg_of(page: str) -> ElementTree.Element:
    drawn = re.search(r"<svg.*?</svg>", page, re.DOTALL)
    assert drawn
    return ElementTree.fromstring(drawn.group())


def of_class(svg: ElementTree.Element, name: str) -> list[ElementTree.Element]:
    return [e for e in svg.iter() if name in (e.get("class") or "").split()]


def test_every_mode_is_a_line_at_its_frequency(found: Identification) -> None:
    svg = svg_of(stabilisation_chart(found))
    drawn = of_class(svg, "mode")
    assert len(drawn) == len(found.modes) == 3
    ends = [re.findall(r"L([\d.]+)", e.find("path").get("d"))[0] for e in drawn]  # type: ignore[union-attr,arg-type]
    at = np.array([float(x) for x in ends])
    hz = found.modes.frequencies_hz
    assert (at - at[0]) / (at[-1] - at[0]) == pytest.approx(
        (hz - hz[0]) / (hz[-1] - hz[0]), abs=2e-4
    )
    for k, e in enumerate(of_class(svg, "hit")):
        said = e.find("title").text or ""  # type: ignore[union-attr]
        assert said.startswith(f"mode {k + 1}: {hz[k]:.2f} ± ")


@pytest.mark.parametrize("references", [1, 2])
def test_every_pole_is_marked_by_what_of_it_stayed(references: int) -> None:
    """A single reference takes part in all poles alike, so nothing is said of participation."""
    found = identify(survey(references=references))
    page = stabilisation_chart(found)
    svg = svg_of(page)
    f, c = found.cmif.frequencies_hz, found.chart
    inside = (c.frequency_hz >= f[0]) & (c.frequency_hz <= f[-1])
    names = ("new", "frequency", *["damping"] * (references > 1), "shape")
    drawn = [sum((e.get("d") or "").count("M") for e in of_class(svg, n)) for n in names]
    level = np.minimum(c.level[inside], len(names) - 1)
    assert drawn == np.bincount(level, minlength=len(names)).tolist()
    assert drawn[-1] > 9
    assert ("and participation" in page) == (references == 2)


def test_every_rejected_root_is_a_cross_with_its_reason(found: Identification) -> None:
    some = replace(found, rejected=(Rejected(33.3, 0.02, "too wide & weak"),))
    (cross,) = of_class(svg_of(stabilisation_chart(some)), "reject")
    said = "rejected: 33.30 Hz, damping 2.000 %\ntoo wide & weak"
    assert cross.find("title").text == said  # type: ignore[union-attr]


def test_the_indicator_peaks_where_the_modes_are(found: Identification) -> None:
    svg = svg_of(stabilisation_chart(found))
    curve, _ = of_class(svg, "curve")  # and the linear one
    points = np.array(
        [[float(v) for v in p.split()] for p in (curve.get("d") or "")[1:].split("L")]
    )
    x = [
        float(re.findall(r"L([\d.]+)", e.find("path").get("d"))[0])  # type: ignore[union-attr,arg-type]
        for e in of_class(svg, "mode")
    ]
    for at in x:
        near = np.abs(points[:, 0] - at) < 40.0
        highest = points[near][np.argmin(points[near][:, 1])]  # y points down
        assert abs(highest[0] - at) < 6.0


def test_a_long_survey_stays_small_and_keeps_its_peaks() -> None:
    found = identify(survey(8000))
    curve, _ = of_class(svg_of(stabilisation_chart(found)), "curve")
    y = [float(p.split()[1]) for p in (curve.get("d") or "")[1:].split("L")]
    assert len(y) <= 2 * 1056
    few = identify(survey(600))
    other, _ = of_class(svg_of(stabilisation_chart(few)), "curve")
    peak = min(float(p.split()[1]) for p in (other.get("d") or "")[1:].split("L"))
    assert min(y) == pytest.approx(peak, abs=6.0)


def test_the_page_needs_nothing_else(found: Identification) -> None:
    page = stabilisation_page(found, "a < b & c")
    assert "a &lt; b &amp; c" in page
    assert "a < b" not in page
    assert not re.search(r"(src|href)=|https?://|@import", page)
    assert "3 modes between 5 and 100 Hz from 4 responses and 1 reference" in page
    assert "one reference cannot tell two roots" in page


def test_the_table_says_what_was_found(found: Identification) -> None:
    table = modes_table(found)
    assert [row[1].text for row in table.rows] == [f"{f:.2f}" for f in found.modes.frequencies_hz]
    assert all(row[-1].text.endswith("a close pair may hide here") for row in table.rows)


def test_what_takes_no_part_is_left_blank() -> None:
    found = identify(survey(), bands=[(10.0, 30.0), (70.0, 95.0)])
    svg = svg_of(stabilisation_chart(found))
    (blank,) = of_class(svg, "out")
    left, wide = float(blank.get("x") or 0), float(blank.get("width") or 0)
    x = [float(e.find("rect").get("x")) + 3 for e in of_class(svg, "hit")]  # type: ignore[union-attr,arg-type]
    per_hz = (x[1] - x[0]) / 60.0  # from 20 to 80 Hz
    assert left == pytest.approx(x[0] + 10.0 * per_hz, abs=2.0)
    assert wide == pytest.approx(40.0 * per_hz, abs=3.0)


def test_nothing_found_is_said_and_still_drawn() -> None:
    flat = identify(survey(), fmin=5.0, fmax=12.0)
    assert len(flat.modes) == 0
    page = stabilisation_page(flat)
    assert "No mode between 5" in page
    assert of_class(svg_of(page), "curve")
    assert "<table" not in page
    assert "viewer" not in page.split("</style>")[1].split("<script>")[0]


def codes(page: str, name: str, kind: type[np.generic]) -> np.ndarray:
    packed = re.search(rf'data-{name}="([^"]+)"', page)
    assert packed
    return np.frombuffer(base64.b64decode(packed.group(1)), kind)


def test_measured_and_synthesised_functions_lie_over_each_other(found: Identification) -> None:
    page = function_overlay(identified_curves(found))
    low, high = map(float, re.findall(r'data-decades="(\S+) (\S+)"', page)[0])
    size = codes(page, "size", np.uint8).reshape(4, 2, 600)
    angle = codes(page, "angle", np.int8).reshape(4, 2, 600)
    for k, values in enumerate((found.measured.values, found.synthesised().values)):
        drawn = low + (high - low) * size[:, k] / 255.0
        assert drawn == pytest.approx(np.log10(np.abs(values[:, 0])), abs=(high - low) / 500)
        turned = np.exp(1j * np.pi * angle[:, k] / 127.0) * np.exp(-1j * np.angle(values[:, 0]))
        assert np.abs(np.angle(turned)).max() < np.pi / 250
    options = re.findall(r"<option[^>]*>([^<]+)<", page)
    assert options == [
        f"{node}:Z / 1:Z · FRAC {100 * v:.1f} %" for node, v in enumerate(found.frac[:, 0], 1)
    ]
    assert "All 600 lines are drawn" in page


def test_many_long_functions_are_thinned_but_not_at_the_modes() -> None:
    found = identify(survey(8000))
    page = function_overlay(identified_curves(found))
    f = np.array([float(v) for v in re.findall(r'data-f="([^"]+)"', page)[0].split()])
    assert f"Drawn are {len(f)} of 8000 lines" in page
    assert len(f) < 900
    assert len(page) < 80_000
    step = 95.0 / 7999
    for hz in found.modes.frequencies_hz:
        near = f[np.abs(f - hz) < 0.01 * hz]
        assert np.abs(near - hz).min() < 2 * step
        assert np.diff(near).max() < 0.5 * np.diff(f).max()


def test_functions_of_least_assurance_come_first(found: Identification) -> None:
    page = stabilisation_page(found)
    listed = re.findall(r'data-function="(\d):Z / 1:Z">.*?>([\d.]+) %<', page)
    values = [float(v) for _, v in listed]
    assert values == sorted(values)
    assert [int(n) for n, _ in listed] == (np.argsort(found.frac[:, 0]) + 1).tolist()
    assert found.frac.min() > 0.99


def test_what_was_not_measured_has_no_assurance() -> None:
    whole = survey(references=2)
    values = whole.values.copy()
    values[2, 1] = np.nan
    found = identify(replace(whole, values=values))
    assert np.argwhere(np.isnan(found.frac)).tolist() == [[2, 1]]
    assert function_overlay(identified_curves(found)).count("<option") == 7


def test_shapes_of_the_test_move_on_its_page(found: Identification) -> None:
    geometry = Geometry(np.arange(1, 5), np.eye(4)[:, :3], "m")
    page = stabilisation_page(found, geometry=geometry)
    assert "mode 1 at 20.00 Hz, damping 1.00 %, MPC 100.0 %|mode 2 at 50.00 Hz" in page
    assert "The file holds no lines" in page
