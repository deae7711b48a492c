"""A hypothesis on a basis of its own: one whose mass is negative is none."""

from types import SimpleNamespace as Some

import numpy as np
import pytest
from tests.core.discovery.strings import hidden, searcher

from trueup.core.discovery.likelihood.map_fit import evaluate
from trueup.core.discovery.search import own_basis as room
from trueup.core.errors import CheckError


def completed(monkeypatch, mesh_error):
    p = searcher(hidden()).problem
    state = evaluate(p, np.append(np.zeros(len(p.prior.spread) - 1), 0.0), ())
    seen, mesh = p.everywhere, np.eye(p.basis.size)
    own = Some(better=p.basis, seen=seen, mesh=Some(whole=[mesh]), factors=())
    own.bars = Some(matrices=np.zeros((0, p.basis.size, p.basis.size)))
    own.added = np.zeros((len(p.basis.vectors), 0))
    monkeypatch.setattr(room, "_known", lambda *_: own)
    ground = Some(structure=Some(supports=None), at_supports=np.zeros((len(seen), 0)))
    ground.seen, ground.basis = np.ones(len(seen), bool), p.basis
    state.nuisance[-1] = mesh_error
    return room.complete_model(ground, p, state)


def test_a_completed_model_has_modes_of_its_own(monkeypatch):
    assert completed(monkeypatch, 0.0).eigenvalues[0] > 0.0


def test_a_completed_model_with_a_negative_mass_is_refused(monkeypatch):
    with pytest.raises(CheckError, match="negative mass"):
        completed(monkeypatch, 1.0e6)


def test_no_more_bases_are_kept_than_memory_is_for(monkeypatch):
    """The oldest goes, and is made again where it is asked for."""
    made = []
    monkeypatch.setattr(room, "_own", lambda _, places, __: made.append(places) or places)
    ground, kept = Some(known={}), room.SEARCH.bases_kept
    for k in range(kept + 1):
        room._known(ground, (k,), 1)
    room._known(ground, (kept,), 1)
    assert len(ground.known) == kept
    assert len(made) == kept + 1
    assert room._known(ground, (0,), 1) == (0,)
    assert len(made) == kept + 2
