"""Parts of a survey in which every combination of output and input was measured."""

from __future__ import annotations

import numpy as np

from ...arrays import Ints, Numbers
from .pole_numbers import POLES


def complete_blocks(measured: Numbers) -> list[tuple[Ints, Ints]]:
    """Find sets of outputs and inputs with every combination measured, the most telling first.

    Parameters
    ----------
    measured : (n_output, n_input) bool

    Returns
    -------
    list of (rows, columns)
        The first block has all inputs when enough outputs were measured with all of them;
        otherwise blocks of fewer inputs follow until every input and nearly every output took
        part.
    """
    n_output = len(measured)
    patterns = np.unique(measured, axis=0)
    blocks = []
    for pattern in patterns:
        rows = np.flatnonzero(measured[:, pattern].all(axis=1))
        blocks.append((rows, np.flatnonzero(pattern)))
    blocks.sort(key=lambda b: (-len(b[1]) * min(len(b[0]), POLES.responses_enough), -len(b[0])))
    chosen = [blocks[0]]
    seen = np.zeros_like(measured)
    seen[np.ix_(*blocks[0])] = True
    for rows, columns in blocks[1:]:
        inputs_done = seen.any(axis=0).all()
        enough = min(n_output, 2 * POLES.responses_enough)
        outputs_done = np.count_nonzero(seen.any(axis=1)) >= enough
        if inputs_done and outputs_done:
            break
        if not seen[np.ix_(rows, columns)].all():
            chosen.append((rows, columns))
            seen[np.ix_(rows, columns)] = True
    return chosen
