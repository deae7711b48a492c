"""Derivatives of eigenvalues and mode shapes by the parameters, repeated eigenvalues included."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from ..arrays import Floats, Ints, Numbers
from ..data.parametric_model import Model
from ..eigen.normal_modes import Eigensolution
from ..errors import InputError
from .derivative_numbers import DERIVATIVES
from .eigenvector_derivatives import ShapeDerivatives


class Spectral(Protocol):
    """What a solution must have to be differentiated."""

    @property
    def eigenvalues(self) -> Floats:
        """Ascending, (n_mode,)."""
        ...

    @property
    def vectors(self) -> Floats:
        """Mass-orthonormal, (n, n_mode)."""
        ...

    @property
    def rigid_body_modes(self) -> int:
        """How many of the first modes are rigid-body modes."""
        ...


class Sensitivities(NamedTuple):
    """Values and derivatives, one row per mode.

    Parameters
    ----------
    values : (n,) float
        Eigenvalues, (rad/s)^2; of a combination its Rayleigh quotient.
    slopes : (n, n_parameter) float
        Their derivatives.
    shapes : (n_sensor, n, n_parameter) float or None
        Derivatives of the mass-normalised shapes at the sensors.
    """

    values: Floats
    slopes: Floats
    shapes: Floats | None


def sensitivities(
    model: Model,
    p: Floats,
    solution: Eigensolution,
    modes: Sequence[int] | Ints | Floats,
    parameters: Sequence[int],
    shapes_at: sp.spmatrix | Floats | None = None,
    *,
    tolerance: float = DERIVATIVES.tolerance,
) -> Sensitivities:
    """Differentiate modes, or fixed combinations of the modes of a cluster.

    A mode j apart from all others has (Fox and Kapoor 1968)

        dlambda_j = phi_j^T (K' - lambda_j M') phi_j
        (K - lambda_j M) dphi_j = -(K' - lambda_j M' - dlambda_j M) phi_j,
        phi_j^T M dphi_j = -phi_j^T M' phi_j / 2.

    Modes of a cluster Phi_c (repeated eigenvalues, or modes that a column of `modes` combines)
    are differentiated as a subspace. Its derivative is the part of the solution above outside
    Phi_c, plus -Phi_c (Phi_c^T M' Phi_c) / 2, which keeps it mass-orthonormal and adds no
    rotation within. Combinations with fixed coefficients follow linearly.

    Parameters
    ----------
    model : Model
    p : (n_parameter,) float
        Where `solution` was found.
    solution : Eigensolution
        At `p`; some modes more than those differentiated make it fast and well determined.
    modes : (n,) int, or (n_mode, n) float
        Positions in `solution`; or one column of coefficients for each wanted shape, nonzero
        only within one cluster.
    parameters : sequence of int
        Positions in ``model.parameters``.
    shapes_at : (n_sensor, n_free) sparse or dense, optional
        Rows of the shapes that are wanted; without it only eigenvalues are differentiated.
    tolerance : float
        Relative accuracy of the static solves for the shapes.

    Returns
    -------
    Sensitivities
        For eigenvalues repeated to 1e-5 and given by position, `slopes` are for each parameter the
        eigenvalues, ascending, of the cluster's derivative matrix (Mills-Curran 1988; Dailey
        1989): the slopes of the branches that leave the common value, which in general belong
        to a different rotation of the modes for each parameter. For combinations they are the
        quotients t^T G t / t^T t of that matrix,
        G_i = Phi^T K' Phi - (Phi^T M' Phi Lambda + Lambda Phi^T M' Phi) / 2.

    Raises
    ------
    InputError
        A mode or parameter that does not exist, or a mode that cannot be told from those above
        the last of `solution`.

    Notes
    -----
    The part of each shape derivative outside all modes of `solution` comes from conjugate
    gradients on their M-orthogonal complement, where K - lambda M is positive definite,
    preconditioned by the factor of K - s M with s near lambda; so nearly repeated pairs, where
    Nelson's method loses its accuracy, do no harm.
    """
    T, by_position = coefficients(modes, len(solution.eigenvalues))
    _check(model, solution, parameters, shapes_at)
    changes = [(model.dK(i, p), model.dM(i, p)) for i in parameters]
    change_of = None
    if shapes_at is not None:
        static = ShapeDerivatives(model, p, solution, tolerance)
        change_of = partial(static.of, changes=changes)
    matrices_of = partial(_derivative_matrices, changes, solution)
    size = len(changes)
    return differentiate(T, by_position, solution, size, matrices_of, shapes_at, change_of)


def differentiate(
    T: Floats,
    by_position: bool,
    solution: Spectral,
    n_parameter: int,
    matrices_of: Callable[[Ints], Floats],
    shapes_at: Any | None,
    change_of: Callable[[Ints], Floats] | None,
) -> Sensitivities:
    """Put together the derivatives of clusters, as `sensitivities` says.

    Parameters
    ----------
    T : (n_mode, n) float
        Coefficients of the wanted shapes.
    by_position : bool
        Whether each column of `T` is one mode.
    solution : Eigensolution or the like
        ``eigenvalues``, ``vectors`` and ``rigid_body_modes``.
    n_parameter : int
    matrices_of : callable
        Derivative matrices of a cluster, (n_parameter, n_cluster, n_cluster).
    shapes_at : (n_sensor, n) sparse or dense, or None
    change_of : callable or None
        Derivative of the vectors of a cluster, (n, n_cluster, n_parameter).

    Returns
    -------
    Sensitivities
    """
    size = np.sum(T**2, axis=0)
    slopes = np.zeros((T.shape[1], n_parameter))
    shapes = None if shapes_at is None else np.zeros((shapes_at.shape[0], *slopes.shape))
    for cluster in clusters(T, solution):
        columns = np.flatnonzero(T[cluster].any(axis=0))
        t = T[np.ix_(cluster, columns)]
        G = matrices_of(cluster)
        if by_position and len(cluster) > 1:
            rank = np.searchsorted(cluster, np.argmax(T[:, columns], axis=0))
            slopes[columns] = np.linalg.eigvalsh(G)[:, rank].T
        else:
            slopes[columns] = np.einsum("ac,iab,bc->ci", t, G, t) / size[columns, None]
        if shapes_at is not None and shapes is not None and change_of is not None:
            change = change_of(cluster)
            seen = np.asarray(shapes_at @ change.reshape(len(change), -1))
            seen = seen.reshape(-1, len(cluster), n_parameter)
            shapes[:, columns] = np.einsum("sai,ac->sci", seen, t)
    return Sensitivities(solution.eigenvalues @ T**2 / size, slopes, shapes)


def clusters(T: Floats, solution: Spectral) -> Iterator[Ints]:
    """Positions of the modes, ascending, that must be differentiated together.

    Modes that share a column of T (n_mode, n) belong together, and so do repeated eigenvalues and
    the rigid-body modes. Groups without any entry are left out.
    """
    lam = solution.eigenvalues
    near = np.diff(lam) <= DERIVATIVES.repeated * np.abs(lam[1:])
    near[: max(solution.rigid_body_modes - 1, 0)] = True
    follow = sp.diags(near.astype(float), 1, shape=(len(lam), len(lam)))
    together = sp.csr_matrix(T != 0.0, dtype=float)
    count, label = connected_components(follow + together @ together.T, directed=False)
    for k in range(count):
        group = np.flatnonzero(label == k)
        if T[group].any():
            yield group


def _derivative_matrices(
    changes: Sequence[tuple[Any, Any]], solution: Spectral, cluster: Ints
) -> Floats:
    X, lam = solution.vectors[:, cluster], solution.eigenvalues[cluster]
    G = np.zeros((len(changes), len(cluster), len(cluster)))
    for i, (dK, dM) in enumerate(changes):
        g = X.T @ (dK @ X) - (X.T @ (dM @ X)) * lam
        G[i] = (g + g.T) / 2.0
    return G


def coefficients(modes: Sequence[int] | Numbers, count: int) -> tuple[Floats, bool]:
    """Return columns of coefficients, (count, n), and whether positions were given."""
    given = np.asarray(modes)
    if given.ndim == 2:
        if given.shape[0] != count:
            raise InputError(f"coefficients for {given.shape[0]} modes, the solution has {count}")
        if not np.isfinite(given).all() or not np.any(given, axis=0).all():
            raise InputError("a combination of modes is empty or not finite")
        return given.astype(np.float64), False
    if given.size and not (given.min() >= 0 and given.max() < count):
        raise InputError(f"mode {int(given.max()) + 1} was asked for, the solution has {count}")
    T = np.zeros((count, given.size))
    T[given.astype(int), np.arange(given.size)] = 1.0
    return T, True


def _check(
    model: Model,
    solution: Eigensolution,
    parameters: Sequence[int],
    shapes_at: sp.spmatrix | Floats | None,
) -> None:
    if solution.vectors.shape[0] != model.n_free:
        raise InputError(
            f"the solution has {solution.vectors.shape[0]} degrees of freedom, "
            f"the model {model.n_free}"
        )
    if shapes_at is not None and shapes_at.shape[1] != model.n_free:
        raise InputError(
            f"the sensors look at {shapes_at.shape[1]} degrees of freedom of {model.n_free}"
        )
    known = len(model.parameters)
    for i in parameters:
        if not 0 <= i < known:
            raise InputError(f"parameter {i} does not exist, the model has {known}")
