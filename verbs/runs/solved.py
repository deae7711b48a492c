"""What `solve` gives back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Self

from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.errors import InputError, Place, path_of
from ...core.noun import BESIDE
from ...core.results.modes import SolveTables
from ..studies.imprint import imprint_of
from ..studies.study import Study, read_study
from ..studies.study_text import write_study
from .folder import Folder

if TYPE_CHECKING:
    from ...adapters.store import StoreContent


@dataclass(frozen=True, eq=False, kw_only=True)
class Solved(SolveTables, Folder):
    """What `solve` found: the tables as fields, and the nouns behind them.

    Parameters
    ----------
    geometry : Geometry
    shapes : Modes
        On all degrees of freedom, mass-normalised.
    parts : mapping of str to sequence of int
        Grids of the elements of each property of a deck, for the pictures of its page.
    study : Study
        What was asked.
    """

    geometry: Geometry = field(metadata=BESIDE)
    shapes: Modes = field(metadata=BESIDE)
    parts: Mapping[str, Sequence[int]] = field(default_factory=dict, metadata=BESIDE)
    study: Study = field(default_factory=Study, metadata=BESIDE)

    @property
    def content(self) -> StoreContent:
        """What a store holds of it."""
        from ...adapters.store import StoreContent

        return StoreContent(geometry=self.geometry, modes={"analysis": self.shapes})

    def write(self, path: Path | str) -> Path:
        """Write the modes by the suffix: a store (.h5) or a universal file (.unv, .uff).

        Raises
        ------
        InputError
            Another suffix, or a file that cannot be written.
        """
        from ...adapters.store import write_store
        from ...adapters.universal import write_universal

        path = path_of(path, "the file")
        if path.suffix == ".h5":
            write_store(path, **vars(self.content))
        elif path.suffix in (".unv", ".uff"):
            write_universal(path, geometry=self.geometry, modes=self.shapes)
        else:
            raise InputError(f"{path}: modes are written as .h5 or .unv", file=path)
        return path

    def fill(self, work: Path) -> None:
        """Write everything that the run folder of a solution holds."""
        from ...adapters.report.solution_page import solution_page

        imprint = imprint_of(self.study)
        page = solution_page(self, self.geometry, self.shapes, self.parts, imprint)
        (work / "report.html").write_text(page, encoding="utf-8")
        self.write(work / "result.h5")
        if self.study.deck is not None:
            write_study(work, self.study)
        super().fill(work)

    @classmethod
    def opened(cls, run: Path, result: Mapping[str, object], content: StoreContent) -> Self:
        """Return what `fill` wrote."""
        if content.geometry is None or "analysis" not in content.modes:
            raise Place(run / "result.h5").fault("holds no modes of an analysis")
        asked = run / "study.toml"
        study = read_study(asked) if asked.is_file() else Study()
        shapes = content.modes["analysis"]
        return cls.from_dict(result, geometry=content.geometry, shapes=shapes, study=study)
