"""How far a parameter may move before its cards no longer make sense."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ....core.arrays import Ints
from ....core.assembly.element_assembly import ElementBlock
from ....core.errors import InputError
from ..cards.element_group import Group
from ..fields.parameter_references import DEFAULT_BOUNDS, ParameterSpec
from .variation import Variation

_BISECTIONS = 12
_MARGIN = 0.9
"""Of the way that is known to make sense: how much of it is used."""


def admissible(
    variation: Variation,
    specs: Sequence[ParameterSpec],
    groups: Sequence[Group],
    blocks: Sequence[ElementBlock],
) -> tuple[Variation, tuple[str, ...]]:
    """Narrow bounds that nobody gave to where the cards can be read and make elements.

    Poisson's ratio stays below one half, the wall of a tube within its radius. Bounds that the
    user gave are kept; cards that make no sense there are his error.

    Returns
    -------
    variation : Variation
        With the narrower bounds.
    notes : tuple of str
        Which bounds were narrowed.
    """
    parameters, notes = [], []
    for k, (spec, parameter) in enumerate(zip(specs, variation.parameters, strict=True)):
        if (spec.lower, spec.upper) == DEFAULT_BOUNDS:
            probes = list(_probes(k, variation, groups, blocks))
            lower, upper = (
                _farthest(len(specs), k, bound, probes)
                for bound in (parameter.lower, parameter.upper)
            )
            if (lower, upper) != DEFAULT_BOUNDS:
                parameter = replace(parameter, lower=lower, upper=upper)
                notes.append(
                    f"the factor of {spec.name!r} is kept between {lower:.4g} and {upper:.4g}: "
                    "beyond, its cards make no sense"
                )
        parameters.append(parameter)
    return replace(variation, parameters=tuple(parameters)), tuple(notes)


def _probes(
    parameter: int, variation: Variation, groups: Sequence[Group], blocks: Sequence[ElementBlock]
) -> Iterator[tuple[ElementBlock, Ints]]:
    """One element for each set of cards that the parameter acts on."""
    for group, block in zip(groups, blocks, strict=True):
        first = np.unique(group.source_of, return_index=True)
        rows = [
            int(row)
            for source, row in zip(*first, strict=True)
            if any(parameter in variation.acting_on(key) for key in group.sources[source])
        ]
        if rows:
            yield block, np.array(rows, np.int64)


def _farthest(
    count: int, parameter: int, bound: float, probes: Sequence[tuple[ElementBlock, Ints]]
) -> float:
    """Return the factor next to `bound` at which all elements can be made."""

    def sound(factor: float) -> bool:
        p = np.ones(count)
        p[parameter] = factor
        try:
            for block, rows in probes:
                block.evaluate(rows, p, (True, True))
        except InputError:
            return False
        return True

    if sound(bound):
        return bound
    good, bad = 1.0, bound
    for _ in range(_BISECTIONS):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if sound(middle) else (good, middle)
    return 1.0 + _MARGIN * (good - 1.0)
