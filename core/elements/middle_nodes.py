"""Second-order elements: interpolation, middle nodes left out, lumped mass all at middle nodes."""

import numpy as np

from ..arrays import Bools, Floats, Ints
from .batch import transpose


def serendipity(corners: Floats, edges: Ints, p: Floats) -> tuple[Floats, Floats]:
    """Shape functions (m, n) and derivatives (m, d, n) at points (m, d) of a square or cube.

    Its `corners` (k, d), at -1 and 1, come first, then the middles of the `edges`.
    """
    nodes = np.concatenate([corners, corners[edges].mean(axis=1)])
    k, d = corners.shape
    x = p[:, None]
    across = nodes == 0.0  # the direction of the edge of a middle node
    f = np.where(across, 1.0 - x**2, 1.0 + nodes * x)
    df = np.where(across, -2.0 * x, nodes)
    part = np.where(across.any(axis=1), 2.0, 1.0) / 2**d
    N = f.prod(axis=2) * part
    dN = [df[..., a] * np.delete(f, a, axis=2).prod(axis=2) * part for a in range(d)]
    s = (corners * x).sum(axis=2) - (d - 1)
    for a in range(d):
        dN[a][:, :k] = dN[a][:, :k] * s + N[:, :k] * corners[:, a]
    N[:, :k] *= s
    return N, np.stack(dN, axis=1)


def quadratic(L: Floats, dL: Floats, edges: Ints) -> tuple[Floats, Floats]:
    """Quadratic shape functions of a triangle or tetrahedron from its linear ones."""
    a, b = np.asarray(edges).T
    N = np.concatenate([L * (2.0 * L - 1.0), 4.0 * L[:, a] * L[:, b]], axis=1)
    middle = 4.0 * (dL[..., a] * L[:, None, b] + dL[..., b] * L[:, None, a])
    return N, np.concatenate([dL * (4.0 * L - 1.0)[:, None], middle], axis=2)


def spread(edges: Ints, kept: Bools) -> Floats | None:
    """Values at all nodes from those that are `kept`: a missing one takes the mean of its edge.

    (n_node, n_kept), None where all are there; `edges` (m, 2) are the ends of the edge of each
    middle node.
    """
    if kept.all():
        return None
    n = len(kept)
    corners = n - len(edges)
    columns = np.cumsum(kept) - 1
    T = np.zeros((n, int(kept.sum())))
    for node in range(n):
        if kept[node]:
            T[node, columns[node]] = 1.0
        else:
            for end in edges[node - corners]:
                T[node, columns[end]] += 0.5
    return T


_EMPTY = 1e-9
"""Of the mass of the element: less than that is a share of nothing, found by rounding."""


def to_middle_nodes(share: Floats, xyz: Floats) -> Floats:
    """Move negative masses, those of the corners, to the other nodes; mass and centre stay.

    Row sums of the consistent mass are negative at the corners of second-order elements. Nastran
    leaves no mass there: each of the others takes ``r**2 (c + d . r)`` of it, r being its place
    seen from the centre of gravity, with c and d such that the element keeps its mass and its
    centre of gravity. (Identified from the ten modes of a pair of ten-node tetrahedra, one of them
    curved, of MSC, and the twenty of NX of a patch with middle nodes left out, whose share goes
    to the ends of their edges first: both to the last digit printed.)

    Parameters
    ----------
    share : (n, k) float
        Row sums of the consistent mass.
    xyz : (n, k, 3) float
        Nodes.

    Returns
    -------
    (n, k) float
        None is negative; nothing of elements without mass.
    """
    if (share > 0.0).all():
        return share
    total = share.sum(axis=1)
    heavy = total > 0.0
    if not heavy.all():
        out = np.zeros_like(share)
        out[heavy] = to_middle_nodes(share[heavy], xyz[heavy]) if heavy.any() else 0.0
        return out
    centre = np.einsum("nk,nkd->nd", share, xyz) / total[:, None]
    r = xyz - centre[:, None]
    r = r / np.sqrt((r**2).sum(axis=2).max(axis=1))[:, None, None]
    takes = share > _EMPTY * total[:, None]
    moved = np.where(takes, 0.0, share)
    A = np.concatenate([np.ones((*r.shape[:2], 1)), r], axis=2)
    weighted = A * ((r**2).sum(axis=2) * takes)[..., None]
    wanted = np.einsum("nk,nkd->nd", moved, A)
    normal = np.linalg.pinv(transpose(A) @ weighted, rcond=1e-10, hermitian=True)
    taken = (weighted @ (normal @ wanted[..., None]))[..., 0]
    out = np.maximum(share - moved + taken, 0.0)
    return np.asarray(out * (total / out.sum(axis=1))[:, None])


def lumped(m: Floats, xyz: Floats, there: Floats | None, coupled: bool) -> Floats:
    """Mass of the nodes that are there from the consistent mass of all, (n, k, k).

    Parameters
    ----------
    m : (n, nodes, nodes) float
        Consistent mass.
    xyz : (n, nodes, 3) float
        Nodes.
    there : (nodes, k) float or None
        All nodes from those that are there (`spread`).
    coupled : bool
        Left consistent; otherwise lumped, see `to_middle_nodes`.
    """
    if there is not None:
        m = there.T @ m @ there
        xyz = xyz[:, there.max(axis=1) == 1.0]
    if coupled:
        return m
    return to_middle_nodes(m.sum(axis=2), xyz)[:, :, None] * np.eye(m.shape[1])
