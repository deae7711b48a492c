"""How the nouns show themselves: one line, never their arrays; what stands in tables."""

import dataclasses
from collections.abc import Mapping, Sized
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

_LONGEST = 160
"""Characters of a noun's line."""
_SHORT = 40
"""Characters of one value in it."""
_FEW = 3
"""Members of a tuple that are shown themselves."""

ROLE = "table"
OPTIONAL = MappingProxyType({ROLE: "optional"})
"""Metadata of a field whose key in result.json is absent where the value is None."""
BESIDE = MappingProxyType({ROLE: None})
"""Metadata of a field that is no part of the table."""


def key(name: str) -> Mapping[str, str]:
    """Return the metadata of a field whose key differs from its name."""
    return {ROLE: f"key {name}"}


class Noun:
    """Base of the nouns: a dataclass whose `repr` is one short line made of its fields."""

    __slots__ = ()

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if "__repr__" not in cls.__dict__:  # a dataclass would make its own, arrays and all
            cls.__repr__ = Noun.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        return self._line()

    def _line(self) -> str:
        """Tell the noun; a noun that has a better line of its own replaces this."""
        fields: dict[str, Any] = getattr(self, "__dataclass_fields__", {})
        told = [(name, brief(getattr(self, name))) for name, f in fields.items() if f.repr]
        text = ", ".join(f"{name}={value}" for name, value in told if value)
        return f"{type(self).__name__}({_cut(text, _LONGEST)})"


def brief(value: object) -> str:
    """Return a value in a few words: ``<8 from 33.49 to 61.2>``, ``<240 × 8>``; "" for nothing."""
    if hasattr(value, "nnz"):  # scipy.sparse is slow to import
        return f"<{_shape(value)} sparse>"
    if isinstance(value, np.ndarray):
        if value.ndim == 1 and value.dtype.kind in "iuf" and np.isfinite(value).any():
            return f"<{value.size} from {np.nanmin(value):.4g} to {np.nanmax(value):.4g}>"
        return f"<{_shape(value)}>" if value.size else ""
    if value is None or (isinstance(value, Sized) and not len(value)):
        return ""
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Noun) or dataclasses.is_dataclass(value):
        name = type(value).__name__
        return f"<{name} of {len(value)}>" if isinstance(value, Sized) else f"<{name}>"
    if isinstance(value, tuple | list) and len(value) <= _FEW:
        return f"({', '.join(map(brief, value))})"
    if isinstance(value, Mapping | tuple | list | set | frozenset):
        of = f": {', '.join(map(str, list(value)[:_FEW]))}, …" if isinstance(value, Mapping) else ""
        return f"<{len(value)}{of}>"
    text = value.name if isinstance(value, Path) else repr(value)
    return _cut(text, _SHORT)


def _cut(text: str, most: int) -> str:
    return text if len(text) <= most else f"{text[: most - 1]}…"


def _shape(value: Any) -> str:
    return " × ".join(map(str, value.shape))
