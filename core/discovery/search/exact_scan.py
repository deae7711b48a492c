"""Every place and size of one kind of effect, evaluated exactly on a small basis."""

import numpy as np

from ...arrays import Floats, Ints
from ...numerics.products import stacked_product
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.mode_likelihood import least_sums, mode_squares
from .search_numbers import SEARCH


def scan(problem: Problem, state: Fit, kind: int, rows: Ints, trials: Floats) -> Floats:
    """Misfit (n, n_trial) with one more suspect at every place and size, all else as it stands.

    The problem stands on a basis that holds the lowest modes of `state`, which on its own modes is
    diagonal; `kind` is the number in the catalogue, `rows` (n,) are places, `trials` (n_trial, t)
    or (n, n_trial, t) values of θ, the same everywhere or for each place. Each entry is an exact
    solution of the changed eigenproblem on the basis.
    """
    if not len(rows):
        return np.empty((0, trials.shape[-2]))
    U, law = problem.part(kind, rows, state.nuisance)
    own = state.vectors[: problem.basis.size]
    U = stacked_product(U, own)
    lam = np.maximum(state.eigenvalues, 0.0)
    trials = np.broadcast_to(trials, (len(rows), *trials.shape[-2:]))
    out = np.empty(trials.shape[:2])
    seen = problem.sensors @ own
    S2 = seen.T @ seen
    cross = problem.evidence.shapes.T @ seen
    n = min(problem.columns, len(lam))
    for start in range(0, len(rows), SEARCH.at_once):
        part = slice(start, start + SEARCH.at_once)
        u = U[part]
        places, alike = np.arange(len(U))[part], _gram(u)
        for j in range(trials.shape[1]):
            at = trials[part, j]
            c = law.value(at, places)
            if law.on == "A":
                values, Z = _attached(lam, u, c, 1.0 / law.flexibility(at, places))
            else:
                added = c[:, :, None] * alike if c.shape[1] == 1 else _gram(u, c)
                values, Z = _changed(lam, added, law.on)
            values, Z = values[:, :n], Z[:, :, :n]
            gram = np.matmul(Z.transpose(0, 2, 1), S2 @ Z)
            squares = mode_squares(problem.evidence, values, cross @ Z, gram)
            out[part, j] = least_sums(squares, problem.evidence.noise.robust)
    return out


def _gram(u: Floats, c: Floats | float = 1.0) -> Floats:
    """Return uᵀ c u of rows u (g, q, n), each times one of c (g, q), (g, n, n)."""
    return np.asarray(np.matmul((u * np.asarray(c)[..., None]).transpose(0, 2, 1), u))


def _changed(lam: Floats, added: Floats, on: str) -> tuple[Floats, Floats]:
    """Eigenpairs of diag(lam) + A or of the pencil (diag(lam), I + A), A `added` (g, n, n).

    Batched. The pencil is solved for the reciprocals of its eigenvalues, with a shift where there
    are rigid-body modes, whose share in each eigenvalue is taken off again.
    """
    if on == "K":
        return tuple(np.linalg.eigh(added + np.diag(lam)))  # type: ignore[return-value]
    shift = max(SEARCH.nil * lam[-1] - lam[0], 0.0)
    root = 1.0 / np.sqrt(lam + shift)
    e, Y = np.linalg.eigh(added * (root * root[:, None]) + np.diag(root**2))
    values = 1.0 / e[:, ::-1]
    Z = root[:, None] * Y[:, :, ::-1] * np.sqrt(values)[:, None, :]
    return values - shift * np.sum(Z**2, axis=1), Z


def _attached(lam: Floats, u: Floats, m: Floats, k: Floats) -> tuple[Floats, Floats]:
    """Eigenpairs of diag(lam) with masses m (g, 1) on springs k (g, q) at rows u, batched.

    The vectors are those of the structure, without the rows of the masses.
    """
    g, q, n = u.shape
    A = np.zeros((g, n + q, n + q))
    A[:, :n, :n] = _gram(u, k) + np.diag(lam)
    A[:, n:, :n] = -u * (k / np.sqrt(m))[:, :, None]  # what is above the diagonal is not read
    A[:, np.arange(n, n + q), np.arange(n, n + q)] = k / m
    values, Z = np.linalg.eigh(A)
    return values, Z[:, :n]


def best_apart(xyz: Floats, score: Floats, distance: float, count: int) -> list[int]:
    """Return indices of the best scores that are at least `distance` apart, best first."""
    kept: list[int] = []
    for i in np.argsort(score, kind="stable"):
        if not np.isfinite(score[i]):
            break
        if all(np.linalg.norm(xyz[i] - xyz[j]) > distance for j in kept):
            kept.append(int(i))
        if len(kept) >= count:
            break
    return kept
