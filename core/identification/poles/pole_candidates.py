"""Candidate roots of a band: pLSCF on complete blocks of the survey, wide and narrow."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...arrays import Ints, Numbers
from ..survey.survey_data import Survey
from .complete_blocks import complete_blocks
from .plscf import poles_by_order
from .pole_numbers import POLES
from .pole_stabilisation import Candidate, Chart, stabilise


@dataclass(frozen=True, eq=False)
class Proposal:
    """What the stabilisation of a band proposes.

    Parameters
    ----------
    firm : tuple of Candidate
        From the whole band.
    chart : Chart
        Of the whole band.
    more : callable
        Returns the candidates seen only in a narrower band or in another block of the survey, to
        be tested; they cost several times the firm ones, and few surveys need them.
    """

    firm: tuple[Candidate, ...]
    chart: Chart
    more: Callable[[], tuple[Candidate, ...]]


def propose(
    survey: Survey, first: float, last: float, n_peaks: int, max_order: int | None
) -> Proposal:
    """Propose roots of a band.

    Parameters
    ----------
    survey : Survey
    first, last : float
        Band [Hz].
    n_peaks : int
        Peaks that the mode indicator shows, from which the highest order follows.
    max_order : int, optional
        Highest order of the denominator polynomial instead.
    """
    blocks = complete_blocks(survey.measured)
    firm, chart = _run(survey, blocks[0], first, last, n_peaks, max_order)

    def more() -> tuple[Candidate, ...]:
        spare: list[Candidate] = []
        for block in blocks[1:]:
            found, _ = _run(survey, block, first, last, n_peaks, max_order)
            spare += _new(found, [*firm, *spare])
        third = (last - first) / 3.0
        for step in range(POLES.thirds):
            low = first + 0.5 * step * third
            found, _ = _run(survey, blocks[0], low, low + third, max(3, n_peaks // 2), max_order)
            spare += _new(found, [*firm, *spare])
        return tuple(spare)

    return Proposal(firm, chart, more)


def _run(
    survey: Survey,
    block: tuple[Ints, Ints],
    first: float,
    last: float,
    n_peaks: int,
    max_order: int | None,
) -> tuple[tuple[Candidate, ...], Chart]:
    rows, columns = block
    lines = survey.lines(first, last)
    f = survey.frequencies_hz[lines]
    n_input = len(columns)
    wanted = (POLES.order_each * n_peaks + POLES.order_base) * POLES.order_wider / n_input
    top = max_order or int(np.ceil(wanted)) + POLES.order_more
    top = max(2, min(top, POLES.columns_most // n_input, len(f) // 3))
    if len(f) < POLES.lines_least:
        return (), stabilise([], first, last)[1]
    values = survey.values[:, :, lines][rows][:, columns]
    scale = np.sqrt(np.mean(np.abs(values) ** 2, axis=(0, 2)))
    scale = 1.0 / np.where(scale > 0.0, scale, 1.0)
    sets = poles_by_order(f, values * scale[:, None], range(1, top + 1))
    found, chart = stabilise(sets, first, last)
    return tuple(_spread(c, scale, columns, survey.measured.shape[1]) for c in found), chart


def _spread(c: Candidate, scale: Numbers, columns: Ints, n_input: int) -> Candidate:
    participation = np.full(n_input, np.nan + 0j)
    participation[columns] = c.participation / scale
    return Candidate(c.pole, participation, c.length)


def _new(found: tuple[Candidate, ...], known: list[Candidate]) -> list[Candidate]:
    """Return those of `found` that `known` does not hold; one known root excuses one found."""
    free = list(known)
    fresh = []
    for c in found:
        gaps = [abs(c.pole - k.pole) for k in free]
        if gaps:
            best = int(np.argmin(gaps))
            if gaps[best] < POLES.candidate_same * max(abs(c.pole.real), abs(free[best].pole.real)):
                del free[best]
                continue
        fresh.append(c)
    return fresh
