"""Inner products that a fit of poles, participation and shapes is made of.

A function of output o and input i is modelled as Σ_k Re(ψ_ok l_ik) F1_k + Im(ψ_ok l_ik) F2_k in
the span of F1 = c + c̄, F2 = j(c − c̄) with c = (jω)²/(jω − λ), c̄ = (jω)²/(jω − λ*); F3, F4
are the same with the derivative by λ. Real and imaginary parts of the lines are stacked, and
the residual terms of modes above and below are projected out. Every product needed then follows
from F'F and F'Y; the number of lines is met only once per step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...arrays import Floats, Ints, Numbers
from .complete_blocks import complete_blocks

_IN_TURN = ["einsum_path", (0, 1), (0, 1)]  # of three factors, without looking for a better order

Solver = Callable[[Floats, Floats], Floats]


def stacked(lines: Numbers) -> Floats:
    """Real parts of all lines, then imaginary parts, along the last axis."""
    return np.concatenate([lines.real, lines.imag], axis=-1)


def unstacked(y: Floats) -> Numbers:
    """Complex lines of stacked ones, the inverse of `stacked`."""
    n_line = y.shape[-1] // 2
    lines = np.empty((*y.shape[:-1], n_line), complex)
    lines.real, lines.imag = y[..., :n_line], y[..., n_line:]
    return lines


@dataclass(frozen=True, eq=False)
class BandData:
    """Measured functions of a band with the residual terms projected out.

    Parameters
    ----------
    s : (n_line,) complex
        jω.
    residual_terms : (2 n_line, 8) float
        Orthonormal basis of the lower and upper residuals, complex coefficients.
    y : (n_output, n_input, 2 n_line) float
        Stacked functions, weighted, orthogonal to `residual_terms`.
    weight : (n_output, n_input) float
        1 where measured, 0 where not.
    error : float
        Part of the energy around a resonance that poles common to all functions leave over in
        this survey, beyond noise.
    """

    s: Numbers
    residual_terms: Floats
    y: Floats
    weight: Floats
    error: float = 0.0

    @cached_property
    def by_line(self) -> Floats:
        """Sum of squares of what is to be explained at each line, (n_line,)."""
        return np.asarray(np.einsum("oin,oin->n", self.y, self.y).reshape(2, -1).sum(axis=0))

    @cached_property
    def power(self) -> float:
        """Sum of squares of what is to be explained."""
        return float(self.by_line.sum())

    @cached_property
    def patterns(self) -> tuple[tuple[Floats, Ints], ...]:
        """Distinct rows of `weight` with the outputs that have them; most surveys have one."""
        rows, number = np.unique(self.weight, axis=0, return_inverse=True)
        number = number.ravel()
        return tuple((rows[p], np.flatnonzero(number == p)) for p in range(len(rows)))

    @cached_property
    def blocks(self) -> tuple[tuple[Ints, Ints], ...]:
        """Outputs and inputs of which every combination was measured, see `complete_blocks`."""
        return tuple(complete_blocks(self.weight > 0.0))


def band_data(
    frequencies_hz: Floats, values: Numbers, measured: Numbers, error: float = 0.0
) -> BandData:
    """Prepare the functions of a band for fitting.

    The modes below and above act in the band as (jω)² [LR₂/(jω)⁴ + LR/(jω)² + UR + UR₂ (jω)²]:
    their mass and stiffness lines and one further term of the expansion of each.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_output, n_input, n_line) complex
        Accelerations.
    measured : (n_output, n_input) bool
    error : float
        See `BandData`.
    """
    s = 2j * np.pi * frequencies_hz
    return _projected(s, stacked(values), measured.astype(float), error)


def excerpt(data: BandData, lines: slice, functions: Floats) -> BandData:
    """Restrict a band to some of its lines, with residual terms of their own.

    Parameters
    ----------
    data : BandData
    lines : slice
    functions : (n_output, n_input, 2 n_line) float
        Stacked functions over all lines of the band, of which the excerpt is taken.
    """
    n_line = len(data.s)
    halves = functions.reshape(*functions.shape[:2], 2, n_line)[..., lines]
    y = np.array(halves.reshape(*functions.shape[:2], -1))
    return _projected(data.s[lines], y, data.weight, data.error)


def _projected(s: Numbers, y: Floats, weight: Floats, error: float) -> BandData:
    powers = np.array([-4, -2, 0, 2])[:, None]
    lines = s**2 * (s / np.mean(np.abs(s))) ** powers
    terms = stacked(np.concatenate([lines, 1j * lines])).T
    Q, _ = np.linalg.qr(terms / np.linalg.norm(terms, axis=0))
    y -= onto(onto(y, Q), Q.T)
    y[weight == 0.0] = 0.0
    return BandData(s, np.ascontiguousarray(Q), y, weight, error)


def basis(data: BandData, poles: Numbers, derivative: bool = True) -> Floats:
    """Functions F1..F4 of each mode: (2 n_line, 2, n_mode, 2) by value or derivative, mode, part.

    Without the derivative the second axis has length 1.
    """
    near = 1.0 / (data.s - poles[:, None])
    far = 1.0 / (data.s - poles.conj()[:, None])
    n, count = len(data.s), 1 + derivative
    rows = np.empty((count, len(poles), 2, 2 * n))
    for k in range(count):
        c, conjugate = data.s**2 * near ** (k + 1), data.s**2 * far ** (k + 1)
        both, apart = c + conjugate, c - conjugate
        rows[k, :, 0, :n], rows[k, :, 0, n:] = both.real, both.imag
        rows[k, :, 1, :n], rows[k, :, 1, n:] = -apart.imag, apart.real
    flat = rows.reshape(-1, 2 * n)
    flat -= (flat @ data.residual_terms) @ data.residual_terms.T
    return np.asarray(flat.T.reshape(2 * n, count, len(poles), 2))


def onto(y: Floats, F: Floats) -> Floats:
    """Return inner products of functions and bases, all functions in one product of matrices.

    Parameters
    ----------
    y : (n_output, n_input, n) float
    F : (n, ...) float

    Returns
    -------
    (n_output, n_input, n_basis) float
    """
    flat = F.reshape(len(F), int(np.prod(F.shape[1:])))
    functions = y.reshape(y.shape[0] * y.shape[1], len(F))
    return np.asarray((functions @ flat).reshape(*y.shape[:2], flat.shape[1]))


def parts_of(z: Numbers) -> Floats:
    """Real and imaginary parts side by side: (..., m) complex to (..., 2 m) float."""
    pairs = np.stack([z.real, z.imag], axis=-1)
    return np.asarray(pairs.reshape(*z.shape[:-1], 2 * z.shape[-1]))


def paired(x: Floats) -> Numbers:
    """Join the last axis, of length 2, to one complex number: the inverse of `parts_of`."""
    return np.asarray(np.ascontiguousarray(x).view(complex)[..., 0])


def turned(z: Numbers) -> Floats:
    """Return the 2×2 matrices [[Re z, Im z], [−Im z, Re z]], (..., 2, 2).

    Their rows are what a unit real and a unit imaginary change of one factor do to the (F1, F2)
    coefficients, z being the other factor.
    """
    return np.stack(
        [np.stack([z.real, z.imag], axis=-1), np.stack([-z.imag, z.real], axis=-1)], axis=-2
    )


@dataclass(frozen=True, eq=False)
class Normal:
    """Normal matrices of shapes (ψ, per output) and of poles and participation (θ, common).

    Parameters
    ----------
    shape_shape : (n_output, 2 n_mode, 2 n_mode) float
    shape_common : (n_output, 2 n_mode, n_theta) float
    common_common : (n_theta, n_theta) float
        θ: Re λ, Im λ by mode, then Re l, Im l by mode and input; n_theta = 2 n_mode (1 + n_input).
    """

    shape_shape: Floats
    shape_common: Floats
    common_common: Floats


def shape_normals(G: Floats, participation: Numbers) -> Floats:
    """Return what each input adds to the normal matrix of the shapes, (n_input, 2m, 2m).

    Parameters
    ----------
    G : (., n_mode, 2, ., n_mode, 2) float
        F'F, values first.
    participation : (n_input, n_mode) complex
    """
    return _rows_turned(_columns_turned(G[0, :, :, 0], participation), participation)


def _columns_turned(X: Floats, z: Numbers) -> Floats:
    """Multiply X (2m, m, 2) by the transposed `turned` of each row of z: (n_input, 2m, 2m)."""
    m = z.shape[1]
    return parts_of(paired(X.reshape(2 * m, m, 2)) * z.conj()[:, None, :])


def _rows_turned(X: Floats, z: Numbers) -> Floats:
    """Multiply X (., 2m, 2m) by `turned` of each row of z from the left: (n_input, 2m, 2m)."""
    columns = X.transpose(0, 2, 1).reshape(len(X), X.shape[2], z.shape[1], 2)
    return np.asarray(parts_of(paired(columns) * z.conj()[:, None, :]).transpose(0, 2, 1))


def reduced_normal(
    G: Floats,
    participation: Numbers,
    shapes: Numbers,
    patterns: tuple[tuple[Floats, Ints], ...],
    solve: Solver,
) -> Floats:
    """Assemble the normal matrix of θ with the shapes eliminated, (n_theta, n_theta).

    Outputs measured at the same inputs share the normal matrix of their shapes, and what they
    add is linear in the second moments of the shapes: nothing here grows with their number.
    θ is ordered as in `Normal`.
    """
    n_input, m = participation.shape
    vv, vd, dd = G[0, :, :, 0], G[0, :, :, 1], G[1, :, :, 1]
    z, by_mode = participation, (n_input, m, 2, m, 2)
    pole = _rows_turned(_columns_turned(vd, z), z).reshape(by_mode)
    part = _rows_turned(vv.reshape(1, 2 * m, 2 * m), z).reshape(by_mode)
    own = shape_normals(G, participation)
    tensor = np.zeros((m, 2, 1 + n_input, m, 2, 1 + n_input))
    pole_pole = _rows_turned(_columns_turned(dd, z), z).reshape(by_mode)
    dv = vd.transpose(2, 3, 0, 1).reshape(1, 2 * m, 2 * m)
    pole_part = _rows_turned(dv, z).reshape(by_mode)
    for w, rows in patterns:
        P = turned(shapes[rows])
        flat = P.reshape(len(rows), -1)
        moment = (flat.T @ flat).reshape(m, 2, 2, m, 2, 2)
        H = np.zeros((m, 2, m, 2, 1 + n_input))
        H[..., 0] = np.tensordot(w, pole, axes=1)
        H[..., 1:] = (w[:, None, None, None, None] * part).transpose(1, 2, 3, 4, 0)
        flat_h = H.reshape(2 * m, -1)
        N = np.tensordot(w, own, axes=1)
        Q = -(flat_h.T @ solve(N, flat_h)).reshape(m, 2, 1 + n_input, m, 2, 1 + n_input)
        Q[:, :, 0, :, :, 0] += np.tensordot(w, pole_pole, axes=1)
        for i in range(n_input):
            Q[:, :, 0, :, :, 1 + i] += w[i] * pole_part[i]
            Q[:, :, 1 + i, :, :, 0] += w[i] * pole_part[i].transpose(2, 3, 0, 1)
            Q[:, :, 1 + i, :, :, 1 + i] += w[i] * vv
        tensor += np.einsum("kafKAF,kftKFT->katKAT", moment, Q)
    n_p = 2 * m
    S = np.empty((n_p * (1 + n_input), n_p * (1 + n_input)))
    first, rest = slice(0, 1), slice(1, None)
    for rows_of, a in ((slice(0, n_p), first), (slice(n_p, None), rest)):
        for columns_of, b in ((slice(0, n_p), first), (slice(n_p, None), rest)):
            block = tensor[:, :, a, :, :, b]
            S[rows_of, columns_of] = block.reshape(int(np.prod(block.shape[:3])), -1)
    return S


def normal(G: Floats, participation: Numbers, shapes: Numbers, weight: Floats) -> Normal:
    """Assemble all normal matrices of the model at given participation and shapes.

    Parameters
    ----------
    G : (2, n_mode, 2, 2, n_mode, 2) float
    participation : (n_input, n_mode) complex
    shapes : (n_output, n_mode) complex
    weight : (n_output, n_input) float
    """
    L, P = turned(participation), turned(shapes)
    n_input, m = participation.shape
    n_output = len(shapes)
    vv, vd, dd = G[0, :, :, 0], G[0, :, :, 1], G[1, :, :, 1]
    # second moments of the shapes by input: (i, k, a, b, K, A, B)
    flat = P.reshape(n_output, -1)
    moment = np.stack([(flat * weight[:, [i]]).T @ flat for i in range(n_input)])
    moment = moment.reshape(n_input, m, 2, 2, m, 2, 2)
    z = np.einsum("ikaf,kfKF,iKAF->ikaKA", L, dd, L, optimize=_IN_TURN)
    pole_pole = np.einsum("ikabKAB,ikbKB->kaKA", moment, z, optimize=True)
    dv = np.einsum("ikbf,kfKF->ikbKF", L, vd.transpose(2, 3, 0, 1), optimize=True)
    pole_part = np.einsum("ikabKAF,ikbKF->kaKAi", moment, dv, optimize=True)
    part_part = np.einsum("ikafKAF,kfKF->ikaKA", moment, vv, optimize=True)
    n_p, n_l = 2 * m, 2 * m * n_input
    common = np.zeros((n_p + n_l, n_p + n_l))
    common[:n_p, :n_p] = pole_pole.reshape(n_p, n_p)
    common[:n_p, n_p:] = pole_part.reshape(n_p, n_l)
    common[n_p:, :n_p] = common[:n_p, n_p:].T
    block = np.zeros((n_p, n_input, n_p, n_input))
    block[:, np.arange(n_input), :, np.arange(n_input)] = part_part.reshape(n_input, n_p, n_p)
    common[n_p:, n_p:] = block.reshape(n_l, n_l)
    x = np.einsum("ikaf,kfKF,iKAF->ikaKA", L, vd, L, optimize=_IN_TURN)
    x = (weight @ x.reshape(n_input, -1)).reshape(n_output, m, 2, m, 2)
    shape_pole = np.einsum("okaKB,oKAB->okaKA", x, P, optimize=True)
    h = np.einsum("ikaf,kfKF->iKFka", L, vv, optimize=True).reshape(n_input, m, 2, n_p)
    by_mode = P.transpose(1, 0, 2, 3).reshape(m, n_output * 2, 2)
    shape_part = (by_mode @ h).reshape(n_input, m, n_output, 2, n_p)
    shape_part *= weight.T[:, None, :, None, None]
    shape_part = shape_part.transpose(2, 4, 1, 3, 0)
    cross = np.concatenate(
        [shape_pole.reshape(n_output, n_p, n_p), shape_part.reshape(n_output, n_p, n_l)], axis=2
    )
    own = weight @ shape_normals(G, participation).reshape(n_input, -1)
    return Normal(own.reshape(n_output, n_p, n_p), cross, common)
