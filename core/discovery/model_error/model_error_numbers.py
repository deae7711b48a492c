"""The tuned numbers of the error of a model."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

NOISE = "of the rms of a shape"
BY_HAND = "set by hand from the errors left where what was hidden is known, not yet calibrated"


@dataclass(frozen=True)
class ModelErrorNumbers:
    errors: tuple[float, float] = number((3e-4, 1.0), "of K", "least and largest diffuse error")
    noises: tuple[float, float] = number((0.005, 0.5), NOISE, "least and largest noise of a reading")
    legible: float = number(0.3, "of the rms of a shape", "noise of the readings from which on shapes bear no model out", "0.12 on a measured aeroplane, 0.34 where one of six sensors reads what another should")
    frequency: float = number(0.001, "of f", "standard deviation of a measured frequency, at least")
    starts: int = number(5, "errors", "and noises, from the best of which they are looked for uphill")
    shrinks: float = number(0.05, "of its square", "that an error or a noise becomes in such a step, at least")
    reach: float = number(0.5, "of ln f", "a mode that nobody explains may be anywhere within it")
    stray: float = number(0.03, "-", "chance that a test mode is none of the model's")
    nil: float = number(20.0, "ln L", "less than the likelihood of a stray mode, below which a pair is not looked at", "double precision")
    tie: float = number(1e-6, "ln L", "by which the more alike of repeated modes is the partner", "decides ties alone")
    unseen: float = number(1e-6, "of the largest squared length", "of a mode at the sensors, at least: what they do not see is rounding", ROUNDING)
    independent: float = number(24.0, "readings", "of a shape that count as independent, at most")
    cells: int = number(8, "boxes", "along the longest side, in each of which a smooth field is one value")
    degree: int = number(2, "-", "of the polynomials that smooth fields are made of, at most")
    flat: float = number(0.05, "-", "what a polynomial must have of its own beside the others", "thin structures have no fields across")
    most: float = number(0.4, "rms", "of a smooth field, at most")
    drifts: tuple[float, ...] = number((0.03, 0.01, 0.003), "rms", "of each smooth field, sizes that are tried", "all of them together make a tenth: more is no drift but another structure")
    drift_part: float = number(0.15, "of the diffuse error", "below which a size of smooth fields is not tried: it could not make it", "fits from three starts on a measured aeroplane find the same then")
    suspension: float = number(0.1, "of the lowest eigenvalue", "standard deviation of what a free structure swings on", "a suspension is soft where it swings at a third of the lowest frequency")
    sensor_mass: float = number(0.02, "of the structure's mass", "standard deviation of what all sensors weigh")
    mesh: float = number(1.0, "of what lumping does", "standard deviation of the error of the mesh, as a whole and along each axis: 0 lumped mass, 1 consistent", "what lumping does to linear shells")
    mesh_most: float = number(3.0, "of what lumping does", "that it is, at most")
    drift_gain: float = number(60.0, "ln L", "that smooth fields gain, at most: they are not tried for hypotheses that are further behind", "time")
    promised: float = number(1.0, "ln L", "that smooth fields must promise to be tried", "time")
    seen: float = number(3.0, "ln L", "what smooth fields or known parameters must gain to be spoken of, and for a model to lack something")
    clamp: tuple[float, float] = number((1.0, 1.0), "of ln f", "mean and standard deviation beforehand of what the row in which a clamp ends is stiffer by", "1/f is the part of it that is left: anything between 0 and 1")
    clamp_rows: int = number(4, "rows of elements", "that a clamp may reach further in, at most")
    clamp_rigid: float = number(100.0, "times that", "what rows within the reach are stiffer by")
    shape: float = number(0.005, "of the structure's size", "standard deviation of how far its shape is off beforehand", "tolerances of hollow sections, EN 10219-2: straight to 0.2 % of the length, sides to 0.6 to 1 %, round to 2 % of the diameter")
    shape_most: float = number(10.0, "times that", "that it is, at most")
    shape_unit: float = number(0.01, "of ln p", "that stands for a standard deviation of it")
    shape_step: float = number(0.05, "times that", "to which nodes are moved to see what it does", "of what a bowed plate strains as it turns as a whole, all of which has to cancel, the square of this slope is left")
    shape_starts: tuple[float, ...] = number((-2.0, -0.4, 0.4, 2.0), "times that", "from the best of which its amplitude is fitted", "the first order of a bow of a plate is nothing")
    short: float = number(0.3, "of the largest extent", "below which nothing is bowed, twisted or tapered along it")
    basic: float = number(0.99, "-", "cosine to a basic axis from which on an axis goes by its name")
    round: float = number(0.05, "of the moment about an axis", "by which moments across it differ in what is not round, and of a radius that on an arc differ")
    arc_gap: float = number(0.5, "rad", "between nodes along an arc, at most", "four corners lie on a circle, too")
    folds: int = number(5, "parts", "of the test modes, each of which is foretold by the others")
    usual: float = number(0.003, "of K", "median of the errors that right models left", BY_HAND)
    usual_noise: float = number(0.1, "of K a relative noise of readings", "what it is beside that in a poor test", BY_HAND)
    usual_spread: float = number(1.2, "of ln ε", "standard deviation of them", BY_HAND)
    adequate: float = number(0.05, "-", "adequacy below which something else is missing")
    claimed: float = number(0.2, "-", "adequacy below which no effect is claimed", "230 cases: 3 of 13 effects found below it were right, 9 of 14 between it and 0.4, 58 of 75 above")
    explained: float = number(0.4, "-", "adequacy below which the known parameters are not said to explain the gap, and no sensor to read too much or too little", "195 frozen cases")
    steps: int = number(12, "steps", "uphill, of unknowns or of error and noise alone, at most")
    step: float = number(0.5, "of ln p or θ", "by which an unknown moves in one, at most")
    tolerance: float = number(0.1, "ln L", "gain of such a step that counts, and that is looked for")
    dampings: int = number(6, "trials", "of Levenberg's damping a step")
    told: float = number(0.15, "of θ", "standard deviation of a magnitude above which its posterior is followed to either side", "below it a normal one is near enough")
    profile: tuple[float, float, float] = number((0.3, 0.6, 1.7), "of θ, of θ, times the step before", "first step to either side, at least and at most, and each further one")
    profile_depth: float = number(4.0, "ln L", "below its highest, down to which a posterior is followed")
    profile_fine: int = number(400, "magnitudes", "by which it is summed")


MODEL_ERROR = ModelErrorNumbers()
