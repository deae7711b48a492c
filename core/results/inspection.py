"""The tables of what files hold."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..noun import OPTIONAL
from .plain import Json, Table, Tables


@dataclass(frozen=True)
class SkippedRow:
    """Something in a file that is not read, and why."""

    what: str
    line: int | None
    why: str


@dataclass(frozen=True)
class FileRow:
    """What a file holds; `contents` is what its format has: counts, names, modes, matrices."""

    path: str
    format: str
    contents: Json
    skipped: Table[SkippedRow] = field(default_factory=Table)
    warnings: tuple[str, ...] | None = field(default=None, metadata=OPTIONAL)
    datasets: Json = field(default=None, metadata=OPTIONAL)


@dataclass(frozen=True, eq=False, kw_only=True)
class InspectTables(Tables):
    """What ``inspect`` answers."""

    verb = "inspect"
    files: Table[FileRow]


@dataclass(frozen=True, eq=False, kw_only=True)
class ConvertTables(Tables):
    """What ``convert`` answers: what was `written`, by part, and what was `lost`, in words."""

    verb = "convert"
    sources: tuple[str, ...]
    destination: str
    format: str
    written: dict[str, str]
    lost: tuple[str, ...]
    warnings: tuple[str, ...]
