"""Damping that a deck states: matrices on its free degrees of freedom, ratios of its modes."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Ints, Matrices
from ....core.assembly.affine_terms import parametric_terms
from ....core.assembly.element_assembly import ElementBlock
from ....core.data.parameter import Parameter
from ....core.data.parametric_model import Factor, Model, Term
from ..cards import Key
from ..cards.element_group import Group
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..fields.parameter_references import ParameterSpec
from ..properties.damping_tables import selected_ratios
from ..properties.dmig_input import direct_damping
from ..properties.grids import read_points, to_basic
from .deck_dashpots import damping_matrix, dashpot_terms
from .deck_elements import read_structure
from .variation import Variation, read_variation

_MATERIAL = ("mid", "mid1", "mid2")
"""Fields of a property that name its material; the first counts."""


def free_damping(deck: Deck, model: Model) -> sp.csr_matrix | None:
    """Return D of the deck on its free degrees of freedom; None where it has none."""
    D = damping_matrix(deck)
    return None if D is None else _free(deck, model, D)


def modal_ratios(deck: Deck, model: Model, frequencies_hz: Floats, X: Floats) -> Floats | None:
    """Return what the deck says of the damping of each mode by itself, fractions of critical.

    PARAM G, materials and springs (GE, by their share of the strain energy), dashpots, and the
    TABDMP1 that SDAMPING selects, one on top of the other as in modal solutions.

    Johnson, Kienholz (1982), *Finite element prediction of damping in structures with constrained
    viscoelastic layers*, AIAA Journal 20(9), 1284.

    Parameters
    ----------
    frequencies_hz : (n_mode,) float
    X : (n_free, n_mode) float
        Modes of modal mass 1.

    Returns
    -------
    (n_mode,) float, NaN of rigid-body modes, or None where the deck says nothing

    Raises
    ------
    InputError
        A dashpot or a table that refers to nothing.
    """
    w = 2.0 * np.pi * np.where(frequencies_hz > 0.0, frequencies_hz, np.nan)
    structural, table = deck.param("G", 0.0), selected_ratios(deck)
    loss = _onto(deck, model, _loss_terms(deck, read_variation(deck, ())))
    K4 = sum((t.matrix for t in loss[1:]), loss[0].matrix) if loss else None
    D = free_damping(deck, model)
    if structural == 0.0 and table is None and K4 is None and D is None:
        return None
    ratios = structural / 2.0 + (0.0 if table is None else table(frequencies_hz)) + 0.0 * w
    for A, power in ((K4, 2), (D, 1)):
        if A is not None:
            ratios = ratios + np.einsum("ij,ij->j", X, A @ X) / (2.0 * w**power)
    return np.asarray(ratios)


def damping_terms(
    deck: Deck, model: Model, variation: Variation, specs: Sequence[ParameterSpec]
) -> tuple[tuple[Term, ...], tuple[Term, ...]]:
    """Return D and H of a deck on its free degrees of freedom, as terms in the parameters.

    D are the dashpots, B2GG and PARAM ALPHA1 M + ALPHA2 K; H is PARAM G K, K42GG and the stiffness
    of every element times its GE. The ratios of a TABDMP1 are of modes
    and have no matrix (`Model.ratios`).

    Parameters
    ----------
    model : Model
        With its stiffness and mass.
    variation : Variation
        What `specs` move.
    """
    named = params_moved(specs)

    def times(name: str, terms: tuple[Term, ...]) -> tuple[Term, ...]:
        value, own = deck.param(name, 0.0), named.get(name)
        more = () if own is None else (linear(variation.parameters[own], own),)
        return tuple(Term(value * t.matrix, (*t.factors, *more)) for t in terms if value != 0.0)

    D = _onto(deck, model, dashpot_terms(deck, variation))
    H = _onto(deck, model, _loss_terms(deck, variation))
    D = (*D, *times("ALPHA1", model.mass), *times("ALPHA2", model.stiffness))
    return D, (*H, *times("G", model.stiffness))


def params_moved(specs: Sequence[ParameterSpec]) -> dict[str, int]:
    """Return which parameter moves each PARAM that one moves."""
    return {ref.field: k for k, spec in enumerate(specs) for ref in spec.fields if not ref.id}


def linear(parameter: Parameter, number: int) -> Factor:
    """Return the factor that is the parameter itself, which has this number."""
    lower, upper = parameter.lower, parameter.upper
    return Factor(number, ((lower + upper) / 2.0, (upper - lower) / 2.0), lower, upper)


def _onto(deck: Deck, model: Model, terms: tuple[Term, ...]) -> tuple[Term, ...]:
    """Return terms over the g-set on the free degrees of freedom; empty ones are left out."""
    return tuple(Term(_free(deck, model, t.matrix), t.factors) for t in terms if t.matrix.nnz)


def _free(deck: Deck, model: Model, A: sp.csr_matrix) -> sp.csr_matrix:
    motion = to_basic(read_points(deck.bulk)).T @ model.expansion
    return (motion.T @ A @ motion).tocsr()


def _loss_terms(deck: Deck, variation: Variation) -> tuple[Term, ...]:
    """Return the stiffness of every element times its loss factor, and K42GG, over the g-set."""
    direct = direct_damping(deck, read_points(deck.bulk))[1]
    more = (Term(direct),) if direct.nnz else ()
    if not any(np.any(c.ge) for c in _with_loss(deck.bulk)):
        return more
    own = replace(variation, bulk=_by_direction(variation.bulk), read_as=_by_direction, _known={})
    structure, blocks = read_structure(deck, own), []
    for group, block in zip(structure.groups, structure.blocks, strict=True):
        if any(_loss(own.bulk, s) for s in group.sources):
            blocks.append(_scaled(block, group, own))
    return (*parametric_terms(blocks, structure.points.n_dof, *own.bounds)[0], *more)


def _by_direction(bulk: Bulk) -> Bulk:
    """Take loss factors of single directions into the stiffness of a PBUSH; GE1 alone is of all."""
    apart = {
        number: p._replace(k=tuple(np.multiply(p.k, p.ge)), ge=(1.0,) * len(p.ge))
        for number, p in bulk.table("PBUSH").items()
        if p.apart
    }
    table = {**bulk.table("PBUSH"), **apart}
    return replace(bulk, tables={**bulk.tables, "PBUSH": table}) if apart else bulk


def _with_loss(bulk: Bulk) -> Iterable[Any]:
    for table in bulk.tables.values():
        if hasattr(next(iter(table.values()), None), "ge"):
            yield from table.values()


def _loss(bulk: Bulk, source: frozenset[Key]) -> float:
    """Return GE of a property, of its first material where it has none of its own."""
    materials = {n for n, c in bulk.definitions.items() if c.space == "material"}
    for name, number in sorted(source):
        card = bulk.table(name)[number]
        if name in materials:
            continue
        if hasattr(card, "ge"):
            return float(np.ravel(card.ge)[0])
        every = [m for word in _MATERIAL for m in np.ravel(getattr(card, word, ())) if m]
        found = bulk.find(materials, int(every[0])) if every else None
        if found:
            return float(getattr(found[1], "ge", 0.0))
    return 0.0


def _scaled(block: ElementBlock, group: Group, variation: Variation) -> ElementBlock:
    def evaluate(rows: Ints, p: Floats, wanted: tuple[bool, bool]) -> Matrices:
        K, _ = block.evaluate(rows, p, (wanted[0], False))
        if K is None:
            return None, None
        bulk, of = variation.at(p), group.source_of[rows]
        loss = np.zeros(len(group.sources))
        for s in np.unique(of):
            loss[s] = _loss(bulk, group.sources[s])
        return K * loss[of, None, None], None

    return replace(block, evaluate=evaluate)
