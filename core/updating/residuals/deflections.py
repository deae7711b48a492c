"""Displacements under static loads; no row where none were read."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ...data.parametric_model import Model
from ...errors import CheckError, InputError
from ...numerics.factorisation import NotDefinite, factorise
from ..updating_numbers import UPDATING
from .declaration import LoadCase, Residual, Seen, Slopes


@dataclass(frozen=True, eq=False)
class _Solved:
    """Of one load case: displacements, (n_free,), and those under unit loads at the readings."""

    case: LoadCase
    moved: Floats
    adjoint: Floats

    @property
    def largest(self) -> float:
        """What differences are relative to."""
        return float(np.abs(self.case.values).max())


@lru_cache(maxsize=2)
def _solved(
    model: Model, factors: tuple[float, ...], cases: tuple[LoadCase, ...]
) -> tuple[_Solved, ...]:
    try:
        K = model.K(np.array(factors))
        solve = factorise(K, True).solve
        done = tuple(_Solved(c, solve(c.load), solve(c.rows.toarray().T)) for c in cases)
        held = all(_balanced(K, s) for s in done)
    except (NotDefinite, CheckError):
        held = False
    if not held:
        raise InputError(
            "static deflections need a structure that is held: without its supports it moves off "
            "under the load"
        )
    return done


def _balanced(K: sp.csr_matrix, solved: _Solved) -> bool:
    load = solved.case.load
    off = np.abs(K @ solved.moved - load).max()
    return bool(off <= UPDATING.balance * np.abs(load).max())


def _of(seen: Seen) -> tuple[_Solved, ...]:
    cases = seen.beside.load_cases
    return _solved(seen.model, tuple(map(float, seen.factors)), cases) if cases else ()


def _value(seen: Seen) -> Floats:
    off = [(s.case.rows @ s.moved - s.case.values) / s.largest for s in _of(seen)]
    return np.asarray(np.concatenate([np.zeros(0), *off])[:, None])


def _derivative(seen: Seen, slopes: Slopes) -> Floats:
    changes = [seen.model.dK(k, seen.factors) for k in slopes.parameters]
    parts = [
        np.stack([-s.adjoint.T @ (dK @ s.moved) / s.largest for dK in changes], axis=-1)
        for s in _of(seen)
    ]
    return np.asarray(np.concatenate([np.zeros((0, len(changes))), *parts])[:, None, :])


DEFLECTIONS = Residual(
    "deflections", "deflection_sigma", UPDATING.deflection, _value, _derivative, stated=True
)
"""Differences of displacement over the largest reading of their load case."""
