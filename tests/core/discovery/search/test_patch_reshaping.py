"""A patch takes the shape of what is there: a membrane that is soft over a part of it."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.linalg as la
import scipy.sparse as sp
from tests.core.discovery.strings import by_the_whole_test

from trueup.core.data.parametric_model import Term
from trueup.core.discovery.effects import KINDS
from trueup.core.discovery.effects.candidates import Suspect
from trueup.core.discovery.effects.effect_laws import FactorLaw
from trueup.core.discovery.effects.element_patches import Patch, on_patches
from trueup.core.discovery.likelihood.hypothesis import Prior, Problem
from trueup.core.discovery.likelihood.map_fit import fit
from trueup.core.discovery.likelihood.mode_likelihood import Evidence, Noise
from trueup.core.discovery.reduction.elements_and_supports import Structure
from trueup.core.discovery.reduction.search_basis import Basis
from trueup.core.discovery.search.credible_places import Place, alike, middle
from trueup.core.discovery.search.last_look import looked_again
from trueup.core.discovery.search.model_selection import scored
from trueup.core.discovery.search.moves import Searcher
from trueup.core.discovery.search.patch_reshaping import reshaped, variants
from trueup.core.elements.surfaces.quad4 import QUAD4
from trueup.core.reduction.reduced_sum import ReducedSum

NX, NY = 11, 8
FACTOR = 0.4
_MASS = np.tile([0.25, 0.25, 0.25, 0.0, 0.0, 0.0], 4)
_ELEMENT = np.array([[4, -1, -2, -1], [-1, 4, -1, -2], [-2, -1, 4, -1], [-1, -2, -1, 4]]) / 6.0


def grid():
    """Corners (n, 4) and nodes of square elements, numbered along x first."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(NX), np.arange(NY)))
    first = j * (NX + 1) + i
    x, y = (a.ravel() for a in np.meshgrid(np.arange(NX + 1.0), np.arange(NY + 1.0)))
    corners = np.stack([first, first + 1, first + NX + 2, first + NX + 1], axis=1)
    return corners, np.column_stack([x, y, 0.0 * x])


def box(x, y):
    """Elements with their lower left corners from x[0] to x[1] - 1, likewise y."""
    i, j = np.meshgrid(np.arange(*x), np.arange(*y))
    return np.sort((j * NX + i).ravel())


def membrane(property_of=None):
    """A square membrane held at its rim; each node moves in z."""
    corners, xyz = grid()
    n = len(corners)
    K = np.zeros((n, 24, 24))
    across = 6 * np.arange(4) + 2
    K[:, across[:, None], across] = _ELEMENT
    rim = (xyz[:, 0] % NX == 0) | (xyz[:, 1] % NY == 0)
    free = np.flatnonzero(~rim)
    displacement = sp.csr_matrix(
        (np.ones(len(free)), (6 * free + 2, np.arange(len(free)))), (6 * len(xyz), len(free))
    )
    at = (6 * corners[:, :, None] + np.arange(6)).reshape(n, 24)
    member = SimpleNamespace(
        element=QUAD4,
        ids=np.arange(1, n + 1),
        corners=corners,
        block=SimpleNamespace(
            width=6, depends_of=np.zeros(n, int) if property_of is None else property_of
        ),
        stiffness=lambda rows, p: K[rows],
        mass=lambda rows, p: np.tile(np.diag(_MASS), (len(rows), 1, 1)),
        coordinates=lambda rows: at[rows],
    )
    geometry = SimpleNamespace(ids=np.arange(1, len(xyz) + 1), xyz=xyz)
    model = SimpleNamespace(deck_point=np.ones(0), geometry=geometry, n_free=len(free))
    return Structure(model, (member,), displacement)


def stiffness(structure, soft=()):
    """The stiffness of the membrane, less over some elements."""
    m = structure.members[0]
    own = m.stiffness(np.arange(len(m.ids)), None).copy()
    own[list(soft)] *= FACTOR
    D = structure.displacement.toarray()
    u = D[m.coordinates(np.arange(len(m.ids)))]
    return np.einsum("eir,eij,ejs->rs", u, own, u)


def suspecting(structure, soft, start):
    """A search on the test of a soft membrane, with one patch in its catalogue, and its fit."""
    middle = structure.centroids(structure.members[0])[start].mean(axis=0)
    catalogue = on_patches(
        KINDS["local_stiffness"],
        structure,
        [Patch(0, start, middle, True)],
        FactorLaw(),
        np.log([[0.3], [0.6]]),
        (np.zeros(1), np.array([1.2])),
    )
    s = searching(structure, stiffness(structure, soft), 0.0, catalogue)
    return s, fit(s.problem, np.zeros(1), (Suspect(0, 0, (np.log(0.5),)),), (0,), 10)


def searching(structure, K, added, catalogue):
    """A search on the test of a membrane with another stiffness and mass."""
    values, vectors = la.eigh(stiffness(structure))
    n, modes = len(values), 12
    found, shapes = la.eigh(K, np.eye(n) + added)
    seen = np.arange(0, n, 2)
    test = shapes[seen, :modes] / np.linalg.norm(shapes[seen, :modes], axis=0)
    e = Evidence(np.sqrt(found[:modes]) / (2.0 * np.pi), test, Noise(0.002, 0.03, 20.0, 40.0, 1e-4))
    basis = Basis(
        vectors,
        vectors,
        ReducedSum((Term(sp.csr_matrix(stiffness(structure))),), np.diag(values)[None]),
        ReducedSum((Term(sp.identity(n, format="csr")),), np.eye(n)[None]),
    )
    prior = Prior(np.ones(1), -np.ones(1), np.ones(1))
    factors = tuple(c.factors(basis) for c in catalogue)
    problem = Problem(
        e, e, basis, vectors[seen], vectors[seen], np.zeros((n, n)), catalogue, factors, prior,
        40, 20,
    )  # fmt: skip
    every = tuple(np.arange(len(c)) for c in catalogue)
    size = float(np.hypot(NX, NY))
    return Searcher(problem, every, np.zeros(1), size, by_the_whole_test)


