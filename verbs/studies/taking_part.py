"""What takes part, as users write it: modes, sensors, pairs, weights and nodes by hand."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ...core.errors import InputError, Place

_SENSOR = re.compile(r"(\d+)(?::[+-]?(R?[XYZ]))?")


def _items(value: object) -> list[object]:
    """Return what a list, one value or text with commas holds."""
    given = value if isinstance(value, list | tuple) else [value]
    return [i for v in given for i in (v.split(",") if isinstance(v, str) else [v])]


def _numbers(item: object) -> list[int]:
    """Return the numbers of ``7`` or ``9:12``."""
    if isinstance(item, str):
        first, _, last = item.partition(":")
        numbers = list(range(int(first), int(last or first) + 1))
        if not numbers:
            raise ValueError
        return numbers
    return [_whole(item)]


def _whole(item: Any) -> int:
    if isinstance(item, bool) or int(item) != item:
        raise ValueError
    return int(item)


def _two(item: Any, between: str) -> tuple[Any, Any]:
    first, second = item.split(between) if isinstance(item, str) else item
    return first, second


def _pair(item: object) -> list[tuple[int, int]]:
    test, analysis = _two(item, ":")
    return [(int(test), int(analysis))]


def _weight(item: object) -> list[tuple[int, float]]:
    mode, weight = _two(item, "=")
    return [(int(mode), float(weight))]


def _node(item: object) -> list[tuple[int, int]]:
    node, grid = _two(item, "=")
    return [(int(node), int(grid))]


def _name(item: object) -> list[tuple[int, str]]:
    mode, name = item.split("=", 1) if isinstance(item, str) else _two(item, "=")
    if not str(name).strip():
        raise ValueError
    return [(int(mode), str(name).strip())]


def _sensor(item: object) -> list[str]:
    found = _SENSOR.fullmatch(str(item).strip().upper())
    if found is None:
        raise ValueError
    node, direction = found.groups()
    return [f"{node}:{direction}" if direction else node]


def _whole_items(value: object) -> list[object]:
    """Return what a list or one value holds: names may have commas."""
    return list(value) if isinstance(value, list | tuple) else [value]


def _reader(
    item: Callable[[object], list[Any]],
    example: str,
    items: Callable[[object], list[object]] = _items,
) -> Callable[[str, object, Place], tuple[Any, ...]]:
    def read(name: str, value: object, who: Place) -> tuple[Any, ...]:
        if isinstance(value, Mapping):
            value = [*value.items()]
        found: list[Any] = []
        for one in items(value):
            try:
                found += item(one)
            except (ValueError, TypeError):
                raise who.error(f"'{name}' holds {one!r}; write it as {example}") from None
        return tuple(dict.fromkeys(found))

    return read


READERS: dict[str, Callable[[str, object, Place], tuple[Any, ...]]] = {
    "exclude_test": _reader(_numbers, "7, or 9:12"),
    "exclude_analysis": _reader(_numbers, "7, or 9:12"),
    "exclude_sensors": _reader(_sensor, "1112 (a node), or 40:Z"),
    "pairs": _reader(_pair, "TEST:ANALYSIS, such as 3:5"),
    "mode_weights": _reader(_weight, "TEST=WEIGHT, such as 3=0.2"),
    "node_map": _reader(_node, "TEST=GRID, such as 1112=40"),
    "mode_names": _reader(_name, "TEST=NAME, such as 3=first bending", _whole_items),
}
"""By the key of a study: its value, as text, numbers or a list of them, to a tuple."""

_COMPARING = frozenset(
    {
        *READERS,
        "mac_min", "frequency_tolerance", "cluster_width", "rotate", "deck_length_unit",
        "test_modes", "shape_sigma", "residuals", "fmin", "bands", "max_order", "take", "refuse",
        "identify_modes", "exponential_window",
    }
)  # fmt: skip
_IDLE: dict[str, dict[str, str]] = {
    "correlate": {
        "parameters": "nothing moves; update, discover and parameters take it",
        "mode_weights": "nothing is fitted; update, discover and parameters take it",
    },
    "parameters": {"modes": "derivatives need the embedded solver's modes"},
}


def refuse_idle(
    verb: str, given: Iterable[str], with_test: bool = True, staged: bool = False
) -> None:
    """Refuse what was given beside a study and has no effect on a verb.

    `with_test` says whether there is a test, `staged` whether the study has stages.

    Raises
    ------
    InputError
        Which, and why.
    """
    for key in given:
        why = _IDLE.get(verb, {}).get(key)
        if not with_test and key in _COMPARING:
            why = "there is no test to compare with"
        if staged and key in ("residuals", "max_iterations"):
            why = "each stage of the study has its own"
        if why:
            raise InputError(f"{verb}: {key} has no effect: {why}")
