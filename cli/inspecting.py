"""What ``inspect`` found, cut down to one screen; the JSON keeps all of it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_MOST, _SHOWN = 14, 8


def condensed(entry: Mapping[str, Any]) -> dict[str, Any]:
    """Shorten long lists, and list what was skipped for one reason on one line."""
    short: dict[str, Any] = {
        "contents": _short(entry.get("contents")),
        "skipped": _grouped(entry.get("skipped") or ()),
        "warnings": list(entry.get("warnings") or ())[:_MOST],
    }
    left = len(entry.get("warnings") or ()) - _MOST
    if left > 0:
        short["warnings"].append(f"and {left} more warnings")
    return short


def _short(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {k: _short(v) for k, v in value.items() if v is not None}
    if not isinstance(value, list | tuple):
        return value
    if len(value) <= _MOST:
        return [_short(v) for v in value]
    numbers = all(isinstance(v, int | float) for v in value)
    if numbers:
        return [*value[:_SHOWN], f"... {len(value) - _SHOWN - 1} more ...", value[-1]]
    if all(isinstance(v, str) for v in value):
        return [*value[:_MOST], f"and {len(value) - _MOST} more"]
    return [*(_short(v) for v in value[:_MOST]), {"what": f"and {len(value) - _MOST} more"}]


def _grouped(skipped: Any) -> list[dict[str, Any]]:
    reasons: dict[str, list[Mapping[str, Any]]] = {}
    for item in skipped:
        reasons.setdefault(str(item.get("why", "")), []).append(item)
    result = []
    for why, items in reasons.items():
        told = [_place(i) for i in items]
        more = f" and {len(told) - _MOST} more" if len(told) > _MOST else ""
        what = ", ".join(told[:_MOST]) + more
        result.append({"what": what, "line": None, "why": why})
    return result


def _place(item: Mapping[str, Any]) -> str:
    line = item.get("line")
    return f"{item.get('what', '')}" + (f" (line {line})" if line is not None else "")
