"""From evidence to verdict."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp

from ..arrays import Bools
from ..correlation.comparison import Placed
from ..errors import TrueupError
from .dampers.damper_evidence import Weighed, taken_off, weighed
from .discovery_numbers import DISCOVERY
from .effects import point_mass
from .effects.candidates import factors_of, lacking
from .findings import Discovery
from .likelihood.frf_evidence import hearing, with_responses
from .likelihood.hypothesis import Fit, Problem
from .likelihood.map_fit import evaluate
from .likelihood.repeated_modes import in_pairs
from .likelihood.request import Request as Request
from .model_error.diffuse_fit import Judged
from .model_error.size_posterior import centred
from .model_error.support_reach import reaches_of
from .narrative.build_findings import build_discovery
from .narrative.damper_findings import with_damper
from .reduction.elements_and_supports import Structure
from .reduction.residual_flexibility import Lost
from .search.coarse_scan import first_places, neighbourhoods
from .search.completeness import Completeness, completeness
from .search.footprints import at_the_edge, footed, settled
from .search.found import Found
from .search.misshapen import beside_geometry
from .search.model_selection import (
    adequate,
    chosen,
    held_out,
    scored,
    usual,
    without_one_to_spare,
)
from .search.moves import Searcher
from .search.own_basis import Ground
from .search.patch_reshaping import reshaped
from .search.refit_own_basis import (
    by_model_error,
    completed_modes,
    for_deck,
    polished,
    solves,
)
from .search.set_up import beside_reach
from .search.strategy import on_stands, searched
from .search.unknown_mounts import as_blocks_on_mounts
from .sensor_faults.diagnosis import Bench, Verdicts
from .starting_point import Deck, ground_of, prepared


def discover(request: Request, progress: Callable[[str], None] = lambda _: None) -> Discovery:
    """Find what the model lacks or what is wrong in the test.

    Sensors are checked against each other first; then known parameters and missing effects of
    every kind and place compete for the rest of the misfit. A part of the modes and sensors is
    kept out of the search. `progress` is told what happens, a few words at a time.
    """
    progress("checking the sensors against each other")
    bench = Bench(request.placed, request.structure.model)
    test = bench.survey
    out = (
        held_out(*DISCOVERY.modes_held, DISCOVERY.modes_enough, test.frequencies_hz),
        held_out(*DISCOVERY.sensors_held, DISCOVERY.sensors_enough, test.moves),
    )
    progress("making the catalogue of effects")
    ground = ground_of(request, ~out[0])
    progress("fitting the known parameters")
    bench, trial = _dashpot_off(request, bench, _tried(request, bench, ground, out))
    searcher, found, accepted = _searched(trial, progress)
    if accepted and solves(trial.own, searcher.problem, found.levels[accepted]):
        tested = _judged(bench, trial, searcher, found.levels[accepted])
        if np.any(tested.accused & ~trial.aside):
            progress("searching again without sensors that the completed model accuses")
            aside = trial.aside | tested.doubtful
            trial = _Trial(trial.asked, ground, aside, tested.noise, out)
            searcher, found, accepted = _searched(trial, progress)
    progress("weighing what was found against the error of the model")
    searcher, found, accepted, whole = _completed(trial, searcher, found, accepted)
    best = found.levels[accepted]
    tested = _judged(bench, trial, searcher, best)
    known = for_deck(trial.own, searcher.problem, best)
    said = build_discovery(request, searcher, found, accepted, whole, known, tested, out)
    progress("weighing dashpots by the measured damping")
    best = evaluate(searcher.problem, best.nuisance, best.suspects)
    if best.suspects or trial.asked is not request:
        sound = replace(request, placed=request.placed.take(~trial.aside))
        dashpot = weighed(sound, searcher.problem, best)
    else:
        dashpot = trial.dashpot
    said = with_damper(request, dashpot, said)
    return with_responses(searcher.problem, found.levels[0].nuisance, best, said)


def _tried(request: Request, bench: Bench, ground: Deck, out: tuple[Bools, Bools]) -> _Trial:
    """Fit the known parameters without the sensors that look faulty."""
    motion = np.asarray(request.structure.model.expansion @ request.solution.vectors)
    first = bench.judged(motion, request.solution.eigenvalues)
    trial = _Trial(request, ground, first.doubtful, first.noise, out)
    basis, null = trial.problem.basis, trial.null
    tested = bench.judged(basis.motion @ null.vectors[: basis.size], null.eigenvalues)
    if np.any(tested.doubtful != first.doubtful):
        return _Trial(request, ground, tested.doubtful, tested.noise, out)
    return trial


def _dashpot_off(request: Request, bench: Bench, trial: _Trial) -> tuple[Bench, _Trial]:
    """Take a heavy dashpot off the test where the model then fits better, else leave it.

    It moves frequencies and shapes, which a search for stiffness and mass would put down to such.
    What it does follows from the model, whose parameters follow from the test without it: in turns.
    """
    for _ in range(DISCOVERY.dashpot_turns):
        w = trial.dashpot
        if w is None or not w.heavy or request.responses is not None:
            break
        other = replace(request, placed=taken_off(w, request.placed, trial.problem))
        its_bench = Bench(other.placed, request.structure.model)
        without = _tried(other, its_bench, trial.ground, trial.out)
        if without.null.objective >= trial.null.objective:
            break
        bench, trial = its_bench, without
    return bench, trial


def _at_supports(placed: Placed, structure: Structure) -> sp.csr_matrix:
    """Return what sensors read, weighted, of supports that move, (n_sensor, n_support)."""
    supports, matrix = structure.supports, placed.observation.matrix
    motion = sp.csr_matrix((matrix.shape[1], 0)) if supports is None else supports.motion
    return sp.csr_matrix(placed.weighted(matrix @ motion))


class _Trial:
    """A search without the sensors that are set aside; modes and sensors are held `out` of it."""

    def __init__(
        self,
        request: Request,
        ground: Deck,
        aside: Bools,
        noise: float,
        out: tuple[Bools, Bools],
    ) -> None:
        self.asked, self.ground, self.aside, self.out = request, ground, aside, out
        self.request = replace(request, placed=request.placed.take(~aside))
        sensors = ~out[1][~aside]
        self.problem, self.null, self.zero = prepared(self.request, ground, noise, ~out[0], sensors)
        placed, structure = self.request.placed, request.structure
        motion = placed.observation.matrix @ structure.model.expansion
        observation = sp.csr_matrix(placed.weighted(motion))
        nodes = len(np.unique(placed.observation.sensors.node))
        self.own = Ground(
            structure, ground.plain, ground.mesh, ground.bars, ground.compliance, observation,
            _at_supports(placed, structure), sensors,
            sp.csr_matrix(np.sqrt(request.mass / nodes) * motion),
        )  # fmt: skip
        self._judged: dict[object, Judged | None] = {}
        self._laid: dict[object, tuple[Searcher, Fit]] = {}

    @cached_property
    def dashpot(self) -> Weighed | None:
        """A dashpot weighed beside the known parameters alone."""
        return weighed(self.request, self.problem, self.null)

    def judged(self, problem: Problem, f: Fit, least: float = -np.inf) -> Judged | None:
        """Return a hypothesis as the error of the model judges it, None where it does not solve.

        Without smooth fields where these could not bring it to the evidence `least`.
        """
        places = tuple((problem.catalogue[s.kind], s) for s in f.suspects)
        same = places, f.nuisance.tobytes()
        known = self._judged.get(same)
        if same not in self._judged or (known and not known.whole and known.may_reach(least)):
            self._judged[same] = None
            with suppress(TrueupError):
                self._judged[same] = by_model_error(self.own, problem, f, least=least)
        return self._judged[same]

    def laid(self, searcher: Searcher, best: Fit) -> tuple[Searcher, Fit]:
        """Give patches better shapes, and lay masses on footprints, if the test is likelier so.

        What made up for their places no longer earns its own then: anew without it.
        """
        same = searcher.problem, best
        if same not in self._laid:
            wide, laid = _laid(self, searcher, best)
            spare = without_one_to_spare(wide, laid, self.null) if laid is not best else None
            self._laid[same] = self.laid(wide, spare) if spare else (wide, laid)
        return self._laid[same]

    def explained(self, searcher: Searcher, best: Fit) -> bool:
        """Whether a hypothesis leaves no more than right models do, its masses laid on footprints.

        A mass on the nearest grid leaves what a spring or an absorber beside it would make up for.
        """
        return usual(*self.laid(searcher, best))


def _judged(bench: Bench, trial: _Trial, searcher: Searcher, best: Fit) -> Verdicts:
    """Judge the sensors by what was accepted."""
    return bench.judged(*completed_modes(trial.own, searcher.problem, best))


def _searched(trial: _Trial, progress: Callable[[str], None]) -> tuple[Searcher, Found, int]:
    """Search on sensors taken as sound, and weigh."""
    searcher = _searcher(trial)
    compliance, null = trial.ground.compliance, trial.null
    heard = hearing(trial.request, searcher.problem, compliance, null.nuisance)
    searcher = replace(searcher, problem=heard)
    found = searched(searcher, progress, trial.explained)
    progress("weighing the best hypotheses on bases of their own")
    best = found.levels[chosen(searcher, found)]
    if not trial.explained(searcher, best):
        searcher, best = reshaped(searcher, best)
        found = found.with_level(best)
        searcher, found = on_stands(trial.request.structure, searcher, found, progress)
        best = found.levels[chosen(searcher, found)]
    searcher, best = trial.laid(searcher, best)
    accepted = len(best.suspects)
    return searcher, _weighed(trial, searcher, found.with_level(best), accepted), accepted


def _laid(trial: _Trial, searcher: Searcher, best: Fit) -> tuple[Searcher, Fit]:
    structure = trial.request.structure
    kinds = (searcher.problem.catalogue[s.kind].kind for s in best.suspects)
    if any(kind is not point_mass.KIND for kind in kinds):
        searcher, best = reshaped(searcher, best)
    wide, free = footed(searcher, structure, best)
    if wide is not searcher:
        with suppress(TrueupError):
            free = polished(trial.own, wide.problem, free)
            far = at_the_edge(wide, free)
            wide, laid = settled(wide, structure, free)
            if any(wide.problem.catalogue[s.kind].kind.spread_out for s in laid.suspects):
                wide, laid = reshaped(wide, laid)
            laid = polished(trial.own, wide.problem, laid)
            if scored(wide, laid).score > scored(searcher, best).score:
                return _laid(trial, wide, laid) if far else (wide, laid)
    return searcher, best


def _weighed(trial: _Trial, searcher: Searcher, found: Found, accepted: int) -> Found:
    """Fit the chosen hypothesis and the one with a suspect less on bases of their own."""
    for f in found.levels[max(accepted - 1, 0) : accepted + 1]:
        with suppress(TrueupError):
            found = found.with_level(polished(trial.own, searcher.problem, f))
    return found


def _completed(
    trial: _Trial, searcher: Searcher, found: Found, accepted: int
) -> tuple[Searcher, Found, int, Completeness]:
    """Keep the effects that are likelier than an error of the model without any place.

    Their magnitudes are those at which the test is likeliest beside such an error, or the middle
    of what is likely; in a poor model masses are blocks. Of what leaves a model that does not solve
    the next best is taken.
    """
    deck = by_model_error(trial.own, searcher.problem, trial.zero, moving=False)
    old = found.levels
    searcher, found, kept, whole = completeness(searcher, found, accepted, deck)
    reaches = reaches_of(trial.request.structure)
    kept, whole = beside_reach(searcher, found, kept, whole, reaches)
    kept, whole = beside_geometry(trial.own, searcher, found, kept, whole)
    best = found.levels[kept]
    if kept:
        structure, densest = trial.request.structure, trial.request.densest
        blocks = None
        if densest and not adequate(searcher, best):
            starts = whole.told.fit.nuisance, whole.alone.fit.nuisance
            blocks = as_blocks_on_mounts(structure, searcher, best, starts, densest)
        if blocks is None:
            whole = replace(whole, told=centred(whole.told))
        else:
            searcher, rigid, told = blocks
            best = evaluate(searcher.problem, rigid.fit.nuisance, rigid.fit.suspects)
            whole = replace(whole, best=rigid, told=told)
        if best is not old[kept] or kept > accepted:
            with suppress(TrueupError):
                best = polished(trial.own, searcher.problem, best)
        sized = replace(best, suspects=whole.told.fit.suspects)
        solving = (f for f in (sized, best) if solves(trial.own, searcher.problem, f))
        solved = next(solving, None)
        if solved is None:
            found = Found(found.levels[:kept], found.rivals[:kept])
            return _completed(trial, searcher, found, chosen(searcher, found))
        best = solved
    found = Found((*found.levels[:kept], best), found.rivals[: kept + 1])
    return searcher, found, kept, whole


def _searcher(trial: _Trial) -> Searcher:
    """Put the catalogue on the leading vectors of the fitted state."""
    request, problem, null = trial.request, trial.problem, trial.null
    made, size = trial.ground.catalogue, request.structure.model.geometry.size
    small = problem.turned(null.vectors)
    lost = Lost(trial.ground.compliance, small.basis.vectors)
    missing = tuple(lacking(c, lost) for c in made)
    factors = factors_of(made, small.basis)
    modes = min(DISCOVERY.small_modes, small.basis.size)
    small = replace(
        small, catalogue=tuple(made), factors=factors, missing=missing, modes=modes, turn=None
    )
    both, columns = zip(made, factors, strict=True), small.columns
    coarse = tuple(first_places(c, f, columns, size) for c, f in both)
    paired = in_pairs(null.eigenvalues[null.match.min() : null.match.max() + 1])
    beside = tuple(
        neighbourhoods(c, rows, size) if paired or c.tunings == 1 else None
        for c, rows in zip(made, coarse, strict=True)
    )
    return Searcher(small, coarse, null.nuisance, size, trial.judged, beside)
