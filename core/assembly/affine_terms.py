"""Stiffness and mass of a model as sums of constant matrices times functions of the parameters."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats
from ..data.parametric_model import Factor, Term
from ..errors import CheckError
from ..numerics.interpolative_expansion import Expansion, expand
from .element_assembly import ElementBlock, Members, Recipe, assemble

_FITTED = 24
"""Elements of a kind that the functions are found on; as many others check them."""

Known = tuple[Floats, int, Expansion]
"""Bounds (2, k), kind (0 stiffness, 1 mass), functions."""

_ALLOWED = 1e-6
"""Error of an element's energy."""
_ALLOWED_MOVING = 1e-9
"""The same where its shape moves: rigid motions then count, which are many times the strains."""
_NEAR = 4
"""Power of the ratio of two energies by which the larger counts less."""
_TOLERANCE = 0.3
"""Of the error that is allowed, in the features that functions are found by."""


def parametric_terms(
    blocks: Sequence[ElementBlock], n_dof: int, lower: Floats, upper: Floats
) -> tuple[tuple[Term, ...], tuple[Term, ...]]:
    """Assemble stiffness and mass as terms.

    Parameters
    ----------
    blocks : sequence of ElementBlock
        Elements, each with the set of parameters that it depends on.
    n_dof : int
        Size of the matrices.
    lower, upper : (n_parameter,) float
        Bounds of the parameters; the terms hold between them to 1e-6 of the elements' energy,
        those of elements whose shape moves to 1e-9.

    Returns
    -------
    stiffness, mass : tuple of Term
        The constant term first.

    Raises
    ------
    CheckError
        A dependence that could not be expanded to this accuracy.
    """
    collected: tuple[dict[tuple[Factor, ...], sp.csr_matrix], ...] = ({(): None}, {(): None})
    known: list[Known] = []
    for parameters, members in _groups(blocks).items():
        terms = _group_terms(parameters, members, n_dof, lower, upper, known)
        for kind, (factors, matrix) in terms:
            before = collected[kind].get(factors)
            collected[kind][factors] = matrix if before is None else before + matrix
    zero = sp.csr_matrix((n_dof, n_dof))
    stiffness, mass = (
        tuple(Term(zero if m is None else m, f) for f, m in terms.items()) for terms in collected
    )
    return stiffness, mass


def _groups(blocks: Sequence[ElementBlock]) -> dict[tuple[int, ...], list[Members]]:
    """Elements by the set of parameters that they depend on, the constant ones first."""
    groups: dict[tuple[int, ...], list[Members]] = {(): []}
    for block in blocks:
        for k, parameters in enumerate(block.depends):
            rows = np.flatnonzero(block.depends_of == k)
            if len(rows):
                groups.setdefault(parameters, []).append(Members(block, rows))
    return groups


def _group_terms(
    parameters: tuple[int, ...],
    members: list[Members],
    n_dof: int,
    lower: Floats,
    upper: Floats,
    known: list[Known],
) -> list[tuple[int, tuple[tuple[Factor, ...], sp.csr_matrix]]]:
    """Terms (0 stiffness, 1 mass; factors; matrix) of elements with the same parameters."""
    everywhere = np.ones(len(lower))
    if not parameters:
        one = np.ones((1, 1))
        K, M = assemble(members, n_dof, Recipe(everywhere[None, :], one, one))
        return [(0, ((), K[0])), (1, ((), M[0]))]
    index = list(parameters)
    expansions = [_expansion(members, kind, parameters, lower, upper, known) for kind in (0, 1)]
    n_points = [len(e.points) for e in expansions]
    points = np.tile(everywhere, (sum(n_points), 1))
    points[:, index] = np.concatenate([e.points for e in expansions])
    weights = [np.zeros((len(e.series), len(points))) for e in expansions]
    weights[0][:, : n_points[0]] = expansions[0].weights
    weights[1][:, n_points[0] :] = expansions[1].weights
    matrices = assemble(members, n_dof, Recipe(points, weights[0], weights[1]))
    terms = []
    for kind in (0, 1):
        for product, matrix in zip(expansions[kind].series, matrices[kind], strict=True):
            factors = tuple(
                Factor(i, c, float(lower[i]), float(upper[i]))
                for i, c in zip(parameters, product, strict=True)
                if c is not None
            )
            terms.append((kind, (factors, matrix)))
    return terms


