"""What was measured or known beside modes: that a residual of the update reads it."""

from __future__ import annotations

from ...core.errors import InputError
from .study import Study

_READS = {
    "relations": ("relations", "is known of parameters", ", such as 'skin / web = 2 ± 0.1'"),
    "mass": ("measured_mass", "the structure weighs", ""),
    "centre_of_gravity": ("measured_centre_of_gravity", "was measured of it", ""),
    "deflections": ("load_cases", "was read under which load", ""),
}
"""Residuals, each with the key of a study that it reads, what that is, and an example."""


def require_heard(asked: Study) -> None:
    """Refuse what an update would not hear, and a residual that has nothing to hear.

    Of several configurations one has to be measured.

    Raises
    ------
    InputError
        Which, and what to do.
    """
    named = {r.name for r in asked.named_residuals}
    for residual, (key, what, example) in _READS.items():
        states = (asked, *asked.configurations)
        given = any(getattr(s, key, None) not in (None, ()) for s in states)
        if residual in named and not given:
            raise InputError(f"the residual '{residual}' needs what {what}: give {key}{example}")
        if given and residual not in named:
            raise InputError(
                f"{key} is given, and residuals does not name '{residual}', which reads it; name "
                "it, or leave the other out"
            )
