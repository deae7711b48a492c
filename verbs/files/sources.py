"""Files or objects in: the deck, the test and the modes that a verb is given."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np

from ...core.data.measurement import Measurement
from ...core.data.modes import Modes
from ...core.errors import InputError, Place, naming, path_of

if TYPE_CHECKING:
    from ...adapters.nastran import Deck
    from ...adapters.nastran.editing.changed_deck import ChangedDeck
    from ...core.data.geometry import Geometry
    from ...core.data.parametric_model import Model
    from ..studies.study import Study

Source = object
"""A path, or an object that stands for its content."""


def file_of(source: object, what: str) -> Path:
    """Return a path that was given as text or as a path.

    Raises
    ------
    InputError
        Something else; `what` it should be.
    """
    return path_of(source, what, f"a path or {what} as read")


def file_or_pynastran(source: Any, what: str) -> Any:
    """Return the path, or an object of pyNastran's as it is."""
    of_theirs = any(c.__module__.startswith("pyNastran.") for c in type(source).__mro__)
    return source if of_theirs else file_of(source, what)


def existing(paths: Sequence[Path]) -> list[Path]:
    """Return the paths, all of which are files.

    Raises
    ------
    InputError
        One is missing.
    """
    for path in paths:
        if not path.is_file():
            raise Place(path).fault("does not exist or is not a file")
    return list(paths)


def read_deck(source: Source) -> Deck:
    """Read a Nastran deck with its INCLUDE files; a deck that was read already is given back.

    Parameters
    ----------
    source : path, Deck, ChangedDeck or pyNastran's BDF
        The main file; executive and case control may be missing (bulk data alone). The changed
        deck of a result (``better.deck``) is read as it became, under the names of its files.

    Raises
    ------
    InputError
        A file that cannot be read or is not a deck, a card that cannot be read: file and line.
    """
    from ...adapters.nastran import Deck, read_deck as read

    if isinstance(source, Deck):
        return source
    if is_changed(source):
        return read(source.text)
    path = file_or_pynastran(source, "a deck")
    try:
        return read(path)
    except InputError:
        from .read import OP4, kind_of_file

        if isinstance(path, Path) and path.is_file() and kind_of_file(path) is OP4:
            raise Place(path).fault(
                "holds matrices, and a deck is expected: make one of their grids that selects them "
                f"(K2GG, M2GG), with what 'trueup convert {path.name} {path.stem}.pch' writes"
            ) from None
        raise


def is_changed(source: Source) -> TypeGuard[ChangedDeck]:
    """Tell the changed deck of a result."""
    from ...adapters.nastran.editing.changed_deck import ChangedDeck

    return isinstance(source, ChangedDeck)


def read_test(source: Source) -> Measurement:
    """Read a test: its geometry, and modes or frequency responses in the measured directions.

    Parameters
    ----------
    source : path, sequence of paths, Measurement, or pyuff's dictionaries or UFF
        Universal files; modes or responses, geometry and coordinate systems may stand apart.

    Returns
    -------
    ModalTest
        A `Measurement` with ``to_pyuff()``; a Measurement that was given is given back.

    Raises
    ------
    InputError
        A file that is missing or cannot be read; neither modes nor frequency responses; no
        geometry; a node of the shapes without a position.
    """
    from ...adapters.universal import is_pyuff, read_pyuff, read_test as read
    from .modes_as_test import holds_modes, modes_as_test

    if isinstance(source, Measurement):
        return source
    if is_pyuff(source):
        return read_pyuff(source)
    files = existing(files_of(source))
    if holds_modes(files):
        return modes_as_test(files)
    return _own_systems(files, read(files))


def files_of(source: Source) -> list[Path]:
    """Return the paths of a test that is given as one or several files."""
    if isinstance(source, list | tuple):
        if not source:
            raise InputError("no file of a test is given")
        return [file_of(s, "a test") for s in source]
    return [file_of(source, "a test")]


def _own_systems(files: Sequence[Path], measurement: Measurement) -> Measurement:
    """Return a test of several files with its responses along the axes of their own file.

    Of nodes that stand in several files with different displacement systems only the first are
    kept; responses that are whole in a file of their own, geometry included, are read from there.
    """
    from ...adapters.universal import read_test

    if len(files) < 2 or measurement.frfs is None:
        return measurement
    alone = []
    for file in files:
        with suppress(InputError):
            alone.append(read_test([file]))
    whole = [m.frfs for m in alone if m.frfs is not None]
    if len(whole) != 1 or len(whole[0].responses) < len(measurement.frfs.responses):
        return measurement
    if np.any(measurement.geometry.index_of(whole[0].responses.node) < 0):
        return measurement
    return replace(measurement, frfs=whole[0])


@dataclass(frozen=True, eq=False)
class Measured:
    """The test of a verb: with modes, and the files it came from, none where it was an object."""

    measurement: Measurement
    files: tuple[Path, ...]

    @property
    def name(self) -> Path | None:
        """File to name in messages."""
        return self.files[0] if self.files else None

    @property
    def modes(self) -> Modes:
        """Its modes.

        Raises
        ------
        InputError
            It has none, or none with a frequency.
        """
        modes = self.measurement.modes
        with naming(self.name):
            if modes is None or not len(modes):
                heard = self.measurement.frfs is not None
                found = " (none stands out of its responses)" if heard else ""
                raise InputError(f"the test holds no modes{found}")
            if np.max(modes.frequencies_hz) == 0.0:
                raise InputError("all modes are at 0 Hz or have no frequency in the file")
        return modes

    def highest(self, study: Study) -> float:
        """Return the frequency up to which analysis modes count, Hz: they pair, or are heard."""
        top = float(self.modes.frequencies_hz.max())
        paired = top * (1.0 + study.frequency_tolerance)
        if not study.hears:
            return paired
        from ...core.updating.residuals.frfs import modes_up_to

        return max(paired, modes_up_to(top))


def measured(source: Source, study: Study) -> Measured:
    """Return the test of a verb; modes are identified where it holds responses only."""
    from ...adapters.universal import ModalTest
    from ...core.data.without_sensors import without_sensors
    from ...core.identification.measured_modes import with_modes

    test = read_test(source)
    files = test.files if isinstance(test, ModalTest) else ()
    with naming(files[0] if files else None):
        if test.modes is not None:  # they say which of the modes take part
            study = replace(study, fmin=None, fmax=None, bands=())
        kept = without_sensors(test, study.exclude_sensors)
        return Measured(with_modes(kept, **study.identification), files)


def geometry_of(model: Model, deck: Deck | None) -> Geometry:
    """Return the geometry of a model with the length unit that its deck declares."""
    geometry = model.geometry
    if geometry.length_unit is None and deck is not None and deck.length_unit:
        return replace(geometry, length_unit=deck.length_unit)
    return geometry
