"""Whether the model completed by what was found bears the verdict out."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ...correlation.comparison import Comparison, Placed
from ...correlation.mode_pairing import Correlation
from ...data.dofs import Dofs
from ...eigen.normal_modes import Eigensolution
from ...errors import TrueupError
from ..discovery_numbers import DISCOVERY
from ..effects import KINDS, local_damper
from ..faults import corrected, lost
from ..findings import Discovery, MovedParameter
from ..narrative.narrative_numbers import NARRATIVE
from ..narrative.sentences import effects_said
from ..search.search_numbers import SEARCH
from .screening_numbers import SCREENING


@dataclass(frozen=True, eq=False)
class SolvedModel:
    """A model compared with the test: the comparison, its solution, D or None without dashpots."""

    compared: Comparison
    solution: Eigensolution
    damping: sp.csr_matrix | None


C = TypeVar("C")
_FINER = (
    "a finer mesh: this one may well leave what frequencies are off by, and known parameters "
    "may; the test alone does not tell which"
)


def upheld(found: Discovery, complete: Callable[[Discovery], C]) -> tuple[Discovery, C]:
    """Complete the model; withdraw the verdict where it cannot be: the model as it came solves."""
    try:
        return found, complete(found)
    except TrueupError as error:
        if not found.adopted:
            raise
        why = f"a deck that solves: completed as found, {error}"
        found = _in_doubt(found, why, proposal=False)
        return found, complete(found)


def borne_out(
    found: Discovery,
    before: Correlation,
    after: Correlation,
    lowered: Floats,
    tests: int,
    readings: int,
) -> Discovery:
    """Return what was found as far as its completed deck and what was measured bear it out.

    What brings its deck no nearer to the test is nothing that was found. Nearer is: more modes
    pair, or those that pair both times deviate less in frequency, a share of what lumping does to
    each apart: the mesh stays. By so much, `lowered` (n_mode,), are ln f of the modes of the model
    as it came too low. Dashpots show in the damping. Nor is anything said to be complete of
    which most of the `tests`, the modes that take part, pair with nothing, or of which too little
    was measured, by so many `readings` of each mode, to tell. What is as far off as its mesh may
    be has a gap, which known parameters explain as well.
    """
    damped = any(f.kind == local_damper.KIND.name for f in found.findings)
    more = len(after.pairs) - len(before.pairs)
    helps = more > 0 or _left(before, after, lowered) < 1.0
    if found.verdict != "effect" and not any(f.kind in KINDS for f in found.findings):
        moved = any(m.written != 1.0 for m in found.parameters)
        if moved and more <= 0 and not _nearer(before, after):
            found = _or_a_mesh(found)
        found = _seen_in_pairs(found, len(after.pairs), tests, readings, helps)
        return _near_in_pairs(_as_far_off_as_a_mesh(found, before), after)
    return found if helps or damped or not found.completes else _withdrawn(found)


def _nearer(before: Correlation, after: Correlation) -> bool:
    """Whether the modes that pair both times deviate less in frequency, or clearly in shape."""
    both = {p.test for p in before.pairs} & {p.test for p in after.pairs}
    was, now = ([p for p in c.pairs if p.test in both] for c in (before, after))
    off, far = (sum(abs(p.deviation_percent) for p in pairs) for pairs in (now, was))
    apart, unlike = (sum(1.0 - p.mac for p in pairs) for pairs in (now, was))
    return off < far or apart < SCREENING.alike * unlike


def _left(before: Correlation, after: Correlation, lowered: Floats) -> float:
    """Return what is left of the deviations in frequency of the modes that pair both times."""
    was, now = ({p.test: p.deviation_percent / 100.0 for p in c.pairs} for c in (before, after))
    mesh = {p.test: lowered[p.analysis] for p in before.pairs if p.test in now}
    by_mesh = np.array(list(mesh.values()))
    whole = _beside_mesh(np.array([was[k] for k in mesh]), by_mesh)
    return _beside_mesh(np.array([now[k] for k in mesh]), by_mesh) / whole if whole else 1.0


def _beside_mesh(deviations: Floats, by_mesh: Floats) -> float:
    """Return the sum of deviations beside the share of what lumping does that lessens it most."""
    low, high = DISCOVERY.mesh_bounds
    best = -deviations[by_mesh > 0.0] / by_mesh[by_mesh > 0.0]
    shares = np.clip(np.append(best, 0.0), low, high)
    return float(np.abs(deviations + shares[:, None] * by_mesh).sum(axis=1).min())


def _withdrawn(found: Discovery) -> Discovery:
    """Return what was found without effects that explain nothing."""
    effects = [f for f in found.findings if f.kind in KINDS]
    said = effects_said([f.kind for f in effects], [f.where.region or "" for f in effects])
    why = (
        f"what brings a completed deck nearer to the test: with {said} "
        "no mode more pairs and no frequency is less off"
    )
    rest = tuple(f for f in found.findings if f.kind not in KINDS)
    return replace(_in_doubt(found, why, proposal=False), findings=rest)


def _seen_in_pairs(
    found: Discovery, pairs: int, tests: int, readings: int, helps: bool
) -> Discovery:
    """Return what was found, in doubt where hardly a mode of the test pairs, or hardly any is.

    A mode that pairs tells its frequency and what its shape says, less that it has to be one of
    the model's; known parameters that explain the test and one effect are fitted to as much.
    """
    moved = len(found.parameters) if found.adopted else 0
    values = pairs * (int(min(readings, SEARCH.per_mode)) - 1)
    if pairs < SCREENING.pairs * tests:
        why = (
            f"a test of which more modes pair than {pairs} of {tests}: see whether its sensors "
            "lie on the model where they were, in the directions they measured"
        )
        return _in_doubt(found, why, proposal=found.adopted and helps)
    if values <= SCREENING.effect + moved:
        known = f", and {moved} known parameters move" if moved else ""
        why = (
            f"more modes or more sensors: those that pair ({pairs}, read in {readings} "
            f"directions) tell {values} values beside which modes of the model they are; one effect"
            f" has {SCREENING.effect} unknowns, where it is and how large{known}: what is missing "
            "may not show in so little"
        )
        return _in_doubt(found, why, proposal=False)
    return found


def _as_far_off_as_a_mesh(found: Discovery, before: Correlation) -> Discovery:
    """Return what was found, with a gap where frequencies are off by more than tests repeat by.

    That nothing is missing was said since the mesh explains them. So do known parameters: none of
    these is known to be off, each may as well be as in the deck.
    """
    off = [abs(p.deviation_percent) / 100.0 for p in before.pairs]
    if found.verdict != "no_gap" or not off or np.mean(off) <= SCREENING.repeats:
        return found
    return _or_a_mesh(replace(found, verdict="parameters_only"))


def _near_in_pairs(found: Discovery, after: Correlation) -> Discovery:
    """Return what was found, in doubt where a mode that pairs is off by more than any mesh is.

    So few sensors tell shapes apart no more, or something is missing that the search has not.
    """
    off = max((abs(p.deviation_percent) / 100.0 for p in after.pairs), default=0.0)
    if found.verdict not in ("no_gap", "parameters_only") or off <= SCREENING.off:
        return found
    why = (
        f"more sensors: of the modes that pair one is {100.0 * off:.0f} % off in frequency, more "
        "than meshes are and known parameters explain; so few may not tell which mode it is"
    )
    return _in_doubt(found, why, proposal=False)


def _or_a_mesh(found: Discovery) -> Discovery:
    """Return what was found with no known parameter said to be off: a finer mesh would tell."""
    stay = tuple(replace(m, significant=False, written=1.0) for m in found.parameters)
    return replace(found, parameters=stay, would_decide=(_FINER, *found.would_decide))


def _in_doubt(found: Discovery, why: str, proposal: bool) -> Discovery:
    sure = min(found.posterior, NARRATIVE.doubted)
    return replace(
        found,
        verdict="undecided",
        proposal=proposal,
        would_decide=(why, *found.would_decide),
        posterior=sure,
        findings=tuple(
            replace(f, confidence=min(f.confidence, sure)) if f.kind in KINDS else f
            for f in found.findings
        ),
    )


def written(found: Discovery, adopt: str) -> Discovery:
    """Return what was found with the factors that its completed model takes.

    `adopt` says which known parameters move: the "significant", "all" or "none". What changes no
    model moves none.
    """
    if not found.adopted:
        adopt = "none"
    return replace(found, parameters=tuple(_written(m, adopt) for m in found.parameters))


def _written(m: MovedParameter, adopt: str) -> MovedParameter:
    if adopt == "all":
        m = replace(m, factor=m.together)
    taken = adopt == "all" or (adopt == "significant" and m.significant)
    far = abs(m.factor - 1.0) > SCREENING.moved
    return replace(m, written=m.factor if taken and far else 1.0)


def sound_test(placed: Placed, found: Discovery, had: Dofs, has: Dofs) -> Placed:
    """Return the test as sound sensors would have read it, on a model with further grids.

    Sensors of which that cannot be known are left out. The test was placed on the degrees of
    freedom that the model `had` as it came; completed it `has` others.
    """
    if has.node.shape != had.node.shape:
        seen = placed.observation
        seen = replace(seen, matrix=(seen.matrix @ _onto(had, has)).tocsr())
        placed = replace(placed, observation=seen)
    shapes = corrected(placed.test.shapes, found.corrected_sensors)
    left = ~lost(found.corrected_sensors, len(shapes))
    return replace(placed, test=replace(placed.test, shapes=shapes)).take(left)


def _onto(had: Dofs, has: Dofs) -> sp.csr_matrix:
    """Return ones where a degree of freedom of `had` is one of `has`, (n_had, n_has)."""
    old, new = (6 * d.node + d.component for d in (had, has))
    _, rows, columns = np.intersect1d(old, new, assume_unique=True, return_indices=True)
    return sp.csr_matrix((np.ones(len(rows)), (rows, columns)), (len(had), len(has)))
