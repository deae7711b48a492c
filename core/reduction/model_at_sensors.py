"""A model reduced to the sensors of a test: the test-analysis model, and test shapes expanded."""

from dataclasses import dataclass

import numpy as np
import scipy.linalg as sl
import scipy.sparse as sp

from ..arrays import Floats
from ..errors import InputError
from ..noun import Noun
from ..numerics.factorisation import factorise
from .derivative_numbers import DERIVATIVES

METHODS = ("serep", "guyan", "irs")


@dataclass(frozen=True, eq=False)
class ModelAtSensors(Noun):
    """A model in terms of what its sensors read.

    Parameters
    ----------
    method : {"serep", "guyan", "irs"}
    expansion : (n_free, n_sensor) float
        Motion of the whole model for readings of the sensors: of test shapes, too.
    stiffness, mass : (n_sensor, n_sensor) float
    """

    method: str
    expansion: Floats
    stiffness: Floats
    mass: Floats


def require_method(method: str) -> None:
    """Refuse what is no method of reduction (`InputError`)."""
    if method not in METHODS:
        raise InputError(f"reduction is '{method}'; give one of {', '.join(METHODS)}")


def reduce_to_sensors(
    method: str,
    K: sp.csr_matrix,
    M: sp.csr_matrix,
    sensors: sp.csr_matrix,
    modes: Floats,
    rigid: int,
) -> ModelAtSensors:
    """Reduce a model to the sensors of a test.

    Sensors may read any direction, and between grids: where they are degrees of freedom these are
    the well-known methods.

    - ``serep``: the motions of `modes`, those that fit the readings best. O'Callahan, Avitabile,
      Riemer (1989), *System equivalent reduction expansion process*, IMAC VII.
    - ``guyan``: the least strain energy. Guyan (1965), AIAA Journal 3(2), 380. Rigid-body motions
      that no sensor sees stay at rest.
    - ``irs``: the same with the forces of inertia. O'Callahan (1989), *A procedure for an improved
      reduced system (IRS) model*, IMAC VII.

    Parameters
    ----------
    method : {"serep", "guyan", "irs"}
    K, M : (n_free, n_free) sparse
    sensors : (n_sensor, n_free) sparse
    modes : (n_free, n_mode) float
        Mass-normalised; the first `rigid` of them are the rigid-body modes, all there are.

    Raises
    ------
    InputError
        No such method; SEREP of more modes than the sensors tell apart.
    """
    require_method(method)
    if method == "serep":
        T = _by_modes(sensors, modes)
    else:
        T = _by_energy(K, M, sensors, modes[:, :rigid], method == "irs")
    return ModelAtSensors(method, T, T.T @ (K @ T), T.T @ (M @ T))


def _by_modes(sensors: sp.csr_matrix, modes: Floats) -> Floats:
    seen = np.asarray(sensors @ modes)
    known = np.linalg.matrix_rank(seen, DERIVATIVES.told_apart * np.linalg.norm(seen, 2))
    if known < modes.shape[1]:
        raise InputError(
            f"the sensors tell {known} of {modes.shape[1]} modes apart, too few for SEREP: "
            "let fewer modes take part, or reduce by guyan or irs"
        )
    return np.asarray(modes @ np.linalg.pinv(seen))


def _by_energy(
    K: sp.csr_matrix, M: sp.csr_matrix, sensors: sp.csr_matrix, rigid: Floats, inertia: bool
) -> Floats:
    """Minimise uᵀKu with C u as read.

    The sensors as springs to ground change the energy by what is given, and make K definite; so
    do springs that hold what no sensor sees, in as many points as there is: they carry no force.
    """
    stiff, power = K.diagonal(), np.asarray(sensors.multiply(sensors).sum(axis=1)).ravel()
    power = np.where(power > 0.0, power, 1.0)
    spring = np.asarray(sensors.multiply(sensors) @ stiff) / power**2
    scale = np.sqrt(np.where(spring > 0.0, spring, stiff.max()))
    C = sp.csr_matrix(sp.diags(scale) @ sensors)
    _, size, turn = np.linalg.svd(C @ rigid)
    seen = np.count_nonzero(size > DERIVATIVES.told_apart * size.max(initial=0.0))
    unseen = rigid @ turn[seen:].T
    held = np.zeros(K.shape[0])
    if unseen.shape[1]:
        rows = sl.qr((np.sqrt(stiff)[:, None] * unseen).T, pivoting=True, mode="r")[1]
        held[rows[: unseen.shape[1]]] = stiff[rows[: unseen.shape[1]]]
    factor = factorise(sp.csr_matrix(K + C.T @ C + sp.diags(held)), None)

    def at_rest(u: Floats) -> Floats:
        return np.asarray(u - unseen @ (unseen.T @ (M @ u)))

    W = factor.solve(C.T.toarray())
    inverse = np.linalg.pinv(C @ W, DERIVATIVES.dependent, hermitian=True)
    T = at_rest(W @ inverse)
    if inertia:
        given = factor.solve(M @ T)
        mass = np.linalg.pinv(T.T @ (M @ T), DERIVATIVES.dependent, hermitian=True)
        T = T + at_rest(given - T @ (C @ given)) @ (mass @ (T.T @ (K @ T)))
    return np.asarray(T * scale)
