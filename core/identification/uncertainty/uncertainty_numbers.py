"""The tuned numbers by which standard errors of modes are judged."""

from dataclasses import dataclass

from ...number_table import ROUNDING, SURVEYS, number


@dataclass(frozen=True)
class UncertaintyNumbers:
    chain: float = number(1e-3, "of the decay rate, of the largest component", "error over the width of a mode that the best measuring chain has", "functions may be cleaner, what is measured is not known better")
    window: float = number(1.0 / 3.0, "squared lines", "variance of a Hann window's kernel", "(1, 4, 1)/6")
    memory: float = number(1.1, "-", "of the residual, above which it is not the noise of single lines", SURVEYS)
    sure: float = number(3.0, "standard deviations", "beyond that", SURVEYS)
    many: float = number(8.0, "lines", "across the half-power band, above which a window hardly matters", SURVEYS)

    enough: int = number(8, "responses", "whose scatter tells the error of their mean", SURVEYS)
    disagree: float = number(9.0, "-", "variance between references over the noise's, above which they disagree", "three standard deviations")

    run: int = number(3, "-", "one part in so many of the outputs, in the order of the file, that may be one run", SURVEYS)
    smoothed: int = number(7, "lines", "over which the noise level is averaged", SURVEYS)
    lags: int = number(24, "lines", "over which a residual remembers, at most", SURVEYS)
    lags_share: int = number(4, "-", "one in so many lines, likewise", SURVEYS)
    correlated: float = number(0.02, "-", "least correlation of neighbouring lines that counts", SURVEYS)
    noticed: float = number(3.0, "standard deviations", "likewise", SURVEYS)
    least_left: float = number(0.05, "of a line's freedom", "below which its residual says nothing", SURVEYS)
    least_level: float = number(1e-6, "of the usual level", "of the noise at a line", ROUNDING)
    level_ridge: float = number(1e-12, "of the usual level", "so that no level is nil", ROUNDING)
    least_curvature: float = number(1e-10, "of the diagonal", "of a normal matrix that is inverted", ROUNDING)


UNCERTAINTY = UncertaintyNumbers()
