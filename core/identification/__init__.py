"""Modes from measured frequency responses."""

from .identify import identify
from .poles.pole_stabilisation import Chart
from .result import Background, Identification, Indicator

__all__ = ["Background", "Chart", "Identification", "Indicator", "identify"]
