"""The tuned numbers by which a survey of frequency responses is read."""

from dataclasses import dataclass

from ...number_table import ROUNDING, SURVEYS, number


@dataclass(frozen=True)
class SurveyNumbers:
    lines_least: int = number(16, "lines", "of a survey", SURVEYS)
    model_error: float = number(0.01, "of a response", "error that it is assumed to have besides its noise", SURVEYS)
    too_smooth: float = number(1e-5, "noise over rms", "below which functions were computed, not measured", SURVEYS)
    noise_only: float = number(0.7, "noise over rms", "above which a response holds nothing else", SURVEYS)
    coherence_most: float = number(1e-6, "-", "by which a coherence exceeds 1", ROUNDING)
    level_rounds: int = number(5, "rounds", "in which levels of inputs and outputs settle", "they settle in few")
    named: int = number(5, "names", "that a message lists", "what a reader takes in")

    decays: float = number(0.8, "of an impulse response's square", "in its first half, typically, for a dead one to be told; in surveys in order 0.98 to 0.999", SURVEYS)
    goes_on: float = number(0.62, "of an impulse response's square", "in its first half, below which it is noise (0.5); in surveys in order 0.98 at least, at 20 % noise 0.70", SURVEYS)
    impulse: int = number(3, "samples", "of an impulse response that are the impulse itself, to either side", "width of a Hann window's spectrum")
    beside: float = number(0.5, "of an impulse response's square", "beside the impulse, above which a function is noise and no line of modes outside the range", SURVEYS)
    noisy: float = number(7.0, "times the survey's noise", "from which a function is named; in surveys in order 2.9 at most", SURVEYS)
    noisy_part: float = number(0.3, "of the range", "that exceeds it, at least", SURVEYS)
    noise_lines: int = number(32, "lines", "of a part of the range whose noise is estimated", SURVEYS)
    flat: float = number(1e-5, "of the largest value", "within which values are the same", "what single precision and five digits keep")
    flat_lines: int = number(5, "lines", "at the largest value say that a function was cut off", SURVEYS)
    impulse_from: int = number(8, "lines", "missing at 0 Hz, at most, for an impulse response", SURVEYS)
    echo_least: float = number(0.2, "rad", "ripple of the phase of a double hit, at least", SURVEYS)
    echo_share: float = number(0.35, "of the phase's square", "that one ripple explains, at least; in surveys in order 0.25 at most", SURVEYS)
    echo_phase: float = number(0.35, "rad", "typical phase against the others, above which modes are no normal ones; aeroplane 0.18, GARTEUR 0.28", SURVEYS)
    echo_cycles: float = number(2.0, "cycles", "of a ripple in the range, at least", SURVEYS)
    echo_alone: float = number(3.0, "cycles", "likewise, of a ripple that other functions of the point do not have", SURVEYS)
    echo_together: int = number(2, "functions", "of a point that have it, at least, for the former", SURVEYS)
    echo_line: float = number(0.35, "cycles per line", "of a ripple, at most", SURVEYS)
    echo_functions: int = number(8, "functions", "that have one phase to measure against, at least", SURVEYS)

    peaks_most: int = number(10, "peaks", "in one band", SURVEYS)
    core_most: int = number(2000, "lines", "in the core of one band", "time")
    core_least: int = number(96, "lines", "a band is not split below twice this", SURVEYS)
    core_widths: float = number(12.0, "half-power bandwidths", "likewise, of its modes", SURVEYS)
    margin: float = number(0.25, "of the core's width", "on either side", SURVEYS)
    margin_lines: int = number(8, "lines", "on either side, at least", SURVEYS)
    prominence_db: float = number(1.0, "dB", "of a peak of the indicator", SURVEYS)

    misaligned: float = number(0.03, "-", "part of a reference direction that the responses do not span, at most", SURVEYS)
    spanned: float = number(1e-6, "-", "least singular value of the directions of a node, over the largest", ROUNDING)
    in_phase_deg: float = number(45.0, "deg", "phase of a modal mass, at most", SURVEYS)
    unreciprocal: float = number(0.3, "of H", "difference of H_ij and H_ji above which scaling is withheld", SURVEYS)
    window_sure: float = number(3.0, "standard deviations", "below nil, that damping less that of a window is at most", SURVEYS)
    even: float = number(1e-3, "of the spacing", "by which lines may be unevenly spaced", "single precision of a file")
    disagree: float = number(0.1, "-", "mean failure of driving points and reciprocity (0 to 1) from which exchanges of references are tried; aeroplane 0.005", SURVEYS)
    exchanged: float = number(0.25, "of that failure", "that an exchange leaves, for it to be believed", SURVEYS)
    coincident: float = number(1e-6, "of the size of the geometry", "nodes this close are one point", ROUNDING)

    coherent: float = number(0.8, "-", "coherence where a function is large, below which it is named", "standard error of H over 15 % in five averages, Bendat and Piersol 9.2")
    signs_outputs: int = number(4, "responses", "that tell how the functions of a point belong together, at least", SURVEYS)
    signs_clear: float = number(3.0, "-", "first singular value over the second, where one mode rules", SURVEYS)
    signs_prominence_db: float = number(3.0, "dB", "of a peak at which signs are compared", SURVEYS)
    signs_lines: int = number(2, "lines", "to either side of it", SURVEYS)
    signs_peaks: int = number(4, "peaks", "that are compared, at least; three let a node look like a fault", SURVEYS)
    signs_better: float = number(0.3, "-", "of what contradicts, that is left after a change, at most; in surveys in order 1.9 at least", SURVEYS)
    signs_rival: float = number(2.0, "times the least left", "below which another change is as likely", SURVEYS)
    flows: float = number(0.25, "of a function's square", "that is in phase with the force's power, at least, to judge a driving point; noise alone 0.18 at most, surveys 0.37 at least", SURVEYS)
    gives: float = number(0.5, "-", "share of positive power less negative of a driving point, at least; in real surveys 0.996 at least", SURVEYS)
    takes: float = number(-0.9, "-", "likewise, of one that is reversed, at most", SURVEYS)
    reciprocal: float = number(0.5, "-", "correlation of two reciprocal functions of the same sign, at least; aeroplane 0.975", SURVEYS)
    neighbours: int = number(6, "points", "of the same direction that tell what one between them does", SURVEYS)
    one_way: float = number(0.99, "-", "cosine of directions that are the same", SURVEYS)
    neighbour_slope: float = number(0.3, "-", "that holds the slope of the interpolation down", SURVEYS)
    neighbour_left: float = number(0.15, "of a function's square", "that neighbours leave, for them to tell; aeroplane 0.04 typically", SURVEYS)
    neighbour_odd: float = number(0.6, "of a function's square", "that neighbours leave of one which may be wrong, at least", SURVEYS)
    neighbour_most: int = number(40, "points", "of which every exchange is tried", "time: 780")

    pair_width: float = number(0.01, "of f", "frequencies closer than this are a subspace", SURVEYS)
    known: float = number(0.3, "of a component", "standard error that one which a shape is scaled by has, at most", SURVEYS)
    doubtful: float = number(4.0, "of the median one's", "standard error above which a component is not known", SURVEYS)
    parallel: float = number(0.4, "-", "ratio of singular values below which real shapes of a pair are nearly one", SURVEYS)

    rigid: float = number(0.95, "of a shape's square", "in the rigid-body motions from which it is called one of them", SURVEYS)
    rigid_sensors: int = number(2, "sensors", "per rigid-body motion, below which shapes cannot be told from them", SURVEYS)
    rigid_spanned: float = number(1e-3, "-", "least singular value of a rigid-body motion, over the largest", SURVEYS)


SURVEY = SurveyNumbers()
