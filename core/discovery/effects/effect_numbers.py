"""The tuned numbers of the kinds of effects: what is tried, and what is thought likely."""

from dataclasses import dataclass

from ...number_table import ROUNDING, number

SIZE, MASS, ERROR = "of the structure's size", "of the structure's mass", "standard deviation of θ that comes of a place not quite the true one"
MEASURED = "python -m benchmarks.discovery"


@dataclass(frozen=True)
class EffectNumbers:
    trials: int = number(4, "sizes", "of a mass or a spring that are tried")
    mass_trials: tuple[float, float] = number((0.01, 0.09), MASS, "least and largest mass that is tried")
    spring_trials: tuple[float, float] = number((3e-3, 0.5), "of m ω² in mid band", "least and largest spring that is tried, m that of the structure")
    mass: float = number(0.03, MASS, "median of an attached mass beforehand")
    spread_mass: float = number(0.05, MASS, "median of a distributed mass beforehand")
    mass_spread: float = number(1.5, "of ln m", "standard deviation of both")
    spring: float = number(0.03, "of m ω² in mid band", "median of a spring to ground beforehand")
    spring_spread: float = number(2.5, "of ln k", "standard deviation of it, and of joints and supports that give")
    factors: tuple[float, ...] = number((0.2, 0.5, 1.6, 3.0), "-", "factors on a local stiffness that are tried")
    factor_spread: float = number(1.2, "of ln factor", "standard deviation of it beforehand")

    mount: tuple[float, float, float] = number((2.0, 1.0, 100.0), "of the band's end, of ln f, of the band's end", "median and standard deviation of the frequency of a mass on its mount beforehand, and the highest: an octave above the band; in the band it is an absorber")
    mount_soft: float = number(0.25, "of ln f", "above an absorber: a soft mount that is tried at other places")
    held: float = number(1e-3, "θ", "standard deviation of a magnitude that is to stay")
    mounts_unknown: tuple[float, ...] = number((0.1, 0.3, 0.5, 0.7, 0.9), "of what mounts may be beforehand", "at which masses are sized where a model errs by more than tells it")
    mount_known: float = number(5.0, "-", "ratio of the ends of its interval, beyond which the test does not tell it")
    mass_error: float = number(0.15, "of ln m", ERROR, MEASURED)
    stiffness_error: float = number(0.25, "of ln k, or of a factor on it", ERROR, MEASURED)
    damper_error: float = number(0.12, "of ln c", ERROR, MEASURED)
    absorber_error: tuple[float, float] = number((0.08, 0.02), "of ln m, ln f", ERROR, MEASURED)
    body: float = number(0.05, SIZE, "standard deviation beforehand of how far the centre of equipment is off its foot along each axis, and of how far it extends")
    masses_across: float = number(18.0, "places", "across the structure, each way, that a first scan looks at, of masses")
    springs_across: float = number(13.0, "places", "likewise, of springs and absorbers")
    links_across: float = number(9.0, "places", "likewise, of both ends of springs between two places")

    rigid: float = number(1e-4, "of 1 / (ω² m)", "flexibility that an attached mass has, at least", ROUNDING)
    least_left: float = number(1e-7, "of the stiffest", "stiffness that freed coordinates keep, at least", ROUNDING)

    patch_radii: tuple[float, ...] = number((0.045, 0.056, 0.07, 0.088, 0.11, 0.14, 0.175, 0.22), SIZE, "radii of patches of stiffness; every third is scanned first")
    mass_radii: tuple[float, ...] = number((0.062, 0.075, 0.092, 0.11, 0.14, 0.175, 0.22), SIZE, "radii of a distributed mass; what is smaller is one at a point")
    feet: tuple[float, ...] = number((0.024, 0.034, 0.048), SIZE, "radii of the footprint of a mass")
    spacing: float = number(0.35, "radii", "between the centres of patches, and of groups of supports off the edges of shells")
    patch_first: float = number(3.2, "times that", "between those that are scanned first")
    patch_centres: int = number(400, "centres", "of a size, at most", "time")
    patch_thinned: float = number(1.05, "-", "times the spacing, where there are more")
    patch_sides: tuple[float, float] = number((1.25, 0.63), "radii", "half sides of an elongated patch", "the area of the round one")
    patch_largest: float = number(0.5, "of all elements", "that a patch may hold")
    sheet_bend: float = number(0.7, "cosine", "between the ways across a side that shells on either side of it lie, of one sheet", "half a right angle")
    sheet_thick: float = number(0.5, "of its width", "thickness up to which grids beside each other are a sheet that equipment stands up from")
    patch_left: float = number(1e-5, "of the trace", "that a row of a patch's root is worth, at least")

    bar_point: float = number(0.25, "of an element's length", "from its ends that a bar has points beside its middle", "as near to any place as a shell's are")
    bar_coarse: float = number(0.05, SIZE, "length of an element above which it has these", "elements of a tower, 3 %, need none: a stretch of it was taken for a link with them")
    bar_stretches: int = number(400, "stretches", "of all bars, at most", "time")
    bar_long: float = number(0.5, SIZE, "length of a bar whose stretches are scanned first")
    bar_first: tuple[float, float] = number((0.08, 0.25), SIZE, "least and largest length of those")

    joint_trials: tuple[float, ...] = number((0.003, 0.03, 0.3, 3.0), "of the median beam end's stiffness", "that are tried")
    joint_softer: float = number(1.0, "of ln k", "how much softer a joint is beforehand than its beams' ends")

    straight: float = number(0.98, "cosine", "between elements of a bar, beams, and sides of an edge and the shells on them, that continue each other")
    edge_ends: int = number(18, "places", "along an edge where a stretch may begin or end")
    edge_shortest: float = number(0.03, SIZE, "length of a stretch, at least")
    support_halves: tuple[float, ...] = number((0.06, 0.12, 0.2), SIZE, "half lengths of groups of supports off the edges of shells")
    support_trials: tuple[float, ...] = number((0.001, 0.006, 0.04, 0.25, 2.0), "of the median stiffness of what is held", "that are tried")
    support_softer: float = number(2.5, "of ln k", "how much softer a support that turns is beforehand than what it holds")
    support_along: float = number(0.95, "cosine", "between a direction of a support and that of an edge that count as one")

    link_spacing: float = number(0.02, SIZE, "between the ends of links, at least")
    link_thinned: float = number(1.15, "-", "times the spacing, where there are more")
    link_ends: int = number(250, "grids", "that links may end at, at most", "memory")
    link_lengths: tuple[float, float] = number((0.1, 0.7), SIZE, "least and largest length of a link")

    absorber_masses: tuple[float, ...] = number((0.008, 0.016, 0.032, 0.06), MASS, "that are tried")
    absorber_mass: float = number(0.025, MASS, "median beforehand")
    absorber_spread: float = number(1.0, "of ln m", "standard deviation of it")
    absorber_band: tuple[float, float] = number((0.93, 1.07), "of the band's ends", "between which it is tuned", "it shows by a mode of its own")
    absorber_spacing: float = number(0.04, "of ln f", "between the frequencies that are tried")
    absorber_step: float = number(0.15, "of ln f", "unit of its largest step in a fit")

    damper_trials: tuple[float, float] = number((0.004, 0.3), "damping ratio", "least and largest that a dashpot gives the mode which feels it most")
    damper_sizes: int = number(14, "sizes", "of a dashpot that are tried")

    alike: float = number(1.1, "-", "likelihoods whose ratio is nearer to 1 say nothing", "what a reader takes in")
    odds_most: float = number(10.0, "-", "ratio of likelihoods that is told, at most", "of 37 claims in frozen cases two had the truth as an alternative")
    mode_runs: int = number(4, "stretches", "of modes that are listed, at most", "what a reader takes in")


EFFECTS = EffectNumbers()
