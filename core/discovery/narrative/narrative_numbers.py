"""The tuned numbers of what a person is told."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

SIZE, READER = "of the structure's size", "what a reader takes in"
CALIBRATED = "279 unseen cases, frozen, by `benchmarks.discovery.calibrate`, rounded down"


@dataclass(frozen=True)
class NarrativeNumbers:
    off_one: float = number(4.0, "standard deviations", "that a factor is off 1, at most, by the likelihood without it")
    claimed: float = number(0.9, "-", "share of findings that are right where an effect is claimed", CALIBRATED)
    little: float = number(2.5, "ln L a test mode", "gain of a claim below which it is less sure")
    claimed_by_little: float = number(0.6, "-", "share of findings that are right where a claim gains less", "5 of 7 fresh cases, and the rule of succession, rounded down")
    doubted: float = number(0.4, "-", "the same where none is, one proposed or not", CALIBRATED)
    nothing: float = number(0.92, "-", "share of answers without an effect that are right", CALIBRATED)
    like_model: float = number(0.8, "-", "share of sensors said to be turned or to read too much or little that are", CALIBRATED)
    held: float = number(10.0, "of the structure's mass", "above which a mass at one place is none: the test is held there", "the place moves less than a tenth of what it would")
    hardly: float = number(20.0, "-", "quotient of the ends of an interval from which on a magnitude is hardly known")
    modes_each: int = number(3, "modes", "for each effect of a claim, and where sensors are accused, at least", "an effect has a place and a size; none of 256 claims in unseen cases had fewer")
    alternatives: int = number(5, "alternatives", "that are told, at most", READER)
    rivals: int = number(3, "hypotheses", "that further data should tell from the best, at most", READER)
    rival: float = number(7.0, "ln L", "how far behind the best they are, at most", "a thousand times less likely")

    damper_sure: float = number(0.6, "-", "posterior of a dashpot at its place from which on it is an effect")
    damper_told: float = number(0.02, "-", "posterior of a dashpot anywhere from which on it is an alternative")
    damper_confidence: float = number(0.88, "-", "share of clear findings of dashpots that are right", "six of six, and the rule of succession")
    damper_together: float = number(0.1, SIZE, "places that are nearer are one")
    damper_tie: float = number(1e-6, "-", "weight by which the likeliest of places that hold as much comes first", "decides ties alone")
    damper_credible: float = number(0.05, "of the likeliest place's weight", "below which a place is not listed")
    damper_places: int = number(40, "places", "that are listed, at most", READER)

    grids_named: int = number(4, "grids", "of supports that give together, up to which each is named", READER)
    at_zero: float = number(1e-9, SIZE, "below which a coordinate is said to be 0", ROUNDING)
    rim: float = number(0.95, "of the largest radius", "from which on grids are on the rim of a round structure")
    rim_filled: int = number(23, "of 24 sectors", "that hold grids of the rim if a structure is round", "one may be cut out")


NARRATIVE = NarrativeNumbers()
