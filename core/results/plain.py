"""Typed tables to plain values (what JSON holds) and back."""

from __future__ import annotations

import dataclasses
import math
import reprlib
import types
import typing
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any, ClassVar, Self, SupportsIndex, TypeAlias, TypeVar, Union, overload

import numpy as np

from ..errors import InputError, path_of
from ..noun import ROLE, Noun
from . import export

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"
Row = TypeVar("Row")
T = TypeVar("T")


class Table(tuple[Row, ...]):
    """Rows of one kind in reading order.

    Parameters
    ----------
    rows : iterable of dataclass
        One field of a row is one column.
    row : type, optional
        Class of the rows, for the columns of an empty table; default: that of the first.
    """

    def __new__(cls, rows: Iterable[Row] = (), row: type | None = None) -> Self:  # noqa: D102
        self = super().__new__(cls, rows)
        self._row = row or (type(self[0]) if self else None)
        return self

    _row: type | None

    @overload
    def __getitem__(self, at: SupportsIndex) -> Row: ...
    @overload
    def __getitem__(self, at: slice) -> Table[Row]: ...
    def __getitem__(self, at: SupportsIndex | slice) -> Row | Table[Row]:
        if isinstance(at, slice):
            return Table(tuple.__getitem__(self, at), self._row)
        return tuple.__getitem__(self, at)

    @property
    def columns(self) -> tuple[export.Column, ...]:
        """Names and units."""
        return tuple(
            export.Column.of(name, f.metadata.get("unit", "")) for f, name, _ in _keys(self._row)
        )

    def to_dict(self) -> list[dict[str, Json]]:
        """Return the rows as plain dictionaries."""
        return [_record(row) for row in self]

    def to_csv(self, path: Path | str) -> None:
        """Write a CSV file: UTF-8, a header line with the units (`InputError` if it cannot be)."""
        export.write_csv(path, self.columns, self.to_dict())

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame; `InputError` where pandas is not installed."""
        return export.frame(self.columns, self.to_dict())

    def __repr__(self) -> str:
        names = ", ".join(c.name for c in self.columns)
        return f"Table({len(self)} row{'s' * (len(self) != 1)}: {names})"

    def _repr_html_(self) -> str:
        return export.html(self.columns, self.to_dict())


@typing.runtime_checkable
class Tabular(typing.Protocol):
    """What can be a CSV file: a `Table`, a matrix."""

    def __len__(self) -> int: ...
    def to_csv(self, path: Path | str) -> None:
        """Write the file."""

    def _repr_html_(self) -> str: ...


class Matrix(Noun):
    """Base of numbers under two headings, one down and one across."""

    @property
    def _wide(self) -> tuple[list[export.Column], list[dict[str, object]]]:
        """Columns, and a record of each row."""
        raise NotImplementedError

    def to_csv(self, path: Path | str) -> None:
        """Write a CSV file, a row a line."""
        export.write_csv(path, *self._wide)

    def to_pandas(self) -> Any:
        """Return a pandas DataFrame likewise; `InputError` where pandas is not installed."""
        return export.frame(*self._wide)

    def _repr_html_(self) -> str:
        return export.html(*self._wide)


class Tables(Noun):
    """Base of what a verb answers; `schema` names it in result.json."""

    verb: ClassVar[str] = ""
    schema: ClassVar[str] = ""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.schema = f"trueup/{cls.verb}/1" if cls.verb else ""

    def to_dict(self) -> dict[str, Json]:
        """Return the content of result.json."""
        return {"schema": self.schema, **_record(self)} if self.schema else _record(self)

    @classmethod
    def from_dict(cls, values: Mapping[str, object], **beside: object) -> Self:
        """Return what `to_dict` gave; `beside` are the fields that are no part of it.

        Raises
        ------
        InputError
            A key that is missing, or a value of another type.
        """
        return _dataclass(cls, values, "", beside)

    def _repr_html_(self) -> str | None:
        return next((t._repr_html_() for t in self.tables().values() if len(t)), None)

    def tables(self) -> dict[str, Tabular]:
        """Return all tables by name: ``pairs``, ``parameters``, ``before_pairs``, ..."""
        return dict(_tables(self, ""))

    def write_tables(self, folder: Path | str) -> None:
        """Write the tables that are not empty as CSV, a file each, into a new folder.

        Raises
        ------
        InputError
            The folder cannot be made, a file cannot be written.
        """
        try:
            path_of(folder, "the folder").mkdir()
        except OSError as error:
            raise InputError(f"cannot make {folder}: {error.strerror}", file=folder) from error
        for name, table in self.tables().items():
            if len(table):
                table.to_csv(Path(folder) / f"{name}.csv")


def _tables(value: object, above: str) -> Iterator[tuple[str, Tabular]]:
    for f, name, _ in _keys(type(value)):
        inner = getattr(value, f.name)
        if isinstance(inner, Tabular):
            yield above + name, inner
        elif dataclasses.is_dataclass(inner):
            yield from _tables(inner, f"{above}{name}_")


def finite(value: float) -> float | None:
    """Return a number, None for what is none."""
    return float(value) if math.isfinite(value) else None


def plain(value: object) -> Json:
    """Return a value as JSON holds it: arrays as lists, what is no finite number as None."""
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, bool | int | str):
        return value
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    return _record(value) if dataclasses.is_dataclass(value) else str(value)


def _record(value: object) -> dict[str, Json]:
    return {
        name: plain(getattr(value, f.name))
        for f, name, optional in _keys(type(value))
        if not (optional and getattr(value, f.name) is None)
    }


def _keys(kind: type | None) -> list[tuple[dataclasses.Field[Any], str, bool]]:
    fields = dataclasses.fields(kind) if kind is not None else ()
    roles = [(f, f.metadata.get(ROLE, "")) for f in fields]
    return [
        (f, role.removeprefix("key ") if role.startswith("key ") else f.name, role == "optional")
        for f, role in roles
        if role is not None
    ]


def typed(kind: type[T], value: object, where: str = "") -> T:
    """Return a plain value as the type that `plain` made it from.

    Raises
    ------
    InputError
        It is none; `where` names its place.
    """
    result: T = _typed(kind, value, where)
    return result


def _typed(kind: Any, value: object, where: str) -> Any:
    origin, inner = _parts(kind)
    if origin in (Union, types.UnionType):
        if value is None and type(None) in inner:
            return None
        inner = tuple(k for k in inner if k is not type(None))
        return _typed(inner[0], value, where) if len(inner) == 1 else value
    if dataclasses.is_dataclass(kind) and isinstance(value, Mapping):
        return _dataclass(typing.cast(type, kind), value, where, {})
    if isinstance(value, list | tuple) and origin is np.ndarray:
        with suppress(ValueError, TypeError):
            return np.array(value, typing.get_args(inner[1])[0])
    elif isinstance(value, list | tuple) and isinstance(origin, type) and issubclass(origin, tuple):
        many = origin is Table or inner[-1] is Ellipsis
        kinds = [inner[0]] * len(value) if many else inner
        if len(kinds) == len(value):
            named = enumerate(zip(kinds, value, strict=True))
            members = [_typed(k, v, f"{where}[{n}]") for n, (k, v) in named]
            return Table(members, inner[0]) if origin is Table else origin(members)
    elif origin is dict and isinstance(value, Mapping):
        return {k: _typed(inner[1], v, f"{where}.{k}") for k, v in value.items()}
    elif kind is float and (value is None or isinstance(value, float) or type(value) is int):
        return math.nan if value is None else value
    elif kind is Any or (isinstance(kind, type) and isinstance(value, kind)):
        return value
    shown = reprlib.repr(value)
    raise InputError(f"'{where}' is {shown}, which is no {getattr(kind, '__name__', kind)}")


def _parts(kind: Any) -> tuple[Any, tuple[Any, ...]]:
    origin, inner = typing.get_origin(kind), typing.get_args(kind)
    alias = getattr(origin, "__value__", None)  # numpy 2.5 makes NDArray a `type` statement
    return (origin, inner) if alias is None else _parts(alias[inner])


def _dataclass(kind: type[T], values: Mapping[str, object], where: str, beside: Any) -> T:
    hints, found = typing.get_type_hints(kind), dict(beside)
    for f, name, optional in _keys(kind):
        place = f"{where}.{name}".lstrip(".")
        if name in values:
            found[f.name] = _typed(hints[f.name], values[name], place)
        elif not optional and f.default is f.default_factory is dataclasses.MISSING:
            raise InputError(f"'{place}' is missing")
    return kind(**found)
