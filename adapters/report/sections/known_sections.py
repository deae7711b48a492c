"""The sections of the report, one line each."""

from typing import Any

from ....core.errors import InputError, require_kind
from .alignment import ALIGNMENT
from .alternatives import ALTERNATIVES
from .damping import DAMPING
from .damping_ratios import DAMPING_RATIOS
from .deck_changes import DECK_CHANGES
from .disagreement import DISAGREEMENT
from .findings import FINDINGS
from .frequency_responses import FREQUENCY_RESPONSES
from .gap import GAP
from .mac_matrices import MAC_MATRICES
from .mass import MASS
from .measured_functions import MEASURED_FUNCTIONS
from .moving_shapes import MOVING_SHAPES
from .orthogonality import ORTHOGONALITY
from .pairs import PAIRS
from .parameters import PARAMETERS
from .posterior import EVIDENCE, SAMPLES
from .section import Section
from .sensors import SENSORS
from .unpaired_modes import UNPAIRED_MODES
from .would_decide import WOULD_DECIDE

SECTIONS: list[Section[Any]] = [
    FINDINGS,
    WOULD_DECIDE,
    GAP,
    DAMPING,
    FREQUENCY_RESPONSES,
    DISAGREEMENT,
    PAIRS,
    MAC_MATRICES,
    ORTHOGONALITY,
    MOVING_SHAPES,
    UNPAIRED_MODES,
    MEASURED_FUNCTIONS,
    SENSORS,
    MASS,
    PARAMETERS,
    DAMPING_RATIOS,
    SAMPLES,
    EVIDENCE,
    ALTERNATIVES,
    ALIGNMENT,
    DECK_CHANGES,
]
"""In the order of the page."""


def register_section(section: Section[Any], before: Section[Any] | None = None) -> None:
    """Add a section to every report, before another or last; ``SECTIONS.remove`` undoes it.

    Raises
    ------
    InputError
        Its anchor is taken; the other is not in the report.
    """
    require_kind(section, Section, "what is registered")
    if before not in (None, *SECTIONS):
        raise InputError(f"{before!r} is no section of the report")
    if any(s.anchor == section.anchor for s in SECTIONS):
        raise InputError(f"a section with the anchor '{section.anchor}' is there already")
    SECTIONS.insert(len(SECTIONS) if before is None else SECTIONS.index(before), section)
