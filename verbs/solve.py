"""The verb `solve`."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..core.data.modes import Modes
from ..core.data.parametric_model import Model
from ..core.eigen import normal_modes
from ..core.errors import InputError, Place, naming
from ..core.results.modes import ModeRow
from ..core.results.plain import Table
from .files.made_of import made_of_files
from .files.sources import Source, geometry_of, read_deck
from .runs.solved import Solved
from .studies.imprint import imprint_of
from .studies.options import Files, Say, checked_call, study_of, unheard
from .studies.study import Study
from .studies.values import converted

if TYPE_CHECKING:
    from ..adapters.nastran.deck.read_deck import EigenRequest

_FEW = 10
"""Modes where neither the user nor the deck says how many."""


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
