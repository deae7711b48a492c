"""The tuned numbers of an update."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/updating"


@dataclass(frozen=True)
class UpdatingNumbers:
    frequency: float = number(0.01, "of f", "standard deviation of a frequency, unless said otherwise", "modal tests")
    shape: float = number(0.1, "√(1 − MAC)", "standard deviation of a shape, unless said otherwise", "modal tests")
    mass: float = number(0.005, "of the mass", "standard deviation of what was weighed, unless said otherwise", "scales")
    centre_of_gravity: float = number(0.002, "of the size of the structure", "standard deviation of a coordinate, unless said otherwise", "scales")
    damping: float = number(0.1, "of a ratio", "standard deviation of a damping ratio, unless said otherwise", "modal tests")
    response: float = number(0.3, "ln of a magnitude", "standard deviation of a response, unless said otherwise", "modal tests")
    antiresonance: float = number(0.01, "of f", "standard deviation of an antiresonance, unless said otherwise", "modal tests")
    heard: float = number(2.5, "times the highest test mode", "up to which modes make up frequency responses; static answers stand for those above", "their error goes by the square of the frequency")
    lines: int = number(60, "lines", "of responses that count, at most, spread evenly", "time")
    functions: int = number(24, "responses", "of each reference that count, at most, spread evenly", "time")
    deflection: float = number(0.02, "of the largest of its load case", "standard deviation of a static reading, unless said otherwise", "static tests")
    prior: float = number(0.2, "of a factor", "standard deviation of the deck's values, unless said otherwise", "practice of updating")
    relation: float = number(1.0, "of its own", "standard deviation of a relation, unless said otherwise", "as it is stated")
    regularisation: float = number(1e-2, "-", "on steps of the factors, unless said otherwise", CHECK)
    iterations: int = number(10, "iterations", "of a stage, unless said otherwise", CHECK)
    modes: int = number(40, "modes", "of an eigensolution, unless said otherwise", "time")
    tolerance: float = number(1e-3, "of a factor", "moves that settle an update, unless said otherwise", CHECK)

    unidentifiable: float = number(1e-4, "of the largest singular value, at least of 1", "of a direction that the test does not determine", CHECK)
    unsure: float = number(0.2, "of a factor", "standard error above which it is not determined: the deck knows it as well", "as prior")
    part: float = number(0.1, "-", "of such a direction that a parameter has, for it to be named", CHECK)
    alike: float = number(1e-6, "of what a parameter moves", "difference below which the first named is taken", ROUNDING)
    indistinct: float = number(0.98, "cosine", "of two columns of derivatives from which on they are not told apart", "angles of 11 degrees")
    chance: float = number(6.0, "χ²", "that a parameter must explain besides twice the log of their number", CHECK)
    least_gain: float = number(1e-3, "of the objective", "by which the pairs that are kept must be closer", CHECK)
    kept: float = number(0.75, "of the pairs", "that a step must keep to be judged by those alone", CHECK)
    step: tuple[float, float] = number((0.5, 1.0), "of a factor", "largest step down and up", CHECK)
    slack: float = number(1e-12, "-", "between the bounds of a step that would fall together", ROUNDING)

    reach: float = number(2.0, "times", "or part of, the factors of a reduced model, beyond which it is left", CHECK)
    rebuild: float = number(4.0, "times", "or part of, the factors that a reduced model was made at, beyond which it is made anew", CHECK)
    agree: float = number(0.1, "of the tolerance", "difference of eigenvalues, full and reduced, that ends an update", CHECK)
    agree_least: float = number(1e-9, "of λ", "the same, at least", ROUNDING)
    balance: float = number(1e-6, "of the load", "unbalanced force at which a static solution holds", ROUNDING)
    same_value: float = number(1e-5, "of a value", "difference of a property between decks that is none", "figures of a field")
    same: float = number(1e-6, "of the objective", "reduced ones this close to the full one are not told apart from it", CHECK)
    chi_square: float = number(3.84, "χ²", "95 % of it with one degree of freedom", "statistics")
    profile_iterations: int = number(8, "iterations", "of the others as one parameter is moved", CHECK)
    profile_steps: int = number(12, "steps", "to the end of an interval, at most", CHECK)
    profile_accuracy: float = number(1e-3, "-", "of the root of a rise, and of the objective while others follow", CHECK)
    start_spread: float = number(0.3, "ln of a factor", "standard deviation of other starts", CHECK)
    same_optimum: float = number(0.01, "of a factor", "or its standard error, within which optima are one", CHECK)
    chains: int = number(4, "chains", "of samples, side by side", "Gelman et al. 2013, section 11.4")
    learning: float = number(0.5, "of the samples that are kept", "thrown away before them", "Gelman et al. 2013, section 11.4")
    least_learning: int = number(200, "steps", "thrown away, at least", CHECK)
    relearn: int = number(25, "steps", "after which the proposals are made anew", CHECK)
    proposal: float = number(2.38, "standard deviations over √n", "of a proposal", "Roberts and Rosenthal 2001")
    prior_steps: float = number(10.0, "steps a parameter", "that the first covariance counts for", CHECK)
    least_effective: float = number(100.0, "samples", "independent ones below which more are asked for", "statistics")
    most_spread: float = number(1.05, "-", "potential scale reduction above which more are asked for", "Gelman et al. 2013, section 11.4")
    prior_ratio: float = number(1.5, "times", "from one standard deviation of the prior to the next", CHECK)
    prior_trials: int = number(8, "standard deviations", "of the prior below and above that asked for", CHECK)
    prior_accuracy: float = number(1e-4, "of the objective, absolute", "that ends the way to an optimum for a prior", CHECK)
    band: tuple[float, float] = number((0.7, 1.2), "times", "the lowest and highest frequency of the pairs' test modes: where responses count", CHECK)
    ratio: float = number(0.01, "of critical", "damping ratio of a model where neither deck nor test says one", "modal tests")
    depth: float = number(1.0, "ln of a magnitude", "from an antiresonance to the lower of the peaks beside it, at least", CHECK)
    antiresonance_reach: float = number(0.1, "of f", "from an antiresonance of the test to its partner, at most", CHECK)
    halvings: int = number(5, "halvings", "of a step, at most", CHECK)
    at_bound: float = number(1e-6, "of a factor", "beside its bound, at which it is", ROUNDING)


UPDATING = UpdatingNumbers()
