"""Rigid elements as equations: RBE1, RBE2, RBE3, RBAR, RBAR1, RROD; a routine a card, one table."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from ...core.arrays import Floats
from ...core.elements.batch import skew
from ...core.errors import InputError
from .cards import Card
from .grids import Points


class Rows:
    """Equations collected one by one; each gives one dependent degree of freedom.

    Parameters
    ----------
    points : Points
        Grids, whose displacement systems the components refer to.
    """

    def __init__(self, points: Points) -> None:
        self.points = points
        self.dependent: list[int] = []
        self.owners: list[str] = []
        self.rows: list[int] = []
        self.columns: list[int] = []
        self.values: list[float] = []

    def add(self, dependent: int, columns: Sequence[int], values: Floats, owner: str) -> None:
        """Add ``u[dependent] = sum(values * u[columns])``."""
        row = len(self.dependent)
        self.dependent.append(int(dependent))
        self.owners.append(owner)
        self.rows.extend([row] * len(columns))
        self.columns.extend(int(c) for c in columns)
        self.values.extend(float(v) for v in values)

    def motion(self, row: int, origin: Floats) -> Floats:
        """Displacements (6) of grid `row`, its system, from rigid motion about `origin`, (6, 6)."""
        R = self.points.directions[row]
        arm = self.points.xyz[row] - origin
        out = np.zeros((6, 6))
        out[:3, :3] = R
        out[:3, 3:] = -R @ skew(arm[None])[0]
        out[3:, 3:] = R
        return out


def components_of(digits: object, place: str) -> list[int]:
    """Component numbers 1..6 from digits such as 1235.

    Raises
    ------
    InputError
        Anything else.
    """
    text = str(digits or "").strip()
    text = "" if text == "0" else text
    if any(d not in "123456" for d in text):
        raise InputError(f"{place}: components {text!r} are not digits from 1 to 6")
    return sorted(int(d) for d in set(text))


def rbe2(rows: Rows, card: Card, place: str) -> None:
    """Components CM of the grids GMi follow the rigid motion of GN."""
    points = rows.points
    centre = points.row(int(card.gn), place)
    components = components_of(card.cm, place)
    independent = rows.motion(centre, points.xyz[centre])
    inverse = independent.T  # a rotation of translations and of rotations
    for grid in card.Gmi:
        row = points.row(int(grid), place)
        if row == centre:
            raise InputError(f"{place}: grid {grid} is both the independent and a dependent grid")
        T = rows.motion(row, points.xyz[centre]) @ inverse
        for c in components:
            values = T[c - 1]
            used = np.flatnonzero(np.abs(values) > 1e-14 * max(1.0, float(np.abs(values).max())))
            rows.add(6 * row + c - 1, (6 * centre + used).tolist(), values[used], place)


def rbar(rows: Rows, card: Card, place: str) -> None:
    """Two grids on a rigid bar; six components of either are independent."""
    independent = [(int(card.ga), card.cna), (int(card.gb), card.cnb)]
    dependent = [(int(card.ga), card.cma), (int(card.gb), card.cmb)]
    if not any(str(c or "").strip("0") for _, c in dependent):
        free = {grid: set(components_of(c, place)) for grid, c in independent}
        dependent = [
            (grid, "".join(str(k) for k in range(1, 7) if k not in free[grid]))
            for grid in (int(card.ga), int(card.gb))
        ]
    _rigid_body(rows, independent, dependent, place)


def rbar1(rows: Rows, card: Card, place: str) -> None:
    """Components CB of GB follow the rigid motion of GA."""
    components = card.cb or "123456"
    _rigid_body(rows, [(int(card.ga), "123456")], [(int(card.gb), components)], place)


def rbe1(rows: Rows, card: Card, place: str) -> None:
    """Several grids on a rigid body; six components of them are independent."""
    independent = list(zip(card.Gni, card.Cni, strict=True))
    dependent = list(zip(card.Gmi, card.Cmi, strict=True))
    _rigid_body(rows, independent, dependent, place)


def _rigid_body(
    rows: Rows,
    independent: Sequence[tuple[int, object]],
    dependent: Sequence[tuple[int, object]],
    place: str,
) -> None:
    """Dependent components from the rigid motion that six independent components determine."""
    points = rows.points
    origin = points.xyz[points.row(int(independent[0][0]), place)]
    base, columns = _motions(rows, independent, origin, place)
    if len(columns) != 6:
        raise InputError(f"{place}: {len(columns)} components are independent; there must be six")
    scale = _lengths(rows, [*independent, *dependent], origin, place)
    balance = np.array([1.0, 1.0, 1.0, scale, scale, scale])
    unit = np.where(np.array(columns) % 6 < 3, 1.0, scale)
    if np.linalg.cond(base * unit[:, None] / balance) > 1e10:
        raise InputError(
            f"{place}: its independent components do not determine the motion of a rigid body"
        )
    values, targets = _motions(rows, dependent, origin, place)
    solved = np.linalg.solve((base / balance).T, (values / balance).T).T
    for dof, row in zip(targets, solved, strict=True):
        if dof in columns:
            raise InputError(
                f"{place}: {points.label(dof)} (grid:component) is both independent and dependent"
            )
        used = np.flatnonzero(np.abs(row) > 1e-13 * max(1.0, float(np.abs(row).max())))
        rows.add(dof, [columns[k] for k in used], row[used], place)


def _motions(
    rows: Rows, members: Sequence[tuple[int, object]], origin: Floats, place: str
) -> tuple[Floats, list[int]]:
    """Rows (m, 6) of displacements by rigid motion about `origin`, and their dofs."""
    values, dofs = [], []
    for grid, digits in members:
        row = rows.points.row(int(grid), place)
        motion = rows.motion(row, origin)
        for c in components_of(digits, place):
            values.append(motion[c - 1])
            dofs.append(6 * row + c - 1)
    return np.array(values).reshape(-1, 6), dofs


def _lengths(
    rows: Rows, members: Sequence[tuple[int, object]], origin: Floats, place: str
) -> float:
    """Return the largest distance from `origin`, 1 where all coincide."""
    at = [rows.points.xyz[rows.points.row(int(grid), place)] for grid, _ in members]
    largest = float(np.linalg.norm(np.array(at) - origin, axis=1).max(initial=0.0))
    return largest if largest > 0.0 else 1.0


def rrod(rows: Rows, card: Card, place: str) -> None:
    """Keep the distance of two grids; one component of one of them is dependent."""
    points = rows.points
    a, b = (points.row(int(grid), place) for grid in card.nodes)
    along = points.xyz[b] - points.xyz[a]
    length = float(np.linalg.norm(along))
    if length == 0.0:
        raise InputError(f"{place} has no length: its ends coincide")
    x = along / length
    coefficients = np.concatenate([-points.directions[a] @ x, points.directions[b] @ x])
    dofs = [6 * a, 6 * a + 1, 6 * a + 2, 6 * b, 6 * b + 1, 6 * b + 2]
    chosen = [c - 1 for c in components_of(card.cma, place)]
    chosen += [c + 2 for c in components_of(card.cmb, place)]
    if len(chosen) != 1 or chosen[0] > 5:
        raise InputError(f"{place}: one translation must be dependent, CMA or CMB")
    pivot = coefficients[chosen[0]]
    if abs(pivot) < 1e-3:
        raise InputError(
            f"{place}: the dependent component is (nearly) normal to the rod: give another"
        )
    others = [k for k in range(6) if k != chosen[0] and abs(coefficients[k]) > 1e-14]
    rows.add(dofs[chosen[0]], [dofs[k] for k in others], -coefficients[others] / pivot, place)


def rbe3(rows: Rows, card: Card, place: str) -> None:
    """Move the reference grid as the weighted mean of others.

    The motion of the reference grid is the rigid motion that fits the others' displacements best,
    with the weights given; rotations weigh by the square of the mean distance, so that the result
    does not depend on the unit of length (MSC Nastran Reference Guide, RBE3). With UM other
    components are made dependent by the same equations.
    """
    points = rows.points
    reference = points.row(int(card.refgrid), place)
    origin = points.xyz[reference]
    members = [
        (int(grid), digits, float(weight))
        for weight, digits, grids in zip(card.weights, card.comps, card.Gijs, strict=True)
        for grid in grids
    ]
    S, columns = _motions(rows, [(g, c) for g, c, _ in members], origin, place)
    weights = np.array([w for _, c, w in members for _ in components_of(c, place)])
    ends = np.array([points.xyz[points.row(g, place)] for g, _, _ in members])
    distance = np.linalg.norm(ends - origin, axis=1)
    length = float(distance.mean()) if distance.any() else 1.0
    rotations = np.array(columns) % 6 >= 3
    weights = np.where(rotations, weights * length**2, weights)
    balance = np.array([1.0, 1.0, 1.0, length, length, length])
    A = S / balance
    normal = A.T @ (weights[:, None] * A)
    values, vectors = np.linalg.eigh(normal)
    lost = vectors[:, values <= 1e-10 * values[-1]]
    components = components_of(card.refc, place)
    own = np.zeros((6, 6))
    own[:3, :3] = own[3:, 3:] = points.directions[reference]
    wanted = (own / balance)[[c - 1 for c in components]]
    if lost.size and np.abs(wanted * balance.max() @ lost).max() > 1e-6 * balance.max():
        raise InputError(
            f"{place}: the grids it averages do not determine all components {card.refc} of the "
            "reference grid: average more components or fewer in a line"
        )
    G = wanted @ np.linalg.pinv(normal, rcond=1e-10, hermitian=True) @ (A.T * weights)
    targets = [6 * reference + c - 1 for c in components]
    moved = list(zip(card.Gmi or [], card.Cmi or [], strict=True))
    if not moved:
        for dof, row in zip(targets, G, strict=True):
            _add_trimmed(rows, dof, columns, row, place)
        return
    _rbe3_um(rows, moved, targets, columns, G, place)


def _rbe3_um(
    rows: Rows,
    moved: list[tuple[int, object]],
    targets: list[int],
    columns: list[int],
    G: Floats,
    place: str,
) -> None:
    """Solve the equations ``u[targets] = G u[columns]`` for the components under UM."""
    _, dependent = _motions(rows, moved, np.zeros(3), place)
    every = [*targets, *columns]
    if len(dependent) != len(targets):
        raise InputError(
            f"{place}: UM names {len(dependent)} components; there must be as many as in REFC, "
            f"{len(targets)}"
        )
    if any(d not in every for d in dependent):
        raise InputError(f"{place}: UM names a component that the element does not use")
    equations = np.hstack([np.eye(len(targets)), -G])
    position = [every.index(d) for d in dependent]
    rest = [k for k in range(len(every)) if k not in position]
    if np.linalg.cond(equations[:, position]) > 1e12:
        raise InputError(f"{place}: the components under UM cannot be the dependent ones")
    solved = -np.linalg.solve(equations[:, position], equations[:, rest])
    for dof, row in zip(dependent, solved, strict=True):
        _add_trimmed(rows, dof, [every[k] for k in rest], row, place)


def _add_trimmed(rows: Rows, dof: int, columns: list[int], row: Floats, place: str) -> None:
    used = np.flatnonzero(np.abs(row) > 1e-14 * max(1.0, float(np.abs(row).max())))
    rows.add(dof, [columns[k] for k in used], row[used], place)


RIGID: dict[str, Callable[[Rows, Card, str], None]] = {
    "RBE2": rbe2,
    "RBAR": rbar,
    "RBAR1": rbar1,
    "RBE1": rbe1,
    "RBE3": rbe3,
    "RROD": rrod,
}
"""Rigid elements by card name."""
