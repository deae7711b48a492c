"""Functions brought to one set of poles, where each output has poles of its own.

Hammer points and roving sensors move a frequency by their mass, runs by the temperature, joints by
the force at a point. What common poles leave of that looks like further roots, and hides real ones.
"""

from __future__ import annotations

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ..survey.modal_synthesis import modal_response
from .pole_numbers import POLES


def aligned(
    f: Floats, values: Numbers, measured: Bools, poles: Numbers, participation: Numbers,
    shapes: Numbers,
) -> Numbers:  # fmt: skip
    """Take off what the own poles of each output make of its functions beyond their mean.

    At every output a mode keeps its participation, its pole is free; but for modes close by at
    outputs that were not measured with all inputs. The modes are taken in turn, a few rounds. The
    mean counts outputs by how far they move, not by the square of it: where mass or
    force move a frequency, they do so most where the mode moves most.

    Parameters
    ----------
    f : (n_line,) float
        Hz.
    values : (n_output, n_input, n_line) complex
        Accelerations.
    measured : (n_output, n_input) bool
    poles : (n_mode,) complex
    participation : (n_input, n_mode) complex
    shapes : (n_output, n_mode) complex

    Returns
    -------
    (n_output, n_input, n_line) complex
    """
    s = 2j * np.pi * f
    own, size = np.tile(poles, (len(shapes), 1)), shapes.copy()
    left = np.where(
        measured[..., None], values - modal_response(f, poles, shapes, participation), 0.0
    )
    for _ in range(POLES.align_rounds):
        for k in range(len(poles)):
            part, lines = measured * participation[:, k], _around(f, poles[k])
            close = _close(poles, k, POLES.align_reach)
            alone = measured * _alone(participation, close, k)
            weight = np.sum(alone.conj() * part, axis=1)
            weight = np.where(weight != 0.0, weight, 1.0)
            seen = np.einsum("oin,oi->on", left[..., lines], alone.conj()) / weight[:, None]
            seen += size[:, k, None] * s[lines] ** 2 / (s[lines] - own[:, k, None])
            left += _response(s, own[:, k], size[:, k], part)
            free = measured.all(axis=1) | (np.count_nonzero(close) == 1)
            own[:, k], size[:, k] = _own_poles(s[lines], seen, poles[k], free)
            left -= _response(s, own[:, k], size[:, k], part)
    motion = np.abs(size)
    mean = np.sum(motion * own, axis=0) / np.maximum(motion.sum(axis=0), 1e-300)
    return left + measured[..., None] * modal_response(f, mean, size, participation)


def distinct(poles: Numbers, participation: Numbers, strength: Floats) -> Bools:
    """Tell roots that do not repeat the participation of a stronger one close by, (n_mode,)."""
    unit = participation / np.maximum(np.linalg.norm(participation, axis=0), 1e-300)
    keep = np.zeros(len(poles), bool)
    for k in np.argsort(-strength):
        close = keep & _close(poles, k, POLES.align_shift)
        alike = np.abs(unit[:, k].conj() @ unit) ** 2 > POLES.one_shape
        keep[k] = not (close & alike).any()
    return keep


def _close(poles: Numbers, k: int, widths: float) -> Bools:
    decay = np.maximum(np.abs(poles.real), abs(poles[k].real))
    return np.asarray(np.abs(poles.imag - poles[k].imag) < widths * decay)


def _alone(participation: Numbers, close: Bools, k: int) -> Numbers:
    """Return what modes close by do not have of a participation; all of it where that is little."""
    own = participation[:, k]
    others = participation[:, close & (np.arange(len(close)) != k)]
    rest = own - others @ (np.linalg.pinv(others) @ own)
    enough = np.sum(np.abs(rest) ** 2) > POLES.align_alone * np.sum(np.abs(own) ** 2)
    return np.asarray(rest if enough else own)


def _around(f: Floats, pole: complex) -> slice:
    half = abs(pole.real) / (2.0 * np.pi)
    reach = max(POLES.align_reach * half, POLES.align_lines * float(np.median(np.diff(f))))
    first, last = np.searchsorted(f, abs(pole) / (2.0 * np.pi) + np.array([-reach, reach]))
    return slice(int(first), int(last))


def _own_poles(s: Numbers, seen: Numbers, common: complex, free: Bools) -> tuple[Numbers, Numbers]:
    """Fit one pole and amplitude to each of several functions, beside what is smooth.

    Of poles about the common one that which explains most, then Gauss-Newton: what is there along
    the derivative by the pole, over what is there along the mode, is the step. The common pole
    stays where one pole explains too little of what is there.

    Parameters
    ----------
    s : (n_line,) complex
    seen : (n_output, n_line) complex
    common : complex
    free : (n_output,) bool
        Where the pole may differ from the common one.

    Returns
    -------
    poles, amplitudes : (n_output,) complex
    """
    smooth, _ = np.linalg.qr((s / np.mean(np.abs(s)))[:, None] ** np.arange(3))

    def rough(x: Numbers) -> Numbers:
        return np.asarray(x - (x @ smooth.conj()) @ smooth.T)

    def unit(x: Numbers) -> Numbers:
        return np.asarray(x / np.maximum(np.linalg.norm(x, axis=1), 1e-300)[:, None])

    seen, decay = rough(seen), -common.real
    shift = np.arange(
        -POLES.align_shift, POLES.align_shift + 0.5 * POLES.align_step, POLES.align_step
    )
    trial = (
        decay * (1j * shift - np.array(POLES.align_decays)[:, None])
    ).ravel() + 1j * common.imag
    explained = np.abs(seen @ unit(rough(s**2 / (s - trial[:, None]))).conj().T)
    pole = trial[np.argmax(explained, axis=1)]
    for _ in range(POLES.align_steps):
        c, d = (rough(s**2 / (s - pole[:, None]) ** n) for n in (1, 2))
        cc, dd, cd = (np.sum(x.conj() * y, axis=1) for x, y in ((c, c), (d, d), (c, d)))
        cy, dy = (np.sum(x.conj() * seen, axis=1) for x in (c, d))
        along, slope = dd * cy - cd * dy, cc * dy - cd.conj() * cy
        step = slope / np.where(along != 0.0, along, 1.0)
        most = 0.5 * np.abs(pole.real)
        pole = pole + step * np.minimum(1.0, most / np.maximum(np.abs(step), 1e-300))
    modes = unit(rough(s**2 / (s - pole[:, None])))
    told = np.abs(np.sum(modes.conj() * seen, axis=1)) ** 2
    unsure = told < POLES.align_told * np.sum(np.abs(seen) ** 2, axis=1)
    pole[unsure | ~free] = common
    c = rough(s**2 / (s - pole[:, None]))
    size = np.sum(np.abs(c) ** 2, axis=1)
    return pole, np.sum(c.conj() * seen, axis=1) / np.maximum(size, 1e-300)


def _response(s: Numbers, pole: Numbers, size: Numbers, part: Numbers) -> Numbers:
    near = size[:, None] * s**2 / (s - pole[:, None])
    far = size.conj()[:, None] * s**2 / (s - pole.conj()[:, None])
    return np.asarray(part[..., None] * near[:, None] + part.conj()[..., None] * far[:, None])
