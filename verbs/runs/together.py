"""What `update` of several configurations gives back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Self

from ...core.errors import naming
from ...core.noun import BESIDE
from ...core.results.together import TogetherTables
from ..studies.imprint import imprint_of
from ..studies.study import Study, read_study
from ..studies.study_text import write_study
from .folder import Folder
from .run import Updated, put_in_place


@dataclass(frozen=True, eq=False, kw_only=True)
class UpdatedTogether(TogetherTables, Folder):
    """What `update` did to several configurations: the tables of result.json as fields.

    `results` are those of each configuration by its name, as if it stood alone: its deck, its
    tables, its run folder below this one. `study` is what was asked.
    """

    results: Mapping[str, Updated] = field(metadata=BESIDE)
    study: Study = field(metadata=BESIDE)

    def _line(self) -> str:
        from ...adapters.report.together_page import headline

        return f"{type(self).__name__}: {headline(self)}"

    def fill(self, work: Path) -> None:
        """Write everything that the run folder holds, those of the configurations included."""
        from ...adapters.report.together_page import together_page

        super().fill(work)
        for name, result in self.results.items():
            (work / name).mkdir()
            result.fill(work / name)
        write_study(work, self.study)
        page = together_page(self, imprint_of(self.study))
        (work / "report.html").write_text(page, encoding="utf-8")

    def put_in_place(self) -> Self:
        """Write the files of all decks that changed over the originals, with backups.

        Raises
        ------
        InputError
            As of one deck; a file that decks share would be another in each; then none is written.
        """
        put = put_in_place([*self.results.values()])
        return replace(self, results=dict(zip(self.results, put, strict=True)))

    @classmethod
    def of_folder(cls, run: Path, result: Mapping[str, object]) -> Self:
        """Return what `fill` wrote."""
        from .open_run import open_run

        with naming(run / "result.json"):
            tables = TogetherTables.from_dict(result)
        results = {c.name: open_run(run / c.folder) for c in tables.configurations}
        own = {name: r for name, r in results.items() if isinstance(r, Updated)}
        return cls(**vars(tables), results=own, study=read_study(run / "study.toml"))
