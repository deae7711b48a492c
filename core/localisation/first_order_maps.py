"""Which places of a structure could explain a misfit: first-order maps of mass and stiffness."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree

from ..arrays import Floats, frozen
from ..correlation.mode_pairing import Correlation
from ..errors import InputError
from .localisation_numbers import MAPS
from .shape_misfit import PairedShapes
from .shape_noise import Noise


@dataclass(frozen=True, eq=False)
class Evidence:
    """What one more mass or stiffness at each place would explain.

    Parameters
    ----------
    explained : (n_place,) float
        How much of the misfit's sum of squares the best size at the place takes away: at chance
        about 1.
    size : (n_place,) float
        That size, first order: mass, or stiffness as a multiple of the place's own.
    total : float
        Sum of squares of the misfit.
    """

    explained: Floats
    size: Floats
    total: float


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Misfit of the pairs and how small changes of the matrices move it.

    Made by `linearise`; the rows are, pair by pair, the eigenvalue and then the sensors.

    Parameters
    ----------
    residual : (n_pair, 1 + n_sensor) float
        (test - analysis) / sigma.
    modes : (n_mode, n_pair) float
        Participation of the original modes in each pair's analysis shape (rotation).
    eigenvalue : (n_pair,) float
        Of the analysis side of each pair.
    by_eigenvalue : (n_pair,) float
        Change of a pair's first row by its modal change.
    by_mode : (n_pair, n_mode, n_sensor) float
        Change of the other rows by the modal change with each mode.
    """

    residual: Floats
    modes: Floats
    eigenvalue: Floats
    by_eigenvalue: Floats
    by_mode: Floats


def linearise(
    found: Correlation,
    pairs: PairedShapes,
    noise: Noise,
    analysis_hz: Floats,
    analysis_shapes: Floats,
    frequency_sigma: float = MAPS.frequency,
) -> Linearisation:
    """Prepare first-order maps from the misfit of paired modes.

    First-order perturbation of mass-normalised modes, d lambda_j = phi_j' dA_j phi_j and
    d phi_j = -sum_k phi_k (phi_k' dA_j phi_j) / (lambda_k - lambda_j) with
    dA_j = dK - lambda_j dM (Fox and Kapoor, 1968). What a test shape shows of itself and of modes
    near in frequency is taken out on both sides: scale and mixing of close modes say nothing
    about the place.

    Parameters
    ----------
    found, pairs, noise
        See `misfit.misfit`; the analysis side must be the one that was rotated, or none.
    analysis_hz : (n_mode,) float
    analysis_shapes : (n_sensor, n_mode) float
        Mass-normalised, at the sensors.
    frequency_sigma : float
        Standard deviation of a relative frequency difference.

    Raises
    ------
    InputError
        No pairs, or the test side was rotated.
    """
    if not found.pairs:
        raise InputError("no pair of modes to compare; lower the MAC limit")
    if found.criteria.rotate == "test":
        raise InputError("maps of mass and stiffness need the analysis side rotated, not the test")
    columns = [p.analysis for p in found.pairs]
    T = found.transformation if found.criteria.rotate == "analysis" else np.eye(len(analysis_hz))
    modes = T[:, columns]
    lam = (2 * np.pi * np.asarray(analysis_hz)) ** 2
    eigenvalue = (modes**2).T @ lam
    test_eigenvalue = (2 * np.pi * np.array([p.test_hz for p in found.pairs])) ** 2
    sigma = np.sqrt((pairs.mixing**2).T @ noise.sigma**2)
    sound = ~noise.outlier
    C = np.where(sound[:, None], analysis_shapes, 0.0)
    n_pair, n_mode, n_sensor = len(columns), len(lam), len(C)
    residual = np.zeros((n_pair, 1 + n_sensor))
    residual[:, 0] = (test_eigenvalue / eigenvalue - 1.0) / (2 * frequency_sigma)
    by_mode = np.zeros((n_pair, n_mode, n_sensor))
    for j in range(n_pair):
        shape = analysis_shapes @ modes[:, j]
        scale = float(shape @ pairs.analysis[:, j] / max(shape @ shape, 1e-300)) / sigma[j]
        near = np.abs(lam - eigenvalue[j]) <= 2 * MAPS.near * eigenvalue[j]
        Q = np.linalg.qr(np.column_stack([C @ modes[:, j], C[:, near]]))[0]
        left = np.where(sound, pairs.test[:, j] - pairs.analysis[:, j], 0.0) / sigma[j]
        residual[j, 1:] = left - Q @ (Q.T @ left)
        gap = np.where(near, np.inf, lam - eigenvalue[j])
        moved = -scale * C / gap
        by_mode[j] = (moved - Q @ (Q.T @ moved)).T
    by_eigenvalue = 1.0 / (eigenvalue * 2 * frequency_sigma)
    return Linearisation(
        frozen(residual), frozen(modes), frozen(eigenvalue), frozen(by_eigenvalue), frozen(by_mode)
    )


