"""Round ticks and plain axes for the charts."""

import math
from dataclasses import dataclass

from ..html.markup import short, svg_text, tag
from ..tables.number_formats import general


def ticks(low: float, high: float, about: int = 5) -> list[float]:
    """Round values (1, 2 or 5 times a power of ten apart) that cover `low`..`high`."""
    span = high - low
    if not span > 0.0:
        return [low]
    raw = span / max(about, 1)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(m * power for m in (1.0, 2.0, 5.0, 10.0) if m * power >= raw * 0.999)
    first, last = math.floor(low / step + 1e-9), math.ceil(high / step - 1e-9)
    return [k * step for k in range(first, last + 1)]


def decades(low: float, high: float) -> list[float]:
    """Powers of ten that cover `low`..`high`, both above zero."""
    first = math.floor(math.log10(low) + 1e-9)
    last = math.ceil(math.log10(high) - 1e-9)
    return [10.0**k for k in range(first, max(last, first + 1) + 1)]


@dataclass(frozen=True)
class Plot:
    """A plotting rectangle with its scales; y may be logarithmic."""

    left: float
    top: float
    width: float
    height: float
    x_low: float
    x_high: float
    y_ticks: tuple[float, ...]
    log: bool = False

    def x(self, value: float) -> float:
        """Return the pixel of an x value."""
        span = self.x_high - self.x_low
        return self.left + self.width * ((value - self.x_low) / span if span else 0.5)

    def y(self, value: float) -> float:
        """Return the pixel of a y value."""
        low, high = (self._scaled(self.y_ticks[k]) for k in (0, -1))
        share = (self._scaled(value) - low) / (high - low) if high > low else 0.5
        return self.top + self.height * (1.0 - share)

    def frame(self, *, emphasised: float | None = None) -> str:
        """Return horizontal rules with their values; one of them may stand out."""
        rules = ""
        for v in self.y_ticks:
            main = emphasised is not None and math.isclose(v, emphasised, abs_tol=1e-12)
            d = f"M{short(self.left)} {short(self.y(v))}h{short(self.width)}"
            rules += tag("path", d=d, class_="base" if main else None)
            rules += svg_text(self.left - 6, self.y(v) + 3.5, general(v, 5), text_anchor="end")
        return tag("g", rules, class_="rules")

    def _scaled(self, value: float) -> float:
        return math.log10(max(value, 1e-300)) if self.log else value


def spread(wanted: list[float], gap: float, low: float, high: float) -> list[float]:
    """Move label positions apart so that none is nearer than `gap`, keeping their order.

    Each run of labels that touch is centred on the mean of where its members want to be.
    """
    order = sorted(range(len(wanted)), key=lambda k: wanted[k])
    runs: list[list[int]] = []
    for k in order:
        runs.append([k])
        while len(runs) > 1 and (
            _start(runs[-1], wanted, gap) < _start(runs[-2], wanted, gap) + gap * len(runs[-2])
        ):
            runs[-2:] = [runs[-2] + runs[-1]]
    placed = list(wanted)
    for run in runs:
        for j, k in enumerate(run):
            placed[k] = _start(run, wanted, gap) + gap * (j + 0.5)
    overflow = max(0.0, max(placed, default=low) + gap / 2 - high)
    for j, k in enumerate(reversed(order)):
        placed[k] = min(placed[k], high - gap * (j + 0.5)) if overflow else placed[k]
    for j, k in enumerate(order):
        placed[k] = max(placed[k], low + gap * (j + 0.5))
    return placed


def _start(run: list[int], wanted: list[float], gap: float) -> float:
    return sum(wanted[k] for k in run) / len(run) - gap * len(run) / 2
