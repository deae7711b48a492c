"""The lowest modes of a large model: shift, block Lanczos iteration, inertia count."""

from dataclasses import dataclass, replace

import numpy as np
import scipy.linalg as sl

from ..arrays import Floats
from ..data.parametric_model import Model
from ..errors import CheckError, InputError
from ..numerics.block_lanczos import NEGATIVE_MASS, BlockLanczos
from ..numerics.factorisation import Backend, Factorisation, NotDefinite, factorise
from ..numerics.products import product
from .eigen_numbers import EIGEN
from .mechanisms import diagnose, refuse_unresisted
from .pencil import Pencil, Spectrum, refuse_indefinite_mass, widest_gap
from .warm_modes import Near, warm_modes


@dataclass(frozen=True)
class Request:
    """What is asked of the iteration; see `normal_modes.solve`.

    `wanted` modes, rigid-body modes included, or where that is None all up to the eigenvalue
    `limit`, `least` of them at least; `tolerance` is that of the Ritz residuals beside the Ritz
    values. Modes of a number are begun with what is known `near` them.
    """

    wanted: int | None
    limit: float | None
    backend: Backend
    tolerance: float
    count: bool
    keep_factor: bool
    keep_counter: bool
    seed: int
    near: Near | None = None
    least: int = 0


def sparse_modes(model: Model | None, pencil: Pencil, rigid: Floats, request: Request) -> Spectrum:
    """Find the lowest modes that are M-orthogonal to `rigid`, (n, n_rigid).

    Raises
    ------
    InputError
        K - sigma M is singular or indefinite; the message names where.
    CheckError
        Modes stay missing by the inertia count (Sylvester's law: the negative pivots of K - s M
        are the eigenvalues below s).
    """
    n_rigid = rigid.shape[1]
    below = None
    left_out = 0
    if request.limit is not None:
        bounds = request.limit, request.limit * EIGEN.beside_limit
        below, _ = _inertia(pencil, bounds, request.backend)
        if below < request.least:
            more = replace(request, wanted=request.least, limit=None)
            return sparse_modes(model, pencil, rigid, more)
        if below <= n_rigid:
            none = np.zeros(0)
            return Spectrum(none, rigid[:, :0], none, -request.limit, complete=False, missed=0)
        left_out = max(below - EIGEN.most, 0) if request.wanted is None else 0
        if left_out:
            request = replace(request, wanted=EIGEN.most, limit=None)
    asked = min(x for x in (request.wanted, below) if x is not None)
    elastic = max(asked - n_rigid, 1)
    if request.near is not None and request.limit is None:
        warm = warm_modes(pencil, rigid, request.near, elastic, request.backend, request.seed)
        if warm is not None:
            return warm
    sigma, factor, lanczos = _started(model, pencil, rigid, elastic, request)
    found = _converged(pencil, rigid, sigma, factor, lanczos, elastic, request)
    if not request.keep_factor:  # two factors at a time only where the caller keeps one
        found = replace(found, factor=None)
    del factor, lanczos
    limit = None if request.keep_counter else request.limit
    if limit is not None and below == n_rigid + np.count_nonzero(found.values < limit):
        return replace(found, missed=0)  # as many as were counted
    return replace(_counted(pencil, rigid, found, elastic, request), left_out=left_out)


def _counted(
    pencil: Pencil, rigid: Floats, found: Spectrum, elastic: int, request: Request
) -> Spectrum:
    """Count the modes below a gap above the first `elastic` and search for those missed."""
    n_rigid, have, missed = rigid.shape[1], 0, 0
    for attempt in range(1, EIGEN.attempts + 1):
        if not request.count:
            return found
        gap = _gap(pencil, found, elastic)
        if gap is not None:
            have = int(np.count_nonzero(_estimates(found) < gap[0]))
            count, factor = _inertia(pencil, gap, request.backend)
            missed = count - n_rigid - have
            if missed == 0:
                kept = factor if request.keep_counter else None
                return replace(found, missed=0, count_factor=kept)
            del factor
            if missed < 0:
                break
        if attempt < EIGEN.attempts:
            further = max(elastic, have + missed) - len(found.values)
            found = _with_missed(pencil, rigid, found, max(further, 1), request, attempt)
            if not request.keep_factor:
                found = replace(found, factor=None)
    raise CheckError(
        f"{n_rigid + have} modes were found where the inertia count shows {n_rigid + have + missed}"
    )


