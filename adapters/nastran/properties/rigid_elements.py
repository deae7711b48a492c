"""Rigid elements as equations: a routine a card, one table."""

from collections.abc import Callable, Sequence

import numpy as np

from ....core.arrays import Floats
from ....core.elements.lines.bar import bar_stiffness
from ....core.errors import Place
from ..deck.card_definition import Card, Known, Values
from ..deck.field_values import FieldError, Fields, numbers, take
from .grids import Points

_ENDS = "EID:i! GA>nodes:i! GB>nodes:i!"
_CORNERS = "EID:i! GA,GB,GC>nodes:i!"


def _is_real(text: str | None) -> bool:
    return text is not None and "." in text


def _rbe2_grids(fields: Fields, _: Known) -> list[object]:
    """GM1, GM2, ... (THRU written out), then ALPHA and TREF."""
    stop = next((k for k in range(4, len(fields)) if _is_real(fields[k])), len(fields))
    parts = numbers(fields[:stop], 4)
    if not parts:
        raise FieldError(4, "GM1", "must be given")
    every = (n for part in parts for n in (part if isinstance(part, range) else (part,)))
    return [tuple(every), take(fields, stop, "ALPHA:r=0."), take(fields, stop + 1, "TREF:r=0.")]


def _rbe1_grids(fields: Fields, _: Known) -> list[object]:
    """Independent pairs of grid and components, UM, dependent pairs, ALPHA."""
    alpha = len(fields) - 1 if _is_real(fields[-1]) else len(fields)
    words = [str(text).upper() for text in fields]
    if "UM" not in words:
        raise FieldError(len(fields), "UM", "is missing before the dependent grids")
    um = words.index("UM")
    pairs = [*_pairs("N", fields[:um], 2), *_pairs("M", fields[:alpha], um + 1)]
    return [*pairs, take(fields, alpha, "ALPHA:r=0.")]


def _pairs(letter: str, fields: Fields, first: int) -> list[tuple[object, ...]]:
    """Grids and components from a field on; blank pairs are passed over."""
    given = [k for k in range(first, len(fields), 2) if any(fields[k : k + 2])]
    return [tuple(take(fields, k, f"G{letter}:i!") for k in given),
            tuple(take(fields, k + 1, f"C{letter}:c!") for k in given)]  # fmt: skip


def _rbe3_grids(fields: Fields, _: Known) -> list[object]:
    """Weight, components and grids of each group; UM and its pairs; ALPHA."""
    words = [str(text).upper() for text in fields]
    end = words.index("ALPHA") if "ALPHA" in words else len(fields)
    um = words.index("UM") if "UM" in words else end
    starts = [k for k in range(5, um) if _is_real(fields[k])]
    groups = []
    for k, stop in zip(starts, [*starts[1:], um], strict=True):
        grids = tuple(take(fields, i, "G:i") for i in range(k + 2, stop) if fields[i] is not None)
        if not grids:
            raise FieldError(k + 2, "G", "must be given")
        groups.append((take(fields, k, "WT:r!"), take(fields, k + 1, "C:c!"), grids))
    if not groups:
        raise FieldError(5, "WT1", "must be given")
    alpha = take(fields, end + 1, "ALPHA:r=0.")
    return [*zip(*groups, strict=True), *_pairs("M", fields[:end], um + 1), alpha]


def _rspline_grids(fields: Fields, _: Known) -> list[tuple[object, ...]]:
    """Grids along the spline, and the components of each that follow it."""
    at = range(4, len(fields), 2)
    follow = (take(fields, k + 1, "C:c") for k in at)
    first = take(fields, 3, "G1:i!")
    return [(first, *(take(fields, k, "G:i!") for k in at)), ("", *(c or "" for c in follow))]


