"""Damping ratios of modes: given, of a test, of a deck, and a default for the rest."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Floats
from ..errors import InputError
from .statespace_numbers import STATESPACE

KNOWN = ("test", "deck")
Asked = str | float | Sequence[float] | Mapping[int, float] | None

_FOR_MODE = re.compile(r"(\d+)\s*[:=]\s*(.+)")


@dataclass(frozen=True)
class DampingChoice:
    """What was asked for: the sources that count, in their order, and numbers.

    Parameters
    ----------
    sources : tuple of {"test", "deck"}
    by_mode : dict of int to float
        Mode numbers from 1.
    rest : float or None
        Of all modes that nothing else says a ratio of.
    """

    sources: tuple[str, ...] = KNOWN
    by_mode: Mapping[int, float] = field(default_factory=dict)
    rest: float | None = None


def read_damping(asked: Asked) -> DampingChoice:
    """Return the choice that was asked for.

    Parameters
    ----------
    asked : str, float, sequence, mapping or None
        ``0.01``; ``"test"``, ``"deck"``; ``"1:0.01, 2:0.02, 0.015"``; a ratio of each mode; a
        mapping of mode numbers to ratios; None: what is known.

    Raises
    ------
    InputError
        What is no such choice, or a negative ratio.
    """
    if asked is None:
        return DampingChoice()
    if isinstance(asked, str):
        return _of_text(asked)
    if isinstance(asked, Mapping):
        numbers = [k for k in asked if not isinstance(k, int | np.integer)]
        if numbers:
            raise InputError(f"damping: {numbers[0]!r} is no number of a mode")
        return DampingChoice(KNOWN, {int(k): _ratio(z) for k, z in asked.items()})
    if isinstance(asked, int | float):
        return DampingChoice((), {}, _ratio(asked))
    return DampingChoice(KNOWN, {k: _ratio(z) for k, z in enumerate(np.ravel(asked).tolist(), 1)})


def _of_text(asked: str) -> DampingChoice:
    sources: list[str] = []
    by_mode: dict[int, float] = {}
    rest: float | None = None
    for word in filter(None, (w.strip() for w in asked.split(","))):
        if word in KNOWN:
            sources.append(word)
        elif found := _FOR_MODE.fullmatch(word):
            if int(found[1]) in by_mode:
                raise InputError(f"damping={asked!r} gives mode {found[1]} two ratios")
            by_mode[int(found[1])] = _ratio(found[2])
        elif rest is None:
            rest = _ratio(word)
        else:
            raise InputError(
                f"damping={asked!r} gives two ratios for all; write '1:0.01, 2:0.02' for modes"
            )
    others = KNOWN if by_mode and rest is None else ()
    return DampingChoice(tuple(sources) or others, by_mode, rest)


def _ratio(value: object) -> float:
    try:
        ratio = np.nan if isinstance(value, bool) else float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        ratio = np.nan
    if not 0.0 <= ratio < np.inf:
        why = "would be unstable" if ratio < 0.0 else "is no damping ratio"
        raise InputError(
            f"a damping of {str(value).strip()!r} {why}; give a fraction of critical such as 0.01, "
            "'1:0.01, 2:0.02, 0.015', 'test' or 'deck'"
        )
    return ratio


def choose_damping(
    choice: DampingChoice, known: Mapping[str, Floats], frequencies_hz: Floats
) -> tuple[Floats, list[str]]:
    """Return the ratio of each mode, and in words what stands for what is not known.

    Parameters
    ----------
    choice : DampingChoice
    known : mapping of {"test", "deck"} to (n_mode,) float
        Ratios that a source knows, NaN where it does not.
    frequencies_hz : (n_mode,) float

    Raises
    ------
    InputError
        A mode number that there is not, a source asked for that knows nothing.
    """
    n = len(frequencies_hz)
    ratios = np.full(n, np.nan)
    beyond = [k for k in choice.by_mode if not 1 <= k <= n]
    if beyond:
        raise InputError(f"a damping is given for mode {beyond[0]}; there are {n} modes")
    for k, z in choice.by_mode.items():
        ratios[k - 1] = z
    for source in choice.sources:
        found = known.get(source)
        if found is None or np.isnan(found).all():
            if choice.sources != KNOWN:
                raise InputError(f"the {source} says nothing of damping; give a ratio such as 0.01")
            continue
        ratios = np.where(np.isnan(ratios), found, ratios)
    elastic = np.isnan(ratios) & (frequencies_hz > 0.0)
    ratios[np.isnan(ratios) & ~elastic] = 0.0
    if choice.rest is not None:
        ratios[elastic] = choice.rest
    high = [
        f"the damping of mode {k + 1} is {ratios[k]:g} times critical; 5 % is written 0.05"
        for k in np.flatnonzero(ratios >= 1.0)[:1]
    ]
    if choice.rest is not None or not elastic.any():
        return ratios, high
    test = known.get("test")
    heard = test is not None and "test" in choice.sources and not np.isnan(test).all()
    usual = float(np.nanmedian(test)) if heard and test is not None else STATESPACE.damping
    ratios[elastic] = usual
    whose = "the median of the test" if heard else "a default"
    return ratios, [
        *high,
        f"no damping is known of {np.count_nonzero(elastic)} of {n} modes: {100 * usual:.3g} % of "
        f"critical is taken, {whose}",
    ]
