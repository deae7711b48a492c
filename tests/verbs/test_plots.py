"""A result draws itself with matplotlib, and shows itself in a line and on a page."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import trueup

pytest.importorskip("matplotlib")

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"


@pytest.fixture(scope="module")
def found() -> trueup.Correlated:
    return trueup.correlate(DUCT / "duct.bdf", DUCT / "duct_test.unv", deck_length_unit="mm")


def test_the_mac_figure_frames_every_pair(found: trueup.Correlated) -> None:
    figure = found.plot.mac()
    axes, bar = figure.axes
    shown = len(axes.get_xticks())
    assert axes.get_ylabel() == "test mode, Hz"
    assert axes.get_xlabel().startswith("analysis mode, Hz")
    assert f"({len(found.mac.analysis) - shown} more " in axes.get_xlabel()
    assert bar.get_ylabel() == "MAC, %"
    assert axes.get_images()[0].get_clim() == (0.0, 100.0)
    assert len(axes.patches) == len(found.pairs)
    assert axes.get_yticklabels()[0].get_text() == "1 · 33.91 · n = 2, 66.7°"
    assert axes.get_title() == "MAC after rotation of close modes"
    assert found.plot.mac(rotated=False).axes[0].get_title() == "MAC"


def test_the_bars_are_the_deviations(found: trueup.Correlated) -> None:
    upper, lower = found.plot.frequencies().axes
    assert "%" in upper.get_ylabel()
    assert lower.get_xlabel() == "test mode, Hz"
    heights = [bar.get_height() for bar in upper.patches]
    assert heights == [p.deviation_percent for p in sorted(found.pairs, key=lambda p: p.test)]


def test_shapes_are_those_of_the_modes_that_are_asked_for(found: trueup.Correlated) -> None:
    figure = found.plot.shapes([1, 3])
    assert [a.get_title().split("\n")[0] for a in figure.axes] == [
        "test 1: 33.91 Hz", "test 3: 55.47 Hz",
    ]  # fmt: skip
    assert "without a partner" not in figure.get_suptitle()
    assert "without a partner: 7, " in found.plot.shapes().get_suptitle()
    for axes in figure.axes:
        for points in (np.concatenate(c._segments3d) for c in axes.collections[:2]):
            low, high = np.array([axes.get_xlim(), axes.get_ylim(), axes.get_zlim()]).T
            assert ((points >= low - 1e-9) & (points <= high + 1e-9)).all()
    with pytest.raises(trueup.InputError, match="test mode 7 has no partner to draw"):
        found.plot.shapes([1, 7])


def test_the_misfit_names_the_worst_sensors(found: trueup.Correlated) -> None:
    axes, bar = found.plot.misfit().axes
    assert "%" in bar.get_ylabel()
    named = {t.get_text().strip() for t in axes.texts}
    assert {"39:Y", "21:Y"} < named


def test_a_figure_is_a_picture_in_a_notebook(found: trueup.Correlated) -> None:
    assert found.plot.frequencies()._repr_png_().startswith(b"\x89PNG")


def test_without_matplotlib_a_sentence_says_what_to_install(
    found: trueup.Correlated, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    for picture in (found.plot.mac, found.plot.shapes, found.plot.frequencies, found.plot.misfit):
        with pytest.raises(trueup.InputError, match=r"^matplotlib is not installed: .*\[plot\]"):
            picture()


def test_a_result_is_its_headline_and_its_first_tables(found: trueup.Correlated) -> None:
    assert repr(found).startswith("Correlated: 12 of 24 test modes pair with the model")
    assert len(repr(found)) < 250
    page = found._repr_html_()
    assert page.startswith("<p>12 of 24 test modes pair with the model")
    assert page.count("<table") == 1
    assert "<th" in page
    assert "deviation %" in page


def test_waves_round_the_axis_are_named_on_axes_and_page(
    found: trueup.Correlated, tmp_path: Path
) -> None:
    """Modes of the duct are waves: those of its pairs stand beside their frequencies."""
    pair = next(p for p in found.pairs if p.test_harmonic is not None)
    words = pair.waves_by_side[0]
    assert words.startswith(f"n = {pair.test_harmonic}, ")
    assert words.endswith("°")
    made = found.plot.mac()
    assert any(words in t.get_text() for t in made.axes[0].get_yticklabels())
    bars = found.plot.frequencies().axes[1].get_xticklabels()
    assert any(f"n = {pair.test_harmonic}" in t.get_text() for t in bars)
    page = (found.save(tmp_path / "run") / "report.html").read_text(encoding="utf-8")
    assert f"Hz, {words})" in page
