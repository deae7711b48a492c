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
    exchanged: float = number(0.25, "of that difference", "that an exchange of references leaves, for it to be believed", SURVEYS)
    permuted_most: int = number(6, "references", "of which every exchange is tried", "time: 720")
    window_sure: float = number(3.0, "standard deviations", "below nil, that damping less that of a window is at most", SURVEYS)
    even: float = number(1e-3, "of the spacing", "by which lines may be unevenly spaced", "single precision of a file")
    coincident: float = number(1e-6, "of the size of the geometry", "nodes this close are one point", ROUNDING)

    signs_inputs: int = number(3, "references", "that tell which function of a point has the wrong sign", "two contradict each other")
    signs_clear: float = number(3.0, "-", "first singular value over the second, where one mode rules", SURVEYS)
    signs_better: float = number(0.3, "-", "of what contradicts, that is left with the sign turned, at most", SURVEYS)

    pair_width: float = number(0.01, "of f", "frequencies closer than this are a subspace", SURVEYS)
    known: float = number(0.3, "of a component", "standard error that one which a shape is scaled by has, at most", SURVEYS)
    doubtful: float = number(4.0, "of the median one's", "standard error above which a component is not known", SURVEYS)
    parallel: float = number(0.4, "-", "ratio of singular values below which real shapes of a pair are nearly one", SURVEYS)

    rigid: float = number(0.95, "of a shape's square", "in the rigid-body motions from which it is called one of them", SURVEYS)
    rigid_sensors: int = number(2, "sensors", "per rigid-body motion, below which shapes cannot be told from them", SURVEYS)
    rigid_spanned: float = number(1e-3, "-", "least singular value of a rigid-body motion, over the largest", SURVEYS)


SURVEY = SurveyNumbers()
