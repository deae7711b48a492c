"""The page of what may be moved: what modes tell of each parameter, and where it is."""

from collections.abc import Mapping, Sequence
from pathlib import PurePath

import numpy as np

from ...core.data.geometry import Geometry
from ...core.results.parameters import CandidateRow, ParametersTables
from .html.html_table import html_table
from .html.markup import tag
from .imprint import Imprint
from .page import sections, sheet, titled
from .pictures.named_matrix import named_matrix
from .pictures.scene import scene
from .tables.number_formats import counted, few, fixed, general, hz, listed, percent
from .tables.table import Table, left

_MATRIX = 30
"""Parameters of a matrix, the most sensitive ones."""
_PARTS = 12
"""Parameters that are shown on the structure."""


def parameters_page(
    found: ParametersTables,
    geometry: Geometry,
    places: Mapping[str, Sequence[int]],
    imprint: Imprint | None = None,
) -> str:
    """Return what may be moved as one HTML page that needs nothing else.

    Parameters
    ----------
    found : ParametersTables
    geometry : Geometry
    places : mapping of str to sequence of int
        Grids that each parameter moves something at, by its name.
    imprint : Imprint, optional
        Whose page it is.
    """
    name = PurePath(found.deck_file).name
    first = sorted(found.candidates, key=lambda c: (c.recommended or np.inf, -c.sensitivity))
    shown = [c for c in first if c.name in places][:_PARTS]
    largest = max((c.sensitivity for c in found.candidates), default=0.0) or 1.0
    pictures = "".join(_part(geometry, c, places[c.name], largest) for c in shown)
    note = (
        "The darker, the more its modes move with the parameter; touched are its elements' grids."
    )
    shown_in = (
        ("Parameters", html_table(candidates_table(first))),
        ("Sensitivity", _sensitivity(found)),
        ("Likeness", _likeness(found)),
        ("On the structure", tag("div", pictures, class_="maps") + tag("p", note, class_="note")),
    )
    chosen = listed(found.recommended) or "none: no parameter is determined"
    heading = f"{counted(len(found.candidates), 'parameter')}; recommended: {chosen}"
    return sheet(
        found,
        ("parameters", name),
        titled("What may be moved", name, heading, found.warnings),
        sections(*shown_in),
        imprint=imprint,
    )


def candidates_table(rows: Sequence[CandidateRow]) -> Table:
    """Return the parameters with what is known of each."""
    headings = (
        *left("parameter"), "value", "∂ln f/∂ln p", "error alone", "error together", "group",
        "recommended", "explained %",
    )  # fmt: skip
    cells = [
        (
            c.name,
            few([general(v, 5) for v in c.values]),
            fixed(c.sensitivity, 4),
            general(c.error_alone, 2),
            general(c.error_together, 2),
            str(c.group),
            "" if c.recommended is None else str(c.recommended),
            percent(c.explained, 1),
        )
        for c in rows
    ]
    note = "Standard errors are of the factor; parameters of one group are not told apart."
    return Table.of("Parameters", headings, cells, note)


def _kept(found: ParametersTables) -> list[int]:
    assert found.sensitivities is not None
    size = np.abs(found.sensitivities.values).max(axis=0, initial=0.0)
    return sorted(np.argsort(-size, kind="stable")[:_MATRIX].tolist())


def _sensitivity(found: ParametersTables) -> str:
    table = found.sensitivities
    if table is None or not len(table):
        return ""
    kept = _kept(found)
    rows = [f"{m} · {hz(f)} Hz" for m, f in zip(table.modes, table.hz.tolist(), strict=True)]
    values = table.values[:, kept]
    largest = np.abs(values).max(initial=0.0) or 1.0
    return named_matrix(
        values / largest,
        rows,
        [table.parameters[k] for k in kept],
        "Sensitivity of each mode",
        f"∂ln f/∂ln p in percent of the largest, {largest:.3g}.",
    )


def _likeness(found: ParametersTables) -> str:
    table = found.likeness
    if table is None or len(table) < 2:
        return ""
    kept = _kept(found)
    names = [table.parameters[k] for k in kept]
    return named_matrix(
        table.values[np.ix_(kept, kept)],
        names,
        names,
        "Cosines between what parameters do",
        "In percent; parameters near ±100 cannot be told apart.",
    )


def _part(geometry: Geometry, c: CandidateRow, grids: Sequence[int], largest: float) -> str:
    values = np.full(len(geometry.ids), np.nan)
    rows = geometry.index_of(np.asarray(grids, np.int64))
    values[rows[rows >= 0]] = 0.15 + 0.8 * c.sensitivity / largest
    return scene(geometry, c.name, values=values, width=400, height=340, most=900)