CARDS = (
    Card("RBE1", "EID:i!", "eid", more=_rbe1_grids, extra="gn cn gm cm alpha", grids="gn gm"),
    Card(
        "RBE2", "EID:i! GN:i! CM:c", "eid", more=_rbe2_grids, extra="gm alpha tref", grids="gn gm"
    ),
    Card(
        "RBE3",
        "EID:i! - REFGRID:i! REFC:c",
        "eid",
        more=_rbe3_grids,
        extra="weights components groups gm cm alpha",
        grids="refgrid groups",
    ),
    Card("RBAR", f"{_ENDS} CNA:c CNB:c CMA:c CMB:c ALPHA:r=0. TREF:r=0.", "eid"),
    Card("RBAR1", f"{_ENDS} CB:c ALPHA:r=0. TREF:r=0.", "eid"),
    Card("RJOINT", f"{_ENDS} CB:c", "eid"),
    Card("RROD", f"{_ENDS} CMA:c CMB:c ALPHA:r=0. TREF:r=0.", "eid"),
    Card("RTRPLT", f"{_CORNERS} CNA:c CNB:c CNC:c CMA:c / CMB:c CMC:c ALPHA:r=0. TREF:r=0.", "eid"),
    Card("RTRPLT1", f"{_CORNERS} CMB:c CMC:c ALPHA:r=0. TREF:r=0.", "eid"),
    Card(
        "RSPLINE",
        "EID:i! DL:r=0.1 G1:i!",
        "eid",
        more=_rspline_grids,
        extra="nodes dependent",
        grids="nodes",
    ),
)


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
        self.owners: list[Place] = []
        self.rows: list[int] = []
        self.columns: list[int] = []
        self.values: list[float] = []

    def add(
        self,
        dependent: int,
        columns: Sequence[int],
        values: Floats,
        owner: Place,
        least: float = 1e-14,
    ) -> None:
        """Add ``u[dependent] = sum(values * u[columns])``, without what is but rounding."""
        used = np.flatnonzero(np.abs(values) > least * np.abs(values).max(initial=1.0))
        row = len(self.dependent)
        self.dependent.append(int(dependent))
        self.owners.append(owner)
        self.rows.extend([row] * len(used))
        self.columns.extend(int(columns[k]) for k in used)
        self.values.extend(float(v) for v in values[used])

    def motion(self, row: int, origin: Floats) -> Floats:
        """Displacements (6) of grid `row`, its system, from rigid motion about `origin`, (6, 6)."""
        return self.points.motions(np.array([row]), origin)[0]  # type: ignore[no-any-return]


def _components(digits: str | None) -> list[int]:
    """Component numbers of digits such as 1235; 0 and a blank name none."""
    return [int(d) for d in digits or "" if d != "0"]


def rbe2(rows: Rows, card: Values, place: Place) -> None:
    """Components CM of the grids GMi follow the rigid motion of GN."""
    points = rows.points
    centre = points.row(card.gn, place)
    inverse = rows.motion(centre, points.xyz[centre]).T  # a rotation of translations and rotations
    for grid in card.gm:
        row = points.row(int(grid), place)
        if row == centre:
            raise place.error(f"grid {grid} is both the independent and a dependent grid")
        T = rows.motion(row, points.xyz[centre]) @ inverse
        for c in _components(card.cm):
            rows.add(6 * row + c - 1, range(6 * centre, 6 * centre + 6), T[c - 1], place)


def rbar(rows: Rows, card: Values, place: Place) -> None:
    """Two grids on a rigid bar; six components of either are independent."""
    _joined(rows, card.nodes, (card.cna, card.cnb), (card.cma, card.cmb), place)


def rtrplt(rows: Rows, card: Values, place: Place) -> None:
    """Three grids on a rigid plate; six components of them are independent."""
    independent, dependent = (card.cna, card.cnb, card.cnc), (card.cma, card.cmb, card.cmc)
    _joined(rows, card.nodes, independent, dependent, place)


def rtrplt1(rows: Rows, card: Values, place: Place) -> None:
    """Components of GB and GC follow the rigid motion of GA."""
    follow = card.cmb or "123456", card.cmc or "123456"
    _joined(rows, card.nodes, ("123456", None, None), (None, *follow), place)


def _joined(
    rows: Rows,
    nodes: Sequence[int],
    named: Sequence[str | None],
    following: Sequence[str | None],
    place: Place,
) -> None:
    """Grids on a rigid body; all components that are not independent follow where none is named."""
    named = named if any(named) else ("123456", *[None] * (len(nodes) - 1))
    independent = list(zip(nodes, named, strict=True))
    dependent = list(zip(nodes, following, strict=True))
    if not any((c or "").strip("0") for _, c in dependent):
        dependent = [(n, "".join(sorted({*"123456"} - {*(c or "")}))) for n, c in independent]
    _rigid_body(rows, independent, dependent, place)


def rbar1(rows: Rows, card: Values, place: Place) -> None:
    """Components CB of GB follow the rigid motion of GA."""
    a, b = card.nodes
    _rigid_body(rows, [(a, "123456")], [(b, card.cb or "123456")], place)


