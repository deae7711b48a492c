"""The self-contained HTML report."""

from .headline import headline
from .overlay import Overlay, overlay
from .page import make_report

__all__ = ["Overlay", "headline", "make_report", "overlay"]