def _started(
    model: Model | None, pencil: Pencil, rigid: Floats, elastic: int, request: Request
) -> tuple[float, Factorisation, BlockLanczos]:
    """Choose a shift that suits the spectrum, with its factor and the first Krylov vectors."""
    refuse_indefinite_mass(pencil)
    typical = float(np.median(pencil.stiffness_over_mass))
    usual, limit = (2.0 * np.pi * EIGEN.first_shift) ** 2, request.limit
    first = usual if limit is None else EIGEN.below_limit * limit
    least = pencil.least_shift
    sigma = -float(np.clip(first, least, EIGEN.shift_most * typical))
    rng = np.random.default_rng(request.seed)
    width = EIGEN.width if request.backend == "pardiso" else EIGEN.narrow
    factor = None
    for attempt in range(EIGEN.shifts):
        factor = _definite(model, pencil, sigma, request.backend, factor)
        if factor is None:  # by rounding: no mode is that near to zero for certain
            least = -EIGEN.larger_shift * sigma
            sigma = -least
            continue
        if attempt == 0:
            refuse_unresisted(model, pencil, sigma, factor)
        start = rng.standard_normal((pencil.n, min(width, pencil.n)))
        lanczos = BlockLanczos(factor.solve, pencil.M, start, rigid, _room(elastic))
        lanczos.step()
        for _ in range(2):
            if lanczos.exhausted:
                break
            lanczos.advance()
            lanczos.step()
        theta = lanczos.ritz()[0]
        if theta[-1] < -EIGEN.negative * theta[0] and factor.negative:
            diagnose(model, pencil, sigma, request.backend)
            least = -EIGEN.larger_shift * sigma
            sigma, factor = -least, None
            continue
        better = _better_shift(sigma, theta, elastic)
        if better is None or -better < least or attempt == EIGEN.shifts - 1:
            return sigma, factor, lanczos
        sigma = better
    raise CheckError("the stiffness is too badly conditioned to factorise")


def _definite(
    model: Model | None,
    pencil: Pencil,
    sigma: float,
    backend: Backend,
    old: Factorisation | None = None,
) -> Factorisation | None:
    """Factor of K - sigma M, on the pattern of an old one; None where rounding leaves none.

    Raises
    ------
    InputError
        It is not rounding that leaves none; the message names where.
    """
    try:
        if old is None:
            return factorise(pencil.shifted(sigma), True, backend, pencil.groups)
        old.refactorise(pencil.shifted(sigma))
    except NotDefinite:
        diagnose(model, pencil, sigma, backend)
        return None
    return old


def _room(elastic: int) -> int:
    modes, blocks = EIGEN.room
    return modes * (elastic + EIGEN.guard) + blocks * EIGEN.width


def _better_shift(sigma: float, theta: Floats, elastic: int) -> float | None:
    """Another shift where this one is far from the first modes, by their first estimates."""
    values = sigma + 1.0 / theta[theta > EIGEN.zero * theta[0]]
    pivot = values[min(elastic, EIGEN.width, len(values)) - 1]
    lowest = float(values[values > EIGEN.pivot * pivot][0])
    if -sigma > EIGEN.far_shift * lowest and -sigma > pivot:
        return -EIGEN.nearer[0] * lowest
    if lowest > -EIGEN.near_shift * sigma:
        return -EIGEN.nearer[1] * lowest
    return None


