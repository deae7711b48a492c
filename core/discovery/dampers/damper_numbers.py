"""The tuned numbers of the search for dashpots."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number


@dataclass(frozen=True)
class DamperNumbers:
    courses: tuple[tuple[float, float, float], ...] = number(
        ((0.0, 1.0, 0.6), (-0.5, 1.0, 0.1), (0.5, 1.0, 0.1), (1.0, 0.0, 0.03), (1.0, 0.2, 0.03), (1.0, 0.5, 0.04), (1.0, 0.8, 0.04), (1.0, 1.0, 0.06)),
        "exponent, share, chance", "courses of a level over frequency x: a share of x^e, the rest of 1/x^e", "constant, in between, Rayleigh damping",
    )
    spreads: tuple[float, ...] = number((0.2, 0.35, 0.6, 1.0), "of ln ζ", "around the level, each as likely")
    levels: int = number(18, "levels", "that are integrated over")
    lowest_level: float = number(0.5, "of the lowest ratio", "from which on they lie")
    tails: float = number(5.0, "degrees of freedom", "of the t distribution of ln ζ")
    measured: float = number(0.03, "of ln ζ", "error of a measured ratio, at least")

    fewest: int = number(5, "ratios", "below which no dashpot is looked for")
    rare: float = number(3.5, "ln", "of how many times rarer a dashpot is beforehand than none")
    shape_error: float = number(0.08, "of the rms of a shape", "error of a shape anywhere")
    still: float = number(1e-3, "of the most that a place gives", "a place where no mode gets this is still")
    screened: int = number(200, "places", "that are weighed over all levels, at most", "time")
    exact: int = number(24, "places", "that are weighed by the quadratic eigenproblem", "time")
    behind: float = number(12.0, "ln", "places further behind the best are not weighed over all levels")
    likely: float = number(0.5, "-", "posterior of a dashpot anywhere from which on it is a finding")
    at_once: int = number(200_000, "densities", "made at once", "cache: they stay near the processor")
    multiplied: int = number(20, "modes", "whose densities are multiplied before their log is taken", "far from what a float holds")
    least_left: float = number(0.2, "of a measured ratio", "that the deck's own dashpots leave to the structure, at least")
    complexity: float = number(0.03, "of the rms of a shape", "imaginary part without a dashpot")
    own_share: float = number(0.2, "of what a dashpot is foretold to do to a shape or a frequency", "that is wrong")
    freedom: float = number(3.0, "degrees of freedom", "how firmly both are known")
    complex_least: float = number(1e-3, "of the largest reading", "imaginary part below which shapes are real", ROUNDING)
    turned: float = number(0.1, "of a shape's length", "change of a shape that a search for other effects would see, as it would one of ln f by `likelihood.frequency`")


DAMPERS = DamperNumbers()
