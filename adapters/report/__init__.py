"""The self-contained HTML report of a run, and its sections; each is imported when it is used."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...core.late_imports import lazy_names

if TYPE_CHECKING:
    from .imprint import Imprint as Imprint
    from .page import make_report as make_report
    from .pictures.film import Film as Film, paired_film as paired_film
    from .pictures.function_overlay import Curves as Curves
    from .pictures.shape_overlay import Overlay as Overlay, overlay as overlay
    from .sections.known_sections import SECTIONS as SECTIONS, register_section as register_section
    from .sections.section import ReportedRun as ReportedRun, Section as Section
    from .tables.headline import headline as headline
    from .tables.table import Cell as Cell, Column as Column, Table as Table

__getattr__, __all__ = lazy_names(
    __name__,
    {
        ".imprint": "Imprint",
        ".page": "make_report",
        ".pictures.film": "Film paired_film",
        ".pictures.function_overlay": "Curves",
        ".pictures.shape_overlay": "Overlay overlay",
        ".sections.known_sections": "SECTIONS register_section",
        ".sections.section": "ReportedRun Section",
        ".tables.headline": "headline",
        ".tables.table": "Cell Column Table",
    },
)
