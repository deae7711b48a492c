"""The tuned numbers of the search; "θ" are steps of the log of a magnitude."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

SIZE, GAIN, LN = "of the structure's size", "of the best one's gain", "2 ln L"
SCAN = "cache: their matrices stay near the processor"


@dataclass(frozen=True)
class SearchNumbers:
    neighbouring: tuple[float, ...] = number((-0.45, 0.0, 0.45), "θ", "steps tried when a suspect moves to a neighbouring place")
    nearby: tuple[float, ...] = number((-0.35, 0.0, 0.35), "θ", "steps tried around the best places of the first scan")
    few_places: int = number(300, "places", "up to so many of simple kinds more of them are fitted, the known parameters with them")
    few_branches: int = number(3, "-", "times as many branches are followed then")
    few_each: int = number(4, "-", "times as many branches of each kind are followed then")
    steps: int = number(6, "steps", "of all unknowns with which suspects are fitted, unless said otherwise")
    steps_null: int = number(25, "steps", "for the known parameters alone")
    steps_new: int = number(5, "steps", "for a suspect more, or another in place of one")
    steps_moved: int = number(4, "steps", "for a suspect that moved to a neighbour, changed its stretch, or was taken out")
    steps_whole: int = number(2, "steps", "on the whole basis after those on a small one")
    steps_fair: int = number(12, "steps", "for a hypothesis with a suspect less, before the richer one is compared with it")
    steps_guided: int = number(15, "steps", "by the noise of the test for what a wider noise found")
    steps_instead: int = number(8, "steps", "for a simple effect in place of an absorber")
    steps_polished: int = number(20, "steps", "on a basis made for one hypothesis")
    rounds: int = number(6, "moves", "of each suspect to a neighbour, at most")
    promising: int = number(10, "places", "next to a suspect of which it is asked what a step of all unknowns would leave")
    moves_tried: int = number(3, "places", "next to a suspect that are fitted")
    stretches_tried: int = number(2, "stretches", "of an edge beside a suspect's that are fitted to the whole basis")
    better: float = number(0.3, LN, "what a move must gain")
    better_anew: float = number(1.0, LN, "what another suspect in place of one must gain")
    anew_rounds: int = number(1, "rounds", "in which each suspect is taken out and looked for anew")
    anew_looked: int = number(2, "places", "of each kind that are looked at for it")
    anew_tried: int = number(3, "places", "that are fitted for it")
    anew_near: float = number(0.05, "of the objective", "one that is no worse by more than this is moved to better neighbours")
    anew_all: int = number(3, "suspects", "from so many on only the one that is missed least is looked for anew")

    hopeless: float = number(0.3, "of its price", "a further suspect that gains less before it is moved to better neighbours is given up")
    other_kind: float = number(0.5, GAIN, "a kind whose best place gains this is followed too")
    worth_fitting: float = number(0.35, GAIN, "a branch that gains less is not fitted")
    tuned_followed: int = number(2, "hypotheses", "with a tuned suspect that are followed beside the others, if they lead")
    grown_too: float = number(0.35, GAIN, "a hypothesis that gained less than all but this is not grown")
    rivals_kept: int = number(12, "hypotheses", "that are kept as rivals of each number of suspects")
    same_place: float = number(0.5, "of Effort.apart", "hypotheses whose suspects are nearer are one")

    sizes_many: int = number(30, "sizes", "of a kind above which not all are evaluated anywhere")
    sizes_places: int = number(30, "places", "that are evaluated of a kind with many sizes")
    sizes_each: int = number(2, "sizes", "that are evaluated there")
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

    clearly: float = number(1.3, "of a simple effect's gain", "what a tuned one must gain")
    tuned_tried: int = number(3, "places", "of an absorber that are tried beside what was found")
    second_opinion: float = number(2.5, "of the assumed variance", "what a best hypothesis leaves that asks for a search by a wider noise")
    unexplained: float = number(4.0, "of the assumed variance", "what nothing explains, that asks for a search with all kinds")
    margin: float = number(10.0, LN, "what a suspect must gain besides the log of the number of its choices")
    beside: float = number(0.2, SIZE, "suspects of one nature that are nearer may be one effect")
    same_effect: float = number(40.0, LN, "what the second of them must gain more")
    per_mode: float = number(5.0, "degrees of freedom", "of a test mode: its frequency and what its shape says independently")
    most_noise: float = number(3.0, "of the assumed variance", "by which the end of the search is judged, at most")
    overlooked: float = number(4.0, LN, "price of a mode that the test did not see", "one mode in seven is overlooked: 2 ln 7")
    credible: float = number(6.0, LN, "explanations no further behind are told", "likelihood ratio of exp(3)")
    explains: float = number(4.0, LN, "a suspect explains a mode whose misfit it lowers by this", "two standard deviations")
    explains_share: float = number(0.1, "of what it lowers most", "and by this")
    same_effect_apart: float = number(1.5, "of Effort.apart", "a suspect of a rival that is nearer says the same")
    ln_most: float = number(60.0, "ln", "likelihood ratios are said up to its exponential", "kept finite")
    one_effect: float = number(0.09, SIZE, "findings of one nature that are nearer are told as one")

    reshape_steps: int = number(8, "steps", "by which a patch grows or shrinks, at most")
    reshape_tried: int = number(2, "shapes", "next to a patch that are fitted")
    reshape_sizes: tuple[float, ...] = number((-0.4, -0.15, 0.0, 0.15, 0.4), "θ", "tried with every shape: what a patch gains in area it loses in strength")
    row_of_elements: float = number(0.5, "of an element's side", "by which rows of elements are told apart", "half of it")
    largest_patch: float = number(0.5, "of all elements", "that a patch may hold")
    spread_mass: float = number(0.055, SIZE, "radius of a patch from which on its mass is spread, not at a point")
    patch_beside: float = number(0.05, SIZE, "how far from a point patches are tried in its stead")
    property_share: float = number(0.2, "of a patch", "that elements of one property are at least for the patch to end with them")

    own_above: float = number(1.6, "of the test's highest eigenvalue", "up to which a hypothesis gets modes of its own")
    own_more: int = number(8, "modes", "more than these")
    own_reached: float = number(1.2, "of the test's highest eigenvalue", "up to which modes get static responses to parameters")
    own_dependent: float = number(1e-13, "of the squared length", "static response to an effect that is new beside the modes", ROUNDING)
    own_shift: float = number(0.25, "of the lowest elastic eigenvalue", "shift of its static responses")
    rigid: float = number(1e-6, "of the largest eigenvalue", "below which a mode has no strain", ROUNDING)
    held: float = number(1e-3, "θ", "standard deviation of a magnitude that is to stay")


SEARCH = SearchNumbers()
