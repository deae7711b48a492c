"""A test for correlation from universal files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ...core.data.measurement import Measurement
from ...core.errors import InputError, Place
from ...core.sensors.measured_directions import measured_directions
from .pyuff_bridge import SAID, file_of, sets_of
from .read_universal import read_universal
from .universal_content import UniversalContent


@dataclass(frozen=True, eq=False)
class ModalTest(Measurement):
    """A test that was read from universal files or from pyuff's dictionaries.

    `files` are the files it was read from, none where it was not.
    """

    files: tuple[Path, ...] = field(default=(), repr=False)

    def to_pyuff(self) -> list[dict[str, Any]]:
        """Return the test as pyuff's dictionaries: datasets 151, 164, 2411, 82 or 2412, 55, 58.

        Directions that were not measured are zero in 55, as the format wants it.

        Raises
        ------
        InputError
            pyuff is not installed, or the format cannot hold the test.
        """
        return sets_of(self)


def read_pyuff(source: object) -> ModalTest:
    """Read a test from pyuff's dictionaries, which stay as they are, or from its ``UFF`` object.

    Raises
    ------
    InputError
        pyuff is not installed or does not accept them; what `read_test` refuses of a file.
    """
    with file_of(source) as path:
        test = read_test(path)
    said = tuple(w.replace(str(path), SAID) for w in test.warnings)
    modes = test.modes and replace(test.modes, source=SAID)
    return replace(test, files=(), warnings=said, modes=modes)


def read_test(paths: Sequence[Path] | Path) -> ModalTest:
    """Read a test: positions, and modes or frequency responses in the measured directions.

    Parameters
    ----------
    paths : sequence of Path, or Path
        Universal files; modes or responses, geometry and coordinate systems may stand apart.

    Returns
    -------
    ModalTest
        In the test's own frame. Directions that were not measured are absent.

    Raises
    ------
    InputError
        As `read_universal`; modes, nodes, systems or units that cannot be read; no geometry;
        neither modes nor frequency responses; a node of the
        shapes without a position.
    """
    content = read_universal(paths)
    damaged = next((s for s in content.skipped if s.harm == "test"), None)
    if damaged is not None:
        raise Place(damaged.path, damaged.line).error(damaged.why)
    test = Place(content.files[0], shown=" and ".join(content.files))
    if content.modes is None and content.frfs is None:
        raise test.error(
            "neither mode shapes (dataset 55, 2414) nor frequency responses (58) to "
            "compare with; give the file that holds them" + _first_skip(content)
        )
    if content.geometry is None:
        raise test.error(
            "a test with no geometry cannot be placed on the model; "
            "give the file with the nodes (dataset 15 or 2411) as well"
        )
    modes, silent = (None, ()) if content.modes is None else measured_directions(content.modes)
    if modes is not None and not len(modes.dofs):
        raise test.error("every mode shape is zero at every node")
    lost = [str(s) for s in content.skipped if s.harm == "lost"]
    warnings = [*content.warnings, *lost, *silent]
    if content.length_unit is None:
        warnings.append(
            f"{test}: the length unit of the test is not declared (dataset 164 is missing or "
            "unknown)"
        )
    try:
        return ModalTest(
            content.geometry,
            modes,
            content.frfs,
            content.length_unit,
            tuple(warnings),
            files=tuple(map(Path, content.files)),
        )
    except InputError as error:
        raise test.error(str(error)) from None


def _first_skip(content: UniversalContent) -> str:
    if not content.skipped:
        return ""
    first = content.skipped[0]
    return f" (skipped: {first.what} at line {first.line}, {first.why})"
