"""A test for correlation from universal files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...core.dofs import Dofs
from ...core.errors import InputError
from ...core.measured import measured_dofs
from ...core.measurement import Measurement
from ...core.modes import Modes
from .content import METRES, UniversalContent
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
        As `read_universal`; no geometry; neither modes nor frequency responses; a node of the
        shapes without a position.
    """
    content = read_universal(paths)
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
    warnings = list(content.warnings)
    if content.length_unit is None:
        warnings.append(
            f"{names}: the length unit of the test is not declared (dataset 164 is missing or "
            "unknown)"
        )
    modes = None if content.modes is None else measured_modes(content.modes, warnings)
    try:
        test = Measurement(
            content.geometry, modes, content.frfs, content.length_unit, tuple(warnings)
        )
    except InputError as error:
        raise InputError(f"{names}: {error}") from None
    return test if deck_length_unit is None else in_unit(test, deck_length_unit)


def measured_modes(modes: Modes, warnings: list[str]) -> Modes:
    """Keep the measured directions of modes that list 3 or 6 values for every node."""
    width = 6 if np.any(modes.dofs.component > 3) else 3
    shapes = modes.shapes.reshape(-1, width, len(modes))
    axes = modes.dofs.axis.reshape(-1, width, 3)
    nodes = modes.dofs.node.reshape(-1, width)[:, 0]
    dofs, kept = measured_dofs(nodes, axes[:, :3], shapes[:, :3])
    if width == 6 and np.any(shapes[:, 3:] != 0.0):
        node, turn = np.nonzero(np.any(shapes[:, 3:] != 0.0, axis=2))
        dofs = Dofs(
            np.concatenate([dofs.node, nodes[node]]),
            np.concatenate([dofs.component, turn + 4]),
            np.concatenate([dofs.axis, axes[node, 3 + turn]]),
        )
        kept = np.concatenate([kept, shapes[node, 3 + turn]])
    silent = np.setdiff1d(nodes, dofs.node)
    if not len(dofs):
        raise InputError(f"{modes.source}: every mode shape is zero at every node")
    if len(silent):
        warnings.append(
            f"{len(silent)} node(s) are zero in every mode and count as not measured: "
            + ", ".join(str(n) for n in silent[:6])
            + (", ..." if len(silent) > 6 else "")
        )
    return Modes(
        modes.frequencies_hz, kept, dofs, modes.damping, modes.generalized_mass, modes.source
    )


def in_unit(test: Measurement, unit: str) -> Measurement:
    """Convert positions and shapes of a test to another length unit, if its own is known."""
    if unit not in METRES:
        raise InputError(f"length unit {unit!r} is none of {', '.join(METRES)}")
    if test.length_unit is None or test.length_unit == unit:
        return test
    factor = METRES[test.length_unit] / METRES[unit]
    geometry = replace(test.geometry, xyz=test.geometry.xyz * factor, length_unit=unit)
    modes = test.modes
    if modes is not None:
        modes = replace(
            modes,
            shapes=modes.shapes * factor,
            generalized_mass=modes.generalized_mass * factor**2,
        )
    frfs = None if test.frfs is None else replace(test.frfs, values=test.frfs.values * factor)
    return Measurement(geometry, modes, frfs, unit, test.warnings)


def _first_skip(content: UniversalContent) -> str:
    if not content.skipped:
        return ""
    first = content.skipped[0]
    return f" (skipped: {first.what} at line {first.line}, {first.why})"
