"""Damping that a deck states, on its free degrees of freedom and of its modes."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ....core.arrays import Floats, Ints, Matrices
from ....core.assembly.affine_terms import parametric_terms
from ....core.assembly.element_assembly import ElementBlock
from ....core.data.parametric_model import Model
from ..cards import Key
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..properties.damping_tables import selected_ratios
from ..properties.grids import read_points
from .build_model import to_basic
from .deck_dashpots import damping_matrix
from .deck_elements import read_structure
from .variation import read_variation

_MATERIAL = ("mid", "mid1", "mid2")
"""Fields of a property that name its material; the first counts."""


def free_damping(deck: Deck, model: Model) -> sp.csr_matrix | None:
    """Return D of the deck's dashpots on the free degrees of freedom; None where it has none."""
    return _free(deck, model, damping_matrix(deck))


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
    structural, selected = deck.param("G", 0.0), selected_ratios(deck, frequencies_hz)
    K4, D = _free(deck, model, _loss_matrix(deck)), free_damping(deck, model)
    if structural == 0.0 and selected is None and K4 is None and D is None:
        return None
    ratios = structural / 2.0 + (0.0 if selected is None else selected) + 0.0 * w
    for A, power in ((K4, 2), (D, 1)):
        if A is not None:
            ratios = ratios + np.einsum("ij,ij->j", X, A @ X) / (2.0 * w**power)
    return np.asarray(ratios)


def _free(deck: Deck, model: Model, A: sp.csr_matrix | None) -> sp.csr_matrix | None:
    if A is None:
        return None
    motion = to_basic(read_points(deck.bulk)).T @ model.expansion
    return (motion.T @ A @ motion).tocsr()


def _loss_matrix(deck: Deck) -> sp.csr_matrix | None:
    """Return the stiffness of every element times its loss factor, over the g-set."""
    if not any(np.any(c.ge) for c in _with_loss(deck.bulk)):
        return None
    variation = read_variation(deck, ())
    variation = replace(variation, bulk=_by_direction(variation.bulk))
    structure, blocks = read_structure(deck, variation), []
    for group, block in zip(structure.groups, structure.blocks, strict=True):
        loss = np.array([_loss(variation.bulk, s) for s in group.sources])[group.source_of]
        if loss.any():
            blocks.append(_scaled(block, loss))
    terms, _ = parametric_terms(blocks, structure.points.n_dof, np.zeros(0), np.zeros(0))
    return sum((t.matrix for t in terms[1:]), terms[0].matrix).tocsr()


def _by_direction(bulk: Bulk) -> Bulk:
    """Take loss factors of single directions into the stiffness of a PBUSH; GE1 alone is of all."""
    apart = {
        number: p._replace(k=tuple(np.multiply(p.k, p.ge)), ge=(1.0,) * len(p.ge))
        for number, p in bulk.table("PBUSH").items()
        if any(p.ge[1:])
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


def _scaled(block: ElementBlock, loss: Floats) -> ElementBlock:
    def evaluate(rows: Ints, p: Floats, wanted: tuple[bool, bool]) -> Matrices:
        K, _ = block.evaluate(rows, p, (wanted[0], False))
        return (None if K is None else K * loss[rows, None, None]), None

    return replace(block, evaluate=evaluate)
