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


def to_middle_nodes(share: Floats, xyz: Floats, corners: int) -> Floats:
    """Move the mass of the corners to the middle nodes; mass and centre of gravity stay.

    Row sums of the consistent mass are negative at the corners of second-order elements. MSC
    Nastran leaves no mass there: each middle node takes ``r**2 (c + d . r)`` of it, r being its
    place seen from the centre of gravity, with c and d such that the element keeps its mass and
    its centre of gravity. (Identified from the ten modes of a pair of ten-node tetrahedra, one of
    them curved, which it makes to the last digit printed.)

    Parameters
    ----------
    share : (n, k) float
        Row sums of the consistent mass.
    xyz : (n, k, 3) float
        Corners, then middle nodes.
    corners : int
        Number of corners.

    Returns
    -------
    (n, k) float
        Zero at the corners; nothing of elements without mass.
    """
    total = share.sum(axis=1)
    heavy = total > 0.0
    if not heavy.all():
        out = np.zeros_like(share)
        out[heavy] = to_middle_nodes(share[heavy], xyz[heavy], corners) if heavy.any() else 0.0
        return out
    centre = np.einsum("nk,nkd->nd", share, xyz) / total[:, None]
    r = xyz - centre[:, None]
    size = np.sqrt((r**2).sum(axis=2).max(axis=1))
    r = r / size[:, None, None]
    at, moved = r[:, corners:], share[:, :corners]
    A = np.concatenate([np.ones((*at.shape[:2], 1)), at], axis=2)
    weighted = A * (at**2).sum(axis=2)[..., None]
    wanted = np.concatenate(
        [moved.sum(axis=1)[:, None], np.einsum("nk,nkd->nd", moved, r[:, :corners])], axis=1
    )
    normal = np.linalg.pinv(transpose(A) @ weighted, rcond=1e-10, hermitian=True)
    taken = (weighted @ (normal @ wanted[..., None]))[..., 0]
    out = np.zeros_like(share)
    out[:, corners:] = np.maximum(share[:, corners:] + taken, 0.0)
    return np.asarray(out * (total / out.sum(axis=1))[:, None])
