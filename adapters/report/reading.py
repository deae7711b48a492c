"""Reading a run's result.json tolerantly: what is absent or odd is None, never an invention."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeGuard

import numpy as np

from ...core.arrays import Floats

Result = Mapping[str, Any]
_UNBELIEVABLE = 1e60


def number(value: object) -> float | None:
    """Return a finite float of a believable size, or None for anything else."""
    if isinstance(value, bool) or not isinstance(value, (int, float, np.number)):
        return None
    try:
        found = float(value)
    except OverflowError:
        return None
    return found if abs(found) < _UNBELIEVABLE else None  # NaN compares False


def identifiers(value: object) -> list[int]:
    """Return the node, grid or mode numbers of a sequence; what is none is passed over."""
    return [int(v) for v in numbers(value) if v is not None and v == int(v) and abs(v) < 2**53]


def numbers(value: object) -> list[float | None]:
    """Return one entry per item of a sequence; empty for anything else."""
    return [number(v) for v in value] if _is_sequence(value) else []


def part(result: object, key: str) -> Result:
    """Return the mapping at `key`; empty when there is none."""
    value = result.get(key) if isinstance(result, Mapping) else None
    return value if isinstance(value, Mapping) else {}


def records(result: object, key: str) -> list[Result]:
    """Return the mappings in the list at `key`; empty when there is none."""
    value = result.get(key) if isinstance(result, Mapping) else None
    return [r for r in value if isinstance(r, Mapping)] if _is_sequence(value) else []


def texts(result: object, key: str) -> list[str]:
    """Return the texts in the list at `key`."""
    value = result.get(key) if isinstance(result, Mapping) else None
    if isinstance(value, str):
        return [value]
    return [str(v) for v in value if v is not None] if _is_sequence(value) else []


def adopted(result: Result) -> bool:
    """Whether the verdict of a discovery changed the deck; True where there is none."""
    return result.get("verdict") in {None, "effect", "parameters_only"}


def verb(result: object) -> str:
    """Return the verb of ``trueup/VERB/1``; empty when the schema is not ours."""
    schema = result.get("schema") if isinstance(result, Mapping) else None
    parts = schema.split("/") if isinstance(schema, str) else []
    return parts[1] if len(parts) == 3 and parts[0] == "trueup" else ""


def has_correlation(result: object) -> bool:
    """Whether a mapping holds the pairs of a correlation (maybe none paired)."""
    return isinstance(result, Mapping) and _is_sequence(result.get("pairs"))


def final(result: Result) -> Result:
    """Return the correlation that counts: `after` where there is one, else `result` itself."""
    for candidate in (part(result, "after"), result, part(result, "before")):
        if has_correlation(candidate):
            return candidate
    return {}


def initial(result: Result) -> Result:
    """Return the correlation of the deck as it came, where the run holds two; else empty."""
    before = part(result, "before")
    return before if has_correlation(before) and has_correlation(part(result, "after")) else {}


def mode_number(value: object, side: str) -> int | None:
    """Return the mode number of an entry: a number, or a mapping that holds it."""
    if isinstance(value, Mapping):
        value = value.get(side, value.get("mode"))
    found = identifiers([value])
    return found[0] if found else None


def unpaired(correlation: Result, side: str) -> list[tuple[int, float | None]]:
    """Return (mode number, Hz or None) of the modes of one side without a partner."""
    known = mode_hz(correlation, side)
    value = correlation.get(f"unpaired_{side}")
    found = [mode_number(v, side) for v in value] if _is_sequence(value) else []
    return [(n, known.get(n)) for n in found if n is not None]


def mode_hz(correlation: Result, side: str) -> dict[int, float]:
    """Return the frequencies that a correlation tells, by mode number of one side."""
    known: dict[int, float] = {}
    for key in ("mac", "mac_rotated"):
        matrix = part(correlation, key)
        modes, hz = matrix.get(side), numbers(matrix.get(f"{side}_hz"))
        if _is_sequence(modes):
            pairs = zip(modes, hz, strict=False)
            known |= {n: f for m, f in pairs if (n := mode_number(m, side)) and f is not None}
    hz = numbers(correlation.get(f"{side}_hz"))
    known |= {k + 1: f for k, f in enumerate(hz) if f is not None and k + 1 not in known}
    entries = correlation.get(f"unpaired_{side}")
    loose = [e for e in entries if isinstance(e, Mapping)] if _is_sequence(entries) else []
    for entry in [*loose, *records(correlation, "pairs")]:
        n = mode_number(entry, side)
        f = number(entry.get(f"{side}_hz", entry.get("frequency_hz")))
        if n is not None and f is not None:
            known[n] = f
    return known


def pair_by_test(correlation: Result) -> dict[int, Result]:
    """Return the pairs by test mode number."""
    found = {mode_number(p, "test"): p for p in records(correlation, "pairs")}
    return {n: p for n, p in found.items() if n is not None}


def test_modes(*correlations: Result) -> list[int]:
    """Return all test mode numbers that any of the correlations mentions, rising."""
    seen: set[int] = set()
    for c in correlations:
        seen |= set(pair_by_test(c)) | {n for n, _ in unpaired(c, "test")}
    return sorted(seen)


@dataclass(frozen=True, eq=False)
class MacMatrix:
    """A MAC matrix with its modes; `values` (n_test, n_analysis) in 0..1, NaN where unknown."""

    test: tuple[int, ...]
    analysis: tuple[int, ...]
    values: Floats


def mac_matrix(correlation: Result, key: str) -> MacMatrix | None:
    """Return the matrix at `key` (``mac`` or ``mac_rotated``); None when there is no sound one."""
    raw = part(correlation, key).get("values")
    rows = [numbers(r) for r in raw] if _is_sequence(raw) else []
    if not rows or not rows[0] or len({len(r) for r in rows}) != 1:
        return None
    values = np.array([[np.nan if v is None else v for v in r] for r in rows])
    values[(values < 0.0) | (values > 1.0 + 1e-6)] = np.nan  # no MAC
    modes = []
    for side, count in zip(("test", "analysis"), values.shape, strict=True):
        named = part(correlation, key).get(side)
        found = [mode_number(v, side) for v in named] if _is_sequence(named) else []
        complete = len(found) == count and None not in found
        modes.append(
            tuple(n for n in found if n is not None) if complete else tuple(range(1, count + 1))
        )
    if [len(m) for m in modes] != list(values.shape):
        return None
    return MacMatrix(modes[0], modes[1], values)


def mean_abs(values: Sequence[float | None]) -> float | None:
    """Return the mean magnitude of what is known; None when nothing is."""
    known = [abs(v) for v in values if v is not None]
    return sum(known) / len(known) if known else None


def largest(values: Sequence[float | None]) -> float | None:
    """Return the largest magnitude of what is known; None when nothing is."""
    return max((abs(v) for v in values if v is not None), default=None)


@dataclass(frozen=True)
class Summary:
    """How well a correlation stands, in the figures of interface.md's `gap`."""

    pairs: int | None
    test_modes: int | None
    mean_percent: float | None
    worst_percent: float | None
    mean_mac: float | None


def summary(correlation: Result) -> Summary:
    """Summarise a correlation, or a `gap` entry that holds the figures already."""
    if not has_correlation(correlation):
        pairs = number(correlation.get("pairs"))
        count = number(correlation.get("test_modes"))
        return Summary(
            None if pairs is None else int(pairs),
            None if not count else int(count),
            number(correlation.get("mean_abs_deviation_percent")),
            number(correlation.get("worst_deviation_percent")),
            number(correlation.get("mean_mac")),
        )
    pairs_ = records(correlation, "pairs")
    deviations = [number(p.get("deviation_percent")) for p in pairs_]
    return Summary(
        len(pairs_),
        len(test_modes(correlation)) or None,
        mean_abs(deviations),
        largest(deviations),
        mean_abs([number(p.get("mac")) for p in pairs_]),
    )


def _is_sequence(value: object) -> TypeGuard[Sequence[Any]]:
    return isinstance(value, (Sequence, np.ndarray)) and not isinstance(value, (str, bytes))
