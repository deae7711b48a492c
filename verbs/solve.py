"""The verb `solve`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np

from ..core.data.geometry import Geometry
from ..core.data.modes import Modes
from ..core.data.parametric_model import Model
from ..core.eigen import normal_modes
from ..core.errors import InputError, Place, naming, path_of
from ..core.noun import BESIDE
from ..core.results.modes import ModeRow, SolveTables
from ..core.results.plain import Table
from .folder import Folder
from .made_of import made_of_files
from .options import Files, Say, checked_call, study_of, unheard
from .sources import Source, geometry_of, read_deck
from .study import Study, converted, read_study
from .study_text import write_study

if TYPE_CHECKING:
    from ..adapters.nastran.deck.read_deck import EigenRequest
    from ..adapters.store import StoreContent

_FEW = 10
"""Modes where neither the user nor the deck says how many."""


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
        from ..adapters.store import StoreContent

        return StoreContent(geometry=self.geometry, modes={"analysis": self.shapes})

    def write(self, path: Path | str) -> Path:
        """Write the modes by the suffix: a store (.h5) or a universal file (.unv, .uff).

        Raises
        ------
        InputError
            Another suffix, or a file that cannot be written.
        """
        from ..adapters.store import write_store
        from ..adapters.universal import write_universal

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
        from ..adapters.report.solution_page import solution_page
        from .imprint import imprint_of

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


@checked_call
def solve(
    deck: Source | None = None,
    number: int | None = None,
    fmax: float | None = None,
    *,
    study: Study | Files | None = None,
    progress: Say = unheard,
) -> Solved:
    """Find the normal modes of a deck with the embedded solver.

    Parameters
    ----------
    deck : path, Deck, ChangedDeck or Model
        Default: the deck of `study`.
    number : int, optional
        Modes to find, rigid-body ones included; default: what the deck asks for
        (ND, or all up to V2), or ten.
    fmax : float, optional
        All modes up to here, Hz; default: that of `study`.
    study : Study or path, optional
        Of it the deck, ``fmax``, ``deck_length_unit``, and what stands on the report.
    progress : callable
        Told what is done, a few words at a time.

    Returns
    -------
    Solved

    Raises
    ------
    InputError
        A deck that cannot be read or assembled, a number or frequency that is none.
    CheckError
        The eigensolution does not meet its own check.
    """
    from ..adapters.nastran import build_model, weight
    from ..adapters.nastran.assembly.candidate_parameters import grids_by_property
    from ..adapters.nastran.properties.mass_unit import mass_unit
    from .imprint import imprint_of

    who = Place(shown="solve")
    asked = study_of("solve", study, {}, {})
    deck = asked.deck if deck is None else deck
    if deck is None:
        raise InputError("give a deck, or a study that names one")
    imprint_of(asked)
    fmax = asked.fmax if fmax is None else converted("fmax", fmax, float, who)
    number = converted("number", number, int | None, who)
    if number is not None and number < 1:
        raise InputError(f"number is {number!r}; ask for at least one mode")
    if fmax is not None and fmax <= 0.0:
        raise InputError(f"fmax is {fmax!r}; give a frequency above 0 Hz")
    read = None if isinstance(deck, Model) else read_deck(deck)
    request = read.eigen if read and not (number or fmax) else None
    with naming(read.path if read else None):
        model = build_model(read) if read else deck
        assert isinstance(model, Model)
        progress("solving")
        wanted = (number, fmax) if number or fmax else _wanted(request)
        solution = normal_modes.solve(model, *wanted)
    modes = normal_modes.modes_of(model, solution)
    mass, unit = weight(read) if read else None, asked.deck_length_unit
    unit = unit or (read.length_unit if read else None)
    each = mass_unit(read, unit).kilograms if read else None
    own = [*read.files] if read and read.on_disk else []
    return Solved(
        **made_of_files(own),
        deck_file=read.told if read else "",
        modes=Table(
            map(ModeRow, modes.frequencies_hz.tolist(), modes.generalized_mass.tolist()), ModeRow
        ),
        rigid_body_modes=solution.rigid_body_modes,
        mass=mass.mass if mass else None,
        kilograms=mass.mass * each if mass and each else None,
        length_unit=unit,
        centre_of_gravity=mass.centre_of_gravity if mass else None,
        checks=solution.checks,
        degrees_of_freedom=model.n_free,
        backend=solution.backend,
        seconds=solution.seconds,
        warnings=(
            *(read.warnings if read else ()),
            *model.warnings,
            *solution.warnings,
            *_of_range(request, wanted[1], modes),
        ),
        geometry=geometry_of(model, read),
        shapes=modes,
        parts=grids_by_property(read) if read else {},
        study=replace(
            asked, deck=read.path if read and read.on_disk else None, fmax=fmax, fmin=None, bands=()
        ),
    )


def _wanted(request: EigenRequest | None) -> tuple[int | None, float | None]:
    """How many modes a deck asks for, or else up to where [Hz]; or else a few."""
    if request and not request.nd and (request.v2 or 0.0) > 0.0:
        return None, request.v2
    return (request and request.nd) or _FEW, None


def _of_range(request: EigenRequest | None, limit: float | None, modes: Modes) -> tuple[str, ...]:
    """Say what the frequencies that were asked for leave unsaid."""
    if limit and not len(modes):
        return (f"no mode lies below {limit:g} Hz",)
    first = (request and request.v1) or 0.0
    below = int(np.count_nonzero(modes.frequencies_hz < first))
    if not below:
        return ()
    return (f"EIGRL or EIGR asks for modes from {first:g} Hz: the {below} below are counted, too",)