def rspline(rows: Rows, card: Values, place: Place) -> None:
    """Interpolate grids between others as a thin tube would bend, stretch and twist through them.

    Its diameter is DL times its length (Quick Reference Guide, RSPLINE); along a straight line the
    displacements do not depend on it.
    """
    points = rows.points
    at = np.array([points.row(int(grid), place) for grid in card.nodes])
    follow = np.array(
        [6 * k + c - 1 for k, digits in enumerate(card.dependent) for c in _components(digits)], int
    )
    if any(digits.strip("0") not in ("", "123456") for digits in card.dependent):
        raise place.error("a grid must follow the spline with all its components (123456) or none")
    if card.dependent[-1].strip("0") or len(at) < 3 or not len(follow):
        raise place.error("its first and last grid must be independent, grids between them follow")
    xyz = points.xyz[at]
    lengths = np.linalg.norm(np.diff(xyz, axis=0), axis=1)
    if not lengths.all():
        raise place.fault("has no length: two of its grids coincide")
    span = np.diff(xyz, axis=0) / lengths[:, None]
    aside = np.cross(span, np.eye(3)[np.abs(span).argmin(axis=1)])
    one, no_pins = np.ones(len(span)), np.zeros((len(span), 6), bool)
    area = 8.0 / (card.dl * lengths.sum()) ** 2 * one
    bars = bar_stiffness(
        xyz[:-1], xyz[1:], aside, one, one / 2.6, area, one, one, 0 * one, 2 * one,
        0 * one, 0 * one, no_pins, no_pins,
    )  # fmt: skip
    K = np.zeros((6 * len(at), 6 * len(at)))
    for k, bar in enumerate(bars):
        K[6 * k : 6 * k + 12, 6 * k : 6 * k + 12] += bar
    for k, row in enumerate(at):
        turn, own = rows.motion(int(row), xyz[k]), slice(6 * k, 6 * k + 6)
        K[own], K[:, own] = turn @ K[own], K[:, own] @ turn.T
    free = np.setdiff1d(np.arange(len(K)), follow)
    dofs = (6 * at[:, None] + np.arange(6)).ravel()
    moved = -np.linalg.solve(K[np.ix_(follow, follow)], K[np.ix_(follow, free)])
    for dof, values in zip(dofs[follow], moved, strict=True):
        rows.add(int(dof), dofs[free].tolist(), values, place, least=1e-12)


def rbe1(rows: Rows, card: Values, place: Place) -> None:
    """Several grids on a rigid body; six components of them are independent."""
    independent = list(zip(card.gn, card.cn, strict=True))
    dependent = list(zip(card.gm, card.cm, strict=True))
    _rigid_body(rows, independent, dependent, place)


def _rigid_body(
    rows: Rows,
    independent: Sequence[tuple[int, str | None]],
    dependent: Sequence[tuple[int, str | None]],
    place: Place,
) -> None:
    """Dependent components from the rigid motion that six independent components determine."""
    points = rows.points
    origin = points.xyz[points.row(int(independent[0][0]), place)]
    base, columns = _motions(rows, independent, origin, place)
    if len(columns) != 6:
        raise place.error(f"{len(columns)} components are independent; there must be six")
    at = [points.row(int(grid), place) for grid, _ in (*independent, *dependent)]
    scale = float(np.linalg.norm(points.xyz[at] - origin, axis=1).max()) or 1.0
    balance = np.array([1.0, 1.0, 1.0, scale, scale, scale])
    unit = np.where(np.array(columns) % 6 < 3, 1.0, scale)
    if np.linalg.cond(base * unit[:, None] / balance) > 1e10:
        raise place.error("its independent components do not determine the motion of a rigid body")
    values, targets = _motions(rows, dependent, origin, place)
    solved = np.linalg.solve((base / balance).T, (values / balance).T).T
    for dof, row in zip(targets, solved, strict=True):
        if dof in columns:
            raise place.error(
                f"{points.label(dof)} (grid:component) is both independent and dependent"
            )
        rows.add(dof, columns, row, place, least=1e-13)


def _motions(
    rows: Rows, members: Sequence[tuple[int, str | None]], origin: Floats, place: Place
) -> tuple[Floats, list[int]]:
    """Rows (m, 6) of displacements by rigid motion about `origin`, and their dofs."""
    values, dofs = [], []
    for grid, digits in members:
        row = rows.points.row(int(grid), place)
        motion = rows.motion(row, origin)
        for c in _components(digits):
            values.append(motion[c - 1])
            dofs.append(6 * row + c - 1)
    return np.array(values).reshape(-1, 6), dofs


