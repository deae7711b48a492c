"""What the verbs that compare give back, and the run folder that holds it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Self, TypeVar

import numpy as np

from ...adapters.nastran.editing.changed_deck import ChangedDeck
from ...adapters.store import StoreContent
from ...core.correlation.comparison import Comparison
from ...core.data.modes import Modes
from ...core.discovery.likelihood.model_responses import model_responses
from ...core.noun import BESIDE
from ...core.results.correlation import Compared, CorrelateTables, RunTables
from ...core.results.discovery import DiscoverTables
from ...core.results.plain import Table
from ...core.results.update import ChangingTables, InPlace, UpdateTables
from ...core.updating.stages import Iteration
from ..studies.study import Study, read_study
from ..studies.study_text import write_study
from .folder import Folder

if TYPE_CHECKING:
    from .plots import Plots


EXPANDED = "test expanded"
"""The name of test shapes on all grids in result.h5."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Run(RunTables, Folder):
    """Base of the results of the verbs that compare.

    Parameters
    ----------
    content : StoreContent
        What result.h5 holds: geometry and modes of both sides, sensor map, rotation.
    study : Study
        What was asked.
    deck : ChangedDeck or None
        The deck that the verb changed.
    """

    content: StoreContent = field(metadata=BESIDE)
    study: Study = field(metadata=BESIDE)
    deck: ChangedDeck | None = field(default=None, metadata=BESIDE)

    @property
    def plot(self) -> Plots:
        """Its pictures: ``plot.mac()``, ``.shapes()``, ``.frequencies()``, ``.misfit()``."""
        from .plots import Plots

        return Plots(self)

    def _line(self) -> str:
        from ...adapters.report.tables.headline import story

        return f"{type(self).__name__}: {story(self)[0]}"

    def _repr_html_(self) -> str:
        from ...adapters.report.page import summary

        return summary(self)

    def fill(self, work: Path) -> None:
        """Write everything that a run folder holds into an empty folder."""
        from ...adapters.store import write_store
        from ..studies.imprint import imprint_of
        from .report import render

        super().fill(work)
        diff = None
        if self.deck is not None:
            self.deck.write(work / "deck")
            diff = self.deck.diff
            (work / "changes.diff").write_text(diff, encoding="utf-8", newline="")
        write_store(work / "result.h5", **vars(self.content))
        write_study(work, self.study)
        page = render(self, self.content, diff, imprint_of(self.study))
        (work / "report.html").write_text(page, encoding="utf-8")

    @classmethod
    def opened(cls, run: Path, result: Mapping[str, object], content: StoreContent) -> Self:
        """Return what `fill` wrote."""
        return cls.from_dict(result, content=content, study=read_study(run / "study.toml"))


@dataclass(frozen=True, eq=False, kw_only=True)
class Correlated(CorrelateTables, Run):
    """What `correlate` found: the tables of result.json as fields, and the nouns behind them."""

    def fill(self, work: Path) -> None:
        """Write the run folder; expanded test shapes as a universal file as well."""
        from ...adapters.universal import write_universal

        super().fill(work)
        expanded = self.content.modes.get(EXPANDED)
        if expanded is not None:
            path = work / "test_expanded.unv"
            write_universal(path, geometry=self.content.geometry, modes=expanded)


@dataclass(frozen=True, eq=False, kw_only=True)
class Changing(ChangingTables, Run):
    """Base of the results of verbs that change a deck."""

    deck: ChangedDeck = field(metadata=BESIDE)

    @classmethod
    def opened(cls, run: Path, result: Mapping[str, object], content: StoreContent) -> Self:
        """Return what `fill` wrote."""
        from ...adapters.nastran import read_deck_text

        text = read_deck_text(run / str(result.get("deck")))
        diff = (run / "changes.diff").read_bytes().decode("utf-8")
        study = read_study(run / "study.toml")
        return cls.from_dict(result, content=content, study=study, deck=ChangedDeck(text, diff))

    def put_in_place(self) -> Self:
        """Write the files that changed over the originals, with backups; say so in the result.

        Raises
        ------
        InputError
            A file changed on disk meanwhile, or cannot be written; then none is.
        """
        return put_in_place([self])[0]


_C = TypeVar("_C", bound=Changing)


def put_in_place(found: Sequence[_C]) -> list[_C]:
    """Write the files of several changed decks over the originals, all or none; say so in each.

    Raises
    ------
    InputError
        As `Changing.put_in_place`; a file of several decks would be another in each.
    """
    from ...adapters.nastran.editing.changed_deck import put_in_place as put

    written = put([one.deck for one in found])
    return [
        replace(one, in_place=InPlace(*(tuple(map(str, paths)) for paths in both)))
        for one, both in zip(found, written, strict=True)
    ]


@dataclass(frozen=True, eq=False, kw_only=True)
class Updated(UpdateTables, Changing):
    """What `update` did: the tables of result.json as fields, and the nouns behind them."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Discovered(DiscoverTables, Changing):
    """What `discover` told: the tables of result.json as fields, and the nouns behind them."""


def content_of(
    before: Comparison,
    final: Compared,
    after: Comparison | None = None,
    history: Sequence[Iteration] = (),
    expanded: Modes | None = None,
) -> StoreContent:
    """Return the neutral model of a run.

    Parameters
    ----------
    before : Comparison
        Of the deck as it came.
    final : Compared
        Tables of `after`, or of `before` where nothing was changed.
    after : Comparison, optional
        Of the changed deck.
    history : sequence of Iteration
        Of an update.
    expanded : Modes, optional
        Test shapes on the dofs of the analysis.
    """
    last = after or before
    modes = {"test": _as_seen(before.test, last.test), "analysis": before.analysis}
    if expanded is not None:
        modes[EXPANDED] = expanded
    heard = model_responses(last)
    frfs = {} if heard is None else {"measured": heard.measured, "model": heard.model}
    return StoreContent(
        frfs=frfs,
        geometry=before.geometry,
        test_geometry=before.placed.test_geometry,
        modes=modes if after is None else {**modes, "updated": after.analysis},
        pairs=final.pairs.to_dict(),
        mac={"measured": vars(final.mac), "rotated": vars(final.mac_rotated)},
        matrices={
            "observation": last.observation.matrix,
            "transformation": last.correlation.transformation,
            **({} if heard is None else {"frac": heard.frac}),
        },
        history=Table(history).to_dict(),
    )


def _as_seen(measured: Modes, last: Modes) -> Modes:
    """Return a test as it was measured, at the sensors that the last comparison still sees."""
    key, kept = (10 * m.dofs.node + m.dofs.component for m in (measured, last))
    rows = np.flatnonzero(np.isin(key, kept))
    if len(rows) == len(key):
        return measured
    return replace(measured, shapes=measured.shapes[rows], dofs=measured.dofs.take(rows))
