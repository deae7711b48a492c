"""What a correlated model says of the frequency responses that were measured."""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Floats
from ...correlation.comparison import Comparison
from ...data.frfs import Frfs
from .frf_evidence import place_responses
from .frf_likelihood import State, frac, ratios_of, synthesised
from .likelihood_numbers import LIKELIHOOD


@dataclass(frozen=True, eq=False)
class ModelResponses:
    """Measured responses at sensors that lie on the model, and the model's.

    Parameters
    ----------
    measured, model : Frfs
        On the same lines, deck length unit; of the model by its modes as solved, with the damping
        of the test modes they pair with, one common factor taken out.
    frac : (n_response, n_reference) float
        Assurance over all lines, NaN where nothing was measured.
    """

    measured: Frfs
    model: Frfs
    frac: Floats


def model_responses(c: Comparison) -> ModelResponses | None:
    """Return measured responses beside those of the model; None where none lies on it."""
    placed, analysis = c.placed, c.analysis
    found, _ = place_responses(placed.frfs, placed, c.geometry, analysis.dofs, analysis.shapes)
    if found is None:
        return None
    damping, match = np.full(len(c.test), np.nan), np.zeros(len(c.test), np.int64)
    for p in c.correlation.pairs:
        damping[p.test], match[p.test] = c.test.damping[p.test], p.analysis
    omega = 2.0 * np.pi * analysis.frequencies_hz
    state = State(omega, ratios_of(damping, match, len(omega)), np.real(analysis.shapes))
    measured = found.frfs
    none = np.zeros(measured.values.shape[:2])
    made = synthesised(found, state, none)
    known = np.isfinite(measured.values) & (np.abs(measured.values) > 0.0) & (np.abs(made) > 0.0)
    if not known.any():
        return None
    ratio = np.abs(measured.values[known]) / np.abs(made[known])
    made = made * np.exp(np.mean(np.log(ratio)))
    seen = np.isfinite(measured.values).any(axis=-1)
    share = np.where(seen, frac(measured.values, made), np.nan)
    f = measured.frequencies_hz
    at = np.searchsorted(f, [*c.test.frequencies_hz, *analysis.frequencies_hz])
    even = np.linspace(0, len(f) - 1, min(len(f), LIKELIHOOD.pictured)).round()
    lines = np.unique(np.concatenate([even, at.clip(max=len(f) - 1)])).astype(np.int64)
    shown = replace(measured, frequencies_hz=f[lines], values=measured.values[..., lines])
    return ModelResponses(shown, replace(shown, values=made[..., lines], source="model"), share)
