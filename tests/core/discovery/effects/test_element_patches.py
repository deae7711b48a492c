"""Patches on sheets, and the root of a patch's matrix."""

from itertools import pairwise

import numpy as np

from trueup.adapters.nastran import read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.discovery.effects.element_patches import patches_of, root_of

ROUND, DEEP = 8, 6


def test_a_patch_is_on_one_sheet_which_may_be_round_not_on_the_web_behind_it(tmp_path):
    """An arch of eight flat facets, its ends joined by a plate with which it shares their sides."""
    turn = np.pi * np.arange(ROUND + 1) / ROUND
    place = np.column_stack([np.cos(turn), np.sin(turn)]) * 60.0
    flat = np.column_stack([np.linspace(60.0, -60.0, ROUND + 1), np.zeros(ROUND + 1)])
    n = ROUND + 1
    cards = "MAT1,1,70000.,,0.3,2.7-9\nPSHELL,1,1,3.,1,,1\n"
    for j in range(DEEP + 1):
        for i, (x, z) in enumerate([*place, *flat[1:-1]]):
            cards += f"GRID,{1 + i + 100 * j},,{x:.4f},{10.0 * j},{z:.4f}\n"
    ring = [*range(1, n + 1)], [1, *range(n + 1, 2 * n - 1), n]
    arch = []
    for line in ring:
        for a, b in pairwise(line):
            for j in range(DEEP):
                number = 1 + len(arch)
                arch.append(line is ring[0])
                low, high = 100 * j, 100 * (j + 1)
                cards += f"CQUAD4,{number},1,{a + low},{b + low},{b + high},{a + high}\n"
    path = tmp_path / "arch.bdf"
    path.write_text(f"CEND\nBEGIN BULK\n{cards}ENDDATA\n")
    structure = build_structure(read_deck(path))
    (m,) = structure.members
    patches = patches_of(structure, 150.0, (0.1, 0.22))
    on_arch = [set(np.array(arch)[m.ids[p.rows] - 1]) for p in patches]
    assert all(len(s) == 1 for s in on_arch)
    assert {True} in on_arch
    assert {False} in on_arch
    assert max(len(set((p.rows // DEEP).tolist())) for p in patches) > 2


def test_a_root_leaves_next_to_nothing_of_a_patch():
    spread = np.geomspace(1.0, 1e-9, 40)
    Q, _ = np.linalg.qr(np.random.default_rng(2).normal(size=(40, 40)))
    A = (Q * spread) @ Q.T
    U = root_of(A)
    left = np.linalg.eigvalsh(A - U.T @ U)
    assert len(U) < 30
    assert np.trace(A - U.T @ U) < 40 * 1e-5 * np.trace(A)
    assert left[0] > -1e-12


def test_a_root_of_a_few_elements_is_exact():
    W = np.random.default_rng(3).normal(size=(5, 40))
    U = root_of(W.T @ W)
    assert U.shape == (5, 40)
    np.testing.assert_allclose(U.T @ U, W.T @ W, atol=1e-10)
