"""Driving points: where they are, the power that they take, modal mass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ...arrays import Bools, Floats, Ints, Numbers
from ...data.dofs import Dofs
from ...data.geometry import Geometry
from .faults import listed
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class Scaling:
    """Modal masses and what was found on the way.

    Parameters
    ----------
    modal_mass : (n_mode,) float
        For the shapes as given; NaN where no driving point tells.
    warnings : tuple of str
    """

    modal_mass: Floats
    warnings: tuple[str, ...]


def driving_points(outputs: Dofs, inputs: Dofs, geometry: Geometry | None = None) -> Floats:
    """Express each input direction in the outputs measured at its node.

    Parameters
    ----------
    outputs, inputs : Dofs
    geometry : Geometry, optional
        Nodes at one position are then one point, under whatever number.

    Returns
    -------
    (n_input, n_output) float
        Rows of factors, NaN where the outputs at the node do not span the input direction.
        Translations are not mixed with rotations. Outputs listed twice share the factor.
    """
    factors = np.full((len(inputs), len(outputs)), np.nan)
    at_output = _points(outputs, geometry)
    at_input = _points(inputs, geometry)
    for i in range(len(inputs)):
        rotation = inputs.component[i] > 3
        rows = np.flatnonzero((at_output == at_input[i]) & ((outputs.component > 3) == rotation))
        if not len(rows):
            continue
        axes = outputs.axis[rows].T
        c = np.linalg.lstsq(axes, inputs.axis[i], rcond=SURVEY.spanned)[0]
        if np.linalg.norm(axes @ c - inputs.axis[i]) <= SURVEY.misaligned:
            factors[i] = 0.0
            factors[i, rows] = c
    return factors


def _points(dofs: Dofs, geometry: Geometry | None) -> Ints:
    """Node number of each dof, the first of all nodes at its position, (n,)."""
    if geometry is None or not len(geometry.ids):
        return dofs.node
    rows = geometry.index_of(dofs.node)
    tree = cKDTree(geometry.xyz)
    reach = SURVEY.coincident * max(geometry.size, 1e-300)
    number = dofs.node.copy()
    for k in np.flatnonzero(rows >= 0):
        number[k] = geometry.ids[tree.query_ball_point(geometry.xyz[rows[k]], reach)].min()
    return number


def positive_share(function: Numbers) -> float:
    """Return the share of power that a driving point takes, less what it gives back, -1..1.

    A structure at rest takes power from a force at every line: the acceleration of a driving point
    has a positive imaginary part. Lines count by the square of the function.

    Parameters
    ----------
    function : (n_line,) complex
        Acceleration.
    """
    taken = function.imag * np.abs(function)
    return float(np.sum(taken) / max(float(np.sum(np.abs(taken))), 1e-300))


def resonates(function: Numbers) -> bool:
    """Say whether power flows at a driving point at all: off resonance noise alone has a share.

    Parameters
    ----------
    function : (n_line,) complex
        Acceleration.
    """
    flows = np.abs(function.imag) @ np.abs(function)
    return bool(flows > SURVEY.flows * np.linalg.norm(function) ** 2)


def coupled(size: Floats) -> Bools:
    """Say which functions between driving points are large enough to be reciprocal.

    One that symmetry or its directions make nil holds noise, which is not.

    Parameters
    ----------
    size : (n_driven, n_driven) float
        Norm of each function; NaN where it was not measured.

    Returns
    -------
    (n_driven, n_driven) bool
        Of those off the diagonal, where reciprocals are not far below the driving points.
    """
    off = ~np.eye(len(size), dtype=bool) & np.isfinite(size * size.T)
    own = np.sqrt(np.outer(size.diagonal(), size.diagonal()))
    return np.asarray(off & ~(np.sqrt(size * size.T) < SURVEY.uncoupled * own))


def scale(
    poles: Numbers, shapes: Numbers, participation: Numbers, points: Floats, inputs: Dofs
) -> Scaling:
    """Find modal masses from the driving points, after checking them by reciprocity.

    A normal mode has l = φ/(2 j ω_d m) at the point it is driven at; the modal mass m is the
    least-squares one over all driving points.

    Parameters
    ----------
    poles : (n_mode,) complex
    shapes : (n_output, n_mode) complex
        Turned to their principal phase, in physical units.
    participation : (n_input, n_mode) complex
        Physical units (shape times participation is displacement per force).
    points : (n_input, n_output) float
        From `driving_points`.
    inputs : Dofs

    References
    ----------
    Ewins (2000), Modal Testing, 2nd edition, section 2.7.
    """
    n_mode = len(poles)
    none = np.full(n_mode, np.nan)
    driven = np.flatnonzero(np.isfinite(points).all(axis=1))
    if not len(driven):
        return Scaling(none, ("no reference has a response at its own point and direction (no "
                              "driving point): modal masses are unknown",))  # fmt: skip
    at = points[driven] @ shapes
    part = participation[driven]
    apart = _unreciprocal(at, part, np.abs(poles) ** 2 / np.abs(poles.real))
    total = float(np.sqrt(np.sum(apart**2)))
    if total > SURVEY.unreciprocal:
        return Scaling(none, (_said_of(apart, total, inputs.take(driven).labels),))
    q = np.sum(at.conj() * part, axis=0) / np.maximum(np.sum(np.abs(at) ** 2, axis=0), 1e-300)
    inverse_mass = 2j * poles.imag * q
    in_phase = np.cos(np.radians(SURVEY.in_phase_deg)) * np.abs(inverse_mass)
    sound, reversed_sign = inverse_mass.real > in_phase, inverse_mass.real < -in_phase
    warnings = []
    if np.count_nonzero(reversed_sign) > 0.5 * n_mode:
        warnings.append("the driving-point functions have the wrong sign (force or response "
                        "reversed): modal masses are withheld")  # fmt: skip
    elif not sound.all():
        warnings.append(f"{np.count_nonzero(~sound)} mode(s) have no sound modal mass: they hardly "
                        "move the driving points")  # fmt: skip
    mass = np.where(sound, np.abs(inverse_mass) ** 2, np.nan)
    return Scaling(np.asarray(inverse_mass.real / mass), tuple(warnings))


def reciprocity_of_modes(shapes: Numbers, participation: Numbers, points: Floats) -> Floats:
    """MAC of shape and participation at the driving points; NaN where fewer than two tell.

    Parameters
    ----------
    shapes : (n_output, n_mode) complex
    participation : (n_input, n_mode) complex
    points : (n_input, n_output) float
        From `driving_points`.

    Returns
    -------
    (n_mode,) float
    """
    driven = np.flatnonzero(np.isfinite(points).all(axis=1))
    if len(driven) < 2:
        return np.full(shapes.shape[1], np.nan)
    at, part = points[driven] @ shapes, participation[driven]
    both = np.sum(np.abs(at) ** 2, axis=0) * np.sum(np.abs(part) ** 2, axis=0)
    return np.asarray(np.abs(np.sum(at.conj() * part, axis=0)) ** 2 / np.maximum(both, 1e-300))


def _unreciprocal(at: Numbers, part: Numbers, level: Floats) -> Floats:
    """Difference of residues between driving points and their reciprocal, over the size of all.

    Returns
    -------
    (n_driven, n_driven) float
        Above the diagonal, else 0.
    """
    a = at[:, None, :] * part[None, :, :] * level
    a[~coupled(np.linalg.norm(a, axis=2))] = 0.0
    size = float(np.linalg.norm(a))
    apart = np.triu(np.linalg.norm(a - a.transpose(1, 0, 2), axis=2))
    return np.asarray(apart / size if size > 0.0 else 0.0 * apart)


def _said_of(apart: Floats, total: float, labels: Sequence[str]) -> str:
    """Name the pairs that make most of what is not reciprocal."""
    places = sorted(zip(*np.nonzero(apart), strict=True), key=lambda place: -apart[place])
    worst = [f"{labels[i]} and {labels[j]}" for i, j in places
             if apart[i, j] > SURVEY.unreciprocal_part * apart.max()]  # fmt: skip
    return (
        f"the functions between the driving points differ by {100 * total:.0f} % from their "
        f"reciprocal, most between {listed(worst)}: modal masses are withheld"
    )