def stiffness_evidence(
    lin: Linearisation, strain: Floats, patches: sp.csr_matrix | None = None
) -> Evidence:
    """Map what more or less stiffness at each place would explain; see `mass_evidence`.

    `strain` (n_place, r, n_mode) is any S with phi_k' K_place phi_j = sum over r of S_k S_j: the
    modes at a place times a square root of its stiffness (`root_of`), or a displacement for a
    spring of unit stiffness. `size` is then the relative change, negative for a loss; first
    order, so below -1 for a loss that is nearly total.
    """
    return mass_evidence(lin, strain, patches, mass=False)


def patches_of(centres: Floats, xyz: Floats, radius: float) -> sp.csr_matrix:
    """Make patches of all places (n_place, 3) within a radius of each centre (n_patch, 3)."""
    near = cKDTree(xyz).query_ball_point(centres, radius)
    count = np.fromiter(map(len, near), np.int64, len(centres))
    columns = np.concatenate([*near, []]).astype(np.int64)
    rows = np.repeat(np.arange(len(centres)), count)
    return sp.csr_matrix((np.ones(len(rows)), (rows, columns)), (len(centres), len(xyz)))


def root_of(matrices: Floats, modes: Floats) -> Floats:
    """Strains (n_place, m, n_mode) of elements: square roots of their stiffness times their modes.

    `matrices` (n_place, m, m) are symmetric and positive semi-definite, `modes`
    (n_place, m, n_mode) the rows of the shapes that belong to each element.
    """
    value, vector = np.linalg.eigh((matrices + np.swapaxes(matrices, 1, 2)) / 2)
    root = np.sqrt(np.maximum(value, 0.0))[:, :, None] * np.swapaxes(vector, 1, 2)
    return np.asarray(root @ modes)


def mass_evidence(
    lin: Linearisation, motion: Floats, patches: sp.csr_matrix | None = None, mass: bool = True
) -> Evidence:
    """Map what a point mass at each place would explain; only added mass is allowed.

    Parameters
    ----------
    lin : Linearisation
    motion : (n_place, r, n_mode) float
        Mass-normalised shapes of the directions in which each place carries mass: the three
        translations of each grid.
    patches : (n_patch, n_place) csr, optional
        Weights of the places in patches (`patches_of`); the map is then by patch and `size` the
        mass at unit weight.
    mass : bool
        Otherwise what is added is stiffness, of either sign.
    """
    patches = sp.identity(len(motion), format="csr") if patches is None else patches.tocsr()
    own = motion @ lin.modes
    factor = -lin.eigenvalue if mass else np.ones(len(lin.eigenvalue))
    # of eigenvalues, without a common scale of all: any modulus absorbs it
    common = lin.eigenvalue * lin.by_eigenvalue
    common = common / np.linalg.norm(common)
    slope = patches @ (np.einsum("prj,prj->pj", own, own) * factor * lin.by_eigenvalue)
    slope = slope - np.outer(slope @ common, common)
    top, power = slope @ lin.residual[:, 0], np.einsum("pj,pj->p", slope, slope)
    left = float(np.sum(lin.residual**2) - (lin.residual[:, 0] @ common) ** 2)
    step = max(1, MAPS.at_once // (len(motion) * motion.shape[2] or 1))
    for start in range(0, len(lin.residual), step):
        few = slice(start, start + step)
        change = np.matmul(np.swapaxes(own * factor, 1, 2)[:, few], motion).swapaxes(0, 1)
        for j, part in enumerate(change, start):
            slope = (patches @ part) @ lin.by_mode[j]
            top += slope @ lin.residual[j, 1:]
            power += np.einsum("pi,pi->p", slope, slope)
    size = np.divide(top, power, out=np.zeros_like(top), where=power > 0)
    size = np.maximum(size, 0.0) if mass else size
    return Evidence(frozen(size * top), frozen(size), left)
