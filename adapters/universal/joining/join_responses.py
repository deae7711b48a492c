"""Frequency responses: the functions of dataset 58 that belong together, as one array."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from ....core.arrays import Floats, Ints, Numbers
from ....core.data.dofs import Dofs
from ....core.data.frfs import Frfs
from ....core.errors import InputError
from ..datasets.function_names import QUANTITIES
from ..datasets.function_values import check_size, read_values
from ..datasets.functions import Head58, Record
from ..text.number_fields import NotANumber
from ..universal_content import Function, Skipped
from .response_units import DERIVATIVE, MOTION, factors, highest_quantity, quantity_of

Frames = Callable[[Ints], Floats]
_FREQUENCY, _FORCE = 18, (13, 9)


@dataclass
class Report:
    """Where the assembly says what it left out."""

    skipped: list[Skipped]
    warnings: list[str]
    failed: list[InputError] = field(default_factory=list)

    def skip(self, record: Record, why: str, row: int = 0) -> None:
        """List one function as not read."""
        line = record.head.section.line + row
        what = f"dataset 58 ({record.head.kind} {label(record.head)})"
        self.skipped.append(Skipped(what, line, why, record.source.name, "lost"))


def label(head: Head58) -> str:
    """Response and reference of a function for a message, such as ``12:+Z/1:-X``."""
    return "/".join(_label(*dof) for dof in (head.response, head.reference))


def _label(node: int, direction: int) -> str:
    name = ("?", "X", "Y", "Z", "RX", "RY", "RZ")[abs(direction)] if abs(direction) < 7 else "?"
    return f"{node}:{'-' if direction < 0 else '+'}{name}" if direction else f"{node}"


def assemble(
    records: Sequence[Record], frames: Frames, length_unit: str | None, report: Report
) -> tuple[Frfs | None, tuple[Function, ...]]:
    """Put the frequency responses into one array and read every other function by itself.

    Parameters
    ----------
    records : sequence of Record
        Functions in file order.
    frames : callable
        Displacement axes (n, 3, 3) of node numbers (n,), in the basic frame.
    length_unit : str or None
        Unit of the test's lengths; responses whose unit is labelled are converted to it.

    Returns
    -------
    frfs : Frfs or None
        Functions that share the most common frequency axis and quantity.
    functions : tuple of Function
        The rest.
    """
    records = [r for r in records if _whole(r, report)]
    _say_unfit(records, report)
    chosen = _largest_group([r for r in records if is_frf(r.head)], report)
    frfs = _frfs(chosen, frames, length_unit, report) if chosen else None
    taken = {id(r) for r in chosen}
    others = ((r, _read(r, report)) for r in records if id(r) not in taken)
    return frfs, tuple(_function(r, *read) for r, read in others if read is not None)


def is_frf(head: Head58) -> bool:
    """Whether a function is a complex motion per force over frequency at known dofs."""
    general = head.function == 0 and head.ordinate.quantity in MOTION
    return (
        (head.function == 4 or (general and head.denominator.quantity in _FORCE))
        and head.is_complex
        and head.abscissa.quantity in (_FREQUENCY, 0, 1)
        and (head.ordinate.quantity in MOTION or head.ordinate.quantity in (0, 1))
        and (head.denominator.quantity in _FORCE or head.denominator.quantity in (0, 1))
        and 1 <= abs(head.response[1]) <= 6
        and 1 <= abs(head.reference[1]) <= 6
    )


def _largest_group(records: Sequence[Record], report: Report) -> list[Record]:
    """Return the responses on the most common frequency axis; report the others."""
    groups: dict[tuple[object, ...], list[Record]] = {}
    for r in records:
        h = r.head
        axis = (h.n_point, f"{h.start:.5e}", f"{h.step:.5e}") if h.even else (h.n_point, "uneven")
        groups.setdefault(axis, []).append(r)
    best = max(groups.values(), key=len, default=[])
    for group in groups.values():
        if group is not best:
            report.warnings.append(
                f"{group[0].where}: {len(group)} frequency response(s) have another frequency "
                f"axis{_ends(group[0].head)} than the other {len(best)}{_ends(best[0].head)} and "
                "stand apart from them"
            )
    return best


def _ends(head: Head58) -> str:
    if not head.even:
        return ""
    return f" ({head.start:g} to {head.start + (head.n_point - 1) * head.step:g} Hz)"


def _frfs(
    records: Sequence[Record], frames: Frames, length_unit: str | None, report: Report
) -> Frfs | None:
    heads = [r.head for r in records]
    responses = list(dict.fromkeys(h.response for h in heads))
    references = list(dict.fromkeys(h.reference for h in heads))
    row = {dof: k for k, dof in enumerate(responses)}
    column = {dof: k for k, dof in enumerate(references)}
    shape = len(responses), len(references), heads[0].n_point
    values = np.empty(shape, np.complex128)
    quantity = highest_quantity(heads)
    if quantity is None:
        report.warnings.append(
            f"{records[0].where}: neither type nor unit says what the responses are; "
            "taken as acceleration"
        )
        quantity = "acceleration"
    scale = factors(heads, length_unit, records[0].where, report.warnings)
    axis, filled = _fill(values, records, (row, column), quantity, scale, report)
    if axis is None:
        return None
    for place in {*product(range(shape[0]), range(shape[1]))} - filled:
        values[place] = np.nan
    _say_changed(records, quantity, report)
    rows, columns = (sorted({place[k] for place in filled}) for k in (0, 1))
    if (len(rows), len(columns)) != values.shape[:2]:
        values = values[np.ix_(rows, columns)]
    values.flags.writeable = False
    return Frfs(
        axis,
        _dofs([responses[k] for k in rows], frames),
        _dofs([references[k] for k in columns], frames),
        values,
        quantity,
        ", ".join(dict.fromkeys(r.source.name for r in records)),
    )


def _fill(
    values: Numbers,
    records: Sequence[Record],
    places: tuple[dict[tuple[int, int], int], dict[tuple[int, int], int]],
    quantity: str,
    scale: Sequence[float],
    report: Report,
) -> tuple[Floats | None, set[tuple[int, int]]]:
    """Read responses into their places; return the frequency axis and the places filled."""
    axis: Floats | None = None
    filled: set[tuple[int, int]] = set()
    for record, factor in zip(records, scale, strict=True):
        place = places[0][record.head.response], places[1][record.head.reference]
        if place in filled:
            report.skip(record, "this response and reference were read before; the first is kept")
            continue
        if (read := _read(record, report)) is None:
            continue
        x, y = read
        if why := _unusable(record.head, x, y, axis):
            report.skip(record, why)
            continue
        axis = x if axis is None else axis
        filled.add(place)
        np.multiply(y, factor, out=values[place])
        order = DERIVATIVE[quantity] - DERIVATIVE[quantity_of(record.head) or quantity]
        if order:
            values[place] *= (2j * np.pi * axis) ** order
    return axis, filled


def _unusable(head: Head58, x: Floats, y: Numbers, axis: Floats | None) -> str:
    """Say why a response cannot join the others, or nothing."""
    parts = np.ascontiguousarray(y).view(np.float64)
    if not (np.isfinite(parts).all() and np.isfinite(x).all()):
        bad = np.count_nonzero(~np.isfinite(y)) + np.count_nonzero(~np.isfinite(x))
        return f"{bad} of its {len(y)} values are not finite numbers"
    if len(x) > 1 and (head.step <= 0.0 if head.even else np.any(np.diff(x) <= 0.0)):
        return "its frequencies do not increase"
    if axis is not None and np.abs(x - axis).max() > 1e-4 * (axis[-1] - axis[0]) / len(axis):
        return "its frequency axis differs from that of the other responses"
    return ""


def _dofs(dofs: Sequence[tuple[int, int]], frames: Frames) -> Dofs:
    """Degrees of freedom with their axes; a negative direction turns the axis round."""
    node, direction = np.array(dofs, np.int64).T
    component = np.abs(direction)
    axis = frames(node)[np.arange(len(node)), (component - 1) % 3]
    return Dofs(node, component, axis * np.sign(direction)[:, None])


def _say_unfit(records: Sequence[Record], report: Report) -> None:
    """Warn of functions that call themselves frequency responses but cannot be used as such."""
    reasons: dict[str, list[Record]] = {}
    for record in (r for r in records if r.head.function == 4 and not is_frf(r.head)):
        h = record.head
        if not h.is_complex:
            why = "are real, not complex"
        elif not h.response[1] or not h.reference[1]:
            why = "do not say the direction of response or reference"
        else:
            why = "are not a motion per force"
        reasons.setdefault(why, []).append(record)
    for why, found in reasons.items():
        report.warnings.append(
            f"{found[0].where}: {len(found)} frequency response(s) {why}; they stand apart"
        )


def _say_changed(records: Sequence[Record], quantity: str, report: Report) -> None:
    """Tell which dofs came from names, and which responses were differentiated."""
    if others := [r for r in records if quantity_of(r.head) not in (quantity, None)]:
        report.warnings.append(
            f"{others[0].where}: {len(others)} response(s) are not {quantity} as the others and "
            "were multiplied by i omega as often as that takes"
        )
    if named := [r for r in records if r.head.named]:
        report.warnings.append(
            f"{named[0].where}: node and direction of {len(named)} function(s) stand only in their "
            f"names and were taken from there ({label(named[0].head)} first)"
        )


def _whole(record: Record, report: Report) -> bool:
    """Whether a function can hold what its header announces."""
    try:
        check_size(record.source, record.head)
    except ValueError as error:
        _refuse(record, str(error), report)
        return False
    return True


def _read(record: Record, report: Report) -> tuple[Floats, Numbers] | None:
    """Values of a function; None, and a line in the report, where they cannot be read."""
    try:
        return read_values(record.source, record.head)
    except NotANumber as error:
        report.skip(record, f"{error.text!r} is not a number", 12 + error.row)
    except ValueError as error:
        _refuse(record, str(error), report)
    return None


def _refuse(record: Record, why: str, report: Report) -> None:
    """List a function whose data are not what its header announces; the last may be cut off."""
    section = record.head.section
    if not section.closed:
        why = (
            f"the file ends inside dataset 58 that starts here ({why}); it is cut off, "
            "export or copy it again"
        )
        report.failed.append(record.source.error(section.line, why))
    report.skip(record, why)


def _function(record: Record, x: Floats, y: Numbers) -> Function:
    h = record.head
    return Function(
        h.kind,
        x,
        y,
        h.response,
        h.reference,
        QUANTITIES.get(h.ordinate.quantity, f"type {h.ordinate.quantity}"),
        QUANTITIES.get(h.denominator.quantity, f"type {h.denominator.quantity}"),
        QUANTITIES.get(h.abscissa.quantity, f"type {h.abscissa.quantity}"),
        h.abscissa.unit,
        h.ordinate.unit,
        h.ids,
        h.section.line,
        record.source.name,
        (h.function, *(a.quantity for a in (h.abscissa, h.ordinate, h.denominator))),
    )
