"""Is there a dashpot, and where: damping ratios and complex shapes against every place.

Whether there is one, damping says: every place and direction is tried over a range of sizes to
first order, given a model; places, sizes and what the structure has of damping by itself are
integrated out. Where one is likely and how large it is say the exact modes of the model with it at
the best places: ratios, frequencies and shapes of the test together.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.special import expit, logsumexp

from ...arrays import Bools, Floats, Ints
from ..effects.local_damper import PEAKS
from ..likelihood.complex_modes import Oriented, added, imaginary
from .damped_model import Damped
from .damper_numbers import DAMPERS
from .damping_ratios import Levels, expected_level, levels_for, log_likelihood, marginal

Exact = Callable[[int, float, float], Damped]
"""Modes of a model with a dashpot at a place, of a size, beside a ratio that all modes have."""

Gain = Callable[[Ints, Floats], Floats]
"""How much likelier (ln) dashpots at some places (n,), of sizes (n, t), make the shapes, (n, t)."""


@dataclass(frozen=True, eq=False)
class DampingEvidence:
    """What a test says of damping.

    Parameters
    ----------
    measured : (n_test,) float
        Damping ratios, NaN or 0 where unknown.
    imaginary : (n_sensor, n_test) float or None
        Imaginary parts of the shapes beside real parts of unit modal mass; None for real shapes.
    independent : float
        Number of sensors that count as independent.
    """

    measured: Floats
    imaginary: Floats | None
    independent: float

    @property
    def known(self) -> Bools:
        """Modes whose ratio is known."""
        return np.isfinite(self.measured) & (self.measured > 0.0) & (self.measured < 1.0)


@dataclass(frozen=True, eq=False)
class DamperFound:
    """What the damping says.

    Parameters
    ----------
    exists : float
        Posterior of a dashpot anywhere.
    evidence : float
        Twice the ln of how much more likely the data are with one than without, its rarity
        beforehand counted.
    rows : (n,) int
        Places that explain the data, most likely first.
    weights : (n,) float
        Posterior of each, given that there is one.
    log_size, log_deviation : (n,) float
        Mean and standard deviation of ln c at each.
    level_without, level_with : (n_test,) float
        What the structure has of damping by itself, without a dashpot and with the best one.
    """

    exists: float
    evidence: float
    rows: Ints
    weights: Floats
    log_size: Floats
    log_deviation: Floats
    level_without: Floats
    level_with: Floats


def find_damper(
    e: DampingEvidence,
    modes: Oriented,
    u: Floats,
    sensors: Floats,
    known: Floats,
    exact: Exact | None = None,
) -> DamperFound | None:
    """Weigh a dashpot at every place against none; None where fewer than five ratios are known.

    `u` (n_place, n) is the motion of every place in the coordinates of `modes`, along the direction
    tried there, `sensors` (n_sensor, n) likewise; `known` (n, n) are dashpots that the deck has, on
    unit modal masses. By `exact`, where given, the best places are weighed once more.
    """
    chosen = np.flatnonzero(e.known)
    if len(chosen) < DAMPERS.fewest or not len(u):
        return None
    w = _weighing(e, modes, u, sensors, known, chosen)
    peak = w.gives.max(axis=1)
    live = np.flatnonzero(peak > DAMPERS.still * peak.max())
    if not len(live):
        return None
    first = w.scores(live, _coarse(w), slice(None, None, 2)).max(axis=1)
    best = np.argsort(-first, kind="stable")[: DAMPERS.screened]
    kept = first[best] > first.max() - DAMPERS.behind
    kept[: DAMPERS.exact] = True
    rows = live[best[kept]]
    score = w.scores(rows, w.grid)
    odds = float(logsumexp(score)) - np.log(len(PEAKS) * len(live)) - DAMPERS.rare
    exists = float(expit(odds))
    order = np.argsort(-logsumexp(score, axis=1), kind="stable")
    rows, score = rows[order], score[order]
    with_one = w.level(int(rows[0]), _mean(score[:1], w.sizes[rows[:1]])[0])
    if exact is not None and exists > DAMPERS.likely:
        rows = rows[: DAMPERS.exact]
        score = w.exact_scores(rows, exact, float(np.exp(np.mean(np.log(with_one)))))
        order = np.argsort(-logsumexp(score, axis=1), kind="stable")
        rows, score = rows[order], score[order]
    place = logsumexp(score, axis=1)
    mean = np.log(_mean(score, w.sizes[rows]))
    within = np.exp(score - place[:, None])
    step = float(np.log(PEAKS[1] / PEAKS[0]))
    spread = np.sum(within * (np.log(w.sizes[rows]) - mean[:, None]) ** 2, axis=1)
    return DamperFound(
        exists,
        2.0 * odds,
        rows,
        np.exp(place - logsumexp(place)),
        mean,
        np.sqrt(spread + step**2 / 12.0),
        _everywhere(w.level(0, 0.0), modes, chosen),
        _everywhere(with_one, modes, chosen),
    )


def _mean(score: Floats, sizes: Floats) -> Floats:
    """Return the (geometric) mean size at each place, (n,), by the scores (n, n_trial)."""
    within = np.exp(score - logsumexp(score, axis=1)[:, None])
    return np.asarray(np.exp(np.sum(within * np.log(sizes), axis=1)))


@dataclass(frozen=True, eq=False)
class _Weighing:
    """Dashpots of several sizes at every place against the measured ratios.

    `measured` and `own` (n_mode,) are ratios as measured and what the deck's own dashpots give, of
    the modes `chosen`; `gives` and `wrong` (n_place, n_mode) what unit damping gives them, first
    order, and the error of that; `sizes` (n_place, n_trial) are c; `null` is ln of the likelihood
    without a dashpot.
    """

    measured: Floats
    own: Floats
    chosen: Ints
    grid: Levels
    gives: Floats
    wrong: Floats
    sizes: Floats
    shapes: Gain
    null: float

    def scores(self, rows: Ints, grid: Levels, some: slice = slice(None)) -> Floats:
        """Return ln of how much likelier each size, or some, makes the data, (n, n_trial)."""
        sizes = self.sizes[rows, some]
        out = np.empty(sizes.shape)
        step = max(1, DAMPERS.at_once // (sizes.shape[1] * grid.levels.size))
        for start in range(0, len(rows), step):
            few = slice(start, start + step)
            c = sizes[few, :, None]
            part = self.own + c * self.gives[rows[few], None]
            error = c * self.wrong[rows[few], None]
            out[few] = marginal(self.measured, grid, part, error)
        return out - self.null + self.shapes(rows, sizes)

    def level(self, row: int, c: float) -> Floats:
        """Return the ratios that the modes have by themselves beside one dashpot, (n_mode,)."""
        part = self.own + c * self.gives[row]
        return expected_level(self.measured, self.grid, part, c * self.wrong[row])

    def exact_scores(self, rows: Ints, exact: Exact, level: float) -> Floats:
        """Return ln of how likely each size makes ratios, frequencies and shapes, (n, n_trial).

        How far off the model is in frequencies and shapes is unknown and integrated out (prior
        1/σ): of each mode they count as two readings.
        """
        out = np.empty((len(rows), self.sizes.shape[1]))
        for i, row in enumerate(rows):
            for k, c in enumerate(self.sizes[row]):
                d = exact(int(row), float(c), level)
                part = np.maximum(d.ratios[self.chosen] - level, 0.0)
                ratio = marginal(self.measured, self.grid, part, c * self.wrong[row])
                out[i, k] = float(ratio) - len(d.omega) * np.log(d.misfit)
        return out


def _weighing(
    e: DampingEvidence,
    modes: Oriented,
    u: Floats,
    sensors: Floats,
    known: Floats,
    chosen: Ints,
) -> _Weighing:
    z, omega = e.measured[chosen], modes.omega[chosen]
    own = np.diag(known)[chosen] / (2.0 * omega)
    grid = levels_for(np.maximum(z - own, DAMPERS.least_left * z), omega)
    v = u[:, chosen]
    gives = added(v, omega)
    delta = DAMPERS.shape_error * np.sqrt(np.mean(v**2, axis=0))
    wrong = (2.0 * np.abs(v) * delta + delta**2) / (2.0 * omega)
    peak = np.maximum(gives.max(axis=1), np.finfo(float).tiny)
    sizes = PEAKS / peak[:, None]
    null = float(marginal(z, grid, own, np.zeros(len(z))))
    shapes = _of_shapes(e, modes, u, sensors)
    return _Weighing(z, own, chosen, grid, gives, wrong, sizes, shapes, null)


def _coarse(w: _Weighing) -> Levels:
    """Few levels for a first look: of middling spread, the course that suits no dashpot best."""
    middling = DAMPERS.spreads[len(DAMPERS.spreads) // 2]
    some = w.grid.take(np.flatnonzero(w.grid.spreads == middling))
    alone = log_likelihood(w.measured, some, w.own, 0.0 * w.own)
    best = some.course[int(np.argmax(alone + some.log_prior))]
    return some.take(np.flatnonzero(some.course == best)[::2])


def _everywhere(level: Floats, modes: Oriented, chosen: Ints) -> Floats:
    """Levels of all measured modes from those whose ratio is known."""
    ln = np.interp(
        np.log(modes.omega[: modes.count]),
        np.sort(np.log(modes.omega[chosen])),
        np.log(level)[np.argsort(modes.omega[chosen], kind="stable")],
    )
    return np.asarray(np.exp(ln))


def _of_shapes(e: DampingEvidence, modes: Oriented, u: Floats, sensors: Floats) -> Gain:
    """Return the function that says how much likelier imaginary parts become by dashpots.

    Of each mode the variance of what is left is unknown (inverse gamma prior), so one mode that
    is complex for other reasons does not decide.
    """
    Y = e.imaginary

    def none(rows: Ints, sizes: Floats) -> Floats:
        return np.zeros(sizes.shape)

    if Y is None or not np.abs(Y).max() > DAMPERS.complex_least * np.abs(sensors).max():
        return none
    n, count = len(Y), modes.count
    rms = np.mean(sensors[:, :count] ** 2, axis=0)
    total = np.mean(Y**2, axis=0)
    free = DAMPERS.freedom
    ground = free * DAMPERS.complexity**2 * rms
    each = min(float(n), e.independent)
    cross = Y.T @ sensors

    def gain(rows: Ints, sizes: Floats) -> Floats:
        turned, gram = imaginary(u[rows], modes, sensors)
        a = np.einsum("pjk,jk->pj", turned, cross)[:, None, :] / n
        b = np.einsum("pjk,pjk->pj", turned @ gram, turned)[:, None, :] / n
        c = sizes[:, :, None]
        left = np.maximum(total - 2.0 * c * a + c**2 * b, 0.0)
        floor = ground + free * (DAMPERS.own_share * c) ** 2 * b
        ratio = (floor + each * left) / (ground + each * total)
        ln = -0.5 * (free + each) * np.log(ratio) + 0.5 * free * np.log(floor / ground)
        return np.asarray(ln.sum(axis=-1))

    return gain