@pytest.mark.parametrize("start", [box((4, 6), (3, 5)), box((2, 8), (1, 6)), box((3, 4), (2, 7))])
def test_a_patch_grows_and_shrinks_into_what_is_soft(start):
    soft = box((3, 7), (2, 5))
    s, state = suspecting(membrane(), soft, start)
    wide, better = reshaped(s, state)
    suspect = better.suspects[0]
    c = wide.problem.catalogue[0]
    assert c.where[suspect.row]["elements"] == (soft + 1).tolist()
    assert np.exp(suspect.theta[0]) == pytest.approx(FACTOR, rel=0.05)
    assert better.objective < 0.1 * state.objective


def test_a_patch_that_is_right_stays():
    soft = box((3, 7), (2, 5))
    s, state = suspecting(membrane(), soft, soft)
    assert reshaped(s, state) == (s, state)


def test_rows_are_taken_on_each_side():
    structure = membrane()
    own = box((4, 6), (3, 5))
    found = {tuple(p.rows) for p in variants(structure, Patch(0, own, np.zeros(3), True))}
    for x, y in (
        ((3, 6), (3, 5)), ((4, 7), (3, 5)), ((4, 6), (2, 5)), ((4, 6), (3, 6)),
        ((5, 6), (3, 5)), ((4, 6), (3, 4)), ((3, 7), (2, 6)),
    ):  # fmt: skip
        assert tuple(box(x, y)) in found


def test_the_corners_of_a_round_patch_are_filled():
    cross = np.union1d(box((4, 7), (3, 4)), box((5, 6), (2, 5)))
    found = variants(membrane(), Patch(0, cross, np.array([5.5, 3.5, 0.0]), True))
    assert box((4, 7), (2, 5)).tolist() in [p.rows.tolist() for p in found]


def test_a_patch_grows_along_both_sides_at_once():
    structure = membrane()
    start = box((4, 6), (2, 5))
    found = {p.rows.tobytes() for p in variants(structure, Patch(0, start, np.zeros(3), False))}
    assert {box((3, 7), (2, 5)).tobytes(), box((4, 6), (1, 6)).tobytes()} <= found
    assert box((4, 6), (3, 4)).tobytes() in found


@pytest.mark.parametrize("each", [10.0, 0.3])
def test_the_shape_of_what_gives_is_told_by_the_error_of_the_model_not_by_the_misfit(each):
    start, told = box((4, 6), (3, 5)), box((3, 7), (2, 5))
    s, state = suspecting(membrane(), start, start)

    def judged(problem, f, _=0.0):
        patches = problem.catalogue[0].patches
        wrong = sum(len(np.setxor1d(patches[t.row].rows, told)) for t in f.suspects)
        left = SimpleNamespace(error=0.001, noise=0.02, each=np.zeros(12))
        likely = -each * wrong
        return SimpleNamespace(evidence=likely, bare=likely, diffuse=left, fit=f)

    s = replace(s, judged=judged)
    wide, tried = looked_again(s, scored(s, state), 0.0)
    best = max(tried, key=lambda t: t.judged.evidence).fit
    assert wide.problem.catalogue[0].where[best.suspects[0].row]["elements"] == (told + 1).tolist()
    assert best.objective > state.objective
    rows = {t.fit.suspects[0].row for t in tried}
    assert len({repr(wide.problem.catalogue[0].where[row]) for row in rows}) == len(rows)
    _, places = alike((*tried, tried[0]), tried[0], 0)
    assert len({p.suspect.row for p in places}) == len(places)
    assert len(places) == 1 or each < 1.0
    assert sum(p.weight for p in places) == pytest.approx(1.0)


def test_a_larger_shape_starts_from_a_lesser_change():
    start = box((4, 6), (3, 5))
    s, state = suspecting(membrane(), start, start)
    left = SimpleNamespace(error=0.001, noise=0.02, each=np.zeros(12))

    def judged(problem, f, _=0.0):
        return SimpleNamespace(evidence=0.0, bare=0.0, diffuse=left, fit=f)

    s = replace(s, judged=judged)
    wide, tried = looked_again(s, scored(s, state), 0.0)
    where = wide.problem.catalogue[0].where
    does = [len(where[t.row]["elements"]) * t.theta[0] for f in tried for t in f.fit.suspects]
    assert does == pytest.approx(len(does) * [does[0]])


def test_a_patch_may_end_with_its_property():
    left = np.tile(np.arange(NX) >= 5, NY).astype(int)
    own = box((3, 7), (2, 5))
    found = variants(membrane(left), Patch(0, own, np.zeros(3), True))
    shapes = {tuple(p.rows) for p in found}
    assert tuple(box((3, 5), (2, 5))) in shapes
    assert tuple(box((5, 7), (2, 5))) in shapes


def test_the_middle_of_shapes_as_likely_is_the_one_that_does_the_middling():
    """What a patch gains in area it loses in strength."""
    start = box((4, 6), (3, 5))
    s, state = suspecting(membrane(), start, start)
    patches = s.problem.catalogue[0]
    sizes = {-2.0: 0.4, -1.1: 0.25, -1.0: 0.3, 0.3: 0.05}
    places = [Place(Suspect(0, state.suspects[0].row, (t,)), w) for t, w in sizes.items()]
    assert places[middle(patches, places)].suspect.theta == (-1.1,)
