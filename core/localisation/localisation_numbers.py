"""The tuned numbers of the maps of a misfit."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/localisation"


@dataclass(frozen=True)
class LocalisationNumbers:
    places: int = number(3000, "grids", "of a map, at most", "time")
    elements: int = number(20_000, "elements", "that the map of stiffness looks at, at most", "time")
    reach: float = number(0.06, "of the structure's size", "radius of a patch", CHECK)
    few_sensors: int = number(6, "sensors", "below which noise cannot be judged", CHECK)
    shape_noise: float = number(0.03, "of the rms of a shape", "noise where it cannot", "modal tests")
    rigid: float = number(1e-3, "of the highest frequency", "below which a mode is one of a rigid body", CHECK)

    likely: float = number(0.3, "MAC", "of a test mode that nearly has a partner", CHECK)
    turned: float = number(0.03, "of what is missing of the MAC", "that a sensor turned round explains, at least, to be suspect", CHECK)
    few_pairs: int = number(3, "modes", "below which no sensor is suspected", CHECK)

    near: float = number(0.1, "of f", "modes no further apart mix too readily to say where", CHECK)
    frequency: float = number(0.005, "of f", "standard deviation of a frequency", "modal tests")
    at_once: int = number(2_000_000, "numbers", "of a map that is made at once", "memory")
    neighbours: int = number(12, "sensors", "over which a map by sensors is spread", CHECK)
    width: int = number(4, "sensor places", "itself included, to which the spread reaches", CHECK)

    outlier: float = number(4.0, "medians", "residual of a sensor that is no part of the noise", CHECK)
    outlier_least: float = number(2.0, "standard deviations", "likewise, at least", CHECK)
    floor: float = number(1e-3, "of the rms of a shape", "noise, at least", CHECK)
    rounds: int = number(8, "rounds", "in which outliers are left out", CHECK)
    sound: float = number(0.6, "of the sensors", "that stay, at least", CHECK)
    fitted: float = number(1 / 3, "of the sensors", "so many analysis shapes fit a test shape", CHECK)
    predicted: float = number(1e-6, "of a squared shape", "below which nothing is predicted", ROUNDING)
    typical: float = number(0.25, "quantile", "of the noise of all shapes: what the model lacks spoils it least", CHECK)
    lowest: float = number(1e-3, "of f", "lower frequencies count as it", CHECK)
    at_rest: float = number(1e-6, "of the highest frequency", "below which a mode is at rest", ROUNDING)
    dependent: float = number(1e-3, "of the largest singular value", "of shapes that are alike", CHECK)
    leverage: float = number(0.95, "-", "of a sensor on its own prediction, at most", CHECK)


MAPS = LocalisationNumbers()
