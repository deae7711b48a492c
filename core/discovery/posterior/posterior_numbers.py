"""The tuned numbers of what a search leaves open."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number


@dataclass(frozen=True)
class PosteriorNumbers:
    sensors: int = number(3, "sensors", "that are proposed, at most", "what a reader takes in")
    sensors_apart: float = number(0.1, "of the structure's size", "how far apart they are")
    tells: float = number(0.1, "of the rms of a shape", "least difference of a reading that a sensor could tell")
    shift: float = number(0.01, "of ln f", "least difference of a mode that was not measured")
    twin: float = number(0.5, "MAC", "of a mode with its twin in another explanation")
    close: float = number(0.02, "of ln f", "modes no further apart are compared as a subspace")
    band_above: float = number(1.5, "of the highest test frequency", "up to which a mode is proposed")
    elastic: float = number(1e-3, "of that", "above which a mode is elastic", ROUNDING)
    nil: float = number(1e-9, "Hz", "frequency of a mode without strain whose log is taken", ROUNDING)


POSTERIOR = PosteriorNumbers()
