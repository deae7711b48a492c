"""The tuned numbers of modal state spaces."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number


@dataclass(frozen=True)
class StateSpaceNumbers:
    damping: float = number(0.01, "of critical", "of modes of which nothing is known", "usual of bolted and riveted structures")
    beyond: float = number(1.5, "of the band", "up to where modes are kept", "Rixen (2001), AIAA Journal 39(10): customary 1.5 to 2")
    sweeps: int = number(4, "rounds", "from shifted to static residual flexibility, each of which gains the ratio of shift and first mode left out", ROUNDING)
    contained: float = number(1e-7, "of a static answer", "below which the kept modes contain it", ROUNDING)
    dependent: float = number(1e-10, "of the largest", "squared size of a residual vector that the others span", ROUNDING)
    resting: float = number(1e-3, "of the highest frequency", "modes below which are rigid-body motions to the rounding of a file", ROUNDING)
    aligned: float = number(1e-6, "-", "what the axes of a node may miss of a direction", ROUNDING)
    still: float = number(1e-12, "of the largest motion", "of modes alone, below which a place does not move", ROUNDING)
    silent: float = number(1e-3, "of the largest of its row and column", "receptance below which an error counts as of this much", "three decades, the range of a test")
    lines: int = number(200, "lines", "of the band over which receptances are averaged", "enough for a median")
    written: int = number(1600, "lines", "of functions that are written, where no number is asked for", "customary of analysers")
    modes: int = number(30, "modes", "kept where neither band nor number is asked for", "convenience")


STATESPACE = StateSpaceNumbers()
