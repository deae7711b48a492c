"""Close modes: grouped, and rotated onto the shapes that the test measured.

The eigenvectors of a repeated eigenvalue are any mass-orthonormal basis of their subspace, and
those of nearly repeated ones turn freely under the smallest change of the model. Compared one by
one with measured shapes they look wrong although the subspace is right. Equations (8)–(10) of
the source paper: each test shape is written as a least-squares combination of the cluster, the
test shapes that the cluster explains best are taken, and the whole cluster is transformed onto
them at once by an orthogonal matrix, which keeps it mass-orthonormal.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..noun import Noun
from .mac import mac


def combinations(cluster: Floats, test: Floats) -> Floats:
    """Coefficients of each test shape in the cluster, equation (8).

    Parameters
    ----------
    cluster : (n_sensor, m) float
        Mass-normalised analysis shapes of one cluster.
    test : (n_sensor, n_test) float

    Returns
    -------
    (m, n_test) float
        The least-squares solution of ``cluster @ coefficients = test``.
    """
    return np.asarray(np.linalg.lstsq(cluster, test, rcond=None)[0])


def subspace_mac(cluster: Floats, test: Floats) -> Floats:
    """MAC of each test shape with its best combination of the cluster, equation (9).

    Returns
    -------
    (n_test,) float
        The squared cosine of the angle between the test shape and the cluster's span; for a
        cluster of one it is the MAC.
    """
    basis = np.linalg.qr(cluster)[0]
    total = np.sum(test**2, axis=0)
    inside = np.sum((basis.T @ test) ** 2, axis=0)
    return np.asarray(np.divide(inside, total, out=np.zeros_like(total), where=total > 0.0))


@dataclass(frozen=True, eq=False)
class ClusterRotation(Noun):
    """How a cluster is turned onto its test shapes.

    `matrix` (m, m) is orthogonal; its first columns belong, in order, to the test shapes
    `test` (indices), further columns complete the basis.
    """

    matrix: Floats
    test: tuple[int, ...]


def rotate_cluster(
    cluster: Floats, test: Floats, candidates: tuple[int, ...], mac_min: float = 0.0
) -> ClusterRotation:
    """Transform a whole cluster onto its test shapes at once, equation (10).

    Parameters
    ----------
    cluster : (n_sensor, m) float
        Mass-normalised analysis shapes.
    test : (n_sensor, n_test) float
        Test shapes, any scaling.
    candidates : tuple of int
        Columns of `test` that the cluster should explain, at most m.
    mac_min : float
        Where two measured shapes compete for the same direction, the one that the orthogonal
        transformation leaves below this MAC is dropped and the others are fitted again.

    Returns
    -------
    ClusterRotation
        The orthogonal matrix closest to the normalised combinations (Procrustes; Schönemann
        1966), so the turned shapes stay mass-orthonormal.
    """
    kept = list(candidates)
    size = cluster.shape[1]
    while kept:
        a = combinations(cluster, test[:, kept])
        a = a / np.linalg.norm(a, axis=0)
        u, _, vt = np.linalg.svd(a)
        k = len(kept)
        matrix = np.hstack([u[:, :k] @ vt, u[:, k:]])
        got = np.diag(mac(cluster @ matrix[:, :k], test[:, kept]))
        worst = int(np.argmin(got))
        if k == 1 or got[worst] >= mac_min:
            return ClusterRotation(_closest_to_identity(matrix, k), tuple(kept))
        del kept[worst]
    return ClusterRotation(np.eye(size), ())


def _closest_to_identity(matrix: Floats, fixed: int) -> Floats:
    """Turn the completing columns as little as the fixed ones allow."""
    free = matrix[:, fixed:]
    if free.shape[1] == 0:
        return matrix
    target = np.eye(len(matrix))[:, np.argsort(np.sum(matrix[:, :fixed] ** 2, axis=1))]
    target = target[:, : free.shape[1]]
    u, _, vt = np.linalg.svd(free.T @ target)
    return np.hstack([matrix[:, :fixed], free @ (u @ vt)])


def clusters_by_bandwidth(frequencies_hz: Floats, width: float) -> tuple[tuple[int, ...], ...]:
    """Group neighbouring frequencies so that no group spans more than a relative bandwidth.

    The closest neighbours are joined first (complete linkage), so a chain of evenly spaced
    modes is not swallowed whole and a true pair is never split to serve a looser one.

    Parameters
    ----------
    frequencies_hz : (n_mode,) float
        In any order; zeros (rigid-body modes) and NaN are left out.
    width : float
        Largest (f_last − f_first) / f_last within a group; 0 joins nothing.

    Returns
    -------
    tuple of tuple of int
        Mode indices, each used once, groups and members by rising frequency; groups of one
        included.
    """
    f = np.asarray(frequencies_hz, dtype=float)
    order = [int(i) for i in np.argsort(f, kind="stable") if np.isfinite(f[i]) and f[i] > 0.0]
    groups = [[i] for i in order]
    while len(groups) > 1 and width > 0.0:
        first = np.array([f[g[0]] for g in groups])
        last = np.array([f[g[-1]] for g in groups])
        span = (last[1:] - first[:-1]) / last[1:]
        k = int(np.argmin(span))
        if span[k] > width:
            break
        groups[k : k + 2] = [groups[k] + groups[k + 1]]
    return tuple(tuple(g) for g in groups)
