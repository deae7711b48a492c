"""The tuned numbers of the likelihood."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number


@dataclass(frozen=True)
class LikelihoodNumbers:
    frequency: float = number(0.004, "of ln f", "standard deviation of what a right model misses")
    placed: float = number(0.04, "of the rms of a shape", "the same of a sensor's reading: positions of sensors, discretisation")
    independent: float = number(12.0, "sensors", "that count as independent: errors of a model are smooth")
    robust: float = number(40.0, "2 ln L", "misfit of one mode beyond which more of it counts less and less")
    mixing: float = number(0.02, "of λ", "changes of K that no model has right: modes that are no further apart turn freely, see `mixing`")
    soft: float = number(3.0, "of the noise", "where wide valleys are wanted")
    paired: float = number(0.5, "of the modes", "that have another so near where modes come in pairs", "0.67 to 0.9 of ducts and wheels, at most 0.2 of others")
    soft_mixing: float = number(5.0, "of `mixing`", "where the known parameters have yet to follow")
    unseen: float = number(1e-10, "of the largest squared length", "at the sensors, of a mode that they do not see", ROUNDING)
    pictured: int = number(800, "lines", "of responses that are kept for a picture, besides those of the modes", "what a screen shows")
    repeated: float = number(1e-6, "of λ", "gap up to which modes are one, any vectors of their plane", ROUNDING)
    ridge: float = number(1e-6, "-", "on the diagonal of a Gram matrix of shapes that are alike", ROUNDING)
    least_eigenvalue: float = number(1e-6, "of a test mode's λ", "λ of a rigid-body mode that is matched to it")

    tolerance: float = number(0.05, "2 ln L", "fall of the objective that counts")
    dampings: int = number(5, "trials", "of Levenberg's damping a step")
    damping_first: float = number(0.05, "of the curvature", "least damping after a step that failed")
    damping_up: float = number(5.0, "-", "times the damping after a step that failed")
    damping_down: float = number(0.3, "-", "times the damping after one that did not")
    reach: float = number(0.8, "ln p, or steps of a kind", "largest move of an unknown at once")
    degenerate: float = number(2e-3, "of λ", "gap below which modes do not turn into each other in a derivative")
    apart_least: float = number(1e-12, "1 - MAC", "least that is divided by", ROUNDING)
    significant: float = number(3.0, "standard deviations", "by which a known parameter moved, for the test to say that it is off")
    interval: float = number(1.96, "standard deviations", "half of a 95 % interval", "normal distribution")
    law_top: float = number(2.0, "of the test's highest λ", "below which springs that stand for a rigid link do not matter")

    above: float = number(1.5, "of the highest test frequency", "up to which modes count when shapes are turned onto the test's")
    elastic: float = number(1e-3, "of the highest frequency", "above which a mode has a damping ratio", ROUNDING)

    lines: int = number(240, "lines", "of the responses that hypotheses are compared on", "time")
    functions: int = number(60, "functions", "likewise", "time")
    far: float = number(4.0, "ratio", "of magnitudes beyond which more of it counts no more")
    ratio: float = number(0.01, "-", "damping ratio where the test has none")
    least_error: float = number(0.02, "of ln H", "log magnitudes are not known better")
    band_below: float = number(0.7, "of the lowest test frequency", "from which responses count")
    band_above: float = number(1.05, "of the highest test frequency", "up to which they do")


LIKELIHOOD = LikelihoodNumbers()
