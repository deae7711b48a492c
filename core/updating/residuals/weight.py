"""What the structure weighs, and where its centre of gravity is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import Floats
from ...data.parametric_model import Model
from ...errors import InputError
from ..updating_numbers import UPDATING
from .declaration import Residual, Seen, Slopes


def _rigid_mass(model: Model, coefficients: Sequence[float]) -> Floats:
    if len(model.rigid_mass) != len(model.mass):
        raise InputError("the model does not tell its mass: leave the residuals of it out")
    total = np.zeros((6, 6))
    for c, R in zip(coefficients, model.rigid_mass, strict=True):
        total += c * R
    return total


def _at(seen: Seen) -> Floats:
    return _rigid_mass(seen.model, [t.coefficient(seen.factors) for t in seen.model.mass])


def _slopes(seen: Seen, slopes: Slopes) -> list[Floats]:
    terms, p = seen.model.mass, seen.factors
    return [
        _rigid_mass(seen.model, [t.coefficient_derivative(p, k) for t in terms])
        for k in slopes.parameters
    ]


def _mass(R: Floats) -> float:
    """Mean of what the three translations move."""
    return float(np.trace(R[:3, :3]) / 3.0)


def _moment(R: Floats) -> Floats:
    """Mass times the centre of gravity, (3,), each coordinate from two axes."""
    S = R[:3, 3:]
    return np.array([S[1, 2] - S[2, 1], S[2, 0] - S[0, 2], S[0, 1] - S[1, 0]]) / 2.0


def _measured_mass(seen: Seen) -> float:
    if seen.beside.mass is None:
        raise InputError("the residual 'mass' needs what the structure weighs: give measured_mass")
    return seen.beside.mass


def _mass_value(seen: Seen) -> Floats:
    return np.array([[_mass(_at(seen)) / _measured_mass(seen) - 1.0]])


def _mass_derivative(seen: Seen, slopes: Slopes) -> Floats:
    weighed = _measured_mass(seen)
    return np.array([[[_mass(R) / weighed for R in _slopes(seen, slopes)]]])


def _known(seen: Seen) -> tuple[Floats, Floats]:
    """Return which coordinates are known, and the measured ones."""
    measured = seen.beside.centre_of_gravity
    if measured is None:
        raise InputError(
            "the residual 'centre_of_gravity' needs where it is: give measured_centre_of_gravity"
        )
    return np.isfinite(measured), measured


def _centre_value(seen: Seen) -> Floats:
    known, measured = _known(seen)
    R = _at(seen)
    off = _moment(R) / _mass(R) - measured
    return np.asarray(off[known][:, None] / seen.model.geometry.size)


def _centre_derivative(seen: Seen, slopes: Slopes) -> Floats:
    known, _ = _known(seen)
    R = _at(seen)
    m, moment = _mass(R), _moment(R)
    moves = [_moment(dR) / m - moment * _mass(dR) / m**2 for dR in _slopes(seen, slopes)]
    return np.asarray(np.array(moves).T[known][:, None, :] / seen.model.geometry.size)


MASS = Residual("mass", "mass_sigma", UPDATING.mass, _mass_value, _mass_derivative)
"""Relative difference of mass."""

CENTRE_OF_GRAVITY = Residual(
    "centre_of_gravity",
    "centre_of_gravity_sigma",
    UPDATING.centre_of_gravity,
    _centre_value,
    _centre_derivative,
)
"""Difference of each coordinate of the centre of gravity over the size of the structure."""
