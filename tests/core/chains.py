"""Chains of masses and springs, whose modes are known in closed form."""

import numpy as np
import scipy.sparse as sp

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.parametric_model import Factor, Model, Term


def chain(n, k=1.0, m=1.0, ground=0.0):
    """Springs in a row, free ends, each mass on a soft spring to ground."""
    K = k * sp.diags([-np.ones(n - 1), 2.0 * np.ones(n), -np.ones(n - 1)], [-1, 0, 1]).tolil()
    K[0, 0] = K[-1, -1] = k
    return (K + ground * sp.identity(n)).tocsr(), m * sp.identity(n, format="csr")


def chain_exact(n, k=1.0, m=1.0):
    return 4.0 * k / m * np.sin(np.pi * np.arange(n) / (2.0 * n)) ** 2


def scalar_model(K, M):
    """The same matrices as a model of scalar points, without any geometry."""
    n = K.shape[0]
    dofs = Dofs(np.arange(1, n + 1), np.ones(n, int))
    none = Geometry(np.zeros(0, int), np.zeros((0, 3)))
    return Model(none, dofs, sp.identity(n, format="csr"), (Term(K),), (Term(M),))


def proportional(parameter: int, lower: float, upper: float) -> Factor:
    """Return the factor that equals its parameter."""
    return Factor(parameter, ((lower + upper) / 2.0, (upper - lower) / 2.0), lower, upper)