def rrod(rows: Rows, card: Values, place: Place) -> None:
    """Keep the distance of two grids; one component of one of them is dependent."""
    points = rows.points
    a, b = (points.row(grid, place) for grid in card.nodes)
    along = points.xyz[b] - points.xyz[a]
    length = float(np.linalg.norm(along))
    if length == 0.0:
        raise place.fault("has no length: its ends coincide")
    x = along / length
    coefficients = np.concatenate([-points.directions[a] @ x, points.directions[b] @ x])
    dofs = [6 * a, 6 * a + 1, 6 * a + 2, 6 * b, 6 * b + 1, 6 * b + 2]
    chosen = [c - 1 for c in _components(card.cma)]
    chosen += [c + 2 for c in _components(card.cmb)]
    if len(chosen) != 1 or chosen[0] > 5:
        raise place.error("one translation must be dependent, CMA or CMB")
    pivot = coefficients[chosen[0]]
    if abs(pivot) < 1e-3:
        raise place.error("the dependent component is (nearly) normal to the rod: give another")
    others = [k for k in range(6) if k != chosen[0] and abs(coefficients[k]) > 1e-14]
    rows.add(dofs[chosen[0]], [dofs[k] for k in others], -coefficients[others] / pivot, place, 0.0)


def rbe3(rows: Rows, card: Values, place: Place) -> None:
    """Move the reference grid as the weighted mean of others.

    The motion of the reference grid is the rigid motion that fits the others' displacements best,
    with the weights given; rotations weigh by the square of the mean distance, so that the result
    does not depend on the unit of length (MSC Nastran Reference Guide, RBE3). With UM other
    components are made dependent by the same equations.
    """
    points = rows.points
    reference = points.row(card.refgrid, place)
    origin = points.xyz[reference]
    members = [
        (grid, digits, weight)
        for weight, digits, grids in zip(card.weights, card.components, card.groups, strict=True)
        for grid in grids
    ]
    S, columns = _motions(rows, [(g, c) for g, c, _ in members], origin, place)
    weights = np.array([w for _, c, w in members for _ in _components(c)])
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
    components = _components(card.refc)
    wanted = (rows.motion(reference, origin) / balance)[[c - 1 for c in components]]
    if lost.size and np.abs(wanted * balance.max() @ lost).max() > 1e-6 * balance.max():
        raise place.error(
            f"the grids it averages do not determine all components {card.refc} of the "
            "reference grid: average more components or fewer in a line"
        )
    G = wanted @ np.linalg.pinv(normal, rcond=1e-10, hermitian=True) @ (A.T * weights)
    targets = [6 * reference + c - 1 for c in components]
    moved = list(zip(card.gm, card.cm, strict=True))
    if not moved:
        for dof, row in zip(targets, G, strict=True):
            rows.add(dof, columns, row, place)
        return
    _rbe3_um(rows, moved, targets, columns, G, place)


def _rbe3_um(
    rows: Rows,
    moved: list[tuple[int, str | None]],
    targets: list[int],
    columns: list[int],
    G: Floats,
    place: Place,
) -> None:
    """Solve the equations ``u[targets] = G u[columns]`` for the components under UM."""
    _, dependent = _motions(rows, moved, np.zeros(3), place)
    every = [*targets, *columns]
    if len(dependent) != len(targets):
        raise place.error(
            f"UM names {len(dependent)} components; there must be as many as in REFC, "
            f"{len(targets)}"
        )
    if any(d not in every for d in dependent):
        raise place.error("UM names a component that the element does not use")
    equations = np.hstack([np.eye(len(targets)), -G])
    position = [every.index(d) for d in dependent]
    rest = [k for k in range(len(every)) if k not in position]
    if np.linalg.cond(equations[:, position]) > 1e12:
        raise place.error("the components under UM cannot be the dependent ones")
    solved = -np.linalg.solve(equations[:, position], equations[:, rest])
    for dof, row in zip(dependent, solved, strict=True):
        rows.add(dof, [every[k] for k in rest], row, place)


RIGID: dict[str, Callable[[Rows, Values, Place], None]] = {
    "RBE2": rbe2,
    "RBAR": rbar,
    "RBAR1": rbar1,
    "RBE1": rbe1,
    "RBE3": rbe3,
    "RROD": rrod,
    "RJOINT": rbar1,
    "RTRPLT": rtrplt,
    "RTRPLT1": rtrplt1,
    "RSPLINE": rspline,
}
"""Rigid elements by card name."""
