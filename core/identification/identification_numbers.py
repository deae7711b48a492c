"""The tuned numbers of what is said of a mode."""

from dataclasses import dataclass

from ..number_table import ROUNDING, SURVEYS, number


@dataclass(frozen=True)
class IdentificationNumbers:
    poor_quality: float = number(0.9, "-", "correlation of responses about a mode below which it is remarked", SURVEYS)
    poor_mpc: float = number(0.7, "-", "modal phase collinearity below which it is remarked", SURVEYS)
    poor_indicator: float = number(0.3, "-", "indicator of a mode below which it is remarked", SURVEYS)
    weak: float = number(0.05, "of a shape", "standard error above which it is called uncertain", SURVEYS)
    poor_reciprocity: float = number(0.85, "MAC", "of shape and participation at the driving points, below which it is remarked; aeroplane 0.89 at least, surveys in order 0.97", SURVEYS)
    one_participation: float = number(0.99, "MAC", "above which two modes are one to the references", SURVEYS)
    other_responses: float = number(0.2, "MAC", "of magnitudes of shapes, below which responses of one mode are others than those of another; random shapes 0.4", SURVEYS)
    most: float = number(0.5, "of the modes", "that are so, from which a single reference tells it; GARTEUR 0.2, surveys whose frequencies differ 0.6 at least", SURVEYS)
    beside: float = number(0.04, "of f", "within which a resonance may stand whose frequency differs from response to response", SURVEYS)
    heavy: float = number(30.0, "times the median of all modes", "modal mass above which it is remarked", SURVEYS)
    input_rank: float = number(0.02, "-", "singular value ratio below which references see one and the same", SURVEYS)
    excited: float = number(1e-9, "of the largest eigenvalue", "below which a combination of references excites nothing", ROUNDING)
    near_lines: float = number(5.0, "lines", "to either side of a mode over which its quality is judged, at least", SURVEYS)
    by_hand: float = number(0.005, "of f", "within which a root stands that is taken or refused by hand", "what is read off a chart")
    damping: float = number(0.01, "of critical", "of a pole that is started by hand where there is no mode", "typical of metal structures")
    dampings: tuple[float, ...] = number((0.3, 1.0, 3.0, 10.0), "of the typical one", "that are tried for it, where the other roots draw it away", SURVEYS)
    held: float = number(0.4, "significance", "that it then has, at least; 0.3 at most where nothing is, 0.55 at least of what other ranges of the aeroplane show", SURVEYS)
    peak_db: float = number(6.0, "dB", "that a peak without a mode stands out, at least, to be told", SURVEYS)
    peak_noise: float = number(5.0, "times the noise", "that it has, at least", SURVEYS)
    peak_widths: float = number(3.0, "half widths", "within which a mode makes it", SURVEYS)
    peak_lines: float = number(3.0, "lines", "likewise, at least", "width of a window")
    orders: tuple[int, int] = number((2, 20), "orders", "first and last whose poles tell conjugated functions", SURVEYS)
    orders_last: int = number(6, "orders", "the last, whose stable poles are counted", SURVEYS)
    backwards: int = number(3, "-", "times as many of the conjugated functions say that these run backwards", SURVEYS)
    stable: float = number(0.1, "of critical", "damping of a pole that counts as stable", SURVEYS)


IDENTIFICATION = IdentificationNumbers()
