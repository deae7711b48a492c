"""Paired test shapes expanded to the whole model, and their orthogonality by its mass."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..data.modes import Modes
from ..data.parametric_model import Model
from ..errors import InputError
from ..noun import Noun
from ..numerics.factorisation import factorise
from ..reduction.model_at_sensors import reduce_to_sensors
from .comparison import Comparison
from .mac import realised
from .orthogonality import Orthogonality, orthogonality


@dataclass(frozen=True, eq=False)
class PairExpansion(Noun):
    """Paired test shapes on all degrees of freedom of the model.

    Parameters
    ----------
    method : {"serep", "guyan", "irs"}
    modes : Modes
        The test's, on the analysis dofs, one a pair, of generalised mass 1.
    orthogonality : Orthogonality
        Of the pairs, in their order.
    """

    method: str
    modes: Modes
    orthogonality: Orthogonality


def expand_pairs(c: Comparison, model: Model, method: str, rigid: int) -> PairExpansion:
    """Expand the test shapes of the pairs by a model reduced to the sensors.

    Close modes are turned onto each other as the correlation had them. SEREP takes the analysis
    modes of the pairs.

    Parameters
    ----------
    c : Comparison
        With all modes of the model's own, the first `rigid` of them its rigid-body modes.
    model : Model
    method : {"serep", "guyan", "irs"}

    Raises
    ------
    InputError
        There are no pairs; as `reduce_to_sensors`.
    """
    found = c.correlation
    if not found.pairs:
        raise InputError("no test mode pairs with the model: there is nothing to expand")
    E = model.expansion
    modes = factorise(E.T @ E, True).solve(np.asarray(E.T @ c.analysis.shapes))
    test = realised(c.test.shapes)
    turned = {"analysis": modes, "test": test}
    if found.criteria.rotate in turned:
        turned[found.criteria.rotate] = turned[found.criteria.rotate] @ found.transformation
    analysis = turned["analysis"][:, [p.analysis for p in found.pairs]]
    measured = turned["test"][:, [p.test for p in found.pairs]]
    sensors = (c.observation.matrix @ E).tocsr()
    K, M = model.K(), model.M()
    taking = (analysis, 0) if method == "serep" else (modes, rigid)
    small = reduce_to_sensors(method, K, M, sensors, *taking)
    by_mass = orthogonality(np.asarray(sensors @ analysis), measured, small.mass)
    shapes: Floats = np.asarray(small.expansion @ measured)
    size = np.sqrt(np.einsum("nk,nk->k", shapes, M @ shapes))
    at = [p.test for p in found.pairs]
    expanded = Modes(
        c.test.frequencies_hz[at],
        np.asarray(E @ (shapes / np.where(size > 0.0, size, 1.0))),
        c.analysis.dofs,
        c.test.damping[at],
        np.ones(len(at)),
        f"test expanded by {method}",
    )
    return PairExpansion(method, expanded, by_mass)
