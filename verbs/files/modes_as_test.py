"""Modes of any file as a test: of another program, of a Nastran run, of a store."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...adapters.universal import ModalTest
from ...core.data.geometry import Geometry
from ...core.data.modes import Modes
from ...core.errors import InputError, Place
from .exchange import load
from .read import DECK, OP4, RESULTS, STORE, kind_of_file

_GRIDS = 1000
"""Grids of a model that stand for a test, at most: many more than sensors ever are."""


def holds_modes(files: Sequence[Path]) -> bool:
    """Whether some of the files are results of a Nastran run, stores, or OP4 with modes."""
    from ...adapters.nastran import dof_list

    try:
        kinds = {f: kind_of_file(f) for f in files}
        return any(k in (RESULTS, STORE) or (k is OP4 and dof_list(f)) for f, k in kinds.items())
    except InputError:
        return False


def modes_as_test(files: Sequence[Path]) -> ModalTest:
    """Return modes as a test, of a large model on some of its grids; see `modes_on_grids`."""
    test = modes_on_grids(files)
    assert test.modes is not None
    modes, said = _thinned(test.modes)
    return replace(test, modes=modes, warnings=said)


def modes_on_grids(files: Sequence[Path]) -> ModalTest:
    """Return modes on all their grids; a deck among the files gives their positions.

    Of several sets of modes in a store those of a test come first.

    Raises
    ------
    InputError
        No modes, or no positions of their grids.
    """
    cargo = load(files, None, None)
    here = Place(files[0])
    modes = cargo.modes.get("test") or next(iter(cargo.modes.values()), None)
    geometry = cargo.geometry
    if modes is cargo.modes.get("test") and "test_geometry" in cargo.extras:
        geometry = cargo.extras["test_geometry"]
    if modes is None:
        raise here.fault("holds no modes")
    if geometry is None:
        decks = " with" if any(kind_of_file(f) is DECK for f in files) else "; give the deck, too:"
        raise here.fault(f"holds modes and no positions of their grids{decks} a deck that has them")
    modes = _told(modes, geometry)
    return ModalTest(geometry, modes, length_unit=geometry.length_unit, files=tuple(files))


def _told(modes: Modes, geometry: Geometry) -> Modes:
    """Leave out what files list and no sensor would read.

    Scalar points, grids of no element that rest in every mode, and rotations of grids without
    any, which are zero in every mode.
    """
    of = modes.dofs
    held = np.zeros(len(geometry.ids), bool)
    for corners in geometry.elements.values():
        held[corners.ravel()] = True
    moves = (modes.shapes != 0).any(axis=1)
    turns = of.component > 3
    on_it = np.isin(of.node, geometry.ids[held]) | np.isin(of.node, np.unique(of.node[moves]))
    turning = ~turns | np.isin(of.node, np.unique(of.node[moves & turns]))
    rows = np.flatnonzero(np.isin(of.node, geometry.ids) & on_it & turning)
    return replace(modes, shapes=modes.shapes[rows], dofs=of.take(rows))


def _thinned(modes: Modes) -> tuple[Modes, tuple[str, ...]]:
    """Return translations at so many grids, taken evenly; say so where there are more."""
    nodes = np.unique(modes.dofs.node)
    if len(nodes) <= _GRIDS:
        return modes, ()
    kept = nodes[np.linspace(0, len(nodes) - 1, _GRIDS).round().astype(int)]
    rows = np.flatnonzero(np.isin(modes.dofs.node, kept) & (modes.dofs.component <= 3))
    said = f"of the {len(nodes)} grids that the modes hold {_GRIDS} stand for the test"
    thin = replace(modes, shapes=modes.shapes[rows], dofs=modes.dofs.take(rows))
    return thin, (said,)
