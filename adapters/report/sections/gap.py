"""The gap before and after, on the searched and on the held-out data."""

from collections.abc import Sequence

from ....core.results.correlation import Gap
from ....core.results.discovery import DiscoverTables
from ..tables.number_formats import fixed, percent
from ..tables.table import Cell, Table, left
from .section import Section

_LEFT = "The deck was left as it was"
_LEAST = 0.1
_CORRECTED = "what differs comes of sensors corrected for the comparison"


def _tables(found: DiscoverTables) -> Sequence[Table]:
    gap, held = found.gap, found.gap.held_out
    states = [
        ("searched", "before", gap.before),
        ("searched", "after", gap.after),
        ("held out", "before", held.before),
        ("held out", "after", held.after),
    ]
    rows = [(data, model, *_cells(entry)) for data, model, entry in states if entry is not None]
    columns = [*left("data", "model"), "pairs", "mean |dev.| %", "worst |dev.| %", "mean MAC %"]
    note = "Held out: modes and sensors that the search never saw."
    if held.before is None:
        note = "No modes were held out from the search: the test has fewer than ten that count."
    if not found.adopted:
        pairs = (gap.before, gap.after), (held.before, held.after)
        same = all(_shown(old) == _shown(new) for old, new in pairs)
        note += f" {_LEFT}." if same else f" {_LEFT}; {_CORRECTED}."
    return [Table.of("The gap", columns, rows, f"{note} {_off(found)}".strip())]


def _off(found: DiscoverTables) -> str:
    """Say by how much the model is off everywhere, and how usual that is."""
    j = found.judgement
    if not j.error:
        return ""
    said = f"The completed model is off by {100.0 * j.error:.2g} % of its stiffness everywhere"
    if j.gain:
        said += f" ({100.0 * j.error_alone:.2g} % with the known parameters alone)"
    share = _share(100.0 * j.adequacy)
    as_many = " and leave as many modes unexplained" if j.unexplained else ""
    return f"{said}; of models that lack nothing {share} % are off by as much{as_many}."


def _share(percent: float) -> str:
    """Return a share as far as it is known: at most 99, at least 0.1."""
    if percent < _LEAST:
        return f"fewer than {_LEAST}"
    return f"{percent:.2g}" if percent < 99.5 else "99"


def _cells(gap: Gap) -> list[Cell | str]:
    *figures, mac = _shown(gap)
    return [*figures, Cell(mac, bar=gap.mean_mac)]


def _shown(gap: Gap | None) -> list[str]:
    """Return a gap as far as it is shown."""
    if gap is None:
        return []
    mean, worst = gap.mean_abs_deviation_percent, gap.worst_deviation_percent
    return [str(gap.pairs), fixed(mean, 2), fixed(worst, 2), percent(gap.mean_mac, 1)]


GAP = Section("The gap", "gap", DiscoverTables, _tables)
