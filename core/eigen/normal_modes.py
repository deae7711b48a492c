"""Normal modes: K x = lambda M x, lowest first, every solution checked."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Numbers, frozen
from ..data.modes import Modes
from ..data.parametric_model import Model
from ..errors import CheckError, InputError
from ..noun import Noun
from ..numerics.factorisation import Backend, Factorisation, best_backend, factorise
from ..numerics.products import product, sparse_product
from .dense_solver import dense_modes
from .eigen_numbers import EIGEN
from .mechanisms import Massless, hold, mechanism, refuse_linkage
from .pencil import Pencil, Spectrum
from .rigid_body_modes import RigidBody, posed
from .shift_invert_solver import Request, sparse_modes
from .soft_modes import refined
from .warm_modes import Kept, Near


@dataclass(frozen=True)
class Checks:
    """What an eigensolution was checked by.

    `residual` is the largest ||x - (lambda - sigma) A^-1 M x||_M over the elastic modes, with
    A = K - sigma M, or with another shift s |lambda - s| / (lambda - sigma) times that, which
    bounds the relative error of lambda - sigma; `orthonormality` the
    largest entry of X^T M X - 1; `missed` the eigenvalues that the inertia of K - s M (Sturm
    count) shows below s but the solution does not have; None where they were not counted.
    The others are of the matrices as they were given, whatever was done to solve them:
    `backward_error` is the largest ||K x - lambda M x|| beside ||D x||, with the forces scaled by
    D^-1/2 and the motions by D^1/2, D the diagonal of K + lambda M; `rayleigh` the largest
    |x^T K x / x^T M x / lambda - 1| of the modes whose strain energy is more than rounding.
    """

    residual: float
    orthonormality: float
    missed: int | None
    backward_error: float
    rayleigh: float

    def __post_init__(self) -> None:
        if not self.residual <= EIGEN.residual:
            raise CheckError(
                f"the eigensolution has a residual of {self.residual:.1e} "
                f"(limit {EIGEN.residual:g}): the matrices are too badly conditioned"
            )
        if not self.orthonormality <= EIGEN.orthonormal:
            raise CheckError(
                f"the modes are orthonormal to {self.orthonormality:.1e} only "
                f"(limit {EIGEN.orthonormal:g})"
            )
        if not max(self.backward_error / EIGEN.backward, self.rayleigh / EIGEN.rayleigh) <= 1.0:
            raise CheckError(
                f"the modes satisfy the matrices to {self.backward_error:.1e} only (limit "
                f"{EIGEN.backward:g}), Rayleigh's quotients to {self.rayleigh:.1e} (limit "
                f"{EIGEN.rayleigh:g}): masses or stiffnesses differ by too many decades"
            )
        if self.missed:
            raise CheckError(
                f"the inertia count shows {self.missed} mode(s) that the eigensolution missed"
            )


@dataclass(frozen=True, eq=False)
class Eigensolution(Noun):
    """The lowest modes of K x = lambda M x, checked.

    Parameters
    ----------
    eigenvalues : (n_mode,) float
        Ascending, (rad/s)^2 in a consistent system of units; those of rigid-body modes are the
        rounding that is left of zero.
    vectors : (n_free, n_mode) float
        Mass-normalised: X^T M X = 1. The largest entry of each is positive.
    rigid_body_modes : int
        The first so many modes are rigid-body modes, by rank.
    checks : Checks
    backend : str
        ``pardiso``, ``superlu`` or ``lapack``.
    seconds : float
        Wall time.
    sigma : float
        The shift, negative.
    warnings : tuple of str
        For instance fewer modes than asked for.
    factor : Factorisation or None
        Of K - sigma M, kept on request: sensitivities use it again.
    count_factor : Factorisation or None
        Of K - s M, s next to the modes, by which they were counted: on request, or where they
        were known nearly.
    kept : Kept or None
        On request, for solutions of the same model that are begun near another; the first of
        these makes `count_factor` its own.
    """

    eigenvalues: Floats
    vectors: Floats
    rigid_body_modes: int
    checks: Checks
    backend: str
    seconds: float
    sigma: float
    warnings: tuple[str, ...] = ()
    factor: Factorisation | None = field(default=None, repr=False)
    count_factor: Factorisation | None = field(default=None, repr=False)
    kept: Kept | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        for name in ("eigenvalues", "vectors"):
            array = getattr(self, name).view()
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @property
    def frequencies_hz(self) -> Floats:
        """Natural frequencies, (n_mode,) Hz; a negative rounding of zero gives zero."""
        return frozen(np.sqrt(np.maximum(self.eigenvalues, 0.0)) / (2.0 * np.pi))


def solve(
    model: Model | tuple[sp.spmatrix, sp.spmatrix],
    n_modes: int | None = None,
    fmax: float | None = None,
    p: Floats | None = None,
    *,
    backend: Backend | None = None,
    tolerance: float = EIGEN.tolerance,
    keep_factor: bool = False,
    keep_counter: bool = False,
    count: bool = True,
    least: int = 0,
    near: Near | None = None,
    seed: int = 0,
) -> Eigensolution:
    """Find the lowest normal modes of a free or supported structure.

    Parameters
    ----------
    model : Model, or (K, M)
        With matrices alone, each (n, n) sparse, every mode without strain energy counts as a
        rigid-body mode, since mechanisms cannot be told apart without a geometry.
    n_modes : int, optional
        How many, rigid-body modes included. Default 10, or all up to `fmax`.
    fmax : float, optional
        Highest frequency, Hz. Without `n_modes` at most 200 modes below it are given, with a
        warning that says how many there are (of a small model all).
    p : (n_parameter,) float, optional
        Parameter values; default the deck's.
    backend : {"pardiso", "superlu"}, optional
        Default: the best present.
    tolerance : float
        Of the residual of each Ritz pair beside its eigenvalue, both of (K - sigma M)^-1 M;
        the relative error of the eigenvalues is of the order of its square.
    keep_factor : bool
        Keep the factorisation of K - sigma M in the solution.
    keep_counter : bool
        Keep the factorisation that counted the modes, and what serves further solutions.
    count : bool
        Prove by an inertia count that no mode was missed (about a quarter of the time).
    least : int
        How many modes are given where there are fewer up to `fmax`.
    near : Near, optional
        What is known of the `n_modes` beforehand, from a reduced model for instance: half the
        time. The checks are the same, the inertia count with them; where they are not met, or no
        gap is in sight, the modes are searched for from nothing.
    seed : int
        Of the start vectors.

    Returns
    -------
    Eigensolution
        With fewer modes than asked for, and a warning, where the mass matrix has no more.

    Raises
    ------
    InputError
        Matrices that are not finite or symmetric, no mass or negative mass, a stiffness that is
        not positive semi-definite, or a mechanism; the message names where.
    CheckError
        A residual, the orthonormality or the inertia count is not met.

    Notes
    -----
    Block Lanczos on (K - sigma M)^-1 M (Ericsson and Ruhe 1980; Grimes, Lewis and Simon 1994);
    up to 600 degrees of freedom, or when a large part of the spectrum is wanted, LAPACK. The
    rigid-body modes of a `Model` come from its geometry and are kept out of the iteration.
    """
    began = time.perf_counter()
    if n_modes is not None and n_modes < 1:
        raise InputError(f"{n_modes} modes were asked for; ask for at least one")
    if fmax is not None and not fmax > 0.0:
        raise InputError(f"fmax is {fmax:g} Hz; give a frequency above 0")
    owner = model if isinstance(model, Model) else None
    place = near.kept.place if near and near.kept else None
    given, body = posed(model, p, place, keep_factor or keep_counter)
    pencil = given
    rigid = body.modes if body else np.zeros((pencil.n, 0))
    limit = None if fmax is None else (2.0 * np.pi * fmax) ** 2
    wanted = n_modes if n_modes is not None or fmax is not None else EIGEN.modes
    chosen = backend or best_backend()
    small = pencil.n <= EIGEN.dense or (
        (wanted or 0) > pencil.n // EIGEN.dense_many and pencil.n <= EIGEN.dense_many * EIGEN.dense
    )
    request = Request(
        wanted, limit, chosen, tolerance, count, keep_factor, keep_counter, seed, near, least
    )
    held: list[str] = []
    while True:
        try:
            of = (owner, pencil, rigid)
            with _to_working_accuracy():
                spectrum = dense_modes(*of) if small else sparse_modes(*of, request)
            break
        except Massless as found:
            if len(held) == EIGEN.held:
                raise
            pencil, rigid, note = hold(owner, pencil, found.motions, rigid)
            held.append(note)
    spectrum, soft, doubt = refined(pencil, body, spectrum)
    zero = _without_strain(spectrum, soft)
    notes = _refuse_mechanism(owner, pencil, body, spectrum.vectors[:, :zero])
    notes += held
    if owner:
        refuse_linkage(owner, pencil, rigid)
    values, vectors = _joined(pencil, rigid, spectrum)
    n_zero = rigid.shape[1] + zero
    keep = len(values) if wanted is None else min(wanted, len(values))
    if limit is not None:
        keep = min(keep, max(int(np.count_nonzero(values <= limit)), least))
    notes += _notes(pencil, body, n_zero, wanted if limit is None else None, len(values))
    keep -= max(keep - EIGEN.most, 0) if spectrum.left_out else 0
    if spectrum.left_out:
        notes.append(
            f"{EIGEN.most + spectrum.left_out} modes lie below {fmax:g} Hz: the lowest {keep} are "
            "given; check the units and that frequency, or say how many are wanted"
        )
    X = vectors[:, :keep]
    notes += _in_doubt(doubt[zero : max(keep - rigid.shape[1], zero)], n_zero)
    residual = float(spectrum.residual[: max(keep - rigid.shape[1], 0)].max(initial=0.0))
    checks = _checked(given, values[:keep], X, residual, spectrum.missed)
    factor = None
    if keep_factor:
        factor = spectrum.factor or factorise(pencil.shifted(spectrum.sigma), True, chosen)
    return Eigensolution(
        values[:keep],
        X,
        min(n_zero, keep),
        checks,
        "lapack" if small else chosen,
        time.perf_counter() - began,
        spectrum.sigma,
        tuple(notes),
        factor,
        spectrum.count_factor,
        Kept(body.place, spectrum.count_factor) if body and spectrum.count_factor else None,
    )


def modes_of(model: Model, solution: Eigensolution) -> Modes:
    """Expand an eigensolution to all dofs of the model, basic axes, modal mass 1."""
    shapes, mass = model.expansion @ solution.vectors, np.ones(len(solution.eigenvalues))
    hz = solution.frequencies_hz
    return Modes(hz, np.asarray(shapes), model.dofs, generalized_mass=mass, source="analysis")


@contextmanager
def _to_working_accuracy() -> Iterator[None]:
    """Tell what LAPACK gives up on: `CheckError`."""
    try:
        yield
    except np.linalg.LinAlgError as lost:
        raise CheckError(
            "the modes cannot be found to working accuracy: masses or stiffnesses differ by too "
            f"many decades ({lost})"
        ) from None


def _checked(
    given: Pencil, values: Floats, X: Floats, residual: float, missed: int | None
) -> Checks:
    """Check modes by the matrices as they were given."""
    off = backward = rayleigh = 0.0
    k = np.abs(given.k_diagonal)
    for first in range(0, len(values), EIGEN.width):
        few = slice(first, first + EIGEN.width)
        lambda_, x = values[few], X[:, few]
        KX, MX = sparse_product(given.K, x), sparse_product(given.given_mass, x)
        gram = product(X.T, MX) - np.eye(len(values))[:, few]
        off = max(off, float(np.abs(gram).max()))
        energy = np.einsum("ij,ij->j", x, KX)
        firm = lambda_ > EIGEN.soft * np.einsum("ij,ij,i->j", x, x, k)
        mass = 1.0 + gram[few].diagonal()
        quotient = energy[firm] / mass[firm] / lambda_[firm]
        rayleigh = max(rayleigh, float(np.abs(quotient - 1.0).max(initial=0.0)))
        backward = max(backward, given.backward_error(lambda_, x, KX - MX * lambda_))
    return Checks(residual, off, missed, backward, rayleigh)


def _without_strain(spectrum: Spectrum, soft: Numbers) -> int:
    """Count the leading modes, rigid-body ones apart, whose strain energy is rounding."""
    values = spectrum.values[: EIGEN.looked_at]
    soft = soft[: EIGEN.looked_at]
    elastic = values[~soft]
    first = int(np.argmin(soft)) if len(elastic) else len(values)
    if first and len(elastic) and abs(values[first - 1]) > EIGEN.without_strain * elastic[0]:
        return 0
    return first


def _joined(pencil: Pencil, rigid: Floats, spectrum: Spectrum) -> tuple[Floats, Floats]:
    values = np.concatenate([np.einsum("ij,ij->j", rigid, pencil.K @ rigid), spectrum.values])
    vectors = np.hstack([rigid, spectrum.vectors]) if rigid.shape[1] else spectrum.vectors
    if len(values):
        peak = np.abs(vectors).argmax(axis=0)
        sign = np.sign(vectors[peak, np.arange(len(values))])
        vectors = vectors * np.where(sign == 0.0, 1.0, sign)
    return values, vectors


def _refuse_mechanism(
    model: Model | None, pencil: Pencil, body: RigidBody | None, Z: Floats
) -> list[str]:
    """Raise for motions Z, (n, k), without strain energy that no rigid body makes.

    Scalar points have no place, and move as rigid bodies in any ratio (a shaft with gears).
    """
    if model is None or body is None or not Z.shape[1]:
        return []
    nearly, mechanisms, replaced = body.split(pencil, Z)
    moved = np.abs(model.expansion @ mechanisms)
    placed = moved[model.geometry.index_of(model.dofs.node) >= 0].max(initial=0.0)
    if mechanisms.shape[1] and placed > EIGEN.moved * moved.max():
        raise mechanism(model, pencil, mechanisms, body.modes)
    if not nearly.shape[1]:
        return []
    rows = np.argsort(-np.abs(pencil.K @ replaced).max(axis=1))[: EIGEN.few_named]
    return [
        f"{nearly.shape[1]} of the rigid-body modes are not quite those of a rigid body: springs "
        "or constraints join grids that are not in one place, near "
        + ", ".join(pencil.name(int(r)) for r in rows)
    ]


def _in_doubt(doubt: Floats, below: int) -> list[str]:
    """Say which of the modes after the first `below` are uncertain by the rounding of K."""
    rows = np.flatnonzero(doubt > EIGEN.doubt)
    if not len(rows):
        return []
    worst = doubt[rows].max() / 2  # of the frequency
    return [
        f"the stiffness that mode{'s' if len(rows) > 1 else ''} "
        f"{', '.join(str(below + 1 + k) for k in rows[: EIGEN.named])} "
        f"feel{'s' if len(rows) == 1 else ''} is next to the rounding of the stiffest springs "
        f"beside: uncertain by {f'about {100 * worst:.1g} %' if worst < 1 else 'any amount'}; "
        "use softer ones for what is to be rigid, or rigid elements"
    ]


def _notes(
    pencil: Pencil, body: RigidBody | None, n_zero: int, wanted: int | None, found: int
) -> list[str]:
    notes = []
    pieces = len(body.pieces) if body else 0
    if body and pieces and body.held:
        rows = body.pieces[0]
        grids = dict.fromkeys(pencil.name(int(r)).split(":")[0] for r in rows)
        shown = ", ".join(list(grids)[: EIGEN.named]) + (
            ", ..." if len(grids) > EIGEN.named else ""
        )
        part = "a part moves" if pieces == 1 else f"{pieces} parts move"
        notes.append(
            f"{part} freely that {'is' if pieces == 1 else 'are'} not connected to the rest, "
            f"which is held: {'' if pieces == 1 else 'one of them '}at {shown}; check that "
            "nothing is disconnected by mistake"
        )
    elif pieces > 1:
        notes.append(
            f"the model is {pieces} separate free pieces with {n_zero} rigid-body modes in all: "
            "check that nothing is disconnected by mistake"
        )
    if wanted is not None and found < wanted:
        notes.append(
            f"{wanted} modes were asked for but the mass matrix allows only {found}: all are given"
        )
    return notes
