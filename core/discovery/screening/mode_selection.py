"""Which modes take part: those of the model as it is, and of the test those that are elastic."""

import numpy as np

from ...arrays import Bools, Floats, Ints
from ...correlation.comparison import Comparison, Placed
from ...correlation.correlation_numbers import CORRELATION
from ...correlation.mac import realised
from ...data.parametric_model import Model
from ...eigen import normal_modes
from ...eigen.normal_modes import Eigensolution
from ...errors import InputError
from .screening_numbers import SCREENING


def elastic(placed: Placed, solution: Eigensolution, motion: Floats) -> Bools:
    """Return which test modes are elastic, (n_test,).

    A mode at 0 Hz is not, nor one well below the first elastic mode of a free model whose shape
    is a motion of the whole, nor one far below it. `motion` (n_dof, n_mode) are the modes of the
    deck on all analysis dofs.
    """
    hz, n = placed.test.frequencies_hz, solution.rigid_body_modes
    moving = hz > 0.0
    if not n or len(solution.eigenvalues) <= n:
        return np.asarray(moving)
    first = np.sqrt(solution.eigenvalues[n]) / (2.0 * np.pi)
    Q, _ = np.linalg.qr(placed.observation.matrix @ motion[:, :n])
    shapes = realised(placed.test.shapes)
    whole = np.sum(shapes**2, axis=0)
    share = np.sum((Q.T @ shapes) ** 2, axis=0) / np.maximum(whole, np.finfo(float).tiny)
    rigid = (hz < SCREENING.swings * first) & (share > SCREENING.as_a_whole)
    return np.asarray(moving & ~rigid & (hz >= SCREENING.swings_far * first))


def vibrating(placed: Placed, solution: Eigensolution, model: Model) -> Bools:
    """Return which test modes are elastic, (n_test,).

    Raises
    ------
    InputError
        None is.
    """
    found = elastic(placed, solution, model.expansion @ solution.vectors)
    if not found.any():
        raise InputError(
            "no mode of the test is elastic: all are at 0 Hz or motions of the structure as a whole"
        )
    return found


def unfounded(before: Comparison, among: Bools) -> Bools:
    """Return which test modes among some may be none, (n_test,).

    Their own identification doubts them, and no mode of the deck pairs with them. Where that is
    all there is, none.
    """
    alone = among & before.test.doubted
    alone[[p.test for p in before.correlation.pairs]] = False
    return np.asarray(alone if np.any(among & ~alone) else np.zeros_like(alone))


def said_of_unfounded(before: Comparison, unused: Bools) -> tuple[str, ...]:
    """Say which modes of the test are left out as `unfounded`; nothing without any."""
    hz = before.test.frequencies_hz
    named = ", ".join(f"{k + 1} ({hz[k]:.2f} Hz)" for k in np.flatnonzero(unused).tolist())
    if not named:
        return ()
    return (
        f"test mode(s) {named} are left out: their identification doubts that they are modes "
        "(no clear resonance of all responses, or a complex shape), and none of the deck's pairs "
        "with them",
    )


def said_of_others(numbers: Ints) -> tuple[str, ...]:
    """Say which modes of the test, by number, are motions of the whole; nothing without any."""
    if not len(numbers):
        return ()
    which = ", ".join(map(str, numbers))
    one = len(numbers) == 1
    subject = f"test mode {which} is a motion" if one else f"test modes {which} are motions"
    return (
        f"{subject} of the structure as a whole (at 0 Hz, or on its suspension), and no evidence "
        "of what the model lacks",
    )


def reference_modes(model: Model, top_hz: float, tests: int = 1) -> Eigensolution:
    """Solve a model for a discovery, modes up to `top_hz` may pair; the factor is kept.

    Where it has them, as many elastic modes as the test has: a deck that is far too stiff has few
    up to there.
    """
    fmax = SCREENING.modes_above * top_hz / (1.0 + CORRELATION.frequency)
    many = min(SCREENING.modes_least, model.n_free // SCREENING.modes_times)
    solution = normal_modes.solve(model, fmax=fmax, least=many, keep_factor=True)
    least = tests + solution.rigid_body_modes
    if len(solution.eigenvalues) < least:
        solution = normal_modes.solve(model, n_modes=least, keep_factor=True)
    return solution


def matchable(tests: int, solution: Eigensolution) -> None:
    """Refuse more `tests` than modes that a model has.

    Raises
    ------
    InputError
        It has fewer.
    """
    modes = len(solution.eigenvalues) - solution.rigid_body_modes
    if tests > modes:
        raise InputError(
            f"{tests} elastic modes of the test take part and the model has only {modes}; exclude "
            "those that it cannot have, or refine the mesh"
        )
