"""A test for correlation from universal files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from ...core.errors import InputError
from ...core.frfs import Frfs
from ...core.geometry import Geometry
from ...core.measured import measured_directions
from ...core.measurement import Measurement
from ...core.modes import Modes
from ...core.units import length_factor, to_length_unit
from .content import UniversalContent
from .reading import read_universal


def read_test(paths: Sequence[Path] | Path, deck_length_unit: str | None = None) -> Measurement:
    """Read a test: positions, and modes or frequency responses in the measured directions.

    Parameters
    ----------
    paths : sequence of Path, or Path
        Universal files; modes or responses, geometry and coordinate systems may stand apart.
    deck_length_unit : {"m", "mm", "in", "ft"}, optional
        Convert positions and shapes to this unit, where the test declares its own. Default: they
        stay in the test's unit.

    Returns
    -------
    Measurement
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
        raise InputError(f"{damaged.path} line {damaged.line}: {damaged.why}")
    names = " and ".join(content.files)
    if content.modes is None and content.frfs is None:
        raise InputError(
            f"{names}: neither mode shapes (dataset 55, 2414) nor frequency responses (58) to "
            "compare with; give the file that holds them" + _first_skip(content)
        )
    if content.geometry is None:
        raise InputError(
            f"{names}: a test with no geometry cannot be placed on the model; "
            "give the file with the nodes (dataset 15 or 2411) as well"
        )
    modes, silent = (None, ()) if content.modes is None else measured_directions(content.modes)
    if modes is not None and not len(modes.dofs):
        raise InputError(f"{names}: every mode shape is zero at every node")
    lost = [str(s) for s in content.skipped if s.harm == "lost"]
    warnings = [*content.warnings, *lost, *silent]
    if content.length_unit is None:
        warnings.append(
            f"{names}: the length unit of the test is not declared (dataset 164 is missing or "
            "unknown)"
        )
    geometry = content.geometry
    if deck_length_unit is not None and content.length_unit not in (None, deck_length_unit):
        return _converted(geometry, modes, content, deck_length_unit, tuple(warnings))
    return _measurement(names, geometry, modes, content.frfs, tuple(warnings))


def _converted(
    geometry: Geometry,
    modes: Modes | None,
    content: UniversalContent,
    unit: str,
    warnings: tuple[str, ...],
) -> Measurement:
    """Return the test with positions, shapes and responses in another length unit."""
    geometry, modes = to_length_unit(geometry, modes, str(content.length_unit), unit)
    frfs = content.frfs
    if frfs is not None:
        factor = length_factor(str(content.length_unit), unit)
        frfs = replace(frfs, values=frfs.values * factor)
    return _measurement(" and ".join(content.files), geometry, modes, frfs, warnings)


def _measurement(
    names: str,
    geometry: Geometry,
    modes: Modes | None,
    frfs: Frfs | None,
    warnings: tuple[str, ...],
) -> Measurement:
    try:
        return Measurement(geometry, modes, frfs, geometry.length_unit, warnings)
    except InputError as error:
        raise InputError(f"{names}: {error}") from None


def _first_skip(content: UniversalContent) -> str:
    if not content.skipped:
        return ""
    first = content.skipped[0]
    return f" (skipped: {first.what} at line {first.line}, {first.why})"
