"""A chain of masses on springs whose groups are parameters, and what a test of it gives."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp
from tests.core.chains import proportional

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.parameter import Parameter
from trueup.core.data.parametric_model import Model, Term
from trueup.core.eigen.normal_modes import solve
from trueup.core.updating.update import Target

N = 8
HALVES = (range(4), range(4, 8))


def chain(groups, kinds=None, n=N, stiffness=1e4, mass=2.0, **limits) -> Model:
    """Masses in a row on springs, the first one to ground; each group of springs (or masses)
    is a parameter."""
    kinds = kinds or ["k"] * len(groups)

    def spring(i):
        K = sp.lil_matrix((n, n))
        K[i, i] = stiffness
        if i:
            K[i - 1, i - 1], K[i - 1, i], K[i, i - 1] = stiffness, -stiffness, -stiffness
        return K.tocsr()

    def point(i):
        return sp.csr_matrix(([mass], ([i], [i])), (n, n))

    terms = {"k": [], "m": []}
    for which, part in (("k", spring), ("m", point)):
        left = set(range(n))
        for q, (group, kind) in enumerate(zip(groups, kinds, strict=True)):
            if kind == which and group:
                terms[which].append(Term(sum(part(i) for i in group), (proportional(q, 0.1, 10),)))
                left -= set(group)
        if left:
            terms[which].append(Term(sum(part(i) for i in left)))
    return Model(
        Geometry(np.arange(1, n + 1), np.outer(np.arange(n), [1.0, 0.0, 0.0])),
        Dofs(np.arange(1, n + 1), np.ones(n, int)),
        sp.identity(n, format="csr"),
        tuple(terms["k"]),
        tuple(terms["m"]),
        tuple(Parameter(f"{k}{q}", (k,), (1.0,), **limits) for q, k in enumerate(kinds)),
    )


def measured(model: Model, truth, modes=slice(0, 6), noise=0.0, seed=0, sensors=None) -> Target:
    """What a test of the model with other factors gives, shapes scaled at random."""
    sensors = sp.identity(model.n_free, format="csr") if sensors is None else sensors
    solution = solve(model, n_modes=min(model.n_free, 30), p=np.array(truth, float))
    rng = np.random.default_rng(seed)
    chosen = np.arange(len(solution.eigenvalues))[modes]
    hz = np.sqrt(np.maximum(solution.eigenvalues, 0.0))[chosen] / (2.0 * np.pi)
    shapes = np.asarray(sensors @ solution.vectors[:, chosen])
    return Target(
        hz * (1.0 + noise * rng.standard_normal(len(hz))),
        shapes * rng.uniform(0.1, 10.0, len(hz)) * rng.choice([-1, 1], len(hz)),
        sensors,
    )
