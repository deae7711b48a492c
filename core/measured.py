"""Which directions of a test node were really measured, inferred from the rank of its data."""

from __future__ import annotations

import numpy as np

from .arrays import Floats, Ints, Numbers, require_finite, require_shape
from .dofs import Dofs
from .errors import InputError

# Files print five to seven digits, so values that a program computed from one sensor agree to
# about 1e-5; two sensors never agree that well, because each carries noise of its own.
_RELATIVE_RANK = 1e-3


def measured_directions(shapes: Numbers, tolerance: float = _RELATIVE_RANK) -> list[Floats]:
    """Axes along which each node was measured.

    A file gives three values for every node, measured or not. Over all modes the vectors of a
    node that carries one sensor span only a line, with two sensors only a plane. Real and
    imaginary parts count as separate vectors; each mode is scaled to unit size first, so that no
    mode outweighs the others.

    With so few modes that a line or plane would be no evidence (one vector always spans a line,
    two always a plane), directions that are exactly zero throughout are taken as not measured
    and all others as measured.

    Parameters
    ----------
    shapes : (n_node, 3, n_mode) float or complex
        Three orthogonal components for each node and mode.
    tolerance : float
        A direction was measured when its singular value is above this share of the largest of
        the node: above what printing loses, below the noise of any sensor.

    Returns
    -------
    list of (k, 3) float, one for each node
        k = 0..3 orthonormal axes in the frame of the components; unit vectors of that frame
        wherever they span the same space. Empty: all values of the node are zero.

    Raises
    ------
    InputError
        Shapes that are not (n_node, 3, n_mode) or not finite.
    """
    shapes = np.asarray(shapes)
    if shapes.ndim != 3:
        raise InputError(f"shapes have {shapes.ndim} axes, expected (n_node, 3, n_mode)")
    require_shape(shapes, (shapes.shape[0], 3, shapes.shape[2]), "shapes of the nodes")
    require_finite(shapes, "shapes of the nodes")
    vectors = _real_columns(shapes)
    present = np.any(vectors != 0.0, axis=2)
    if not len(vectors):
        return []
    # Copies of one mode, or one mode times a complex number, are no further evidence.
    overall = np.linalg.svd(vectors.reshape(-1, vectors.shape[2]), compute_uv=False)
    evidence = int(np.count_nonzero(overall > tolerance * overall.max(initial=0.0)))
    left, sigma, _ = np.linalg.svd(vectors, full_matrices=vectors.shape[2] < 3)
    sigma = np.pad(sigma, ((0, 0), (0, 3 - sigma.shape[1])))
    rank = np.count_nonzero(sigma > tolerance * np.maximum(sigma[:, :1], 1e-300), axis=1)
    columns = np.minimum(np.count_nonzero(np.any(vectors != 0.0, axis=1), axis=1), evidence)
    axes = []
    for node, r in enumerate(rank):
        if r == 0 or r >= 3 or r >= columns[node]:
            axes.append(np.eye(3)[present[node]])
        else:
            axes.append(_tidy(left[node, :, :r].T, tolerance))
    return axes


def measured_dofs(
    node: Ints, frames: Floats, shapes: Numbers, tolerance: float = _RELATIVE_RANK
) -> tuple[Dofs, Numbers]:
    """Keep the measured directions of shapes that list three components for each node.

    Parameters
    ----------
    node : (n_node,) int
        Node numbers.
    frames : (n_node, 3, 3) float
        Row k: direction of component k at the node, orthonormal, in the basic frame.
    shapes : (n_node, 3, n_mode) float or complex
        Components along `frames`.

    Returns
    -------
    dofs : Dofs
        One row for each measured direction with its axis in the basic frame; the component is
        the frame direction that it is closest to.
    shapes : (n_dof, n_mode)
        Motion along each axis.
    """
    node, shapes = np.asarray(node), np.asarray(shapes)
    kept = measured_directions(shapes, tolerance)
    rows = np.repeat(np.arange(len(node)), [len(a) for a in kept])
    local = np.vstack([np.zeros((0, 3)), *kept])
    axis = np.einsum("ij,ijk->ik", local, np.asarray(frames, np.float64)[rows])
    component = np.concatenate([np.zeros(0, np.int64), *(_components(a) for a in kept)])
    return Dofs(node[rows], component, axis), np.einsum("ij,ijm->im", local, shapes[rows])


def _real_columns(shapes: Numbers) -> Floats:
    """Real vectors (n_node, 3, n) of shapes, each mode scaled to a largest value of one."""
    parts = [shapes.real, shapes.imag] if np.iscomplexobj(shapes) else [shapes]
    size = np.abs(shapes).max(axis=(0, 1), initial=0.0)
    scale = 1.0 / np.where(size > 0.0, size, 1.0)
    return np.asarray(np.concatenate(parts, axis=2) * np.tile(scale, len(parts)))


def _tidy(axes: Floats, tolerance: float) -> Floats:
    """Orthonormal axes of the same space, along the frame's own directions where they can be."""
    projector = axes.T @ axes
    inside = np.flatnonzero(np.diag(projector) > 1.0 - tolerance**2)
    if len(inside) == len(axes):
        return np.eye(3)[inside]
    found: list[Floats] = []
    for _ in axes:
        best = int(np.argmax(np.diag(projector)))
        axis = projector[best] / np.sqrt(projector[best, best])
        found.append(axis)
        projector = projector - np.outer(axis, axis)
    return np.array(found)


def _components(axes: Floats) -> Ints:
    """Give each axis the frame direction closest to it, none twice."""
    share = np.abs(axes)
    chosen = np.zeros(len(axes), np.int64)
    for _ in range(len(axes)):
        row, column = np.unravel_index(int(np.argmax(share)), share.shape)
        chosen[row] = column + 1
        share[row, :] = -1.0
        share[:, column] = -1.0
    return chosen
