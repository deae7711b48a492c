"""What the structure weighs and where its centre of gravity is; no row where not measured."""

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


def _mass_value(seen: Seen) -> Floats:
    if seen.beside.mass is None:
        return np.zeros((0, 1))
    R = _at(seen)
    k = mass_axis(R)
    return np.array([[R[k, k] / seen.beside.mass - 1.0]])


def _mass_derivative(seen: Seen, slopes: Slopes) -> Floats:
    if seen.beside.mass is None:
        return np.zeros((0, 1, len(slopes.parameters)))
    k = mass_axis(_at(seen))
    return np.array([[[R[k, k] / seen.beside.mass for R in _slopes(seen, slopes)]]])


def _measured_centre(seen: Seen) -> Floats:
    measured = seen.beside.centre_of_gravity
    return np.full(3, np.nan) if measured is None else measured


def _centre_value(seen: Seen) -> Floats:
    off = centre_of_mass(_at(seen)) - _measured_centre(seen)
    return np.asarray(off[np.isfinite(off)][:, None] / seen.model.geometry.size)


def _centre_derivative(seen: Seen, slopes: Slopes) -> Floats:
    known = np.isfinite(_measured_centre(seen))
    moments, masses = mass_moments(_at(seen))
    changes = map(mass_moments, _slopes(seen, slopes))
    moves = [(ds - dm * moments / masses) / masses for ds, dm in changes]
    return np.asarray(np.array(moves).T[known][:, None, :] / seen.model.geometry.size)


MASS = Residual("mass", "mass_sigma", UPDATING.mass, _mass_value, _mass_derivative, stated=True)
"""Relative difference of mass."""

CENTRE_OF_GRAVITY = Residual(
    "centre_of_gravity",
    "centre_of_gravity_sigma",
    UPDATING.centre_of_gravity,
    _centre_value,
    _centre_derivative,
    stated=True,
)
"""Difference of each coordinate of the centre of gravity over the size of the structure."""
