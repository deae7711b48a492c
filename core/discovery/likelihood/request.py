"""What discovery is asked."""

from dataclasses import dataclass

from ...arrays import Floats, Ints
from ...correlation.comparison import Placed
from ...data.mass_unit import MassUnit
from ...eigen.normal_modes import Eigensolution
from ...noun import Noun
from ..reduction.elements_and_supports import Structure
from .frf_likelihood import Responses


@dataclass(frozen=True, eq=False)
class Request(Noun):
    """What discovery is asked.

    Parameters
    ----------
    structure : Structure
        Its model carries the known parameters that may be off.
    spread : (n_parameter,) float
        Standard deviation of ln p of each.
    solution : Eigensolution
        Of the deck as it is, its factor kept, with modes to well above the test's.
    placed : Placed
        The test on the model.
    mass : float
        Of the structure, in units of the mass matrix.
    masses : MassUnit
        What masses are said in.
    responses : Responses or None
        Frequency responses of the test: further evidence.
    densest : float
        Largest density of what the structure is made of, as in the mass matrix; 0 if unknown.
    numbers : (n_test,) int
        By which to speak of the modes in `placed`.
    """

    structure: Structure
    spread: Floats
    solution: Eigensolution
    placed: Placed
    mass: float
    masses: MassUnit
    responses: Responses | None
    densest: float
    numbers: Ints
