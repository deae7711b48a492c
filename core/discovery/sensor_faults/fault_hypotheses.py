"""What a node of the test may be: sound, faulty in one of several ways, or beyond the model.

Each alternative is a map from motion to reading with a prior of its unknowns; its evidence is the
likelihood averaged over that prior, so that a richer one pays for itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.special import logsumexp
from scipy.stats import norm
from scipy.stats import t as student

from ..arrays import Floats
from .readings import Node, evidence
from .turning import Evidence, about, anyhow, tilted

_LOG_GAIN = np.arange(-1.8, 1.8001, 0.0125)
_SPREAD = 0.6
"""Of ln gain of a sensor that has a wrong one; gains nearer to 1 than the next are no faults."""
_LEAST = np.log(1.12)
_TAIL = 5.0
_SHARE = {"sensor_polarity": 0.25, "sensor_gain": 0.25, "doubled": 0.1, "sensor_axis": 0.2}
_LONELY_AXIS = 0.05
"""Share of a turned sensor where a node has one."""
_EXCHANGED = 0.05
_SCATTER = 0.02
"""Of sound gains."""
_WHOLE = 0.6


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

    `faulty` is the chance of any fault; `shares` those of `readings.LOCAL`; `proportion` the
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

    Parameters
    ----------
    node : Node
    axes : (k, 3) float or None
        Directions of the rows; None where a row is a rotation.
    before : Before
    """
    of = partial(evidence, node, shares=before.shares)
    k = node.reading.shape[1]
    out = [Alternative("sound", float(of(node.identity[None])[0]))]
    parts = [(tuple(range(k)), 1.0 if k == 1 else _WHOLE)]
    if k > 1:
        parts += [((a,), (1.0 - _WHOLE) / k) for a in range(k)]
    for rows, share in parts:
        out += _scaled(node, rows, share, of, before)
    for a in range(k):
        for b in range(a):
            swapped = node.identity
            swapped[[a, b]] = swapped[[b, a]]
            log = float(of(swapped[None])[0])
            prior = np.log(before.faulty * _EXCHANGED * 2.0 / (k * (k - 1)))
            out.append(Alternative("sensor_swap", log + prior, (b, a)))
    if axes is not None:
        out += _turned(node, axes, of, before)
    return out


def _scaled(
    node: Node, rows: tuple[int, ...], share: float, of: Evidence, before: Before
) -> list[Alternative]:
    """Polarity, gain, doubled readings, and a model that is wrong in proportion there."""
    gains = np.exp(_LOG_GAIN)
    every = np.r_[gains, -gains]
    sure = before.faulty * share
    maps = np.repeat(node.identity[None], len(every), axis=0)
    for r in rows:
        maps[:, r] *= every[:, None]
    log, reverse = np.split(of(maps), 2)
    size = max(float(np.sqrt(np.mean(node.mean[:, list(rows)] ** 2))), 1e-6)
    step = _LOG_GAIN[1] - _LOG_GAIN[0]

    def near(factor: float) -> Floats:
        """Log prior of gains that would be `factor` if every sound gain were 1."""
        scale = np.hypot(_SCATTER, before.proportion / size)
        return np.asarray(norm.logpdf(_LOG_GAIN - np.log(factor), scale=scale) + np.log(step))

    chance, centre, scale = before.in_proportion.T[..., None]
    off = ((gains - 1.0) * size - centre) / scale
    model = logsumexp(student.logpdf(off, _TAIL), axis=0, b=chance * gains * size / scale * step)
    wide = np.where(np.abs(_LOG_GAIN) > _LEAST, np.exp(-0.5 * (_LOG_GAIN / _SPREAD) ** 2), 1e-300)
    as_fault = log + np.log(wide / wide.sum())
    weight = np.exp(as_fault - as_fault.max())
    weight /= weight.sum()
    factor = float(np.sum(weight * gains))
    spread = float(np.sum(weight * (gains - factor) ** 2)) + (step * factor) ** 2 / 12.0

    def told(
        kind: str, log: Floats, prior: float, size: float, deviation: float = 0.0
    ) -> Alternative:
        return Alternative(kind, float(logsumexp(log)) + np.log(prior), rows, size, deviation)

    return [
        told("sensor_polarity", reverse + near(1.0), sure * _SHARE["sensor_polarity"], -1.0),
        told("doubled", log + near(2.0), sure * _SHARE["doubled"], 2.0),
        told("sensor_gain", as_fault, sure * _SHARE["sensor_gain"], factor, np.sqrt(spread)),
        told("model", log + model, share, 1.0),
    ]


def _turned(node: Node, axes: Floats, of: Evidence, before: Before) -> list[Alternative]:
    k = len(axes)
    rows = tuple(range(k))
    prior = np.log(before.faulty)

    def told(found: tuple[float, Floats, float], share: float) -> Alternative:
        log, vector, spread = found
        angle = float(np.degrees(np.linalg.norm(vector)))
        log = log + prior + np.log(share)
        return Alternative(
            "sensor_axis", log, rows, angle, float(np.degrees(spread)), tuple(map(float, vector))
        )

    if k == 1:
        return [told(tilted(axes[0], of), _LONELY_AXIS)]
    share = _SHARE["sensor_axis"]
    own = axes if k == 3 else np.vstack([axes, np.cross(*axes)])
    weights = np.full(3, share / 5.0) if k == 3 else share * np.array([0.1, 0.1, 0.8])
    out = [told(about(axes, u, of), w) for u, w in zip(own, weights, strict=True)]
    if k == 3:
        found = anyhow(axes, _kabsch(node, axes), of)
        if found is not None:
            out.append(told(found, 0.4 * share))
    return out


def _kabsch(node: Node, axes: Floats) -> Floats:
    """Rotation of the set that fits the readings best (Kabsch 1976), every mode alike."""
    read = node.reading @ axes
    U, _, Vt = np.linalg.svd(node.mean[:, -3:].T @ read)
    D = np.diag([1.0, 1.0, np.sign(np.linalg.det(U @ Vt))])
    return np.asarray(U @ D @ Vt)
