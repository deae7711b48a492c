"""At which parameter values matrices must be known so that their dependence follows from them.

Each parameter enters as a polynomial: of degree one where stiffness and mass are exactly linear
(moduli, densities, areas, springs, masses), else of degree four. Parameters that act on the same
elements through a product (a modulus and a thickness) are sampled on a grid, the others one at a
time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

from ....core.arrays import Bools, Floats
from ....core.data.parameter import Parameter
from ....core.data.parametric_model import Factor
from ....core.errors import InputError
from ..assembly.variation import read_variation
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..fields.layouts import movable
from ..fields.parameter_references import FieldRef, ParameterSpec

MOST_RUNS = 200
_CURVED = 4


@dataclass(frozen=True, eq=False)
class Design:
    """Parameter points and the polynomial terms that they determine.

    Parameters
    ----------
    parameters : tuple of Parameter
    points : (n_run, n_parameter) float
        Factors on the deck's values; the first is the deck itself.
    terms : tuple of tuple of Factor
        As many as runs; each product of factors multiplies one constant matrix.
    """

    parameters: tuple[Parameter, ...]
    points: Floats
    terms: tuple[tuple[Factor, ...], ...]

    @property
    def collocation(self) -> Floats:
        """Value of each term at each point, (n_run, n_term)."""
        return np.array(
            [[np.prod([f.value(p) for f in term]) for term in self.terms] for p in self.points]
        )


def design_of(deck: Deck, specs: Sequence[ParameterSpec]) -> Design:
    """Choose the points for a deck and its parameters.

    Raises
    ------
    InputError
        A parameter that the deck does not have; more than 200 runs.
    """
    parameters = read_variation(deck, specs).parameters
    degrees = [_degree(deck.bulk, spec) for spec in specs]
    bulk = deck.bulk
    together = np.array(
        [[any(_coupled(bulk, x, y) for x in a.fields for y in b.fields) for b in specs]
         for a in specs]
    )  # fmt: skip
    orders = list(islice(_orders(degrees, together), MOST_RUNS + 1))
    if len(orders) > MOST_RUNS:
        raise InputError(
            f"these parameters take more than {MOST_RUNS} runs: move fewer values at a time, or "
            "several by one factor"
        )
    nodes = [_nodes(p, d) for p, d in zip(parameters, degrees, strict=True)]
    points = np.ones((len(orders), len(specs)))
    for row, order in zip(points, orders, strict=True):
        for k, n in order:
            row[k] = nodes[k][n]
    terms = [
        tuple(
            Factor(k, (*[0.0] * n, 1.0), parameters[k].lower, parameters[k].upper) for k, n in order
        )
        for order in orders
    ]
    return Design(parameters, points, tuple(terms))


def _orders(
    degrees: Sequence[int], together: Bools, taken: tuple[tuple[int, int], ...] = ()
) -> Iterator[tuple[tuple[int, int], ...]]:
    """Yield all products of (parameter, order) in which every two parameters act together.

    With an order n goes the n-th node: the set holds with a product all parts of it, so that the
    nodes determine the polynomials (Dyn and Floater 2014, "Multivariate polynomial interpolation
    on lower sets").
    """
    yield taken
    for k in range(taken[-1][0] + 1 if taken else 0, len(degrees)):
        if all(together[k, j] for j, _ in taken):
            for n in range(1, degrees[k] + 1):
                yield from _orders(degrees, together, (*taken, (k, n)))


def _nodes(parameter: Parameter, degree: int) -> list[float]:
    """Chebyshev nodes between the bounds, the one nearest to the deck replaced by the deck."""
    angles = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    middle, half = (parameter.upper + parameter.lower) / 2, (parameter.upper - parameter.lower) / 2
    nodes = (middle + half * angles).tolist()
    nearest = min(range(degree + 1), key=lambda k: abs(nodes[k] - 1.0))
    return [1.0, *nodes[:nearest], *nodes[nearest + 1 :]]


def _degree(bulk: Bulk, spec: ParameterSpec) -> int:
    linear = all(_is_linear(bulk, ref) for ref in spec.fields)
    alone = not any(_coupled(bulk, a, b) for a in spec.fields for b in spec.fields if a is not b)
    return 1 if linear and alone else _CURVED


def _is_linear(bulk: Bulk, ref: FieldRef) -> bool:
    if ref.field not in movable()[ref.card].linear:
        return False
    card: Any = bulk.table(ref.card).get(ref.id)
    if ref.card == "MAT1" and ref.field == "E":  # G follows E where it is blank
        return card.g is None
    if ref.card == "PBAR" and ref.field != "NSM":
        return not (card.k1 or card.k2)
    return True


def _coupled(bulk: Bulk, x: FieldRef, y: FieldRef) -> bool:
    if "NSM" in (x.field, y.field):
        return False
    if (x.card, x.id) == (y.card, y.id):
        return not (_is_linear(bulk, x) and _is_linear(bulk, y))
    return _uses(bulk, x, y) or _uses(bulk, y, x)


def _uses(bulk: Bulk, owner: FieldRef, material: FieldRef) -> bool:
    card: Any = bulk.table(owner.card).get(owner.id)
    return material.card.startswith("MAT") and material.id in set(_materials(card))


def _materials(card: Any) -> Iterator[int]:
    for name in ("mid", "mid1", "mid2", "mid3", "mid4"):
        value = getattr(card, name, None)
        yield from value if isinstance(value, tuple) else () if value is None else (value,)
