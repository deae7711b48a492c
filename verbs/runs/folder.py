"""The run folder that a result is kept in."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Self

from ...core.errors import path_of
from ...core.results.plain import Tables

if TYPE_CHECKING:
    from ...adapters.store import StoreContent


class Folder(Tables):
    """Base of the results that a run folder holds."""

    def save(self, folder: Path | str, force: bool = False) -> Path:
        """Write the run folder, whole or not at all; return its path.

        Parameters
        ----------
        folder : path
        force : bool
            Replace a run folder that is there.

        Raises
        ------
        InputError
            The folder exists and `force` is not given, or cannot be written.
        """
        from ...adapters.run_folder.write_run import run_folder

        path = path_of(folder, "the run folder")
        with run_folder(path, force) as work:
            self.fill(work)
        return path

    def fill(self, work: Path) -> None:
        """Write everything that the run folder holds into an empty one; here the tables."""
        from ...adapters.run_folder.write_run import write_json

        write_json(work / "result.json", self.to_dict())
        self.write_tables(work / "tables")

    @classmethod
    def opened(cls, run: Path, result: Mapping[str, object], content: StoreContent) -> Self:
        """Return what `fill` wrote: from result.json, result.h5 and the rest of a run folder."""
        raise NotImplementedError
