"""The stabilisation chart as a self-contained page."""

from __future__ import annotations

import re
from xml.etree import ElementTree

import numpy as np
import pytest

from trueup.adapters.report.stabilisation_page import (
    modes_table,
    stabilisation_chart,
    stabilisation_page,
)
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification import Identification, identify

ROOTS = (20.0, 50.0, 80.0)


def survey(lines: int = 600, seed: int = 1) -> Frfs:
    """Three modes at four sensors and one reference that is one of them, 0.5 % noise."""
    rng = np.random.default_rng(seed)
    f = np.linspace(5.0, 100.0, lines)
    s, shapes = 2j * np.pi * f, rng.standard_normal((4, 3))
    values = np.zeros((4, 1, lines), complex)
    for k, hz in enumerate(ROOTS):
        w = 2.0 * np.pi * hz
        values[:, 0] += np.outer(shapes[:, k] * shapes[0, k], s**2 / (s**2 + 0.02 * w * s + w**2))
    noise = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values += 0.005 * np.sqrt(np.mean(np.abs(values) ** 2)) * noise
    nodes = Dofs(np.array([1, 2, 3, 4]), np.full(4, 3))
    return Frfs(f, nodes, nodes.take(np.array([0])), values, "acceleration", "a < beam")


@pytest.fixture(scope="module")
def found() -> Identification:
    return identify(survey())


def svg_of(page: str) -> ElementTree.Element:
    drawn = re.search(r"<svg.*</svg>", page, re.DOTALL)
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
    for k, e in enumerate(drawn):
        said = e.find("title").text or ""  # type: ignore[union-attr]
        assert said.startswith(f"mode {k + 1}: {hz[k]:.2f} ± ")


def test_every_pole_of_the_chart_is_a_dot(found: Identification) -> None:
    svg = svg_of(stabilisation_chart(found))
    f = found.cmif.frequencies_hz
    inside = (found.chart.frequency_hz >= f[0]) & (found.chart.frequency_hz <= f[-1])
    for name, chosen in (("stable", found.chart.stable), ("loose", ~found.chart.stable)):
        dots = sum((e.get("d") or "").count("h0") for e in of_class(svg, name))
        assert dots == np.count_nonzero(inside & chosen)
    assert np.count_nonzero(inside & found.chart.stable) > 9


def test_the_indicator_peaks_where_the_modes_are(found: Identification) -> None:
    svg = svg_of(stabilisation_chart(found))
    (curve,) = of_class(svg, "curve")
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
    (curve,) = of_class(svg_of(stabilisation_chart(found)), "curve")
    y = [float(p.split()[1]) for p in (curve.get("d") or "")[1:].split("L")]
    assert len(y) <= 2 * 1056
    few = identify(survey(600))
    (other,) = of_class(svg_of(stabilisation_chart(few)), "curve")
    peak = min(float(p.split()[1]) for p in (other.get("d") or "")[1:].split("L"))
    assert min(y) == pytest.approx(peak, abs=6.0)


def test_the_page_needs_nothing_else(found: Identification) -> None:
    page = stabilisation_page(found, "a < b & c")
    assert "a &lt; b &amp; c" in page
    assert "a < b" not in page
    assert not re.search(r"(src|href)=|https?://|@import|<script", page)
    assert "3 modes between 5 and 100 Hz from 4 responses and 1 reference" in page
    assert "one reference cannot tell two roots" in page


def test_the_table_says_what_was_found(found: Identification) -> None:
    table = modes_table(found)
    assert [row[1].text for row in table.rows] == [f"{f:.2f}" for f in found.modes.frequencies_hz]
    assert all(row[-1].text.endswith("a close pair may hide here") for row in table.rows)


def test_nothing_found_is_said_and_still_drawn() -> None:
    flat = identify(survey(), fmin=5.0, fmax=12.0)
    assert len(flat.modes) == 0
    page = stabilisation_page(flat)
    assert "No mode between 5" in page
    assert of_class(svg_of(page), "curve")
    assert "<table" not in page
