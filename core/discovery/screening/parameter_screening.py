"""Which known properties could matter, and a model in which the others stay put.

A property that is wrong shows in the test only where it takes part in the measured modes. Those
move whose error, as large as it may be, shifts the frequency of a mode in the measured band
noticeably: what others do to it would be put down to one that hardly does anything. Values of one
property move together where the modes do not tell them apart, and so do concentrated masses and
springs alike that are too small to be noticed alone.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats
from ...assembly.element_assembly import ElementBlock
from ...correlation.correlation_numbers import CORRELATION
from ...data.parameter import Parameter
from ...data.parametric_model import Model, Term
from ...eigen.normal_modes import Eigensolution
from ..reduction.elements_and_supports import Structure
from .screening_numbers import SCREENING

Groups = Sequence[tuple[int, ...]]
"""Numbers of old parameters that a new one moves."""


def shifts(
    model: Model, solution: Eigensolution, band_hz: tuple[float, float], parameters: Sequence[int]
) -> Floats:
    """Return ∂ln f/∂ln p of the modes that may pair in the measured band, at the deck, (n, n_pair).

    First order, each mode apart from all others (Fox and Kapoor 1968) but for those as close as a
    shift that is noticed: what turns such a pair is a column of its own, so that which vectors of
    equal frequency a solver chose does not count. `solution` is that of the deck as it is,
    `band_hz` the lowest and highest frequency measured.
    """
    hz = solution.frequencies_hz
    around = 1.0 + CORRELATION.frequency
    inside = (hz > band_hz[0] / around) & (hz < band_hz[1] * around)
    inside[: solution.rigid_body_modes] = False
    phi, values = solution.vectors[:, inside], solution.eigenvalues[inside]
    ln_f = 0.5 * np.log(values)
    i, j = np.nonzero(np.triu(np.abs(ln_f[:, None] - ln_f) < SCREENING.noticed))
    p = model.deck_point
    out = np.zeros((len(parameters), len(i)))
    for row, k in zip(out, parameters, strict=True):
        dK, dM = (
            np.einsum("ij,ij->j", phi[:, i], (D(k, p) @ phi)[:, j]) for D in (model.dK, model.dM)
        )
        row[:] = 0.5 * (dK / np.sqrt(values[i] * values[j]) - dM)
    return out


def told_apart(slopes: Floats, group: tuple[int, ...], spread: float) -> list[tuple[int, ...]]:
    """Return groups of the values of one property, those that a test tells apart by themselves.

    `slopes` (n, n_pair), see `shifts`, of which `group` are the property's. All move together
    unless one that is off alone, by `spread` of ln p, leaves noticeably more than all of them,
    moved alike, can follow; none moves where it would not be noticed.
    """
    own = slopes[list(group)]
    whole = own.sum(axis=0)
    share = own @ whole / max(float(whole @ whole), np.finfo(float).tiny)
    left = spread * np.abs(own - share[:, None] * whole).max(initial=0.0)
    groups = [(k,) for k in group] if left >= SCREENING.noticed else [group]
    return [g for g in groups if _effect(slopes, g, spread) >= SCREENING.noticed]


def _effect(slopes: Floats, group: tuple[int, ...], spread: float) -> float:
    """Return the largest shift of ln f by a group that is off by `spread` of ln p."""
    return spread * float(np.abs(slopes[list(group)].sum(axis=0)).max(initial=0.0))


def noticeable(slopes: Floats, alike: Groups, spread: float) -> list[tuple[int, ...]]:
    """Return groups of parameters that would be noticed if they were wrong by `spread` of ln p.

    Of rows of `slopes` (n, n_pair), see `shifts`, each moves alone where it is noticed alone, and
    those `alike`, with one value in the deck, together; `most` groups at the most.
    """
    effect = spread * np.abs(slopes).max(axis=1, initial=0.0)
    groups: list[tuple[int, ...]] = [(int(k),) for k in np.flatnonzero(effect >= SCREENING.noticed)]
    rest = [tuple(k for k in group if effect[k] < SCREENING.noticed) for group in alike]
    groups += [group for group in rest if len(group) > 1]
    together = [_effect(slopes, g, spread) for g in groups]
    order = sorted(range(len(groups)), key=lambda i: -together[i])[: SCREENING.most]
    return [groups[i] for i in sorted(order) if together[i] >= SCREENING.noticed]


def tied(structure: Structure, groups: Groups, names: Sequence[str]) -> Structure:
    """Return the structure with parameters that each move some of the old ones alike.

    Old parameters in none of the groups stay at the deck's values; `names` are of the new ones.
    """
    model = structure.model
    new_of = {k: g for g, group in enumerate(groups) for k in group}
    n_old = len(model.parameters)

    def before(p: Floats) -> Floats:
        out = np.ones(n_old)
        for k, g in new_of.items():
            out[k] = p[g]
        return out

    parameters = tuple(
        Parameter(
            name,
            tuple(h for k in group for h in model.parameters[k].handle),
            tuple(v for k in group for v in model.parameters[k].deck_values),
            max(model.parameters[k].lower for k in group),
            min(model.parameters[k].upper for k in group),
            model.parameters[group[0]].weight,
        )
        for name, group in zip(names, groups, strict=True)
    )
    stiffness, mass = (_terms(t, new_of, model.deck_point) for t in (model.stiffness, model.mass))
    supports = structure.supports
    if supports is not None:
        none = sp.csr_matrix(supports.coupling.shape)
        slopes = tuple(sum((supports.slopes[k] for k in group), none).tocsr() for group in groups)
        supports = replace(supports, slopes=slopes)
    return replace(
        structure,
        model=replace(model, parameters=parameters, stiffness=stiffness, mass=mass),
        members=tuple(replace(m, block=_block(m.block, new_of, before)) for m in structure.members),
        supports=supports,
    )


def _terms(terms: Sequence[Term], new_of: dict[int, int], deck: Floats) -> tuple[Term, ...]:
    """Factors by the new parameters, those that stay put multiplied into the matrices."""
    collected: dict[Any, sp.csr_matrix] = {}
    for t in terms:
        kept = tuple(
            replace(f, parameter=new_of[f.parameter]) for f in t.factors if f.parameter in new_of
        )
        held = float(np.prod([f.value(deck) for f in t.factors if f.parameter not in new_of]))
        matrix = held * t.matrix
        collected[kept] = collected[kept] + matrix if kept in collected else matrix
    return tuple(Term(matrix, factors) for factors, matrix in collected.items())


def _block(
    block: ElementBlock, new_of: dict[int, int], before: Callable[[Floats], Floats]
) -> ElementBlock:
    """Return elements that take the new parameters."""
    depends = tuple(tuple(sorted({new_of[k] for k in old if k in new_of})) for old in block.depends)
    return replace(
        block,
        evaluate=lambda rows, p, wanted: block.evaluate(rows, before(p), wanted),
        depends=depends,
    )