def _converged(
    pencil: Pencil,
    rigid: Floats,
    sigma: float,
    factor: Factorisation,
    lanczos: BlockLanczos,
    elastic: int,
    request: Request,
) -> Spectrum:
    """Iterate until `elastic` modes have converged and a gap above them is in sight."""
    check_at = elastic
    while True:
        if lanczos.exhausted or lanczos.size >= check_at or lanczos.full:
            theta, residual = lanczos.ritz()
            if theta[-1] < -EIGEN.negative * theta[0]:
                if factor.negative:
                    diagnose(None, pencil, sigma, factor.backend)
                raise InputError(NEGATIVE_MASS)
            loose = int(np.argmin(np.append(residual <= EIGEN.guard_tolerance * theta, False)))
            tight = bool((residual <= request.tolerance * theta)[:elastic].all())
            if lanczos.exhausted:
                firm = loose = int(np.count_nonzero(theta > EIGEN.zero * theta[0]))
                break
            values = sigma + 1.0 / theta[:loose]
            if tight and loose > elastic and widest_gap(values, elastic) is not None:
                firm = max(elastic, int(np.argmax(residual > EIGEN.firm * theta)))
                break
            if lanczos.full:
                lanczos.restart(max(elastic, loose) + EIGEN.guard + EIGEN.width)
            check_at = lanczos.size + max(EIGEN.width, lanczos.size // EIGEN.step)
        lanczos.advance()
        lanczos.step()
    found = _polished(pencil, rigid, sigma, factor, lanczos.taken(firm), theta[:firm])
    ahead = sigma + 1.0 / theta[firm : max(loose, firm)]
    return replace(found, complete=lanczos.exhausted, ahead=ahead)


def _polished(
    pencil: Pencil, rigid: Floats, sigma: float, factor: Factorisation, X: Floats, theta: Floats
) -> Spectrum:
    """Residuals of Ritz vectors by one further inverse iteration, which also betters them.

    With Y = A^-1 M X the Ritz problem of (A, M) on Y needs no product with K.
    """
    count = len(theta)
    Y, residual = np.empty_like(X, order="F"), np.empty(count)
    stiff, mass = np.empty((count, count)), np.empty((count, count))
    blocks = [slice(first, first + EIGEN.width) for first in range(0, count, EIGEN.width)]
    for few in blocks:
        y = factor.solve(pencil.M @ X[:, few]) / theta[few]
        Y[:, few] = y - rigid @ (rigid.T @ (pencil.M @ y))
        error = X[:, few] - Y[:, few]
        size = np.einsum("ij,ij->j", error, pencil.M @ error)
        residual[few] = np.sqrt(np.maximum(size, 0.0))
    for few in blocks:
        stiff[:, few] = product(Y.T, pencil.M @ X[:, few]) / theta[few]
        mass[:, few] = product(Y.T, pencil.M @ Y[:, few])
    alpha, C = sl.eigh((stiff + stiff.T) / 2.0, (mass + mass.T) / 2.0)
    return Spectrum(sigma + alpha, product(Y, C, out=X), residual, sigma, False, None, factor)


def _estimates(found: Spectrum) -> Floats:
    return np.concatenate([found.values, found.ahead])


def _gap(pencil: Pencil, found: Spectrum, elastic: int) -> tuple[float, float] | None:
    """Bounds of an interval without modes above the first `elastic`, if there is one in sight."""
    values = _estimates(found)
    if found.complete:
        top = abs(values[-1]) - found.sigma
        return EIGEN.above[0] * top, EIGEN.above[1] * top
    size = np.abs(pencil.k_diagonal) @ found.vectors**2
    k = widest_gap(values, elastic, EIGEN.signs * float(size.max()))
    if k is None:
        return None
    wide = values[k] - values[k - 1]
    low, high = (float(values[k - 1] + share * wide) for share in EIGEN.within)
    return low, high


def _inertia(
    pencil: Pencil, between: tuple[float, float], backend: Backend
) -> tuple[int, Factorisation]:
    """Return the number of eigenvalues below a point of an interval without modes, and its factor.

    The factor is of K - s M, s being that point.
    """
    low, high = between
    try:
        factor = factorise(pencil.shifted(low), False, backend, pencil.groups)
        return factor.negative, factor
    except CheckError:
        at = pencil.shifted((1.0 - EIGEN.again) * low + EIGEN.again * high)
        factor = factorise(at, False, backend, pencil.groups)
        return factor.negative, factor


def _with_missed(
    pencil: Pencil, rigid: Floats, found: Spectrum, missed: int, request: Request, attempt: int
) -> Spectrum:
    """Search again, M-orthogonally to all that was found: another start, as wide as needed."""
    factor = found.factor or factorise(
        pencil.shifted(found.sigma), True, request.backend, pencil.groups
    )
    locked = np.hstack([rigid, found.vectors])
    rng = np.random.default_rng(request.seed + 1000 * attempt)
    width = min(missed + EIGEN.guard, EIGEN.widest) if missed > EIGEN.guard else EIGEN.width
    start = rng.standard_normal((pencil.n, width))
    lanczos = BlockLanczos(
        factor.solve, pencil.M, start, locked, _room(missed) + EIGEN.room[1] * width
    )
    lanczos.step()
    further = _converged(pencil, locked, found.sigma, factor, lanczos, missed, request)
    X = np.hstack([found.vectors, further.vectors])
    values = np.concatenate([found.values, further.values])
    order = np.argsort(values)
    theta = 1.0 / (values[order] - found.sigma)
    joined = _polished(pencil, rigid, found.sigma, factor, X[:, order], theta)
    return replace(joined, complete=further.complete, ahead=further.ahead)
