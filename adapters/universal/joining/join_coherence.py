"""Coherence functions brought to the frequency responses that they belong to."""

from __future__ import annotations

import numpy as np

from ....core.arrays import Floats, Ints
from ....core.data.dofs import Dofs
from ....core.identification.survey.coherence import Coherence
from ..universal_content import Function, UniversalContent

_KINDS = ("coherence", "multiple coherence")


def coherence_of(content: UniversalContent) -> tuple[Coherence | None, tuple[str, ...]]:
    """Return the coherence of the frequency responses, and what is to be told of it.

    Functions of dataset 58 of type 6 and 26, in whichever file they stand. Response and reference
    go together whatever their sign; a multiple coherence belongs to all references.
    """
    given = [f for f in content.functions if f.kind in _KINDS]
    frfs = content.frfs
    if not given or frfs is None:
        return None, ()
    values = np.full(frfs.values.shape, np.nan)
    strays = 0
    for function in given:
        rows = _at(frfs.responses, function.response)
        columns = _at(frfs.references, function.reference)
        if function.kind == "multiple coherence":
            columns = np.arange(len(frfs.references))
        if not len(rows) or not len(columns):
            strays += 1
            continue
        values[np.ix_(rows, columns)] = _on(function, frfs.frequencies_hz)
    said = (f"{strays} of {len(given)} coherence functions belong to no frequency response",)
    found = Coherence(frfs.frequencies_hz, frfs.responses, frfs.references, values)
    return found, said if strays else ()


def _at(dofs: Dofs, place: tuple[int, int]) -> Ints:
    node, direction = place
    return np.flatnonzero((dofs.node == node) & (dofs.component == abs(direction)))


def _on(function: Function, hz: Floats) -> Floats:
    """Values at the lines of the frequency responses, NaN beyond the function's own."""
    real = np.clip(np.real(function.values), 0.0, 1.0)
    return np.interp(hz, function.abscissa, real, left=np.nan, right=np.nan)