def _expansion(
    members: list[Members],
    kind: int,
    parameters: tuple[int, ...],
    lower: Floats,
    upper: Floats,
    known: list[Known],
) -> Expansion:
    """Find the functions on some elements of each kind and check them on others.

    Functions found before, for other parameters with the same bounds, are tried first.
    """
    index = list(parameters)
    low, high = lower[index], upper[index]
    generator = np.random.default_rng(20240229)
    chosen = [_pick(m, 2 * _FITTED, generator) for m in members]
    every = _Samples(chosen, kind, parameters, len(lower))
    fitted = _Samples([Members(m.block, m.rows[::2]) for m in chosen], kind, parameters, len(lower))
    checks = _check_points(low, high, generator)
    if not every.set_scale(checks):
        return Expansion((), np.zeros((0, len(index))), np.zeros((0, 0)))
    for bounds, other_kind, found in known:
        same = other_kind == kind and np.array_equal(bounds, [low, high])
        if same and _fits(found, every, checks, low, high):
            return found
    tolerance = every.tolerance
    for samples in (fitted, every, every):
        samples.set_scale(checks)
        found = expand(samples.features, low, high, tolerance)
        if _worst(found, every, checks, low, high) <= every.allowed:
            known.insert(0, (np.array([low, high]), kind, found))
            return found
        tolerance *= 1e-2 if samples is every else 1.0
    raise CheckError(
        f"the dependence of {members[0].block.name} on its parameters could not be expanded to "
        f"{every.allowed:g} over their bounds: give narrower bounds"
    )


def _fits(found: Expansion, samples: _Samples, points: Floats, low: Floats, high: Floats) -> bool:
    """Whether functions found for other elements hold for these, none of them in vain."""
    amounts = np.abs(found.weights @ samples.features(found.points)).max(axis=1)
    largest = np.abs(found.values(points, low, high)).max(axis=0)
    needed = bool((amounts * largest > samples.tolerance).all())
    return needed and _worst(found, samples, points, low, high) <= samples.allowed


def _pick(m: Members, n: int, generator: np.random.Generator) -> Members:
    rows = m.rows if len(m.rows) <= n else generator.choice(m.rows, n, replace=False)
    return Members(m.block, rows)


def _check_points(low: Floats, high: Floats, generator: np.random.Generator) -> Floats:
    """Both ends of all parameters, the ends of each, and points in between; (m, k)."""
    k = len(low)
    points = [np.ones(k), low, high]
    for i in range(k if k > 1 else 0):
        for corner, other in ((low, high), (high, low)):
            point = corner.copy()
            point[i] = other[i]
            points.append(point)
    inside = low + (high - low) * generator.random((6, k))
    return np.concatenate([np.array(points), inside])


@dataclass(eq=False)
class _Scale:
    """An element's matrix that gives the unit of energy, and the transformation to it."""

    unit: Floats
    W: Floats
    noise: Floats


