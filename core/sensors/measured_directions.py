"""Which directions a test really measured."""

from dataclasses import replace

import numpy as np

from ..arrays import Bools, Floats, Ints, Numbers
from ..data.dofs import Dofs
from ..data.modes import Modes
from .placement_numbers import PLACEMENT


def measured_directions(
    modes: Modes, threshold: float = PLACEMENT.measured
) -> tuple[Modes, tuple[str, ...]]:
    """Keep the directions in which each node of a test was measured.

    Files store three values a node whatever was measured. A node whose vectors over all modes
    span only a line or a plane was measured along that line or in that plane: what is absent is
    absent, not zero. Components that are zero in every mode are dropped; with four vectors or
    more, the translations left become as many sensors as the rank of the node's vectors, on new
    axes as near to the old as can be. Where the rank is full the file's axes stay. Rotations are
    kept where they are not zero throughout.

    Parameters
    ----------
    modes : Modes
        Of the test, real or complex, with one axis a row.
    threshold : float
        Relative to the largest singular value of the node.

    Returns
    -------
    modes : Modes
        On the measured directions; each axis belongs to its row.
    warnings : tuple of str
        Nodes that did not move at all, which are left out.
    """
    dofs, shapes = modes.dofs, modes.shapes
    vectors = np.concatenate([shapes.real, shapes.imag], axis=1) if modes.is_complex else shapes
    size = np.abs(vectors).max(axis=1, initial=0.0)
    translation = dofs.component <= 3
    nodes, of_row = np.unique(dofs.node, return_inverse=True)
    largest = np.zeros(len(nodes))
    np.maximum.at(largest, of_row, np.where(translation, size, 0.0))
    keep = size > np.where(translation, threshold * largest[of_row], 0.0)
    axis, values = dofs.axis.copy(), shapes.copy()
    if _independent(vectors, threshold) >= PLACEMENT.vectors:
        slots = _slots(dofs, of_row, keep & translation, len(nodes))
        _reduce(slots, vectors, threshold, keep, axis, values)
    silent = nodes[(largest == 0) & np.isin(nodes, dofs.node[translation])]
    sensors = Dofs(dofs.node[keep], dofs.component[keep], axis[keep])
    return replace(modes, shapes=values[keep], dofs=sensors), _said(silent)


def _independent(vectors: Floats, threshold: float) -> int:
    """How many of the vectors differ: one mode twice, or times i, shows nothing new."""
    size = np.abs(vectors).max(axis=0, initial=0.0)
    sigma = np.linalg.svd(vectors[:, size > 0.0] / size[size > 0.0], compute_uv=False)
    return int(np.count_nonzero(sigma > threshold * sigma.max(initial=0.0)))


def _slots(dofs: Dofs, of_row: Ints, usable: Bools, n_node: int) -> Ints:
    """Rows of each node's translations, (n, 3), -1 where absent, for nodes with a plain frame."""
    slots = np.full((n_node, 3), -1, np.int64)
    rows = np.flatnonzero(usable)
    slots[of_row[rows], dofs.component[rows] - 1] = rows
    E = np.where(slots[:, :, None] >= 0, dofs.axis[slots], 0.0)
    present = slots >= 0
    gram = E @ np.swapaxes(E, 1, 2) - np.eye(3) * present[:, :, None]
    plain = np.abs(gram).max(axis=(1, 2)) < PLACEMENT.plain
    plain &= np.bincount(of_row[rows], minlength=n_node) == present.sum(axis=1)
    return np.asarray(slots[plain])


def _reduce(
    slots: Ints, vectors: Floats, threshold: float, keep: Bools, axis: Floats, values: Numbers
) -> None:
    """Replace the rows of nodes whose vectors span less than their axes, in place."""
    present = slots >= 0
    V = np.where(present[:, :, None], vectors[slots], 0.0)
    power, directions = np.linalg.eigh(V @ np.swapaxes(V, 1, 2))
    rank = np.count_nonzero(power > threshold**2 * power[:, -1:], axis=1)
    short = (rank < present.sum(axis=1)) & (rank > 0)
    for r in (1, 2):
        chosen = np.flatnonzero(short & (rank == r))
        span = directions[chosen][:, :, 3 - r :]
        # Drop the axes farthest from the span, turn the others into it (polar decomposition).
        closeness = np.linalg.norm(span, axis=2) * present[chosen]
        order = np.argsort(-closeness, axis=1, kind="stable")
        own, rest = np.sort(order[:, :r], axis=1), order[:, r:]
        picked = np.take_along_axis(span, own[:, :, None], axis=1)
        U, _, Vt = np.linalg.svd(np.swapaxes(picked, 1, 2))
        turn = span @ U @ Vt  # (n, 3, r), columns near the axes that stay
        of_node = slots[chosen]
        new_axis = np.einsum("nar,nax->nrx", turn, axis[of_node])
        shapes = np.where(present[chosen][:, :, None], values[of_node], 0.0)
        new_values = np.einsum("nar,nam->nrm", turn, shapes)
        target = np.take_along_axis(of_node, own, axis=1)
        dropped = np.take_along_axis(of_node, rest, axis=1)
        keep[dropped[dropped >= 0]] = False
        axis[target], values[target] = new_axis, new_values


def _said(silent: Ints) -> tuple[str, ...]:
    if not len(silent):
        return ()
    more = ", ..." if len(silent) > PLACEMENT.named else ""
    named = ", ".join(str(n) for n in silent[: PLACEMENT.named]) + more
    return (f"{len(silent)} test node(s) do not move in any mode and were left out: {named}",)
