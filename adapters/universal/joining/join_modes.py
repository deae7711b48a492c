"""Mode shapes of several datasets as one set of modes; units of several files as one."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.data.dofs import Dofs
from ....core.data.modes import Modes
from ....core.errors import InputError
from ..datasets.mode_shapes import Shape
from ..datasets.units import DeclaredUnits
from ..universal_content import Skipped, Units
from .node_frames import NodeFrames, some


def join_modes(shapes: list[Shape], frames: NodeFrames, warnings: list[str]) -> Modes | None:
    """Join mode shapes: rows of the nodes that every mode has, columns in file order.

    Rows are the 3 or 6 values of each node as written, along the axes of the node's displacement
    system. The values of `shapes` are given up one by one, so that they are never there twice.
    """
    if not shapes:
        return None
    nodes = shapes[0].nodes
    if any(not np.array_equal(s.nodes, nodes) for s in shapes):
        everywhere = nodes
        for s in shapes[1:]:
            everywhere = np.intersect1d(everywhere, s.nodes)
        dropped = np.setdiff1d(np.unique(np.concatenate([s.nodes for s in shapes])), everywhere)
        if len(dropped):
            warnings.append(
                f"node(s) {some(dropped)} are missing in some modes and are left out of all"
            )
        nodes = nodes[np.isin(nodes, everywhere)]
    if not len(nodes):
        raise InputError(
            f"{shapes[0].path} line {shapes[0].line}: no node has values in every mode; "
            "give modes of one test only"
        )
    widths = {s.values.shape[1] for s in shapes}
    width = min(widths)
    if len(widths) > 1:
        warnings.append("some modes have 3 values a node, others 6; rotations are left out")
    kind = np.result_type(*(s.values.dtype for s in shapes))
    values = np.empty((len(nodes) * width, len(shapes)), kind, order="F")
    for k, s in enumerate(shapes):
        order = np.argsort(s.nodes, kind="stable")
        rows = order[np.searchsorted(s.nodes[order], nodes)]
        values[:, k] = s.values[rows, :width].ravel()
        shapes[k] = replace(s, values=s.values[:0])
    values.flags.writeable = False
    axes = frames.at(nodes)
    axis = np.concatenate([axes, axes], axis=1)[:, :width].reshape(-1, 3)
    component = np.tile(np.arange(1, width + 1), len(nodes))
    return Modes(
        np.array([s.frequency_hz for s in shapes]),
        values,
        Dofs(np.repeat(nodes, width), component, axis),
        np.array([s.damping for s in shapes]),
        np.array([s.generalized_mass for s in shapes]),
        ", ".join(dict.fromkeys(s.path for s in shapes)),
        np.array([s.doubted for s in shapes]),
    )


def agreed_units(declared: Sequence[DeclaredUnits], skipped: list[Skipped]) -> Units | None:
    """Return the units on which all files agree; the first that differ go to `skipped`."""
    if not declared:
        return None
    first = declared[0]
    for other in declared[1:]:
        factors = first.units.length_factor, other.units.length_factor
        if abs(factors[1] / factors[0] - 1.0) > 1e-6:
            why = (
                f"dataset 164 at {first.path} line {first.line} declares different length units "
                f"(factors {factors[0]:g} and {factors[1]:g}); export all files in one unit"
            )
            skipped.append(Skipped("dataset 164 (units)", other.line, why, other.path, "test"))
            break
    return first.units
