"""An update that moves no parameter that the test does not determine."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from ..arrays import Bools, frozen
from .identifiability import told_alone
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
    without them, unless it determines none of them all by itself: of those that it cannot tell
    apart the one that moves the residuals most stands for their combination (see
    `identifiability`), so that the others come out as they are. `put_back` takes that back. Where
    a value that it determines comes out elsewhere without them, by more than its standard error,
    theirs in the deck are wrong: then those of all moving together are taken, and put back.

    Parameters
    ----------
    configurations, stages
        As for `update_configurations`.
    steps : callable
        Asked for each update that is made.

    Returns
    -------
    Updated
        `undetermined` are those that were left, with factor 1 and no standard error; `combined`
        are those that stand for a combination. Standard errors are those of all moving together.

    Raises
    ------
    InputError, CheckError
        As `update_configurations`.
    """
    problem = Problem.of(configurations)

    def updated(stages: Sequence[Stage]) -> Updated:
        gone_on, progress = steps()
        return update_configurations(configurations, stages, progress=progress, gone_on=gone_on)

    done = every = updated(stages)
    named = sorted({k for s in stages for k in s.parameters})
    alone = told_alone(every.factors, every.standard_error)
    solves, left, told = done.eigensolutions, set[int](), list[str]()
    while done.undetermined:
        told += done.doubts
        left |= {*done.undetermined} if alone.any() else {*named}
        moving = _without(stages, left)
        if not moving:
            done = _as_it_was(done, tuple(problem.deck_point))
            break
        done = updated(moving)
        solves += done.eigensolutions
    if not left:
        return done
    warnings = (*dict.fromkeys(told), _stay(problem, left), *done.warnings)
    if _led_astray(done, every, alone):
        done, left, warnings = every, set(), every.warnings
    combined = tuple(k for k in named if k not in left and not alone[k])
    done = replace(
        done,
        eigensolutions=solves,
        undetermined=tuple(sorted(left)),
        warnings=warnings,
        combined=combined,
    )
    return _known_of(done, every, alone)


def put_back(configurations: Sequence[Configuration], stage: Stage, done: Updated) -> Updated:
    """Return an update with what is known in combination alone as in the deck, solved again."""
    if not done.combined:
        return done
    problem, factors = Problem.of(configurations), np.array(done.factors)
    factors[[*done.combined]] = problem.deck_point[[*done.combined]]
    at_bound = np.array(done.at_bound)
    at_bound[[*done.combined]] = False
    return replace(
        done,
        factors=frozen(factors),
        at_bound=frozen(at_bound),
        after=problem.at(problem.full, factors, stage.minimised).without_factors(),
        eigensolutions=done.eigensolutions + len(configurations),
        undetermined=tuple(sorted((*done.undetermined, *done.combined))),
        warnings=(*done.warnings, _stay(problem, done.combined)),
        combined=(),
    )


def made_up(
    configurations: Sequence[Configuration],
    stages: Sequence[Stage],
    put: Updated,
    steps: Callable[[], Steps] = lambda: ((), lambda _: None),
) -> Updated:
    """Return a deck that values put back made worse than it came with the others fitted anew.

    They then make up for what stays as in the deck: how far that leads them from their values with
    all moving counts in their standard errors. A deck that is no worse keeps those values.

    Parameters
    ----------
    configurations, stages, steps
        As for `update_determined`.
    put : Updated
        What `put_back` returned.

    Returns
    -------
    Updated
        `put` itself where nothing was fitted anew; a warning where it is worse all the same.
    """
    problem, minimised = Problem.of(configurations), stages[-1].minimised
    given = problem.valued(put.before, minimised)

    def worse(done: Updated) -> bool:
        return not problem.closer(problem.valued(done.after, minimised), given, minimised)

    moved = [k for k in range(len(put.factors)) if k not in put.undetermined]
    moving = _without(stages, put.undetermined)
    if not moving or not any(put.factors[k] != 1.0 for k in moved) or not worse(put):
        return put
    gone_on, progress = steps()
    again = update_configurations(configurations, moving, progress=progress, gone_on=gone_on)
    names = [problem.parameters[k].name for k in moved]
    values = zip(names, again.factors[moved], put.factors[moved], strict=True)
    told = (
        "with what stays as in the deck the updated deck was farther from the test than it came; "
        "what moves was fitted anew beside it: "
        + ", ".join(f"{name} {new:.4g} (with all moving {old:.4g})" for name, new, old in values)
    )
    still = ("the updated deck is farther from the test than it came",) * worse(again)
    return replace(
        again,
        standard_error=frozen(np.hypot(again.standard_error, again.factors - put.factors)),
        before=put.before,
        history=(*put.history, *again.history[1:]),
        eigensolutions=put.eigensolutions + again.eigensolutions,
        undetermined=put.undetermined,
        warnings=(*put.warnings, told, *still, *again.doubts),
    )


def _stay(problem: Problem, left: Collection[int]) -> str:
    names = " and ".join(problem.parameters[k].name for k in sorted(left))
    return f"{names} stay{'s' if len(left) == 1 else ''} as in the deck"


def _known_of(done: Updated, every: Updated, alone: Bools) -> Updated:
    """Return an update with the standard errors that its parameters have with all moving."""
    known = alone & np.isfinite(done.standard_error)
    both = known[:, None] & known
    covariance = every.covariance
    return replace(
        done,
        standard_error=frozen(np.where(known, every.standard_error, np.nan)),
        covariance=None if covariance is None else frozen(np.where(both, covariance, np.nan)),
    )


def _led_astray(done: Updated, every: Updated, alone: Bools) -> bool:
    """Whether what is known by itself is another value without those that were left.

    Where they moved to something worse than they were left at, that tells nothing.
    """
    if every.after.objective > done.after.objective:
        return False
    off = np.abs(done.factors - every.factors)
    return bool((off > np.nan_to_num(every.standard_error, nan=np.inf))[alone].any())


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
