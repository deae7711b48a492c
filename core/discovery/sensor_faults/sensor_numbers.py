"""The tuned numbers of what may be wrong in a test; "rms" is that of a measured shape."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

RMS, SIZE = "of the rms of a shape", "of the structure's size"
SHARE = "of the faulty nodes"


@dataclass(frozen=True)
class SensorNumbers:
    fewest: int = number(8, "nodes", "below which nodes cannot judge each other")
    fewest_modes: int = number(3, "modes", "likewise")
    noise: float = number(0.03, RMS, "noise of a sound sensor where they cannot")
    named: float = number(0.8, "-", "chance from which on a fault is told")
    moves: float = number(0.2, RMS, "that a sensor reads of some mode at least for a fault of it to be told", "true faults of seven cases read 1.4 and more, a false one in a corner of a tower 0.12")
    turned_most: int = number(2, "sensors", "that a test has turned by mistake; more are a structure of another shape", "what a crew gets wrong")
    doubtful: float = number(0.05, "-", "chance of a fault above which a node is no evidence about the model")
    known: float = number(0.97, "-", "chance that what is wrong with a faulty sensor is in the list")
    in_plane: float = number(0.02, "-", "a set of sensors turned so little out of its plane can be turned back")

    noise_least: float = number(0.008, RMS, "least noise of a sound sensor that is thought possible")
    noise_step: float = number(1.4, "-", "times the noise from one level to the next")
    noise_levels: int = number(10, "levels", "of noise")
    noise_strides: int = number(3, "levels", "by which the likeliest is looked for first")
    widths: tuple[float, ...] = number((0.03, 0.06, 0.12, 0.24, 0.48), "of ln f", "how far off in frequency analysis shapes take part in a test shape: what is tried")
    trusted: float = number(0.85, "of the nodes", "the best predicted ones, by which the noise is judged")
    suspicious: float = number(4.0, "of the variance", "squared distance from its prediction at which a node is set aside")
    distance_most: float = number(30.0, "of the variance", "that the distance of one mode counts")
    aside_most: float = number(0.25, "of the nodes", "that are set aside")
    aside_always: int = number(4, "nodes", "that are in any case: a fault that the others' predictions share hides itself")
    aside_always_of: int = number(8, "nodes", "for each of which one is, at most")

    faint: float = number(1e-3, "of the largest weight", "analysis shapes below it take no part", ROUNDING)
    absent: float = number(1e6, "squared rms", "variance of a reading that is not there", "so large that it says nothing")
    nearest: float = number(0.2, "of a test frequency", "analysis frequencies below it count as it")

    local: tuple[float, ...] = number((0.0, 0.015, 0.03, 0.06, 0.12, 0.24, 0.48), RMS, "sizes of what a model may have wrong at one node")
    local_before: tuple[float, ...] = number((0.50, 0.20, 0.12, 0.08, 0.05, 0.03, 0.02), "-", "how likely each is beforehand")
    local_weight: float = number(2.0, "nodes", "that this counts as, beside those of the test")
    local_rounds: int = number(30, "rounds", "in which their shares settle")
    gain_scatter: float = number(0.02, "of ln gain", "of sound sensors")
    stray: float = number(0.05, "of the modes", "that may read anything at a node")
    far: float = number(1.0, RMS, "how far off these are")
    least_variance: float = number(1e-12, "squared rms", "of a reading or of the motion of a node", ROUNDING)

    gains: float = number(1.8, "of ln gain", "gains that are tried, up and down")
    gain_step: float = number(0.0125, "of ln gain", "from one to the next")
    gain_spread: float = number(0.6, "of ln gain", "of a sensor that has a wrong one")
    gain_least: float = number(1.12, "-", "gains nearer to 1 are no faults")
    tail: float = number(5.0, "degrees of freedom", "of what models have wrong in proportion, a t distribution")
    polarity: float = number(0.25, SHARE, "that read the opposite")
    gain: float = number(0.25, SHARE, "that have a wrong gain")
    axis: float = number(0.2, SHARE, "that are turned, where a node has several sensors")
    lonely_axis: float = number(0.05, SHARE, "that are turned, where it has one")
    exchanged: float = number(0.05, SHARE, "two of whose directions are exchanged")
    swapped: float = number(0.25, SHARE, "that are swapped with another")
    mutual: float = number(10.0, "ln", "by which either of two readings fits the place of the other better than all it may be alone, where a third may be mixed up with them", "three mixed up in a tower, a panel, an aeroplane: 6 at most; two exchanged: 34 at least")
    whole: float = number(0.6, "of the faults", "that concern all directions of a node")
    about_any: float = number(0.4, "of the turned sets", "of three, anyhow; the others about one of its axes")
    about_pair: tuple[float, ...] = number((0.1, 0.1, 0.8), "of the turned sets", "of two, about each of its axes and in their plane")

    angle_step: float = number(1.5, "deg", "of the angles that are tried")
    angle_least: float = number(6.0, "deg", "smaller ones are no faults")
    angle_unsure: float = number(0.3, "rad", "spread above which the likeliest angle is told, not the mean")
    tilts: int = number(60, "angles", "by which a lone sensor is tilted")
    ways: int = number(36, "directions", "in which it is")
    turn_step: float = number(0.02, "rad", "of the differences of a log likelihood by a rotation")
    turn_most: float = number(0.2, "rad", "largest step of a rotation")
    turn_done: float = number(0.2, "of turn_step", "step at which a rotation is found")
    turn_rounds: int = number(4, "steps", "of a rotation, at most")
    turn_curved: float = number(1.0, "ln L / rad²", "least curvature of a rotation that the readings hold")

    back_lone: float = number(0.5, "of swapped lone sensors", "with the sign turned", "which way a lone sensor looks is not kept")
    back: float = number(0.15, "of swapped directions", "with the sign turned")
    whole_swap: float = number(0.7, "of swapped sets", "with all directions")

    faulty: float = number(0.5, "nodes", "that are expected to be faulty in a test")
    in_proportion: float = number(0.05, "of the nodes", "at which a model may be wrong by a factor of its own in all modes")
    proportion: float = number(0.04, RMS, "by how much, at least")
    beside: float = number(0.4, "of the nodes", "at which it may, near to another that is off its prediction")
    near: float = number(0.15, SIZE, "how near that is")
    unlike: float = number(0.5, "of their errors", "how far these are from alike")
    sure: float = number(0.9, "-", "chance of a fault that no error of a model looks like, above which none is assumed; of one that it may look like, from which on it is told")
    cleared: float = number(0.01, "-", "chance of not being sound below which a node is not swapped")
    mad: float = number(1.4826, "-", "standard deviation over the median absolute deviation", "normal distribution")


SENSORS = SensorNumbers()
