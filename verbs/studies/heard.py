"""What was measured or known beside modes: that a residual of the update reads it."""

from __future__ import annotations

from ...core.errors import InputError
from .study import Study

_READ_BY = {
    "relations": "relations",
    "measured_mass": "mass",
    "measured_centre_of_gravity": "centre_of_gravity",
    "load_cases": "deflections",
}
"""Keys of a study, each with the residual that reads it."""


def require_heard(asked: Study) -> None:
    """Refuse what an update would not hear, and a residual of relations without any.

    Raises
    ------
    InputError
        Which, and what to do.
    """
    named = {r.name for r in asked.named_residuals}
    if "relations" in named and not asked.relations:
        raise InputError(
            "the residual 'relations' needs what is known of parameters: give relations, such as "
            "'skin / web = 2 ± 0.1'"
        )
    for key, residual in _READ_BY.items():
        states = (asked, *asked.configurations)
        given = any(getattr(s, key, None) not in (None, ()) for s in states)
        if given and residual not in named:
            raise InputError(
                f"{key} is given, and residuals does not name '{residual}', which reads it; name "
                "it, or leave the other out"
            )
