"""The tuned numbers by which poles are found and kept."""

from dataclasses import dataclass

from ...number_table import ROUNDING, SURVEYS, number

WIDTHS = "half bandwidths"


@dataclass(frozen=True)
class PoleNumbers:
    filter_widths: tuple[float, ...] = number((0.5, 1.5, 4.0, 12.0, 36.0), "line spacings", "decay rates of the matched filters", SURVEYS)
    filter_widest: float = number(0.1, "of the lines", "decay rate of a filter, at most", SURVEYS)
    filter_risk: float = number(0.1, "-", "that noise shows a trace somewhere", SURVEYS)
    filter_smoothed: int = number(15, "lines", "over which the level of the residual is taken", SURVEYS)
    filter_at_once: int = number(1 << 17, "numbers", "filtered at once", "cache")

    ridge: float = number(1e-13, "of the diagonal", "that keeps normal matrices of clean data invertible", ROUNDING)
    responses_enough: int = number(8, "responses", "complete ones that speak for a band", SURVEYS)
    columns_most: int = number(180, "columns", "of the denominator, order times inputs", "time")
    order_base: int = number(16, "coefficients", "of the denominator for background, besides four a peak", SURVEYS)
    order_each: int = number(4, "coefficients", "a peak", SURVEYS)
    order_wider: float = number(1.2, "-", "times as many are taken", SURVEYS)
    order_more: int = number(4, "orders", "above that", SURVEYS)
    thirds: int = number(5, "parts", "of a band, a third each, half overlapping, searched for further candidates", SURVEYS)
    lines_least: int = number(12, "lines", "of a band in which poles are looked for", SURVEYS)
    candidate_same: float = number(1.5, WIDTHS, "within which candidates of two runs are the same root", SURVEYS)
    damping_most: float = number(0.25, "of critical", "above it a pole describes the background", SURVEYS)
    track_reach: float = number(1.0, "-", "largest distance between the poles of one track, see `_distance`", SURVEYS)
    track_patience: int = number(2, "orders", "that a track may miss", SURVEYS)
    track_members: int = number(9, "members", "the last of a track, that speak for it", SURVEYS)
    track_least: int = number(4, "members", "of a track, or this part of the orders", SURVEYS)
    width_least: float = number(1e-12, "rad/s", "of a pole that is compared", ROUNDING)

    final_sweeps: int = number(2, "sweeps", "through all bands with the modes of the others taken off", SURVEYS)
    same: float = number(0.5, WIDTHS, "within which roots of two bands are one", SURVEYS)
    beyond_doubt: float = number(50.0, "significance", "above which a root is not tested by refining without it", SURVEYS)
    rounds: int = number(12, "rounds", "of trying a root where the residual still shows one", SURVEYS)
    failures: int = number(5, "rounds", "in a row that fail, after which no more is tried", SURVEYS)
    neighbours: float = number(8.0, WIDTHS, "to either side that a trial root is fitted over", SURVEYS)
    around_least: int = number(24, "lines", "to either side that a trial root is fitted over, at least", SURVEYS)
    hopeless: float = number(0.1, "significance", "of a root before any refinement, below which it is not tried", SURVEYS)
    promising: float = number(0.6, "significance", "of a root in a fit of the lines around it, to be tried at all", SURVEYS)
    nearly: float = number(0.8, "significance", "of a root not yet converged, to be refined further", SURVEYS)
    trial_steps: int = number(10, "steps", "after which a root that explains too little is given up", SURVEYS)
    failed_around: int = number(4, "lines", "around a failed trial that are not tried again", SURVEYS)
    background: int = number(2, "roots", "beside or beneath the modes of a band, which a fit may use", SURVEYS)

    one_shape: float = number(0.95, "MAC", "above which two close roots have one shape", SURVEYS)
    one_participation: float = number(0.9, "MAC", "below which their participations contradict that", SURVEYS)
    shared_spread: float = number(0.25, "of the lines", "over which noise that all points share stands, at least", SURVEYS)
    shared_shape: float = number(0.9, "MAC", "with that noise, above which a root is such noise", SURVEYS)
    satellite: float = number(0.2, "of the strength of a root", "that a satellite has at most", SURVEYS)
    telling: int = number(5, "outputs", "below which shapes tell nothing", SURVEYS)
    faint: float = number(0.01, "of the strength of a root", "that a satellite has at most where shapes are not told", SURVEYS)
    split_widths: float = number(6.0, WIDTHS, "within which the roots of a split mode lie", SURVEYS)
    split_lines: float = number(8.0, "lines", "likewise", SURVEYS)
    touching: float = number(3.0, "lines", "within which two modes of one shape are one", SURVEYS)
    one_line: float = number(0.97, "of the energy", "of a root, in one line, above which it is a tone and no resonance", SURVEYS)
    widest: float = number(0.3, "of the band", "the half-power bandwidth of a mode", SURVEYS)

    risk: float = number(0.01, "-", "that noise alone makes one root somewhere in a band", SURVEYS)
    margin: float = number(2.0, "-", "beyond what that risk allows, since noise is never quite white", SURVEYS)
    margin_of_spikes: float = number(6.0, "-", "the same for a pole narrower than the lines are apart", SURVEYS)
    margin_of_needles: float = number(20.0, "-", "and for one much narrower, which noise of a single line may make", SURVEYS)
    needle: float = number(0.3, "lines", "that those are narrower than", SURVEYS)
    dynamic_range: float = number(3e-4, "of the level around", "what is weaker is not a mode, however clean the data", SURVEYS)
    floor: float = number(0.01, "of the level of the band", "that counts as level around", SURVEYS)
    seen: float = number(0.03, "of one function", "over the width of a mode: what artefacts make of it", SURVEYS)
    white: float = number(2.0, "-", "variance over that of the differences, below which noise is white", SURVEYS)
    seen_least: float = number(12.0, "lines", "to either side of a mode over which that is judged", SURVEYS)
    listened: int = number(200, "functions", "enough to tell the colour of the residual", "time")
    prior: float = number(16.0, "numbers", "that the variance of all functions counts for in that of one", SURVEYS)
    near_least: int = number(12, "lines", "nearest to a mode that always count as near it", SURVEYS)
    spent_least: float = number(0.25, "of the freedom of its lines", "that the modes there leave, at least", SURVEYS)

    start_rounds: int = number(10, "rounds", "of alternating shapes and participations", "they settle in few")
    shape_ridge: float = number(1e-12, "of the diagonal", "on the normal matrices of the shapes", ROUNDING)
    fit_steps: int = number(40, "steps", "of a fit, at most", SURVEYS)
    damping_first: float = number(1e-4, "-", "Levenberg's damping of the first step", SURVEYS)
    damping_factor: float = number(10.0, "-", "by which it grows and falls", SURVEYS)
    damping_least: float = number(1e-9, "-", "that it falls to", SURVEYS)
    damping_stuck: float = number(1e8, "-", "no step helps any more", SURVEYS)
    misfit_least: float = number(1e-14, "of the power of the data", "that a misfit may rise by", ROUNDING)
    decay_step: float = number(1.5, "of the ln of a decay rate", "largest change in one step", SURVEYS)
    ratio_least: float = number(1e-6, "damping ratio", "of a pole", SURVEYS)
    frequency_step: float = number(1e-3, "of ω", "that a frequency moves by in one step besides its bandwidth, at most", SURVEYS)
    converged: float = number(1e-3, "of the misfit per number", "decrease that ends the iteration", SURVEYS)

    error_surely: float = number(6e-4, "of the energy", "left over by stable poles, above which a survey has errors besides noise", SURVEYS)
    error_none: float = number(2e-5, "of the energy", "left over by all modes, below which it has none", SURVEYS)
    error_least: float = number(1e-4, "of the energy", "that is taken for the error when directions of a resonance are counted", SURVEYS)
    one_resonance: float = number(3.0, WIDTHS, "within which roots belong to one resonance", SURVEYS)
    seen_widths: float = number(2.0, WIDTHS, "to either side, in which the directions of a resonance are counted", SURVEYS)
    direction: float = number(3.0, "-", "times the error of the survey, which a direction of a resonance is to exceed", SURVEYS)
    scatter: float = number(25.0, "-", "the same where outputs or inputs alone tell it", SURVEYS)
    sure: float = number(3.0, "standard deviations", "of noise, beyond which what is left over is not noise", SURVEYS)

    error_most: float = number(0.15, "of a root's energy", "that its error is, at most", SURVEYS)



POLES = PoleNumbers()
