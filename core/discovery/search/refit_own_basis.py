"""Fit a hypothesis once more on a basis made for it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...arrays import Floats
from ...errors import CheckError
from ..effects import support_flexibility
from ..effects.candidates import Suspect
from ..effects.effect_numbers import EFFECTS
from ..likelihood.elimination import InDeck, in_deck
from ..likelihood.hypothesis import Fit, Problem
from ..likelihood.map_fit import evaluate, fit
from ..likelihood.mode_likelihood import Evidence, targets
from ..model_error.beside_fields import with_drift, with_known
from ..model_error.diffuse_fit import Judged, everything
from ..model_error.model_error_numbers import MODEL_ERROR
from ..model_error.set_up_fields import suspension
from ..model_error.smooth_fields import Fields
from ..reduction.search_basis import structural
from .found import noise_scale
from .own_basis import Ground, complete_model
from .search_numbers import SEARCH


def polished(ground: Ground, problem: Problem, state: Fit) -> Fit:
    """Return the fit with parameters and magnitudes fitted on a basis of its own.

    The laws of the problem's catalogue are not yet fitted to any basis. A support that gives
    follows the known parameters by its slopes alone, so it is made anew where they came to stand.
    """
    for _ in range(SEARCH.made_anew):
        own = complete_model(ground, problem, state)
        every = everything(own.problem)
        new = fit(own.problem, state.nuisance, own.start, every, SEARCH.steps_polished)
        before, state = state, replace(new, suspects=_back(state, new))
        if _follows(problem, before, state):
            break
    return state


def _follows(problem: Problem, before: Fit, after: Fit) -> bool:
    """Whether what gives has followed the known parameters from one fit to another."""
    moved = float(np.max(np.abs(after.log_p - before.log_p), initial=0.0))
    kinds = (problem.catalogue[s.kind].kind for s in after.suspects)
    return moved < SEARCH.followed or support_flexibility.KIND not in kinds


def solves(ground: Ground, problem: Problem, state: Fit) -> bool:
    """Whether the model completed by a fit has no negative stiffness."""
    try:
        complete_model(ground, problem, state)
    except CheckError:
        return False
    return True


def completed_modes(ground: Ground, problem: Problem, state: Fit) -> tuple[Floats, Floats]:
    """Return modes of a completed model on all analysis dofs (n_dof, n), their eigenvalues (n,).

    Beside an effect they move as the basis of the search cannot: a support that gives.
    """
    own = complete_model(ground, problem, state)
    free = sum(V @ T for V, T in own.parts(own.moved))
    out = np.asarray(ground.structure.model.expansion @ free)
    supports = ground.structure.supports
    if supports is not None:
        out += supports.motion @ (own.give @ own.moved)
    return out, own.eigenvalues


def for_deck(ground: Ground, problem: Problem, state: Fit) -> InDeck:
    """Return the known parameters of a fit for a deck, the effects as found.

    A mesh is off in each frequency by about what lumping does to it: a share of that is alike in
    all modes and moves along, and as much again in each of them is no evidence of a modulus or a
    thickness.
    """
    own = complete_model(ground, problem, state)
    own_state = replace(state, suspects=own.start)
    known, found = _in_deck(_beside_mesh(own.problem, own_state), own_state)
    share = found.nuisance[-1]
    lumped = _lowered(share * own.problem.mesh - own.bars, found)
    return replace(known, mesh=float(np.mean(lumped)))


def by_model_error(
    ground: Ground, problem: Problem, state: Fit, moving: bool = True, least: float = -np.inf
) -> Judged:
    """Return a fit as the whole test and the diffuse error judge it, on modes of its own.

    Parameters, what set-up and mesh do and smooth fields of stiffness and mass move along; no
    fields where they could not bring it to the evidence `least`; where nothing is `moving`, the
    error of the mesh alone. Supports that give are made anew where the parameters came to stand.
    """
    if not moving:
        m = modal(ground, problem, state)
        found = with_known(m.problem, m.state, everything(m.problem)[-1:], m.coarse)
        return _on_problem(state, found)
    for _ in range(SEARCH.made_anew):
        m = modal(ground, problem, state)
        found = _on_problem(state, with_drift(m.problem, m.state, m.known, m.smooth, least))
        before, there = state, found.fit
        state = replace(before, nuisance=there.nuisance, suspects=there.suspects)
        if _follows(problem, before, state):
            break
    return found


def _on_problem(state: Fit, found: Judged) -> Judged:
    """Return what was found on a basis of its own with suspects where a fit has them."""
    return replace(found, fit=replace(found.fit, suspects=_back(state, found.fit)))


@dataclass(frozen=True, eq=False)
class Modal:
    """A hypothesis on modes of its own, the whole test its evidence.

    Parameters
    ----------
    problem, state : Problem, Fit
    parts : tuple of ((n_free, q), (q, r)) float
        Bases and what the modes are on each.
    coarse, known, smooth : Fields
        The error of the mesh; that and what the set-up does; smooth fields.
    """

    problem: Problem
    state: Fit
    parts: tuple[tuple[Floats, Floats], ...]
    coarse: Fields
    known: Fields
    smooth: Fields

    @cached_property
    def vectors(self) -> Floats:
        """The modes, (n_free, r)."""
        return np.asarray(sum(V @ T for V, T in self.parts))


def modal(ground: Ground, problem: Problem, state: Fit) -> Modal:
    """Return a fit on modes of its own."""
    own = complete_model(ground, problem, state)
    T = structural(*np.split(own.modes, [own.give.shape[1]]))
    small = own.problem.turned(T).entire()
    here = evaluate(small, state.nuisance, own.start)
    coarse, sensors, smooth = (f.turned(T) for f in (ground.coarse, ground.sensors, ground.fields))
    known = coarse.and_also(sensors)
    if np.count_nonzero(here.eigenvalues < SEARCH.rigid * here.eigenvalues.max()) >= 6:
        M, lowest = small.basis.M(np.exp(state.log_p)), float(targets(small.whole).min())
        known = known.and_also(suspension(M, smooth, lowest))
    return Modal(small, here, own.parts(T), coarse, known, smooth)


def _back(state: Fit, own: Fit) -> tuple[Suspect, ...]:
    """Return suspects at their places with the magnitudes that were fitted."""
    both = zip(state.suspects, own.suspects, strict=True)
    return tuple(replace(s, theta=t.theta) for s, t in both)


def _lowered(M: Floats, f: Fit) -> Floats:
    """Return by how much a mass (r, r) more lowers ln f of modes that match the test, (n_test,)."""
    V = f.vectors[: len(M), f.match]
    return np.asarray(0.5 * np.sum(V * (M @ V), axis=0))


def _beside_mesh(problem: Problem, state: Fit) -> Problem:
    """Return a problem that expects of each frequency to be off by what lumping does to it."""

    def unsure(p: Problem) -> Evidence:
        lowered = _lowered(p.mesh, evaluate(p, state.nuisance, state.suspects))
        noise = p.evidence.noise
        wide = np.hypot(noise.frequency, MODEL_ERROR.mesh * lowered)
        return replace(p.evidence, noise=replace(noise, frequency=wide))

    return replace(problem, evidence=unsure(problem), whole=unsure(problem.entire()))


def _in_deck(own: Problem, found: Fit) -> tuple[InDeck, Fit]:
    """Return the known parameters of a fit for a deck, its effects held as they are; the fit."""
    free = fit(own, found.nuisance, found.suspects, everything(own), SEARCH.steps_polished)
    scale = noise_scale(own, free)
    n = len(found.log_p)
    known = in_deck(free.log_p, free.information, scale, own.prior.spread[:n])
    held = tuple(
        replace(c, typical=np.array(s.theta), spread=np.full(len(s.theta), EFFECTS.held))
        for c, s in zip(own.catalogue, found.suspects, strict=True)
    )
    moving = (*np.flatnonzero(known.clear).tolist(), n)
    start = np.append(known.alone, free.nuisance[n])
    alone = fit(replace(own, catalogue=held), start, found.suspects, moving, SEARCH.steps_polished)
    return replace(known, alone=alone.log_p), alone
