"""Mass and centre of gravity of a deck, as Nastran's grid point weight generator finds them."""

from dataclasses import dataclass

import numpy as np

from ....core.arrays import Floats
from ....core.assembly.element_assembly import Members, Recipe, assemble
from ....core.data.rigid_mass import centre_of_mass, mass_axis
from ....core.noun import Noun
from ..deck.read_deck import Deck
from ..properties.dmig_input import direct_matrices, external_matrices
from .deck_elements import read_structure
from .variation import read_variation


@dataclass(frozen=True, eq=False)
class Weight(Noun):
    """Rigid-body mass of a whole deck, constrained grids included.

    Parameters
    ----------
    mass : float
        The largest of the masses that translations along the three axes move (WTMASS applied).
    masses : (3,) float
        One for each axis; they differ where scalar or direct masses (M2GG) act along some only.
    centre_of_gravity : (3,) float
        Basic frame, deck length unit.
    matrix : (6, 6) float
        Rigid-body mass about `reference`.
    reference : (3,) float
        The grid of PARAM GRDPNT, or the origin.
    """

    mass: float
    masses: Floats
    centre_of_gravity: Floats
    matrix: Floats
    reference: Floats


def weight(deck: Deck) -> Weight:
    """Weigh a deck by the rigid-body motions of its mass matrix before constraints.

    Raises
    ------
    InputError
        As `build_model`.
    """
    structure = read_structure(deck, read_variation(deck, ()))
    points = structure.points
    members = [Members(b, np.arange(len(b))) for b in structure.blocks]
    recipe = Recipe(np.ones((1, 0)), np.zeros((0, 1)), np.ones((1, 1)))
    M = assemble(members, points.n_dof, recipe)[1][0]
    M = M + direct_matrices(deck, points)[1] + external_matrices(deck, points)[1]
    grid = int(deck.param("GRDPNT", -1.0))
    k = int(np.searchsorted(points.ids, grid))
    known = k < len(points.ids) and points.ids[k] == grid
    reference = points.xyz[k] if known else np.zeros(3)
    R = np.zeros((points.n_dof, 6))
    R[: 6 * len(points.ids)] = points.motions(slice(None), reference).reshape(-1, 6)
    matrix = R.T @ (M @ R)
    masses = np.diag(matrix)[:3].copy()
    total = float(masses[mass_axis(matrix)])
    return Weight(total, masses, reference + centre_of_mass(matrix), matrix, reference)
