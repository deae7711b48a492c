"""Modes from measured frequency responses."""

from .identify import identify
from .result import Background, Identification, Indicator
from .stabilisation import Chart

__all__ = ["Background", "Chart", "Identification", "Indicator", "identify"]
