"""A taut string with beads between two walls: the smallest structure that can lack something."""

from __future__ import annotations

import numpy as np
import scipy.linalg as la
import scipy.sparse as sp

from trueup.core.data.parametric_model import Factor, Term
from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Candidates
from trueup.core.discovery.effects.effect_laws import MassLaw, SpringLaw, TunedLaw
from trueup.core.discovery.likelihood.hypothesis import Prior, Problem
from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.likelihood.mode_likelihood import Evidence, Noise
from trueup.core.discovery.model_error.diffuse_fit import everything, judged
from trueup.core.discovery.reduction.search_basis import Basis
from trueup.core.discovery.search.moves import Searcher
from trueup.core.reduction.reduced_sum import ReducedSum

N = 32
X = np.arange(1, N + 1) / (N + 1.0)
K = (2.0 * np.eye(N) - np.eye(N, k=1) - np.eye(N, k=-1)) * (N + 1.0) ** 2
M = np.eye(N)
SEEN = np.arange(0, N, 2)


def hidden(tension=1.0, masses=(), springs=(), absorbers=()):
    """K and M of the truth; masses and springs are (bead, size), absorbers (bead, mass, Hz).

    The masses of the absorbers come after the beads.
    """
    k, m = la.block_diag(tension * K, np.zeros((len(absorbers),) * 2)), np.eye(N + len(absorbers))
    for own, (bead, size, hz) in enumerate(absorbers, N):
        stiffness = size * (2.0 * np.pi * hz) ** 2
        k[np.ix_([bead, own], [bead, own])] += stiffness * np.array([[1.0, -1.0], [-1.0, 1.0]])
        m[own, own] = size
    for bead, size in masses:
        m[bead, bead] += size
    for bead, size in springs:
        k[bead, bead] += size
    return k, m


def measured(truth, n_modes=12, scatter=(0.001, 0.01), seed=3):
    """Frequencies [Hz] and shapes at every other bead, with scatter of both."""
    rng = np.random.default_rng(seed)
    values, vectors = la.eigh(*truth)
    hz = np.sqrt(values[:n_modes]) / (2.0 * np.pi)
    hz = hz * np.exp(scatter[0] * rng.standard_normal(n_modes))
    shapes = vectors[SEEN, :n_modes]
    shapes = shapes + scatter[1] * rng.standard_normal(shapes.shape) / np.sqrt(N)
    return hz, shapes / np.linalg.norm(shapes, axis=0)


def searcher(truth, modes_out=(), n_modes=12, scatter=(0.001, 0.01), seed=3) -> Searcher:
    """A search for masses, springs and absorbers on the string, its tension a known parameter."""
    hz, shapes = measured(truth, n_modes, scatter, seed)
    whole = Evidence(hz, shapes, Noise(0.002, 0.03, float(len(SEEN)), 40.0, 1e-4))
    kept = ~np.isin(np.arange(n_modes), modes_out)
    values, vectors = la.eigh(K, M)
    lower, upper = 0.2, 5.0
    linear = Factor(0, ((lower + upper) / 2.0, (upper - lower) / 2.0), lower, upper)
    basis = Basis(
        vectors,
        vectors,
        ReducedSum((Term(sp.csr_matrix(K), (linear,)),), np.diag(values)[None]),
        ReducedSum((Term(sp.csr_matrix(M)),), np.eye(N)[None]),
    )
    xyz = np.column_stack([X, np.zeros(N), np.zeros(N)])
    where = tuple({"grids": [i + 1], "components": [1]} for i in range(N))
    root = sp.identity(N, format="csr")
    tuned = np.geomspace(0.93 * hz[0], 1.07 * hz[-1], 60)

    def of(kind, law, trials, typical, spread=(1.5,), **more):
        return Candidates(
            kind=KINDS[kind],
            xyz=xyz,
            law=law,
            trials=np.log(trials),
            root=root,
            rows_each=1,
            where=where,
            typical=np.log(typical),
            spread=np.array(spread),
            **more,
        )

    catalogue = (
        of("point_mass", MassLaw(), [[0.5], [1.0], [2.0], [4.0]], [1.0]),
        of("ground_spring", SpringLaw(np.zeros((N, 1))), [[50.0], [200.0], [800.0]], [200.0]),
        of(
            "tuned_absorber",
            TunedLaw(np.zeros((N, 1)), 0.0),
            [(m, hz) for m in (0.25, 0.5, 1.0, 2.0) for hz in tuned],
            [0.5, np.sqrt(tuned[0] * tuned[-1])],
            (1.0, 0.5 * np.log(tuned[-1] / tuned[0])),
            steps=np.array([1.0, 0.15]),
            lower=np.array([-np.inf, np.log(tuned[0])]),
            upper=np.array([np.inf, np.log(tuned[-1])]),
        ),
    )
    factors = tuple(c.factors(basis) for c in catalogue)
    prior = Prior(np.array([0.2, 1.0]), np.array([-1.0, -1.0]), np.array([1.0, 1.0]))
    problem = Problem(
        whole.take(kept, np.ones(len(SEEN), bool)),
        whole,
        basis,
        vectors[SEEN],
        vectors[SEEN],
        np.zeros((N, N)),
        catalogue,
        factors,
        prior,
        24,
        16,
    )
    every = tuple(np.arange(N) for _ in catalogue)
    return Searcher(problem, every, np.zeros(2), 1.0, by_the_whole_test)


def by_the_whole_test(problem, f, least=-np.inf):
    """Judge a hypothesis by the diffuse error: on a string every basis is the whole one."""
    whole = problem.entire()
    return judged(whole, evaluate(whole, f.nuisance, f.suspects), everything(whole))
