"""Figures in the words of the one who reads them: odds, ranges of modes."""

from collections.abc import Sequence

from .effect_numbers import EFFECTS


def odds(ratio: float, other: str = "", most: float = EFFECTS.odds_most) -> str:
    """Say how many times less likely something is than what was found, or more.

    `ratio` is the likelihood of what was found, `other` where it has to be said, over its own.
    More than `most` times is not said, and no figure at all where that is next to nothing.
    """
    if EFFECTS.alike > ratio > 1.0 / EFFECTS.alike:
        return "about as likely" + (other and f" as {other}")
    less, most = ratio > 1.0, min(most, EFFECTS.odds_most)
    count = _count(ratio if less else 1.0 / max(ratio, 1.0 / most), most)
    way = "less" if less else "more"
    return f"{count}{way} likely" + (other and f" than {other}")


def _count(ratio: float, most: float) -> str:
    if most < EFFECTS.alike:
        return ""
    return f"more than {most:.2g} times " if ratio >= most else f"{ratio:.2g} times "


def mode_ranges(modes: Sequence[int]) -> str:
    """Return ``test mode 7``, ``test modes 3 and 7 to 12``: what follows each other is joined.

    Modes all over the test are counted: ``9 test modes``.
    """
    runs: list[list[int]] = []
    for m in sorted(modes):
        if runs and m == runs[-1][-1] + 1:
            runs[-1].append(m)
        else:
            runs.append([m])
    if len(runs) > EFFECTS.mode_runs:
        return f"{len(modes)} test modes"
    words = []
    for run in runs:
        words += [f"{run[0]} to {run[-1]}"] if len(run) > 2 else [str(m) for m in run]
    return f"test mode{'s' if len(modes) > 1 else ''} {listed(words)}"


def listed(parts: Sequence[str]) -> str:
    """Return ``a``, ``a and b``, ``a, b and c``."""
    return " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
