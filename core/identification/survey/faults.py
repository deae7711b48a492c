"""Faults of a survey: which functions are wrong, how, and what was done about it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from .survey_numbers import SURVEY


@dataclass(frozen=True)
class Fault:
    """One fault in words, and in a form that programs read.

    Parameters
    ----------
    kind : str
        ``no_response``, ``dead_channel``, ``overload``, ``noise_floor``, ``double_hit``,
        ``wrong_sign``, ``wrong_gain``, ``swapped_references``, ``swapped_points``,
        ``driving_point`` or ``low_coherence``.
    functions : tuple of str
        Response and reference of each as the file has them, such as ``40:Z/12:Z``.
    sentence : str
    done : str
        ``left out``, ``turned``, ``exchanged``, ``scaled``, or empty: nothing was done.
    """

    kind: str
    functions: tuple[str, ...]
    sentence: str
    done: str = ""


def listed(names: Sequence[str]) -> str:
    """Name the first few."""
    more = len(names) - SURVEY.named
    return ", ".join(names[: SURVEY.named]) + (f" and {more} more" if more > 0 else "")
