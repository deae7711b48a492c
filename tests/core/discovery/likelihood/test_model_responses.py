"""Responses of a correlated model over those measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes

DUCT = Path(__file__).parents[4] / "fixtures" / "duct" / "duct.bdf"
RATIO = 0.015


@pytest.fixture(scope="module")
def run() -> trueup.Correlated:
    """The duct beside what it would say itself, in a scale of its own."""
    solved = trueup.solve(DUCT, 30)
    nodes = solved.geometry.ids[::90]
    at = Dofs(np.repeat(nodes, 3), np.tile([1, 2, 3], len(nodes)))
    rows = [int(np.flatnonzero((solved.shapes.dofs.node == n) & (solved.shapes.dofs.component == c))
                [0]) for n, c in zip(at.node, at.component, strict=True)]  # fmt: skip
    xyz = solved.geometry.xyz[solved.geometry.index_of(nodes)]
    elastic = slice(solved.rigid_body_modes, None)
    modes = solved.shapes.take(np.arange(len(solved.shapes))[elastic])
    known = np.full(len(modes), RATIO)
    modes = Modes(modes.frequencies_hz, modes.shapes[rows], at, damping=known)
    measured = Measurement(Geometry(nodes, xyz, "mm"), modes=modes)
    alone = trueup.correlate(DUCT, measured, deck_length_unit="mm", rotate="none")
    every = alone.content.modes["analysis"]
    f, by = np.linspace(20.0, 120.0, 400), [1, 32]
    phi, jw, w = every.shapes[rows], 2j * np.pi * f, 2 * np.pi * every.frequencies_hz[:, None]
    gain = jw**2 / (jw**2 + 2 * RATIO * w * jw + w**2)
    H = np.einsum("ok,ik,kf->oif", phi, phi[by], gain)
    frfs = Frfs(f, at, at.take(np.array(by)), 4.2 * H)
    told = replace(measured, frfs=frfs)
    return trueup.correlate(DUCT, told, deck_length_unit="mm", rotate="none")


def test_a_model_says_what_it_says_but_for_one_factor(run):
    measured, model = run.content.frfs["measured"], run.content.frfs["model"]
    np.testing.assert_array_equal(measured.frequencies_hz, model.frequencies_hz)
    size = np.abs(measured.values).max(axis=-1, keepdims=True)
    assert np.abs((model.values - measured.values) / size).max() < 1e-9
    frac = np.asarray(run.content.matrices["frac"])
    assert frac.min() > 1.0 - 1e-9


def test_the_report_shows_them_and_can_be_made_again(run, tmp_path):
    folder = run.save(tmp_path / "run")
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert 'class="overlaid"' in page
    assert 'data-made="the model"' in page
    trueup.open_run(folder)
    from trueup.verbs.runs.report import report

    assert report(folder).read_text(encoding="utf-8") == page
