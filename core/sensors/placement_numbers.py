"""The tuned numbers of sensors on a model."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/sensors"
SIZE = "of the model's size"


@dataclass(frozen=True)
class PlacementNumbers:
    reach: float = number(0.1, SIZE, "within which the nearest facet is found exactly", "time")
    wider: tuple[float, float] = number((1e-9, 1e-12), "of the bound, of the model's size", "by which a search looks further", ROUNDING)
    tied: float = number(1e-9, SIZE, "distances no further apart are alike: a face wins over a line on its edge", ROUNDING)
    slender: float = number(1e-14, "sin²", "of a facet without an area", ROUNDING)
    warped: float = number(1e-24, "of the squared diagonal", "below which a quad is flat", ROUNDING)
    rounds: int = number(12, "steps", "to the foot on a warped quad", CHECK)

    measured: float = number(1e-4, "of a node's largest motion", "below which a direction was not measured", "five to six digits of universal files")
    vectors: int = number(4, "independent vectors", "below which a node that moves in a plane only does not show", CHECK)
    plain: float = number(1e-6, "-", "error of axes that are at right angles", ROUNDING)
    named: int = number(10, "nodes", "that a sentence names", "what a reader takes in")
    fewest: float = number(0.2, "of the sensors", "on the model, below which a test is refused", CHECK)
    local: float = number(0.5, "of the local mesh size", "that a sensor may be off the model", CHECK)
    off: tuple[float, float] = number((0.005, 0.03), SIZE, "that it may be, at least and at most", CHECK)
    dependent: float = number(1e-8, "of the largest pivot", "of shapes that the candidates do not tell apart", ROUNDING)
    at_once: float = number(0.05, "of the candidates", "that are left out in one step while there are many", "time")
    one_by_one: int = number(500, "candidates", "from which on they are left out one by one", "time")
    pool: int = number(2000, "candidates", "among which the least MAC is sought", "memory")
    slight: float = number(1e-6, "-", "weight of the mean beside the least of equal shares", ROUNDING)
    rotation: float = number(1e-6, "-", "error of a rotation that is none", ROUNDING)


PLACEMENT = PlacementNumbers()
