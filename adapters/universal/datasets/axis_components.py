"""Motion along any axes as the three components a universal file stores for each node."""

import numpy as np

from ....core.arrays import Floats, Ints, Numbers, frozen
from ....core.data.dofs import Dofs
from ....core.errors import InputError


def node_vectors(dofs: Dofs, values: Numbers) -> tuple[Ints, Numbers]:
    """Vectors in the basic frame whose component along each axis is the value given.

    Unmeasured directions become zero, the only way the format has to say it.

    Parameters
    ----------
    dofs : Dofs
        Translations, rotations or both, in any order.
    values : (n_dof, n_mode) float or complex

    Returns
    -------
    nodes : (n_node,) int
        In order of first mention.
    vectors : (n_node, 3 or 6, n_mode)
        Six where any rotation is given.

    Raises
    ------
    InputError
        A node whose values contradict each other (two different values along one axis).
    """
    unique, first, inverse = np.unique(dofs.node, return_index=True, return_inverse=True)
    order = np.argsort(first)
    row = np.argsort(order)[inverse]
    width = 6 if np.any(dofs.component > 3) else 3
    vectors = np.zeros((len(unique), width, values.shape[1]), values.dtype)
    for half in range(width // 3):
        rows = np.flatnonzero((dofs.component > 3) == bool(half))
        vectors[:, 3 * half : 3 * half + 3] = _solved(
            row[rows], dofs.axis[rows], values[rows], unique[order]
        )
    return frozen(unique[order]), vectors


def _solved(row: Ints, axis: Floats, values: Numbers, nodes: Ints) -> Numbers:
    """Vectors (n_node, 3, n_mode) with ``axis @ vector = value`` for every row."""
    result = np.zeros((len(nodes), 3, values.shape[1]), values.dtype)
    order = np.argsort(row, kind="stable")
    count = np.bincount(row, minlength=len(nodes))
    start = np.concatenate([[0], np.cumsum(count)])
    for k in np.unique(count[count > 0]):
        which = np.flatnonzero(count == k)
        rows = order[start[which][:, None] + np.arange(k)]
        A, z = axis[rows], values[rows]
        gram = A @ np.swapaxes(A, 1, 2) - np.eye(k)
        plain = np.abs(gram).max(axis=(1, 2)) < 1e-12
        inverse = np.swapaxes(A, 1, 2)
        if not plain.all():
            inverse = np.where(plain[:, None, None], inverse, np.linalg.pinv(A, rcond=1e-9))
        found = inverse @ z
        size = np.abs(z).max(axis=(1, 2), initial=0.0)
        off = np.abs(A @ found - z).max(axis=(1, 2), initial=0.0) > 1e-6 * size
        if off.any():
            raise InputError(
                f"node {nodes[which[off]][0]} has {k} values along axes that contradict each "
                "other; a universal file holds one vector for each node"
            )
        result[which] = found
    return result


def node_systems(*sets: Dofs) -> dict[int, Floats]:
    """Cartesian displacement axes, (3, 3) rows, of the nodes whose dofs are not basic.

    Raises
    ------
    InputError
        A node whose axes do not fit into one orthogonal system.
    """
    systems: dict[int, Floats] = {}
    dofs = Dofs(
        np.concatenate([d.node for d in sets]),
        np.concatenate([d.component for d in sets]),
        np.concatenate([d.axis for d in sets]),
    )
    own = np.abs(dofs.axis[np.arange(len(dofs)), (dofs.component - 1) % 3])
    for node in np.unique(dofs.node[own < 1.0 - 1e-12]):
        rows = np.flatnonzero(dofs.node == node)
        R = np.zeros((3, 3))
        for k in rows:
            c = (dofs.component[k] - 1) % 3
            if R[c].any() and abs(abs(R[c] @ dofs.axis[k]) - 1.0) > 1e-9:
                raise _crooked(int(node))
            R[c] = R[c] if R[c].any() else dofs.axis[k]
        systems[int(node)] = _completed(R, int(node))
    return systems


def _completed(R: Floats, node: int) -> Floats:
    """Fill the missing rows of a rotation; three left-handed rows have the last one turned."""
    given = np.flatnonzero(R.any(axis=1))
    gram = R[given] @ R[given].T
    if np.abs(gram - np.eye(len(given))).max() > 1e-9:
        raise _crooked(node)
    if len(given) == 1:
        first = given[0]
        helper = np.eye(3)[np.argmin(np.abs(R[first]))]
        second = (first + 1) % 3
        R[second] = np.cross(R[first], helper)
        R[second] /= np.linalg.norm(R[second])
        given = np.array([first, second])
    if len(given) == 2:
        missing = 3 - int(given.sum())
        R[missing] = np.cross(R[(missing + 1) % 3], R[(missing + 2) % 3])
    if np.linalg.det(R) < 0.0:
        R[2] = -R[2]
    return R


def _crooked(node: int) -> InputError:
    return InputError(
        f"the response axes at node {node} are not orthogonal to each other; "
        "a universal file holds one coordinate system for each node"
    )
