"""What `identify` gives back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

from ...adapters.store import StoreContent
from ...adapters.universal.universal_content import Skipped, Units
from ...core.errors import Place, path_of
from ...core.noun import BESIDE
from ...core.results.modes import IdentifyTables
from ..studies.study import Study, read_study
from ..studies.study_text import write_study
from .folder import Folder


@dataclass(frozen=True, eq=False, kw_only=True)
class Identified(IdentifyTables, Folder):
    """What `identify` found: the tables of result.json as fields, and the nouns behind them.

    Parameters
    ----------
    content : StoreContent
        Geometry, modes ``test`` (normalised real shapes) and ``test_complex``, and ``shape_std``.
    units : Units or None
        Of the responses.
    page : str
        The stabilisation chart as one self-contained HTML page.
    study : Study or None
        What was asked of files; None of objects.
    skipped : tuple of Skipped
        What of the files was not read, and why.
    """

    content: StoreContent = field(metadata=BESIDE)
    units: Units | None = field(metadata=BESIDE)
    page: str = field(metadata=BESIDE)
    study: Study | None = field(default=None, metadata=BESIDE)
    skipped: tuple[Skipped, ...] = field(default=(), metadata=BESIDE)

    def write(self, path: Path | str, complex_shapes: bool = False) -> Path:
        """Write the modes by the suffix: a store (.h5), which holds both kinds, or .unv, .uff.

        Raises
        ------
        InputError
            No mode was found, or the file cannot be written.
        """
        from ...adapters.store import write_store
        from ...adapters.universal import write_universal

        path = path_of(path, "the file")
        if not self.modes:
            raise Place(path).fault("is not written: no mode stands out of the noise")
        if path.suffix.lower() == ".h5":
            write_store(path, **vars(self.content))
            return path
        write_universal(
            path,
            geometry=self.content.geometry,
            modes=self.content.modes["test_complex" if complex_shapes else "test"],
            units=self.units,
            description="complex shapes" if complex_shapes else "normalised real shapes",
        )
        return path

    def fill(self, work: Path) -> None:
        """Write everything that the run folder of an identification holds."""
        from ...adapters.store import write_store

        super().fill(work)
        if self.modes:
            self.write(work / "modes.unv")
            self.write(work / "modes_complex.unv", complex_shapes=True)
        write_store(work / "result.h5", **vars(self.content))
        (work / "stabilisation.html").write_text(self.page, encoding="utf-8")
        if self.study is not None:
            write_study(work, self.study)

    @classmethod
    def opened(cls, run: Path, result: Mapping[str, object], content: StoreContent) -> Self:
        """Return what `fill` wrote."""
        from ...adapters.universal import read_universal

        modes, page = run / "modes.unv", run / "stabilisation.html"
        units = read_universal([modes]).units if modes.is_file() else None
        shown = page.read_text(encoding="utf-8") if page.is_file() else ""
        asked = run / "study.toml"
        study = read_study(asked) if asked.is_file() else None
        return cls.from_dict(result, content=content, units=units, page=shown, study=study)
