"""Orthogonality of shapes by a mass matrix at the sensors, and what contracts ask of it."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..errors import InputError
from ..noun import Noun
from .correlation_numbers import CORRELATION


@dataclass(frozen=True)
class Requirement:
    """What a contract asks of the modes that count.

    `deviation_percent` of a frequency at most, `diagonal` of the cross-orthogonality at least,
    `off_diagonal` of it and of the test's own orthogonality at most.
    """

    name: str
    deviation_percent: float
    diagonal: float
    off_diagonal: float


REQUIREMENTS = (
    Requirement("NASA-STD-5002", *CORRELATION.nasa),
    Requirement("SMC-S-004", *CORRELATION.air_force),
)
"""Of NASA for payloads, and of the US Air Force for loads analyses."""


@dataclass(frozen=True, eq=False)
class Orthogonality(Noun):
    """Orthogonality by the mass matrix of a model reduced to the sensors.

    Parameters
    ----------
    own : (n_test, n_test) float
        Of the test shapes among themselves (pseudo-orthogonality): 1 on the diagonal.
    cross : (n_test, n_analysis) float
        Of test and analysis shapes, each of generalised mass 1.
    """

    own: Floats
    cross: Floats


def orthogonality(analysis: Floats, test: Floats, mass: Floats) -> Orthogonality:
    """Return the orthogonality of shapes at the sensors, signs taken away.

    Targoff (1976), *Orthogonality check and correction of measured modes*, AIAA Journal 14(2),
    164; for the mass matrix see `reduction.model_at_sensors`.

    Parameters
    ----------
    analysis : (n_sensor, n_analysis) float
    test : (n_sensor, n_test) float
        Of any scaling.
    mass : (n_sensor, n_sensor) float

    Raises
    ------
    InputError
        Shapes that are not at the sensors of the matrix.
    """
    if not len(analysis) == len(test) == len(mass):
        raise InputError(
            f"shapes at {len(analysis)} and {len(test)} sensors and a mass matrix of {len(mass)} "
            "do not belong together"
        )
    a, t = (s / np.where(g > 0.0, g, 1.0) for s in (analysis, test) for g in [_size(s, mass)])
    return Orthogonality(np.abs(t.T @ mass @ t), np.abs(t.T @ mass @ a))


def _size(shapes: Floats, mass: Floats) -> Floats:
    """Square roots of generalised masses, (n,)."""
    return np.asarray(np.sqrt(np.maximum(np.einsum("sn,sn->n", shapes, mass @ shapes), 0.0)))


def unmet(found: Orthogonality, deviations_percent: Floats, asked: Requirement) -> tuple[str, ...]:
    """Say what of a requirement the pairs do not meet; nothing where they meet all.

    Told are a deviation, a cross-orthogonality of a pair, one beside the pairs, and one of two test
    modes (own).

    `found` is of the pairs alone, in their order, whose deviations (n_pair,) are given.
    """
    off = ~np.eye(len(found.own), dtype=bool)
    deviation, diagonal = _most(np.abs(deviations_percent)), _least(np.diag(found.cross))
    cross, own = _most(found.cross[off]), _most(found.own[off])
    checks = (
        (deviation <= asked.deviation_percent, "deviation", f"{deviation:.1f} %"),
        (diagonal >= asked.diagonal, "cross", f"{diagonal:.2f}"),
        (cross <= asked.off_diagonal, "beside", f"{cross:.2f}"),
        (own <= asked.off_diagonal, "own", f"{own:.2f}"),
    )
    return tuple(f"{what} {value}" for met, what, value in checks if not met)


def _most(values: Floats) -> float:
    return float(np.max(values, initial=0.0))


def _least(values: Floats) -> float:
    return float(np.min(values, initial=1.0))
