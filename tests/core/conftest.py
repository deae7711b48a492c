"""Structures with known answers, built without any file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.sparse as sp
from tests.core.chains import proportional

from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.parameter import Parameter
from trueup.core.data.parametric_model import Model, Term
from trueup.core.numerics.factorisation import best_backend


@dataclass(frozen=True)
class Section:
    """A round tube or any section with equal bending in both planes; SI units."""

    E: float = 2.1e11
    nu: float = 0.3
    rho: float = 7850.0
    A: float = 4e-4
    I2: float = 2e-8
    J: float = 4e-8


def bar_matrices(start, end, s: Section):
    """Euler-Bernoulli bar, consistent mass with rotatory inertia of torsion, (12, 12) each."""
    d = end - start
    L = np.linalg.norm(d)
    x = d / L
    y = np.cross(x, np.eye(3)[np.argmin(np.abs(x))])
    y /= np.linalg.norm(y)
    T = np.kron(np.eye(4), np.vstack([x, y, np.cross(x, y)]))
    K, M = np.zeros((12, 12)), np.zeros((12, 12))
    pair = np.array([[1.0, -1.0], [-1.0, 1.0]])
    both = np.array([[2.0, 1.0], [1.0, 2.0]]) / 6.0
    K[np.ix_([0, 6], [0, 6])] = s.E * s.A / L * pair
    K[np.ix_([3, 9], [3, 9])] = s.E / (2.0 * (1.0 + s.nu)) * s.J / L * pair
    m = s.rho * s.A * L
    M[np.ix_([0, 6], [0, 6])] = m * both
    M[np.ix_([3, 9], [3, 9])] = s.rho * s.J * L * both
    k = np.array(
        [[12, 6 * L, -12, 6 * L], [6 * L, 4 * L**2, -6 * L, 2 * L**2],
         [-12, -6 * L, 12, -6 * L], [6 * L, 2 * L**2, -6 * L, 4 * L**2]]
    )  # fmt: skip
    h = np.array(
        [[156, 22 * L, 54, -13 * L], [22 * L, 4 * L**2, 13 * L, -3 * L**2],
         [54, 13 * L, 156, -22 * L], [-13 * L, -3 * L**2, -22 * L, 4 * L**2]]
    )  # fmt: skip
    for rows, sign in (([1, 5, 7, 11], 1.0), ([2, 4, 8, 10], -1.0)):
        flip = np.diag([1.0, sign, 1.0, sign])
        K[np.ix_(rows, rows)] = s.E * s.I2 / L**3 * flip @ k @ flip
        M[np.ix_(rows, rows)] = m / 420.0 * flip @ h @ flip
    return T.T @ K @ T, T.T @ M @ T


def build_frame(
    xyz,
    bars,
    section: Section = Section(),
    *,
    fixed: Sequence[tuple[int, int]] = (),
    springs: Sequence[tuple[int, int, float]] = (),
    masses: Sequence[tuple[int, float]] = (),
    pins: Sequence[tuple[int, int]] = (),
    lumped: bool = False,
    parameters: Sequence[tuple[str, Sequence[int]]] = (),
) -> Model:
    """A frame of bars with the neutral `Model` around it.

    `fixed` (node, component) removed; `springs` (node, component, stiffness) to ground; `masses`
    (node, mass); `pins` (bar, component 4..6) rotations that the bar's first end does not hand
    to its node, in basic axes, by a node of its own; `parameters` ("E" | "rho", bars).
    """
    xyz, bars = np.asarray(xyz, float), [tuple(b) for b in bars]
    n = len(xyz)
    own = {pin: 6 * n + k for k, pin in enumerate(pins)}
    size = 6 * n + len(own)
    parts = []
    for b, (i, j) in enumerate(bars):
        dof = [*range(6 * i, 6 * i + 6), *range(6 * j, 6 * j + 6)]
        dof[:6] = [own.get((b, c + 1), dof[c]) for c in range(6)]
        k, m = bar_matrices(xyz[i], xyz[j], section)
        if lumped:
            half = section.rho * section.A * np.linalg.norm(xyz[j] - xyz[i]) / 2.0
            m = np.diag(np.tile([half] * 3 + [0.0] * 3, 2))
        parts.append((dof, k, m))

    def total(which, chosen):
        matrix = sp.lil_matrix((size, size))
        for b in chosen:
            matrix[np.ix_(parts[b][0], parts[b][0])] += parts[b][which]
        return matrix.tocsr()

    keep = np.setdiff1d(np.arange(size), [6 * i + c - 1 for i, c in fixed])
    ground, points = np.zeros(size), np.zeros(size)
    for i, c, k in springs:
        ground[6 * i + c - 1] += k
    for i, m in masses:
        points[6 * i : 6 * i + 3] += m
    take = sp.identity(size, format="csr")[keep]

    def term(matrix, *factors):
        return Term((take @ matrix @ take.T).tocsr(), factors)

    stiffness, mass, named = [], [], []
    left = {1: set(range(len(bars))), 2: set(range(len(bars)))}
    for q, (kind, chosen) in enumerate(parameters):
        which = 1 if kind == "E" else 2
        factor = proportional(q, 0.2, 5.0)
        (stiffness if which == 1 else mass).append(term(total(which, chosen), factor))
        left[which] -= set(chosen)
        named.append(Parameter(f"{kind} {q}", (kind,), (1.0,)))
    stiffness.append(term(total(1, sorted(left[1])) + sp.diags(ground)))
    mass.append(term(total(2, sorted(left[2])) + sp.diags(points)))
    twins = sorted({b for b, _ in own})  # a node of its own for each pinned end
    ids = np.arange(1, n + len(twins) + 1)
    node = np.concatenate([np.repeat(ids[:n], 6), [n + 1 + twins.index(b) for b, _ in own]])
    component = np.concatenate([np.tile(np.arange(1, 7), n), [c for _, c in own]])
    labels = [f"{i}:{c}" for i, c in zip(node.astype(int), component.astype(int), strict=True)]
    return Model(
        Geometry(ids, np.vstack([xyz, *(xyz[[bars[b][0]]] for b in twins)])),
        Dofs(node.astype(int), component.astype(int)),
        sp.identity(size, format="csr")[:, keep],
        tuple(stiffness),
        tuple(mass),
        tuple(named),
        tuple(labels[i] for i in keep),
    )


def build_ring(n: int, radius: float = 0.5, **options) -> Model:
    """A closed circular ring of `n` bars: every bending mode comes twice."""
    a = 2.0 * np.pi * np.arange(n) / n
    xyz = radius * np.column_stack([np.cos(a), np.sin(a), np.zeros(n)])
    return build_frame(xyz, [(i, (i + 1) % n) for i in range(n)], **options)


def build_line(n: int, length: float = 1.0, **options) -> Model:
    """A straight beam of `n` bars along x: both bending planes alike."""
    xyz = np.outer(np.linspace(0.0, length, n + 1), [1.0, 0.0, 0.0])
    return build_frame(xyz, [(i, i + 1) for i in range(n)], **options)


def build_membrane(n: int, tension: float = 1.0, mass: float = 1.0):
    """A square net of strings with fixed edge, (K, M, exact eigenvalues): many come twice."""
    one = sp.diags([-np.ones(n - 1), 2.0 * np.ones(n), -np.ones(n - 1)], [-1, 0, 1])
    K = tension * (sp.kron(one, sp.identity(n)) + sp.kron(sp.identity(n), one)).tocsr()
    s = 4.0 * np.sin(np.pi * np.arange(1, n + 1) / (2.0 * (n + 1))) ** 2
    exact = np.sort((tension / mass * (s[:, None] + s)).ravel())
    return K, mass * sp.identity(n * n, format="csr"), exact


@pytest.fixture
def frame() -> Callable[..., Model]:
    return build_frame


@pytest.fixture
def ring() -> Callable[..., Model]:
    return build_ring


@pytest.fixture
def line() -> Callable[..., Model]:
    return build_line


@pytest.fixture
def membrane():
    return build_membrane


@pytest.fixture
def section() -> Section:
    return Section()


@pytest.fixture(params=["pardiso", "superlu"])
def backend(request):
    """Every direct solver in turn; the optional one only where it is installed."""
    if request.param == "pardiso" and best_backend() != "pardiso":
        pytest.skip("the optional mkl package is not installed")
    return request.param
