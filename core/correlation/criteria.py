"""When a test mode and an analysis mode may be a pair, and which modes take part at all."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Bools, Floats
from ..errors import InputError
from .correlation_numbers import CORRELATION

SIDES = ("analysis", "test", "none")


@dataclass(frozen=True)
class Criteria:
    """When a test mode and an analysis mode may be a pair, and what counts as close.

    Parameters
    ----------
    mac_min : float
        Smallest MAC of a pair.
    frequency_tolerance : float
        Largest |analysis − test| / test.
    cluster_width : float
        Largest relative bandwidth of a cluster.
    rotate : {"analysis", "test", "none"}
        Which side's close modes are turned.
    exclude_test, exclude_analysis : tuple of int
        Modes that take no part, by their numbers from 1.
    bands : tuple of (low, high)
        Test modes outside of all of them take no part, Hz; high None is no limit.
    pairs : tuple of (test, analysis)
        Pairs by hand, by numbers from 1: whatever their MAC, and not turned.
    """

    mac_min: float = CORRELATION.mac
    frequency_tolerance: float = CORRELATION.frequency
    cluster_width: float = CORRELATION.cluster
    rotate: str = "analysis"
    exclude_test: tuple[int, ...] = ()
    exclude_analysis: tuple[int, ...] = ()
    bands: tuple[tuple[float, float | None], ...] = ()
    pairs: tuple[tuple[int, int], ...] = ()

    def __post_init__(self) -> None:
        if not 0.0 < self.mac_min <= 1.0:
            raise InputError(f"mac_min is {self.mac_min}; give a value above 0 and up to 1")
        if self.frequency_tolerance <= 0.0:
            raise InputError(
                f"frequency_tolerance is {self.frequency_tolerance}; give a fraction above 0"
            )
        if not 0.0 <= self.cluster_width < 1.0:
            raise InputError(f"cluster_width is {self.cluster_width}; give a fraction from 0 to 1")
        if self.rotate not in SIDES:
            raise InputError(f"rotate is '{self.rotate}'; give one of {', '.join(SIDES)}")
        for side, out in enumerate((self.exclude_test, self.exclude_analysis)):
            what, own = ("test", "analysis")[side], [p[side] for p in self.pairs]
            for mode in own:
                if own.count(mode) > 1:
                    raise InputError(f"{what} mode {mode} is in two pairs by hand")
                if mode in out:
                    raise InputError(f"{what} mode {mode} is in a pair by hand, and excluded")
            if min([*own, *out], default=1) < 1:
                raise InputError("modes are numbered from 1")

    def test_modes(self, test_hz: Floats) -> Bools:
        """Return which modes of a test take part, (n_test,); those in a pair by hand do."""
        number = np.arange(len(test_hz)) + 1
        kept = ~np.isin(number, self.exclude_test)
        if self.bands:
            within = [(test_hz >= a) & (test_hz <= (np.inf if b is None else b))
                      for a, b in self.bands]  # fmt: skip
            kept &= np.any(within, axis=0) | np.isin(number, [t for t, _ in self.pairs])
        return np.asarray(kept)

    def analysis_modes(self, count: int, rigid_body_modes: int) -> Bools:
        """Return which analysis modes take part, (count,): elastic ones."""
        number = np.arange(count) + 1
        return (number > rigid_body_modes) & ~np.isin(number, self.exclude_analysis)

    def require(self, test_hz: Floats, count: int, rigid_body_modes: int) -> None:
        """Refuse numbers of modes that are not there, and rigid-body modes in pairs by hand."""
        for what, n, named in (
            ("test", len(test_hz), (*self.exclude_test, *(t for t, _ in self.pairs))),
            ("analysis", count, (*self.exclude_analysis, *(a for _, a in self.pairs))),
        ):
            if max(named, default=0) > n:
                raise InputError(f"there is no {what} mode {max(named)}: the last is {n}")
        for t, a in self.pairs:
            if a <= rigid_body_modes or test_hz[t - 1] == 0.0:
                raise InputError(f"pair {t}:{a}: a motion at 0 Hz cannot be in a pair by hand")
        if not self.test_modes(test_hz).any():
            raise InputError("no test mode takes part: all are excluded or outside of the bands")
