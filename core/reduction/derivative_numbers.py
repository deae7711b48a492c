"""The tuned numbers of reduced models and of derivatives."""

from dataclasses import dataclass

from ..number_table import ROUNDING, number

CHECK = "pytest tests/core/reduction"


@dataclass(frozen=True)
class DerivativeNumbers:
    tolerance: float = number(1e-7, "of the energy", "accuracy of static solves for shapes", CHECK)
    iterations: int = number(80, "iterations", "of conjugate gradients, at most", CHECK)
    own_factor: int = number(8, "parameters", "from which on a factor next to the cluster costs less than it saves", "time")
    block: int = number(64, "vectors", "solved for at once", "memory")
    rounding: float = number(1e-8, "of what is known of it", "part of a derivative outside the known modes that is rounding", ROUNDING)
    repeated: float = number(1e-5, "of λ", "eigenvalues this close are one: rounding of coordinates in a deck splits pairs by so much", CHECK)
    beside: float = number(0.01, "of λ − σ", "by which a factor stands off its cluster, at most", CHECK)
    mass: float = number(1e13, "times the first λ − σ", "above which a vector of the basis has no mass", ROUNDING)

    near_modes: float = number(3.0, "times the highest frequency", "below which modes are coupled by damping with one another in a response", CHECK)
    more_modes: int = number(12, "modes", "in a basis beyond the last that must be good", CHECK)
    most_static: int = number(250, "static vectors", "at most", "time")
    guard: int = number(4, "modes", "above those that are asked for, that a basis is corrected by too", CHECK)
    least_energy: float = number(1e-4, "of a mode's", "energy of a static vector, for a factor moved by one", CHECK)
    known_already: float = number(1e-9, "of its energy", "part of a mode of another point outside a basis that is left out", CHECK)
    too_little: float = number(1e-7, "of its energy", "part of a mode that a correction leaves out", CHECK)
    dependent: float = number(1e-10, "of the largest energy", "of a direction that depends on the others", ROUNDING)
    told_apart: float = number(1e-6, "of the largest singular value", "of modes at the sensors that these tell apart", CHECK)
    held_already: float = number(1e-6, "of its mass", "part of a mode of a component beside the constraint modes that is rounding", ROUNDING)


DERIVATIVES = DerivativeNumbers()
