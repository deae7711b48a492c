"""Surveys whose points have frequencies of their own: scatter makes no modes, whatever is cut."""

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.imperfect_surveys import survey as imperfect

from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.identify import identify

PLATE = [27.9, 59.4, 80.2, 111.68, 111.86, 164.1, 167.4, 197.0]


def plate(noise, gain, beta, *, alpha=0.15, spacing=0.125):
    """48 points, 2 references, frequencies that scatter by 0.03 % from point to point."""
    rng = np.random.default_rng(0)
    hz = np.array(PLATE) * (1.0 + 3e-4 * rng.standard_normal((48, 1)))
    shapes = rng.standard_normal((48, len(PLATE)))
    f = np.arange(10.0, 200.0, spacing)
    omega, own = 2.0 * np.pi * f, 2.0 * np.pi * hz[:, :, None]
    zeta = alpha / own + beta * own
    peaks = -(omega**2) / (own**2 - omega**2 + 2j * zeta * own * omega)
    values = np.einsum("ok,ik,okn->oin", shapes, shapes[[9, 31]], peaks)
    e = rng.standard_normal(values.shape) + 1j * rng.standard_normal(values.shape)
    values *= 1.0 + gain * rng.standard_normal(values.shape[:2])[:, :, None]
    values += noise * np.sqrt(np.mean(np.abs(values) ** 2, axis=2, keepdims=True)) * e
    dofs = Dofs(np.arange(1, 49), np.full(48, 3))
    return Frfs(f, dofs, dofs.take(np.array([9, 31])), values)


@pytest.mark.parametrize("ends", [(10, 175), (10, 180), (15, 185)])
@pytest.mark.parametrize("made", [(1e-3, 0.01, 6e-6), (5e-4, 0.0, 1.2e-5)])
def test_the_ends_of_the_range_decide_nothing(made, ends):
    """Roots that split a scattering resonance leave little over: that alone makes them no modes."""
    found = identify(plate(*made), fmin=ends[0], fmax=ends[1]).modes.frequencies_hz
    assert found == pytest.approx(PLATE[:-1], rel=1e-3)


@pytest.mark.parametrize("seed", [5200, 5201])
def test_what_was_not_measured_doubles_no_resonance(seed):
    """Half of the points have functions to one of two references only."""
    frfs, truth = imperfect(seed, "scatter")
    values = np.array(frfs.values)[:, :2]
    values[20:, 1] = np.nan
    found = identify(replace(frfs, values=values, references=frfs.references.take(np.arange(2))))
    assert found.modes.frequencies_hz == pytest.approx(truth, rel=1e-3)
    assert any("lacks 20 of 80 combinations" in w for w in found.warnings)


@pytest.mark.parametrize("left_out", [None, 3, 30])
def test_modes_that_few_lines_resolve_do_not_hide_the_scatter(left_out):
    """What scatter leaves of narrow modes is as rough as noise; one point more or less decides
    nothing."""
    frfs = plate(1e-3, 0.01, 1.2e-6, alpha=0.6, spacing=0.25)
    keep = np.array([o for o in range(48) if o != left_out])
    frfs = replace(frfs, values=frfs.values[keep], responses=frfs.responses.take(keep))
    found = identify(frfs, fmin=10.0, fmax=180.0).modes.frequencies_hz
    assert found == pytest.approx(PLATE[:-1], rel=1e-3)
