"""Complex shapes turned to their principal phase, and the real shapes closest to them."""

from __future__ import annotations

import numpy as np

from ..arrays import Floats, Numbers
from ..clusters import clusters_by_bandwidth

_PAIR_WIDTH = 0.01  # frequencies closer than this are a subspace
_PARALLEL = 0.4  # ratio of singular values below which real shapes of a pair are nearly one


def turned_to_principal_phase(shapes: Numbers) -> Numbers:
    """Divide each column by the phase that makes it most real; largest component positive."""
    phase = 0.5 * np.angle(np.sum(shapes**2, axis=0))
    turned = shapes * np.exp(-1j * phase)
    if len(turned):
        largest = np.argmax(np.abs(turned), axis=0)
        turned = turned * np.where(turned[largest, np.arange(turned.shape[1])].real < 0, -1, 1)
    return np.asarray(turned)


def real_shapes(frequencies_hz: Floats, shapes: Numbers, weight: Floats) -> Floats:
    """Real shapes of complex ones already turned to their principal phase.

    Modes that stand alone keep their real part. A close pair is a subspace: its complex shapes
    may be any mixture, even one whose real parts are parallel. Where that happens the real parts
    are replaced by the real basis of the subspace that lies closest to them.

    Parameters
    ----------
    frequencies_hz : (n_mode,) float
    shapes : (n_output, n_mode) complex
    weight : (n_output,) float
        One over the noise, for the subspace.

    Returns
    -------
    (n_output, n_mode) float
    """
    real = np.array(shapes.real)
    for group in clusters_by_bandwidth(frequencies_hz, _PAIR_WIDTH):
        columns = list(group)
        if len(columns) < 2 or len(shapes) <= len(columns):
            continue
        size = np.linalg.norm(weight[:, None] * shapes[:, columns], axis=0)
        Z = weight[:, None] * shapes[:, columns] / size
        u, _, _ = np.linalg.svd(np.concatenate([Z.real, Z.imag], axis=1), full_matrices=False)
        basis = u[:, : len(columns)]
        inside = basis.T @ Z.real
        w, s, vt = np.linalg.svd(inside)
        if s[-1] < _PARALLEL * s[0]:
            real[:, columns] = (basis @ (w @ vt)) * size / weight[:, None]
    return real
