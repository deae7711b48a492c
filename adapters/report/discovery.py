"""Tables of a discovery: what was found, what else was considered, how the gap shrank."""

from __future__ import annotations

from collections.abc import Mapping

from . import reading
from .formats import MISSING, fixed, general, percent
from .reading import Result, Summary
from .tables import Cell, Column, Table

KINDS = {
    "point_mass": "attached mass",
    "distributed_mass": "distributed mass",
    "local_stiffness": "local stiffness",
    "ground_spring": "spring to ground",
    "support_flexibility": "flexible support",
    "joint_flexibility": "flexible joint",
    "tuned_absorber": "tuned absorber",
    "local_damper": "local damper",
    "sensor_polarity": "sensor polarity",
    "sensor_gain": "sensor gain",
    "sensor_swap": "swapped sensors",
    "sensor_axis": "turned sensor axis",
}


def would_decide(result: Result) -> Table | None:
    """Return what to measure next where the data do not decide."""
    said = reading.texts(result, "would_decide")
    if not said:
        return None
    return Table("What would decide", (Column("", numeric=False),), tuple((Cell(s),) for s in said))


def kind(finding: Result) -> str:
    """Return the kind of a finding in words; an unknown kind as it stands."""
    word = str(finding.get("kind", ""))
    return KINDS.get(word, word.replace("_", " "))


def where(finding: Result) -> str:
    """Return the place of a finding as a phrase."""
    place = reading.part(finding, "where")
    if place.get("region"):
        return str(place["region"])
    for key, noun in (("sensors", "sensor"), ("grids", "grid"), ("elements", "element")):
        ids = reading.texts(place, key)
        if ids:
            more = f" and {len(ids) - 4} more" if len(ids) > 4 else ""
            return f"{noun}{'s' * (len(ids) > 1)} {', '.join(ids[:4])}{more}"
    return MISSING


def magnitude(finding: Result) -> str:
    """Return the magnitudes of a finding with their 95 % intervals."""
    sizes, intervals = reading.part(finding, "magnitude"), finding.get("interval")
    said = []
    for key, value in sizes.items():
        text = _value(value)
        if not text:
            continue
        bounds = intervals.get(key) if isinstance(intervals, Mapping) else None
        if bounds is None and key == next(iter(sizes)) and not isinstance(intervals, Mapping):
            bounds = intervals
        low_high = reading.numbers(bounds)
        if len(low_high) == 2:
            text += f" ({general(low_high[0], 3)} to {general(low_high[1], 3)})"
        said.append(f"{key.replace('_', ' ')} {text}")
    return "; ".join(said) or MISSING


