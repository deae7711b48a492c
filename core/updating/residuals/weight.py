"""What the structure weighs, and where its centre of gravity is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...arrays import Floats
from ...data.parametric_model import Model
from ...data.rigid_mass import centre_of_mass, mass_axis, mass_moments
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


def _measured_mass(seen: Seen) -> float:
    if seen.beside.mass is None:
        raise InputError("the residual 'mass' needs what the structure weighs: give measured_mass")
    return seen.beside.mass


def _mass_value(seen: Seen) -> Floats:
    R = _at(seen)
    k = mass_axis(R)
    return np.array([[R[k, k] / _measured_mass(seen) - 1.0]])


def _mass_derivative(seen: Seen, slopes: Slopes) -> Floats:
    weighed, k = _measured_mass(seen), mass_axis(_at(seen))
    return np.array([[[R[k, k] / weighed for R in _slopes(seen, slopes)]]])


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
    off = centre_of_mass(_at(seen)) - measured
    return np.asarray(off[known][:, None] / seen.model.geometry.size)


def _centre_derivative(seen: Seen, slopes: Slopes) -> Floats:
    known, _ = _known(seen)
    moments, masses = mass_moments(_at(seen))
    changes = map(mass_moments, _slopes(seen, slopes))
    moves = [(ds - dm * moments / masses) / masses for ds, dm in changes]
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
