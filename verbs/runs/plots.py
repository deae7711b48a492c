"""`result.plot`: the pictures of a run as matplotlib figures."""

from __future__ import annotations

import numbers
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError

if TYPE_CHECKING:
    from ...adapters.report import Overlay
    from .run import Run


@dataclass(frozen=True, eq=False)
class Plots:
    """Pictures of a run; each raises `InputError` where matplotlib is not installed."""

    run: Run

    def mac(self, rotated: bool = True) -> Any:
        """Return the MAC matrix, after rotation of close modes or as measured."""
        from ...adapters.plots import mac
        from ...adapters.report.pictures.colour import ramp

        return mac(self.run.final, rotated, ramp(dark=False))

    def frequencies(self) -> Any:
        """Return the frequency deviation and the MAC of each test mode, before and after."""
        from ...adapters.plots import frequencies

        first, last = self.run.initial, self.run.final
        states = [("before", first), ("after", last)] if first else [("", last)]
        return frequencies(states, _colours(len(states)))

    def shapes(self, test_modes: int | Sequence[int] | None = None) -> Any:
        """Return the paired shapes, the test's over the model's; those of some test modes."""
        from ...adapters.plots import shapes
        from ...adapters.report.pictures.colour import series

        drawn = self._drawn(test_modes)
        left_out = self.run.final.unpaired_test if test_modes is None else ()
        return shapes(drawn, drawn.pairs, series(2, dark=False), left_out)

    def misfit(self, test_modes: int | Sequence[int] | None = None) -> Any:
        """Return where the paired shapes differ, on the structure."""
        from ...adapters.plots import misfit
        from ...adapters.report.pictures.colour import ramp

        names = [f"{s.node}:{s.direction}" for s in self.run.final.alignment.sensors]
        return misfit(self._drawn(test_modes), names, ramp(dark=False))

    def _drawn(self, test_modes: int | Sequence[int] | None) -> Overlay:
        """Return the paired shapes of some test modes, default all."""
        from .report import paired_shapes

        every = paired_shapes(self.run, self.run.content)
        if every is None:
            raise InputError("the run has no paired shapes to draw")
        asked = [p.test for p in every.pairs] if test_modes is None else _numbers(test_modes)
        kept = [k for k, p in enumerate(every.pairs) if p.test in asked]
        lost = sorted(set(asked) - {p.test for p in every.pairs})
        if lost or not kept:
            raise InputError(f"test mode {lost[0] if lost else 'none'} has no partner to draw")
        return replace(
            every,
            shapes=every.shapes[kept],
            model=every.model[kept],
            test=every.test[kept],
            pairs=tuple(every.pairs[k] for k in kept),
        )


def _numbers(test_modes: object) -> list[int]:
    """Return the numbers of test modes that were given as one or several."""
    modes: list[Any] = list(test_modes) if isinstance(test_modes, Iterable) else [test_modes]
    if not all(isinstance(m, numbers.Integral) and not isinstance(m, bool) for m in modes):
        raise InputError(f"test_modes is {test_modes!r}; give mode numbers of the test, from 1")
    return [int(m) for m in modes]


def _colours(count: int) -> list[str]:
    """Return the colours of the report: one series dark, of two the first pale."""
    from ...adapters.report.pictures.colour import ramp, series

    return series(1, dark=False) if count == 1 else [ramp(dark=False)[6], series(1, dark=False)[0]]
