"""The tuned numbers of a comparison, unless its user says otherwise."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/correlation"


@dataclass(frozen=True)
class CorrelationNumbers:
    mac: float = number(0.7, "MAC", "of a pair, at least", "practice of modal correlation")
    frequency: float = number(0.3, "of f", "between the modes of a pair, at most", CHECK)
    cluster: float = number(0.02, "of f", "over which modes count as one subspace", CHECK)
    tie: float = number(1e-9, "squared cosine", "so that every column of a turned cluster gets a number", ROUNDING)
    on_model: float = number(0.9, "of the sensors", "on the model that prove a very small test to be a part of it", CHECK)
    reading: float = number(0.05, "of the rms of a shape", "error of a reading besides that of the fit: gain, place, model", "modal tests")
    ring: float = number(0.01, "of the size of the sensor set", "by which sensors of a ring may be off it", CHECK)
    ring_points: int = number(5, "places", "of a ring, at least: three tell the circle, five two waves", CHECK)
    in_rings: float = number(0.6, "of the sensors", "that stand on rings of a body of revolution", CHECK)
    straight: float = number(0.9, "cosine", "of a sensor that looks radially, tangentially or along the axis", CHECK)
    told_apart: float = number(0.8, "squared cosine", "of two harmonics at the sensors from which on they are not told apart", CHECK)
    dependent: float = number(1e-6, "of the larger", "of a wave that is zero at all sensors of a ring", ROUNDING)
    sectors: int = number(12, "sectors", "in which a body of revolution is looked at along its axis", CHECK)
    round: float = number(0.9, "of the largest", "of the rim of a round body in each sector", CHECK)
    harmonics: int = number(30, "waves", "round the axis that are looked for, at most", "time")
    harmonic: float = number(0.5, "of the power", "of a shape's harmonic, for it to be named", CHECK)
    angle_digits: int = number(9, "digits", "of directions that are different", ROUNDING)
    little: float = number(0.5, "weight", "below which a sensor is named", CHECK)
    nasa: tuple[float, float, float] = number((5.0, 0.90, 0.10), "%, -, -", "frequency, cross-orthogonality of pairs, and of others, asked by NASA for payloads", "NASA-STD-5002 as commonly quoted, its text not at hand")
    air_force: tuple[float, float, float] = number((3.0, 0.95, 0.10), "%, -, -", "the same asked by the US Air Force", "SMC-S-004 as commonly quoted, its text not at hand")
    crowd: int = number(4, "modes", "of a cluster, at most, that need no doubt: two pairs of an axisymmetric structure", CHECK)
    identical: float = number(0.999, "MAC", "of two test modes above which they are one shape", CHECK)
    same_hz: float = number(0.002, "of f", "by which the frequencies of a mode listed twice differ, at most", CHECK)
    rigid: float = number(0.99, "of a squared shape", "that is a motion of the whole in a mode on a suspension", CHECK)
    rigid_modes: int = number(3, "modes", "that are, at least, where a test is free: two are the sway of a tower", CHECK)
    one_place: float = number(1e-3, "of the structure's size", "between grids of two models that are in one place", CHECK)
    places: tuple[int, int] = number((4, 2000), "places", "that two models must have in common, and that are compared at most", "time")
    at_rest: float = number(1e-3, "of the highest frequency", "below which a mode is one of a rigid body", CHECK)
    along: float = number(0.999, "cosine", "of a direction with a basic axis that is one", ROUNDING)
    named: int = number(8, "sensors", "that a sentence names", "what a reader takes in")


CORRELATION = CorrelationNumbers()
