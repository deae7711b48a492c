"""Inner products that a fit of poles, participation and shapes is made of.

A function of output o and input i is modelled as Σ_k Re(ψ_ok l_ik) F1_k + Im(ψ_ok l_ik) F2_k in
the span of F1 = c + c̄, F2 = j(c − c̄) with c = (jω)^d/(jω − λ), c̄ = (jω)^d/(jω − λ*); F3, F4
are the same with the derivative by λ. Real and imaginary parts of the lines are stacked, and
the residual terms of modes above and below are projected out. Every product needed then follows
from F'F and F'Y; the number of lines is met only once per step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Floats, Numbers


def stacked(lines: Numbers) -> Floats:
    """Real parts of all lines, then imaginary parts, along the last axis."""
    return np.concatenate([lines.real, lines.imag], axis=-1)


@dataclass(frozen=True, eq=False)
class BandData:
    """Measured functions of a band with the residual terms projected out.

    Parameters
    ----------
    s : (n_line,) complex
        jω.
    derivative : (n_line,) complex
        (jω)^d.
    residual_terms : (2 n_line, 8) float
        Orthonormal basis of the lower and upper residuals, complex coefficients.
    y : (n_output, n_input, 2 n_line) float
        Stacked functions, weighted, orthogonal to `residual_terms`.
    weight : (n_output, n_input) float
        1 where measured, 0 where not.
    """

    s: Numbers
    derivative: Numbers
    residual_terms: Floats
    y: Floats
    weight: Floats

    @property
    def power(self) -> float:
        """Sum of squares of what is to be explained."""
        return float(np.einsum("oin,oin,oi->", self.y, self.y, self.weight, optimize=True))


def band_data(frequencies_hz: Floats, values: Numbers, measured: Numbers, order: int) -> BandData:
    """Prepare the functions of a band for fitting.

    The modes below and above act in the band as (jω)^d [LR₂/(jω)⁴ + LR/(jω)² + UR + UR₂ (jω)²]:
    their mass and stiffness lines and one further term of the expansion of each.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_output, n_input, n_line) complex
    measured : (n_output, n_input) bool
    order : int
        How often displacement is differentiated (0, 1, 2).
    """
    s = 2j * np.pi * frequencies_hz
    derivative = s**order
    powers = np.array([-4, -2, 0, 2])[:, None]
    lines = derivative * (s / np.mean(np.abs(s))) ** powers
    terms = stacked(np.concatenate([lines, 1j * lines])).T
    Q, _ = np.linalg.qr(terms / np.linalg.norm(terms, axis=0))
    y = stacked(values)
    y -= (y @ Q) @ Q.T
    return BandData(s, derivative, np.ascontiguousarray(Q), y, measured.astype(float))


def basis(data: BandData, poles: Numbers) -> Floats:
    """Functions F1..F4 of each mode, (2 n_line, 2, n_mode, 2): value or derivative, mode, part."""
    near = data.derivative / (data.s - poles[:, None])
    far = data.derivative / (data.s - poles.conj()[:, None])
    near2 = near / (data.s - poles[:, None])
    far2 = far / (data.s - poles.conj()[:, None])
    F = np.stack(
        [
            np.stack([near + far, 1j * (near - far)], axis=1),
            np.stack([near2 + far2, 1j * (near2 - far2)], axis=1),
        ]
    )
    flat = stacked(F).reshape(-1, 2 * len(data.s)).T
    flat = flat - data.residual_terms @ (data.residual_terms.T @ flat)
    return np.ascontiguousarray(flat).reshape(2 * len(data.s), 2, len(poles), 2)


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


def normal_shapes(G: Floats, participation: Numbers, weight: Floats) -> Floats:
    """Return the normal matrices of the shapes alone, (n_output, 2 n_mode, 2 n_mode).

    Parameters
    ----------
    G : (2, n_mode, 2, 2, n_mode, 2) float
        F'F.
    participation : (n_input, n_mode) complex
    weight : (n_output, n_input) float
    """
    L = turned(participation)
    n = 2 * participation.shape[1]
    per_input = np.einsum("ikaf,kfKF,iKAF->ikaKA", L, G[0, :, :, 0], L, optimize=True)
    return np.asarray((weight @ per_input.reshape(len(L), -1)).reshape(-1, n, n))


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
    z = np.einsum("ikaf,kfKF,iKAF->ikaKA", L, dd, L, optimize=True)
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
    x = np.einsum("ikaf,kfKF,iKAF->ikaKA", L, vd, L, optimize=True)
    x = (weight @ x.reshape(n_input, -1)).reshape(n_output, m, 2, m, 2)
    shape_pole = np.einsum("okaKB,oKAB->okaKA", x, P, optimize=True)
    h = np.einsum("ikaf,kfKF->ikaKF", L, vv, optimize=True)
    shape_part = np.stack(
        [
            np.einsum("kaKF,oKAF->okaKA", h[i], P, optimize=True)
            * weight[:, i, None, None, None, None]
            for i in range(n_input)
        ],
        axis=-1,
    )
    cross = np.concatenate(
        [shape_pole.reshape(n_output, n_p, n_p), shape_part.reshape(n_output, n_p, n_l)], axis=2
    )
    return Normal(normal_shapes(G, participation, weight), cross, common)
