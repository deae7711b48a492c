"""What a fit says of known parameters beside the error of the mesh: a string lumped at beads."""

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest
from tests.core.discovery.strings import M, N, hidden, searcher

from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search import refit_own_basis as room

LUMPING = 0.05 * (2.0 * np.eye(N) - np.eye(N, k=1) - np.eye(N, k=-1))
"""Lumped less consistent mass: by half of it the highest measured mode is 2.9 % too low."""
SHARE = 0.7


def known(monkeypatch, tension, told=True):
    """Return what a string is known to have: on a mesh whose error is `told`, or is not."""
    k, _ = hidden(tension)
    p = searcher((k, M - SHARE * LUMPING)).problem
    V = p.basis.vectors
    mesh = V.T @ LUMPING @ V if told else np.zeros((N, N))
    p = replace(p, mesh=mesh, catalogue=(), factors=())
    state = evaluate(p, np.zeros(len(p.prior.spread)), ())
    own = Some(problem=p, start=(), bars=np.zeros((N, N)))
    monkeypatch.setattr(room, "complete_model", lambda *_: own)
    return room.for_deck(None, p, state)


def test_what_the_mesh_leaves_is_no_tension(monkeypatch):
    found = known(monkeypatch, 1.0)
    assert found.clear.tolist() == [False]
    assert found.together[0] == pytest.approx(0.0, abs=2.0 * found.deviation[0])
    assert known(monkeypatch, 1.0, told=False).clear.tolist() == [True]


def test_a_tension_that_is_off_is_known_as_far_as_it_is(monkeypatch):
    found = known(monkeypatch, 1.06)
    assert found.clear.tolist() == [True]
    assert found.alone[0] == pytest.approx(np.log(1.06), abs=2.0 * found.deviation[0])
    assert found.deviation[0] < 0.01


def test_how_much_too_low_the_mesh_makes_frequencies_is_told(monkeypatch):
    """Of n half waves by 1 - cos(n π / (N + 1)) of the pattern, known to its own size over √12."""
    n = np.arange(1, 13)
    lumped = np.mean(0.05 * (1.0 - np.cos(n * np.pi / (N + 1))))
    off = known(monkeypatch, 1.0).mesh
    assert off == pytest.approx(SHARE * lumped, abs=lumped / np.sqrt(len(n)))
    assert known(monkeypatch, 1.0, told=False).mesh == 0.0
