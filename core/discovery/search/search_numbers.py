"""The tuned numbers of the search; "θ" are steps of the log of a magnitude."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

SIZE, GAIN, LN = "of the structure's size", "of the best one's gain", "2 ln L"
SCAN = "cache: their matrices stay near the processor"


@dataclass(frozen=True)
class SearchNumbers:
    sizes: tuple[float, ...] = number((-0.4, -0.15, 0.0, 0.15, 0.4), "θ", "steps tried where a suspect moves, changes its shape or becomes equipment")
    promising: int = number(12, "places", "next to a suspect that are tried with every size, and of which it is asked what a step of all unknowns would leave")
    tried: int = number(2, "hypotheses", "that promise most, that are fitted to the whole test", "time")
    looked: int = number(5, "hypotheses", "of a kind, at a place or judged by the diffuse error, at the last look", "time")
    rounds: int = number(6, "moves", "of a suspect to what is next to it, at most")
    rivals: int = number(12, "hypotheses", "of a number of suspects that are kept and judged", "time")
    worth: float = number(0.35, GAIN, "what gains less is not fitted, not grown, and no rival")
    steps_whole: int = number(2, "steps", "on the whole basis after those on a small one")
    locals_kept: int = number(4, "states", "whose modes are kept, among which suspects move", "memory")
    better: float = number(0.3, LN, "what a move must gain")

    anew_near: float = number(0.05, "of the objective", "another suspect in place of one that is no worse by more than this is moved to better neighbours")
    anew_all: int = number(3, "suspects", "from so many on only the one that is missed least is looked for anew")
    hopeless: float = number(0.3, "of its price", "a further suspect that gains less before it is moved to better neighbours is given up")
    worth_refining: float = number(0.175, GAIN, "a place that gains less in a first scan is not looked at more closely", "half of what is worth it")
    same_place: float = number(0.5, "of Effort.apart", "hypotheses whose suspects are nearer are one")

    sizes_many: int = number(30, "sizes", "of a kind above which not all are evaluated anywhere")
    sizes_places: int = number(30, "places", "that are evaluated of a kind with many sizes")
    every_size: float = number(0.3, "of the places", "that are looked at with every size")
    every_size_least: int = number(30, "places", "that are, at least")
    still: float = number(0.02, "of the largest", "squared motion of a place up to which a kind with one direction is not looked at there")
    at_once: int = number(64, "places", "scanned at once", SCAN)
    pencil_shift: float = number(1e-8, "of the largest eigenvalue", "least eigenvalue with which a pencil is solved", ROUNDING)
    nearest: int = number(3, "modes", "tried for each test mode in the secular equation, the best counts")
    resonance: float = number(1e-9, "of the eigenvalue", "least gap to a mode in the secular equation", ROUNDING)
    secular_least: float = number(1e-3, "of the eigenvalue", "least eigenvalue that the secular equation foretells")

    estimates: int = number(4, "times", "the errors of the model are estimated, at most")
    shrinks: float = number(0.9, "of the error before", "that an estimate has to be less to be searched by")
    every_across: float = number(40.0, "places", "across the structure, each way, that a search by estimated errors looks at, where there are many")
    every_most: int = number(3000, "grids", "that it looks at one by one, at most", "time")

    margin: float = number(6.0, LN, "what a suspect must gain besides the log of the number of its choices")
    suspect: float = number(5.0, "ln L", "what a suspect must gain besides the log of its choices for it to be spoken of")
    claimed: float = number(5.0, "ln L a test mode", "gain over the known parameters and smooth fields, and over other effects, from which on an effect is clear whatever is left", "fresh cases with causes that no list has")
    each_mode: float = number(1.5, "ln L a test mode", "that an effect gains over the known parameters and smooth fields, at least, to be clear beside more than a small part of the error", "of 230 cases made by another program none of eight that gained less was right")
    small_part: float = number(0.25, "of the error before", "what true effects left, and false ones never", "twelve cases by another program")
    usual_left: float = number(0.6, "of the part of the error that is left", "adequacy above which an effect is claimed", "true and false claims among 115 cases made for development")
    look_sizes: tuple[float, ...] = number((-1.6, -0.8, -0.3, 0.0, 0.3, 0.8, 1.6), "θ", "tried there: stiffer where it moves less")
    look_gain: float = number(0.5, "ln L", "what such a move must gain for another to be tried")
    nothing: float = number(0.33, "of what lumping does to ln f", "error of a deck of shells that lacks nothing, at most", "nine of these: 0.18 to 0.33")
    strays: float = number(0.1, "of the test modes", "that a clear explanation may leave unexplained")
    beside: float = number(0.2, SIZE, "suspects of one nature that are nearer may be one effect")
    same_effect: float = number(40.0, LN, "what the second of them must gain more")
    per_mode: float = number(5.0, "degrees of freedom", "of a test mode: its frequency and what its shape says independently")
    complete: float = number(2.0, "of the assumed variance", "what a hypothesis leaves at most whose masses need no stands, and of which it is asked whether it leaves any error", "time")
    most_noise: float = number(3.0, "of the assumed variance", "by which the end of the search is judged, at most, of hypotheses that are not adequate")
    overlooked: float = number(4.0, LN, "price of a mode that the test did not see", "one mode in seven is overlooked: 2 ln 7")
    credible: float = number(6.0, LN, "explanations no further behind are told", "likelihood ratio of exp(3)")
    credible_near: float = number(0.15, SIZE, "places nearer are all looked at")
    credible_most: int = number(400, "places", "of them, at most", "time")
    credible_fitted: int = number(30, "places", "at which all else follows, the most promising")
    credible_vain: int = number(8, "places", "one after the other that are not credible, after which no more are fitted", "time")
    explains: float = number(4.0, LN, "a suspect explains a mode whose misfit it lowers by this", "two standard deviations")
    same_effect_apart: float = number(1.5, "of Effort.apart", "a suspect of a rival that is nearer says the same")

    link_near: int = number(9, "grids", "about either end of a link where it may end instead")
    row_of_elements: float = number(0.5, "of an element's side", "by which rows of elements are told apart", "half of it")
    largest_patch: float = number(0.5, "of all elements", "that a patch may hold")
    spread_mass: float = number(0.055, SIZE, "radius of a patch from which on its mass is spread, not at a point")
    patch_beside: float = number(0.05, SIZE, "how far from a point patches are tried in its stead")
    property_share: float = number(0.2, "of a patch", "that elements of one property are at least for the patch to end with them")

    equipment_steps: tuple[float, ...] = number((0.04, 0.02, 0.01), SIZE, "by which the centre of a mass and its radius of gyration are moved")
    equipment_rounds: int = number(4, "moves", "by each of these, at most")
    equipment_places: int = number(5, "grids", "next to a mass on which equipment is tried")
    equipment_gain: float = number(15.0, LN, "what offset and radius have to gain", "four unknowns more")

    foot: tuple[tuple[float, ...], ...] = number(((0.0, 0.0, -0.36), (0.7, 0.7, 0.7), (0.2, 0.2, 0.2), (1.2, 1.2, 0.8)), "sides of an element, the last of ln radius", "middle and radius of a footprint beforehand, their standard deviations, the units of their largest steps, how far they reach")
    foot_step: float = number(0.03, "likewise", "by which shares of grids are differentiated")
    foot_points: int = number(80, "points", "that a disc is laid on the mesh by", "its share at a grid to a few per cent")
    foot_share: float = number(0.01, "of a mass", "at a grid, below which it is left out")
    foot_near: int = number(5, "grids", "the last of which is a side of an element away")
    foot_reach: float = number(2.6, "sides of an element", "around a place that footprints may lie")
    own_times: int = number(2, "times", "as many modes as may match a test mode make the basis on which a hypothesis is weighed", "time")
    made_anew: int = number(4, "times", "supports that give are made for where the known parameters came to stand, at most", "time")
    followed: float = number(1e-3, "of ln p", "that they may move for slopes to tell how a release follows", "a release leaves a thousandth")
    rigid: float = number(1e-6, "of the largest eigenvalue", "by which the lowest of a completed model may lie below zero", ROUNDING)
    held: float = number(1e-3, "θ", "standard deviation of a magnitude that is to stay")


SEARCH = SearchNumbers()
