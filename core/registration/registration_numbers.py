"""The tuned numbers of laying a test onto a model."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/registration"
SIZE = "of the model's size"


@dataclass(frozen=True)
class RegistrationNumbers:
    on_model: float = number(0.9, "of the test nodes", "must lie on the model for the frames to agree as they are", CHECK)
    fewest: float = number(0.5, "of the test nodes", "must lie on the model in the best position found", CHECK)
    poor: float = number(0.5, "score", "below which a frame that fits is doubted", CHECK)
    good: float = number(0.7, "score", "of another position above which it is", CHECK)
    ahead: float = number(0.25, "score", "by which that is better", CHECK)
    closer: float = number(3.0, "times", "nearer by a small move than the frame as it is: worth a warning", CHECK)
    closer_least: float = number(0.005, SIZE, "rms distance above which it is", CHECK)

    usual: tuple[float, float] = number((0.5, 1.25), "of the model's size", "a test's that needs no further reason", "modal tests")
    possible: tuple[float, float] = number((0.1, 1.4), "of the model's size", "a smaller test's is suspect, a larger one's impossible", "modal tests")
    far_too_small: float = number(10.0, "times smaller still", "where no unit explains it either: refused", CHECK)
    outlying: float = number(4.0, "times the ninth decile of the distances from the middle", "at which a test node lies apart", CHECK)
    most_nodes: float = number(0.9, "of the test nodes", "that set what is far", CHECK)
    unit_near: float = number(0.01, SIZE, "how near a point on it is", CHECK)
    unit_own: float = number(0.1, "of the test's own size", "likewise", CHECK)
    rounded: float = number(999.5, "-", "ratio of sizes from which on it is told in tens", "what a reader takes in")

    free: float = number(0.02, SIZE, "by which a test must be able to move to count as free", CHECK)
    turn_step: float = number(2.0, "deg", "between samples of a family of poses", "time")
    slide_step: float = number(0.01, SIZE, "likewise", "time")
    followed: tuple[float, ...] = number((0.2, 0.5), SIZE, "how far a motion is followed to find its axis", CHECK)
    most_samples: int = number(1500, "poses", "of a family, at most", "time")
    settling: int = number(8, "steps", "by which a pose comes to rest again", CHECK)
    led_least: float = number(0.3, "of the way", "that it must lead when it is followed", CHECK)
    led_along: float = number(0.5, "cosine", "with the way it set out on", CHECK)
    turning: float = number(0.2, "-", "strength of the turn in a motion that is no slide", CHECK)
    still: float = number(1e-9, "of the squared motion", "of points that a motion does not move", ROUNDING)
    off: float = number(1.5, "times the limit", "rms distance of samples that are laid on the facets", CHECK)
    settled: int = number(3, "steps", "of samples along one motion", "time")
    feasible: float = number(2.0, "times the limit", "rms distance at which a test about fits", CHECK)

    band: float = number(0.3, "of ln f", "within which analysis modes may explain a test mode", CHECK)
    most_modes: int = number(6, "modes", "that may, at most", CHECK)
    fewest_modes: int = number(2, "modes", "that may, at least: a pair is not torn", "repeated modes")
    sensors_a_mode: int = number(6, "sensors", "for each mode that may, at least", CHECK)
    most_sensors: int = number(240, "sensors", "that are scored", "time")
    at_once: int = number(20_000, "sensors", "in poses that are scored at once", "memory")
    ridge: float = number(1e-6, "-", "on a Gram matrix of shapes that are alike", ROUNDING)
    lowest: float = number(1e-3, "of the highest frequency", "lower ones count as it", CHECK)

    points: int = number(48, "points", "on which poses are searched, spread as far as can be", "time")
    families: int = number(12, "families", "of poses, at most", "time")
    halvings: int = number(8, "halvings", "of steps to the best position", CHECK)
    named: int = number(4, "scores", "that a sentence names", "what a reader takes in")
    open_turn: float = number(15.0, "deg", "that a test must be able to turn for that to be told", CHECK)
    open_slide: float = number(0.05, SIZE, "that it must be able to slide", CHECK)
    same_angle: float = number(5.0, "deg", "rotations no further apart are alike", CHECK)
    peaks: int = number(5, "positions", "of a family that are refined", "time")
    coarse: float = number(0.1, "score", "behind the best sample: not refined", CHECK)
    calm: float = number(1.25, "-", "times the least distance that a position of less rotation may have", CHECK)
    flat: float = number(0.5, "of a motion's reach", "over which shapes stay as good: correlation does not decide", CHECK)
    exact: float = number(1e-9, SIZE, "distance that is rounding", ROUNDING)
    told_apart: float = number(0.01, "score", "difference that tells positions apart, at least", CHECK)
    told_share: float = number(0.1, "of what is missing to 1", "likewise", CHECK)
    alike: tuple[float, float] = number((1.5, 0.002), "of the least distance, of the model's size beside it", "rms distance that fits about as well", CHECK)
    distance: float = number(0.02, "score", "that distance up to the limit costs", CHECK)
    calm_short: float = number(100.0, "rad", "that a score which falls short counts", CHECK)
    calm_off: float = number(10.0, "rad", "that a distance beyond `calm` counts", CHECK)
    gap_turn: float = number(5.0, "steps", "between samples without a gap: turned ones settle on facets", CHECK)
    gap_slide: float = number(2.0, "steps", "likewise of slides", CHECK)

    cap: float = number(0.03, SIZE, "a point farther off counts as this far: it is off the model", CHECK)
    cloud: int = number(20_000, "points", "sampled on a surface", "time")
    every: int = number(50, "points", "of which one tells their spacing", "time")
    starts: int = number(300, "rotations", "that are tried at random", "time")
    keep: int = number(40, "poses", "that are polished", "time")
    coarser: tuple[tuple[int, float], ...] = number(((1, 1.0), (3, 0.3), (9, 0.1)), "part of the starts, softness", "of rounds that thin them out", CHECK)
    softest: float = number(0.03, "-", "softness of the last of these rounds", CHECK)
    coarse_steps: int = number(4, "steps", "of each", CHECK)
    beyond: float = number(0.3, "of a point's distance", "along the surface that is beyond its border", CHECK)
    outlier: float = number(3.0, "medians", "distance at which a point counts a quarter", "Geman and McClure")
    damping: float = number(1e-4, "of the mean curvature", "of a step", CHECK)
    polish: int = number(30, "steps", "at most", CHECK)
    gain: tuple[float, float] = number((1e-6, 1e-12), "of the distance, of the model's size", "that a step must bring", ROUNDING)
    foot: float = number(1e-9, SIZE, "along the surface that a foot may be off", ROUNDING)
    near: float = number(1e-6, SIZE, "scale of distances, at least", ROUNDING)
    small_turn: float = number(1e-4, "rad", "below which a turn is developed in a series", ROUNDING)


ALIGN = RegistrationNumbers()
