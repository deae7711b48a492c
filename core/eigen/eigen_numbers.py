"""The tuned numbers of the eigensolution and of what it refuses."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/eigen"


@dataclass(frozen=True)
class EigenNumbers:
    dense: int = number(600, "degrees of freedom", "models up to it are solved by LAPACK", "time")
    dense_many: int = number(4, "part of all modes", "more than which are found by LAPACK too, up to so many times `dense`", "time")
    modes: int = number(10, "modes", "where nobody says how many", "convention")
    tolerance: float = number(1e-8, "of a Ritz value", "its residual", CHECK)
    residual: float = number(1e-5, "of λ − σ", "residual of a mode that is refused", CHECK)
    orthonormal: float = number(1e-8, "-", "error of XᵀMX that is refused", CHECK)
    held: int = number(20, "rounds", "of holding motions with neither stiffness nor mass", CHECK)
    looked_at: int = number(100, "modes", "that may be without strain energy", "more than any structure has")
    without_strain: float = number(1e-4, "of the first elastic λ", "below which modes without strain energy lie", CHECK)
    named: int = number(6, "degrees of freedom", "that a sentence names", "what a reader takes in")
    few_named: int = number(4, "degrees of freedom", "likewise", "what a reader takes in")
    unused_named: int = number(5, "degrees of freedom", "without stiffness and mass that are named", "what a reader takes in")

    no_mass: float = number(1e-12, "of the largest mass", "of a motion that has none", ROUNDING)
    lowest: float = number(1e-9, "of the highest λ", "below which an eigenvalue is rounding", ROUNDING)
    negative_mass: float = number(1e-8, "of the largest mass", "negative mass of a motion that is no rounding", ROUNDING)

    singular: float = number(1e-13, "of the diagonal's energy", "energy of A = K − σM below which a motion is unresisted", ROUNDING)
    strain: float = number(2e-15, "of the diagonal's energy", "strain energy that is rounding", ROUNDING)
    digits: float = number(4.0, "times the precision of K", "what its values' own rounding may make", CHECK)
    strong: float = number(1e-3, "of the largest k/m", "shift at which only motions without stiffness and mass stay near zero", CHECK)
    negative_found: float = number(1e-3, "-", "tolerance of a negative eigenvalue that is to be named", CHECK)
    off_zero: float = number(100.0, "times `singular`", "shift by which a singular matrix is factorised", ROUNDING)
    sweeps: int = number(4, "sweeps", "of subspace iteration for motions next to zero", CHECK)
    reweighted: int = number(30, "rounds", "of least squares that leave most of a structure at rest", CHECK)
    at_rest: float = number(1e-6, "of the largest motion", "in such a round", ROUNDING)
    named_motion: float = number(0.3, "of the largest motion", "from which on a degree of freedom is named", CHECK)
    arm: float = number(0.1, "of the structure's size", "by which a rotation is compared with displacements", CHECK)
    moved: float = number(1e-6, "of the largest motion", "of a grid that moves", ROUNDING)
    turned: float = number(1e-3, "of the largest motion", "that no rigid motion explains: a linkage", CHECK)

    mass_rounding: float = number(1e-12, "of usual mass over stiffness", "below which a mass is rounding of a rotation", ROUNDING)
    usual: float = number(0.9, "of the degrees of freedom", "have at most the usual mass over stiffness", CHECK)
    mass_steps: int = number(40, "Lanczos steps", "that look for a negative mass", CHECK)
    mass_spanned: float = number(1e-10, "of a unit vector", "left over: all of the mass is spanned", ROUNDING)
    mass_negative: float = number(1e-6, "of the mass", "that is negative beyond doubt", CHECK)
    symmetric: float = number(1e-6, "of the largest product", "difference by transposition of a matrix that is refused", CHECK)
    least_shift: float = number(1e-11, "of the median k/m", "size of a shift, at least", ROUNDING)
    sample: int = number(2000, "values", "of K whose digits are counted", "time")
    sample_least: int = number(20, "values", "below which nothing is said of them", CHECK)
    few_digits: tuple[int, int] = number((6, 12), "digits", "of values that came through print", "formats of punch files")
    single: float = number(6e-8, "-", "rounding of single precision", "IEEE 754")
    single_digits: int = number(8, "digits", "of values in single precision, at least", "IEEE 754")

    row_rounding: float = number(1e-13, "of the magnitudes that make it", "force on a row that is rounding", ROUNDING)
    nearly: float = number(0.9, "of a motion, M-norm", "that a rigid body explains, for it to count as one", CHECK)
    followed: float = number(1e-10, "of the largest motion", "of a rigid motion that free degrees of freedom follow", ROUNDING)
    massive: float = number(1e-12, "of the largest mass", "of a rigid motion that has any", ROUNDING)

    first_shift: float = number(20.0, "Hz", "a guess, bettered when the first Ritz values are seen", "usual structures")
    below_limit: float = number(0.05, "of the highest λ wanted", "shift, where that is known", CHECK)
    shift_most: float = number(0.1, "of the median k/m", "shift, at most", CHECK)
    shifts: int = number(6, "guesses", "at most", CHECK)
    far_shift: float = number(10.0, "times the lowest λ", "shift from which on another is better", CHECK)
    near_shift: float = number(1e8, "shifts", "lowest λ from which on another is better", ROUNDING)
    nearer: tuple[float, float] = number((0.5, 1e-3), "of the lowest λ", "shift in place of one too far, and too near", CHECK)
    pivot: float = number(1e-6, "of λ of the first modes", "below which a value is no mode", ROUNDING)
    width: int = number(8, "vectors", "of a block: what one pass through the factor serves best", "time")
    narrow: int = number(4, "vectors", "with SuperLU, which gains little by several right sides", "time")
    widest: int = number(64, "vectors", "when many equal modes were missed", "memory")
    guard: int = number(4, "modes", "above the wanted ones, in the room of the basis", CHECK)
    guard_tolerance: float = number(1e-3, "of a Ritz value", "residual at which it helps to find a gap", CHECK)
    firm: float = number(1e-6, "of a Ritz value", "residual up to which guards are kept as modes", CHECK)
    zero: float = number(1e-12, "of the largest Ritz value", "below which one belongs to no mode", ROUNDING)
    negative: float = number(1e-6, "of the largest Ritz value", "that is negative beyond doubt", ROUNDING)
    gap: float = number(1e-4, "of λ", "least gap for an inertia count", CHECK)
    clear: float = number(1e-2, "of λ", "a gap that needs no better one", CHECK)
    within: tuple[float, float] = number((0.4, 0.6), "of a gap", "where inertia is counted, and again", CHECK)
    again: float = number(0.3, "of the way between", "a further place where the first is singular", CHECK)
    above: tuple[float, float] = number((2.0, 4.0), "times the highest λ", "where all modes are known", CHECK)
    beside_limit: float = number(1.0001, "of the highest λ wanted", "a further place where that is an eigenvalue", CHECK)
    room: tuple[int, int] = number((3, 6), "times modes, times `width`", "vectors of a basis before a restart", CHECK)
    step: int = number(12, "part of the basis", "by which it grows between looks at the Ritz values", "time")
    attempts: int = number(5, "searches", "for missed modes, the first included", CHECK)


EIGEN = EigenNumbers()