def _value(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(general(v, 3) for v in value)
    return "" if value is None else general(value, 3)


def findings(result: Result) -> Table | None:
    """Return what was found, on either side, with place, size and confidence."""
    found = reading.records(result, "findings")
    if not found:
        return None
    rows = [
        (
            Cell(str(f.get("side", MISSING))),
            Cell(kind(f)),
            Cell(where(f)),
            Cell(magnitude(f)),
            Cell(percent(f.get("confidence")), bar=reading.number(f.get("confidence"))),
            Cell(_count(f.get("credible_set"))),
        )
        for f in found
    ]
    columns = (
        Column("side", numeric=False),
        Column("what", numeric=False),
        Column("where", numeric=False),
        Column("size (95 % interval)", numeric=False),
        Column("confidence %"),
        Column("places as good"),
    )
    return Table("Findings", columns, tuple(rows))


def _count(value: object) -> str:
    """Count places in a list of places, or of groups of them."""
    if isinstance(value, Mapping):
        value = [value]
    if not isinstance(value, (list, tuple)) or not value:
        return MISSING
    return str(sum(_size(entry) for entry in value))


def _size(entry: object) -> int:
    if not isinstance(entry, Mapping):
        return 1
    place = reading.part(entry, "where") or entry
    named = (place.get(key) for key in ("grids", "elements", "sensors"))
    return max([len(n) for n in named if isinstance(n, (list, tuple))], default=1)


def alternatives(result: Result) -> Table | None:
    """Return what else was considered, and how likely it is beside what was found."""
    found = reading.records(result, "alternatives")
    if not found:
        return None
    rows = [(Cell(_kinds(a)), *map(Cell, _place_and_odds(a))) for a in found]
    headings = ("what", "where", "beside what was found")
    return Table("Also considered", tuple(Column(h, numeric=False) for h in headings), tuple(rows))


def _kinds(alternative: Result) -> str:
    words = reading.texts(alternative, "kinds")
    return " and ".join(KINDS.get(w, w.replace("_", " ")) for w in words) or "nothing missing"


def _place_and_odds(alternative: Result) -> tuple[str, str]:
    """Return a sentence in its two parts."""
    said, colon, likely = str(alternative.get("sentence", MISSING)).rpartition(": ")
    return (said, likely) if colon else (likely, MISSING)


_LEFT = "The deck was left as it was; what differs comes of sensors corrected for the comparison."
_SEARCHED = 2
"""Rows of the modes that were searched."""


def gap(result: Result) -> Table | None:
    """Return the gap before and after, on the searched and on the held-out data."""
    found = reading.part(result, "gap")
    held = reading.part(found, "held_out")
    states = [
        ("searched", "before", reading.part(found, "before")),
        ("searched", "after", reading.part(found, "after")),
        ("held out", "before", reading.part(held, "before")),
        ("held out", "after", reading.part(held, "after")),
    ]
    rows = [
        (Cell(data), Cell(state), *_summary_cells(reading.summary(entry)))
        for data, state, entry in states
        if entry
    ]
    if not rows:
        return None
    columns = (
        Column("data", numeric=False),
        Column("model", numeric=False),
        Column("pairs"),
        Column("mean |dev.| %"),
        Column("worst |dev.| %"),
        Column("mean MAC %"),
    )
    note = ""
    if len(rows) > _SEARCHED:
        note = "Held out: modes and sensors that the search never saw."
    elif held:
        note = "No modes were held out from the search: the test has fewer than ten that count."
    if not reading.adopted(result):
        note = f"{note} {_LEFT}".strip()
    return Table("The gap", columns, tuple(rows), note)


def _summary_cells(s: Summary) -> list[Cell]:
    of = f" of {s.test_modes}" if s.test_modes else ""
    return [
        Cell(MISSING if s.pairs is None else f"{s.pairs}{of}"),
        Cell(fixed(s.mean_percent, 2)),
        Cell(fixed(s.worst_percent, 2)),
        Cell(percent(s.mean_mac, 1), bar=s.mean_mac),
    ]


def damping(result: Result) -> Table | None:
    """Return measured damping ratios beside those of the deck before and after."""
    found = reading.part(result, "damping")
    modes = reading.records(found, "modes")
    if not modes:
        return None
    rows = [
        (Cell(str(m.get("test", MISSING))), *[Cell(percent(m.get(k), 2)) for k in _DAMPING])
        for m in modes
    ]
    columns = (Column("test mode"), *[Column(f"{k} %") for k in _DAMPING])
    typical = reading.part(found, "typical_factor")
    note = (
        f"Off by a factor of {fixed(typical.get('before'), 2)} typically before, "
        f"{fixed(typical.get('after'), 2)} after. Dampers do not enter normal modes: the ratios "
        "are those of complex modes with the structure's own damping as the test shows it."
    )
    return Table("Damping ratios", columns, tuple(rows), note)


_DAMPING = ("measured", "before", "after")


def responses(result: Result) -> Table | None:
    """Return how well measured frequency responses are met before and after."""
    found = reading.part(result, "frf")
    each = reading.records(found, "responses")
    if not each:
        return None
    states = ("before", "after")
    mean, log = reading.part(found, "mean_frac"), reading.part(found, "log_misfit")
    worst = {k: min((reading.number(e.get(k)) or 0.0) for e in each) for k in states}
    rows = (
        (Cell("FRAC %, mean over the sensors"), *[Cell(percent(mean.get(k), 1)) for k in states]),
        (Cell("FRAC %, worst sensor"), *[Cell(percent(worst[k], 1)) for k in states]),
        (Cell("magnitudes, rms log ratio"), *[Cell(fixed(log.get(k), 3)) for k in states]),
    )
    columns = (Column("measure", numeric=False), *[Column(k) for k in states])
    note = (
        f"{found.get('lines')} lines at {len(each)} sensors, none of them used to fit a "
        f"hypothesis; {general(found.get('independent_lines'), 3)} count as independent."
    )
    return Table("Frequency responses", columns, rows, note)