class _Samples:
    """Some elements' matrices of one kind as functions of the parameters, scaled by energy."""

    def __init__(
        self, members: list[Members], kind: int, parameters: tuple[int, ...], n_parameter: int
    ) -> None:
        self._members = members
        self._kind = kind
        self._index = list(parameters)
        self._n = n_parameter
        self._scales: list[_Scale] = []
        self._known: dict[bytes, list[Floats]] = {}
        moving = any(m.block.shape_moves for m in members)
        self.allowed = _ALLOWED_MOVING if moving else _ALLOWED
        self.tolerance = _TOLERANCE * self.allowed

    def matrices(self, point: Floats) -> list[Floats]:
        """Matrices at one point, (k,): for each kind of element (n, m, m); kept."""
        tag = point.tobytes()
        if tag not in self._known:
            self._known[tag] = self._evaluated(point)
        return self._known[tag]

    def _evaluated(self, point: Floats) -> list[Floats]:
        p = np.ones(self._n)
        p[self._index] = point
        out = []
        wanted = (self._kind == 0, self._kind == 1)
        for m in self._members:
            values = m.block.evaluate(m.rows, p, wanted)[self._kind]
            out.append(np.zeros((len(m.rows), 0, 0)) if values is None else values)
        return out

    def set_scale(self, points: Floats) -> bool:
        """Take each element's energy where it is smallest as its unit; False when all is zero.

        Where its shape moves rigid motions do too: then it is the mean of those near the smallest.
        """
        trials = [self.matrices(p) for p in points]
        self._scales = []
        for k in range(len(self._members)):
            stack = np.stack([t[k] for t in trials])
            traces = np.abs(np.einsum("pnii->pni", stack)).sum(axis=2)
            unit = stack[np.argmin(traces, axis=0), np.arange(stack.shape[1])]
            if self._members[k].block.shape_moves:
                least = traces.min(axis=0)
                near = np.divide(least, traces, np.ones_like(traces), where=traces > 0.0) ** _NEAR
                unit = np.einsum("pn,pnij->nij", near / near.sum(axis=0), stack)
            W = _whitener(unit)
            largest = np.abs(stack).max(axis=(0, 2, 3), initial=0.0)
            noise = np.finfo(float).eps * largest * np.einsum("nij->n", W**2)
            self._scales.append(_Scale(unit, W, noise))
        return any(bool(m.any()) for t in trials for m in t)

    def energy(self, k: int, K: Floats) -> Floats:
        """Return what errors of elements of a kind are measured by beside their matrices `K`.

        Where their shape moves, motions that are rigid there alone count as elsewhere.
        """
        if not self._members[k].block.shape_moves:
            return K
        unit = self._scales[k].unit
        own, other = (np.abs(np.einsum("nii->ni", X)).sum(axis=1) for X in (K, unit))
        share = np.divide(own, other, np.zeros_like(own), where=other > 0.0)
        return np.asarray(K + share[:, None, None] * unit)

    def features(self, points: Floats) -> Floats:
        """Scaled matrix entries, (n_point, n_feature); entries below rounding shrunk to nothing."""
        rows = []
        for point in points:
            parts = []
            for scale, K in zip(self._scales, self.matrices(point), strict=True):
                upper = np.triu_indices(K.shape[1])
                scaled = scale.W.swapaxes(1, 2) @ K @ scale.W
                trust = np.minimum(1.0, self.tolerance / np.maximum(20.0 * scale.noise, 1e-300))
                parts.append((scaled[:, upper[0], upper[1]] * trust[:, None]).reshape(-1))
            rows.append(np.concatenate(parts))
        return np.stack(rows)


def _whitener(K: Floats) -> Floats:
    """W with W^T K W = 1 on the range of each K, (n, m, m); no column where K has no stiffness."""
    d = np.sqrt(np.abs(np.einsum("nii->ni", K)))
    d = np.where(d > 0.0, d, 1.0)
    values, vectors = np.linalg.eigh(K / d[:, :, None] / d[:, None, :])
    kept = np.abs(values) > 1e-10
    root = np.where(kept, 1.0 / np.sqrt(np.where(kept, np.abs(values), 1.0)), 0.0)
    return np.asarray(vectors * root[:, None, :] / d[:, :, None])


def _worst(found: Expansion, samples: _Samples, points: Floats, low: Floats, high: Floats) -> float:
    """Largest error in an element's energy, relative to its energy at the same point."""
    at_points = [samples.matrices(p) for p in found.points]
    values = found.values(points, low, high)
    worst = 0.0
    for k_point, point in enumerate(points):
        exact = samples.matrices(point)
        combined = values[k_point] @ found.weights
        for k, K in enumerate(exact):
            approximate = sum(
                (c * at[k] for c, at in zip(combined, at_points, strict=True)), np.zeros_like(K)
            )
            W = _whitener(samples.energy(k, K))
            difference = W.swapaxes(1, 2) @ (approximate - K) @ W
            error = np.abs(difference).max(axis=(1, 2), initial=0.0)
            noise = np.finfo(float).eps * np.abs(K).max(axis=(1, 2), initial=0.0)
            noise = noise * np.einsum("nij->n", W**2) * 100.0
            worst = max(worst, float(np.max(error - noise, initial=0.0)))
    return worst
