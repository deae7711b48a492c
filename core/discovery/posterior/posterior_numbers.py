"""The tuned numbers of what a search leaves open."""

from dataclasses import dataclass

from ...number_table import number


@dataclass(frozen=True)
class PosteriorNumbers:
    sensors: int = number(3, "sensors", "that are proposed, at most", "what a reader takes in")
    sensors_apart: float = number(0.1, "of the structure's size", "how far apart they are")
    tells: float = number(0.1, "of the rms of a shape", "least difference of a reading that a sensor could tell")
    shift: float = number(0.01, "of ln f", "least difference of a mode that was not measured")
    twin: float = number(0.5, "MAC", "of a mode with its twin in another explanation")
    band_above: float = number(1.5, "of the highest test frequency", "up to which a mode is proposed")


POSTERIOR = PosteriorNumbers()
