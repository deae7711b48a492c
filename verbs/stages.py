"""The stages of an update from what the study says."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from ..core.data.parameter import Parameter
from ..core.errors import InputError
from ..core.updating.update import Stage
from .study import Study


def stages_of(study: Study, parameters: Sequence[Parameter]) -> tuple[Stage, ...]:
    """Return the stages; without ``[[stages]]`` one that moves every parameter.

    Raises
    ------
    InputError
        A stage that names a parameter the study does not define.
    """
    names = [p.name for p in parameters]
    if not study.stages:
        every = tuple(range(len(names)))
        return (Stage(every, study.residuals, study.max_iterations),)
    return tuple(
        Stage(
            tuple(_number(name, names) for name in s.parameters) or tuple(range(len(names))),
            s.residuals,
            s.max_iterations,
        )
        for s in study.stages
    )


def _number(name: str, names: Sequence[str]) -> int:
    if name in names:
        return names.index(name)
    near = get_close_matches(name, names, n=1)
    hint = f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(names)}"
    raise InputError(f"a stage names the parameter '{name}', which the study does not define{hint}")
