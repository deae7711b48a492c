"""What a node of the test may be: sound, faulty in one of several ways, or beyond the model.

Each alternative is a map from motion to reading with a prior of its unknowns; its evidence is the
likelihood averaged over that prior, so that a richer one pays for itself.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.special import gammaln, logsumexp

from ...arrays import Floats
from ..faults import AXIS, GAIN, POLARITY, SWAP
from .misalignment import Evidence, about, anyhow, tilted
from .node_likelihood import Node, evidence
from .sensor_numbers import SENSORS

_LOG_GAIN = np.arange(-SENSORS.gains, SENSORS.gains + 0.5 * SENSORS.gain_step, SENSORS.gain_step)


@dataclass(frozen=True, eq=False)
class Alternative:
    """One explanation of a node's readings.

    Parameters
    ----------
    kind : str
        ``sound``, ``model`` (wrong in proportion there) or the word of a fault.
    log : float
        Log of prior times evidence.
    rows : tuple of int
        Of the node, which are concerned.
    factor, deviation : float
        What is read over what should be, or the angle [deg]; its standard deviation.
    vector : (3,) float
        Rotation vector [rad].
    """

    kind: str
    log: float
    rows: tuple[int, ...] = ()
    factor: float = 1.0
    deviation: float = 0.0
    vector: tuple[float, ...] = ()

    @property
    def faulty(self) -> bool:
        """Whether the sensor is at fault."""
        return self.kind not in {"sound", "model"}


@dataclass(frozen=True, eq=False)
class Before:
    """What is assumed of a node before its readings are looked at.

    `faulty` is the chance of any fault; `shares` those of `node_likelihood.LOCAL`; `proportion` the
    scale of what sound nodes have off in proportion, over the rms of a shape; `in_proportion`
    (n, 3) the chance that the model is wrong there by a factor of its own in all modes, by how
    much, and its spread, both over the rms of a shape.
    """

    faulty: float
    shares: Floats
    proportion: float
    in_proportion: Floats


def alternatives(node: Node, axes: Floats | None, before: Before) -> list[Alternative]:
    """Return every alternative but swaps with other nodes.

    `axes` (k, 3) are the directions of the rows, None where a row is a rotation.
    """
    of = partial(evidence, node, shares=before.shares)
    k = node.reading.shape[1]
    out = [Alternative("sound", float(of(node.identity[None])[0]))]
    parts = [(tuple(range(k)), 1.0 if k == 1 else SENSORS.whole)]
    if k > 1:
        parts += [((a,), (1.0 - SENSORS.whole) / k) for a in range(k)]
    for rows, share in parts:
        out += _scaled(node, rows, share, of, before)
    for a in range(k):
        for b in range(a):
            swapped = node.identity
            swapped[[a, b]] = swapped[[b, a]]
            log = float(of(swapped[None])[0])
            prior = np.log(before.faulty * SENSORS.exchanged * 2.0 / (k * (k - 1)))
            out.append(Alternative(SWAP.name, log + prior, (b, a)))
    if axes is not None:
        out += _turned(node, axes, of, before)
    return out


def _scaled(
    node: Node, rows: tuple[int, ...], share: float, of: Evidence, before: Before
) -> list[Alternative]:
    """Polarity, gain, and a model that is wrong in proportion there."""
    gains = np.exp(_LOG_GAIN)
    every = np.r_[gains, -gains]
    sure = before.faulty * share
    maps = np.repeat(node.identity[None], len(every), axis=0)
    for r in rows:
        maps[:, r] *= every[:, None]
    log, reverse = np.split(of(maps), 2)
    square = np.mean(node.mean[:, list(rows)] ** 2)
    size = float(np.sqrt(max(square, SENSORS.least_variance)))
    step = _LOG_GAIN[1] - _LOG_GAIN[0]
    scale = np.hypot(SENSORS.gain_scatter, before.proportion / size)
    sound = -0.5 * (_LOG_GAIN / scale) ** 2 - np.log(scale * np.sqrt(2.0 * np.pi)) + np.log(step)
    chance, centre, scale = before.in_proportion.T[..., None]
    off = ((gains - 1.0) * size - centre) / scale
    each = chance * gains * size / scale * step
    model = logsumexp(_student(off, SENSORS.tail), axis=0, b=each)
    wide = -0.5 * (_LOG_GAIN / SENSORS.gain_spread) ** 2
    wide[np.abs(_LOG_GAIN) <= np.log(SENSORS.gain_least)] = -np.inf
    as_fault = log + wide - logsumexp(wide)
    weight = np.exp(as_fault - as_fault.max())
    weight /= weight.sum()
    factor = float(np.sum(weight * gains))
    spread = float(np.sum(weight * (gains - factor) ** 2)) + (step * factor) ** 2 / 12.0

    def told(
        kind: str, log: Floats, prior: float, size: float, deviation: float = 0.0
    ) -> Alternative:
        return Alternative(kind, float(logsumexp(log)) + np.log(prior), rows, size, deviation)

    return [
        told(POLARITY.name, reverse + sound, sure * SENSORS.polarity, -1.0),
        told(GAIN.name, as_fault, sure * SENSORS.gain, factor, np.sqrt(spread)),
        told("model", log + model, share, 1.0),
    ]


def _student(x: Floats, freedom: float) -> Floats:
    """Return ln of Student's density."""
    half = 0.5 * (freedom + 1.0)
    unit = gammaln(half) - gammaln(0.5 * freedom) - 0.5 * np.log(np.pi * freedom)
    return np.asarray(unit - half * np.log1p(x**2 / freedom))


def _turned(node: Node, axes: Floats, of: Evidence, before: Before) -> list[Alternative]:
    k = len(axes)
    rows = tuple(range(k))
    prior = np.log(before.faulty)

    def told(found: tuple[float, Floats, float], share: float) -> Alternative:
        log, vector, spread = found
        angle = float(np.degrees(np.linalg.norm(vector)))
        log = log + prior + np.log(share)
        turn = tuple(map(float, vector))
        return Alternative(AXIS.name, log, rows, angle, float(np.degrees(spread)), turn)

    if k == 1:
        return [told(tilted(axes[0], of), SENSORS.lonely_axis)]
    own = axes if k == 3 else np.vstack([axes, np.cross(*axes)])
    ways = [(1.0 - SENSORS.about_any) / 3.0] * 3 if k == 3 else SENSORS.about_pair
    out = [told(about(axes, u, of), SENSORS.axis * w) for u, w in zip(own, ways, strict=True)]
    if k == 3:
        found = anyhow(axes, _kabsch(node, axes), of)
        if found is not None:
            out.append(told(found, SENSORS.axis * SENSORS.about_any))
    return out


def _kabsch(node: Node, axes: Floats) -> Floats:
    """Rotation of the set that fits the readings best (Kabsch 1976), every mode alike."""
    read = node.reading @ axes
    U, _, Vt = np.linalg.svd(node.mean[:, -3:].T @ read)
    D = np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    return np.asarray(U @ D @ Vt)
