"""The table of how well a model meets measured frequency responses, by their assurance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from ..data.frfs import Frfs
from ..noun import Noun
from .plain import Table


@dataclass(frozen=True)
class FracRow:
    """Frequency response assurance (0 to 1) of a function, ``node:direction`` of its ends."""

    response: str
    reference: str
    frac: float


@dataclass(frozen=True, eq=False)
class ResponseTables(Noun):
    """How well frequency responses are met by those of the model's modes."""

    mean_frac: float
    functions: Table[FracRow]


def response_tables(measured: Frfs, frac: Floats) -> ResponseTables:
    """Return the tables of functions with their assurance, (n_response, n_reference) or NaN."""
    out, by = measured.responses.labels, measured.references.labels
    rows = [FracRow(out[k], by[j], float(frac[k, j])) for k, j in np.argwhere(np.isfinite(frac))]
    return ResponseTables(float(np.nanmean(frac)), Table(rows, FracRow))
