"""An update that moves no parameter that the test does not determine."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import frozen
from .problem import Configuration, Problem
from .stages import Iteration, Reason, Stage, Stop, Updated
from .update import update_configurations

Steps = tuple[Sequence[Iteration], Callable[[Iteration], None]]
"""Those that an update has taken already, and what is told of each further one."""


def update_determined(
    configurations: Sequence[Configuration],
    stages: Sequence[Stage],
    steps: Callable[[], Steps] = lambda: ((), lambda _: None),
) -> Updated:
    """Update as ever, and leave at the deck's value what the test does not determine.

    Where an update ends with parameters whose values the test leaves open, it is made again
    without them: of those that it cannot tell apart the one that moves the residuals most is kept
    (see `identifiability`).

    Parameters
    ----------
    configurations, stages
        As for `update_configurations`.
    steps : callable
        Asked for each update that is made.

    Returns
    -------
    Updated
        `undetermined` are those that were left, with factor 1 and no standard error.

    Raises
    ------
    InputError, CheckError
        As `update_configurations`.
    """
    problem = Problem.of(configurations)

    def updated(stages: Sequence[Stage]) -> Updated:
        gone_on, progress = steps()
        return update_configurations(configurations, stages, progress=progress, gone_on=gone_on)

    done = updated(stages)
    solves, left, told = done.eigensolutions, set[int](), list[str]()
    while done.undetermined:
        told += done.doubts
        left |= {*done.undetermined}
        moving = _without(stages, left)
        if not moving:
            done = _as_it_was(done, tuple(problem.deck_point))
            break
        done = updated(moving)
        solves += done.eigensolutions
    if not left:
        return done
    names = " and ".join(problem.parameters[k].name for k in sorted(left))
    stay = f"{names} stay{'s' if len(left) == 1 else ''} as in the deck"
    warnings = (*dict.fromkeys(told), stay, *done.warnings)
    at = tuple(sorted(left))
    return replace(done, eigensolutions=solves, undetermined=at, warnings=warnings)


def _without(stages: Sequence[Stage], left: Collection[int]) -> tuple[Stage, ...]:
    """Return the stages with the parameters that still move, those with none left out."""
    moving = (tuple(k for k in s.parameters if k not in left) for s in stages)
    return tuple(replace(s, parameters=p) for s, p in zip(stages, moving, strict=True) if p)


def _as_it_was(done: Updated, point: Sequence[float]) -> Updated:
    """Return an update that moved nothing."""
    n = len(point)
    return replace(
        done,
        factors=frozen(np.array(point)),
        standard_error=frozen(np.full(n, np.nan)),
        covariance=None,
        at_bound=frozen(np.zeros(n, bool)),
        after=done.before,
        history=done.history[:1],
        stopped=Stop(Reason.NOTHING_DETERMINED, "the test determines none of the parameters"),
        warnings=(),
    )
