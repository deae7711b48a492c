"""The self-contained HTML report."""

from .headline import headline
from .page import make_report

__all__ = ["headline", "make_report"]
