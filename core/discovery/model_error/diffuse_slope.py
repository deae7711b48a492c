"""How the likelihood of a test changes with its model, the model's diffuse error and the noise.

A test shape has the covariance C = c² A f(Λ) Aᵀ + s² I. A f(Λ) Aᵀ is a function of the model's
matrices, so that its derivative is A (L ∘ δK) Aᵀ by the divided differences L of f (Daleckii and
Krein 1965, AMS Translations 47, 1): finite however close modes are. With W = Aᵀ C⁻¹ A and
v = Aᵀ C⁻¹ t, −ln L of a shape t has the derivative ½ c² (W − v vᵀ) by A f Aᵀ in modal coordinates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Floats
from .diffuse_error import Diffuse, Seen, at, shares, weight
from .model_error_numbers import MODEL_ERROR


@dataclass(frozen=True, eq=False)
class Slope:
    """Derivatives of −ln L, the match of the modes held.

    Parameters
    ----------
    errors : (2,) float
        By ln of error and noise.
    information : (2, 2) float
        Fisher's, of these.
    stiffness, mass : (n, n) float
        By what is added to either matrix in modal coordinates: the sum of the products is it.
    shapes : (n_test, n, n) float
        AᵀC⁻¹A of each test shape, for what it counts.
    """

    errors: Floats
    information: Floats
    stiffness: Floats
    mass: Floats
    shapes: Floats

    def towards(self, seen: Seen, d: Diffuse) -> tuple[Floats, float]:
        """Return the step of ln of error and noise to where they are likeliest, and its gain.

        Of a scale that is all there is to fit, 1 + 2δ by Fisher's step δ is its square. What no
        mode tells, where all of them are none of the model's, stays.
        """
        fisher = -np.linalg.pinv(self.information, hermitian=True) @ self.errors
        step = 0.5 * np.log(np.maximum(1.0 + 2.0 * fisher, MODEL_ERROR.shrinks))
        step = np.log(moved(seen, d, step)) - np.log([d.error, d.noise])
        return step, -float(self.errors @ step)


def slope(seen: Seen, d: Diffuse) -> Slope:
    """Return the derivatives where a test has the likelihood `d`."""
    k, sensors, gram = d.match, len(seen.shapes), seen.gram
    e2, s2, sure = d.error**2, d.noise**2 / sensors, 1.0 - d.stray
    each = sure * weight(seen)
    values, own = seen.values, seen.values[k]
    c2, f = shares(seen, d.error, k)
    D = c2[:, None] * f
    T = seen.cross[:, np.arange(len(k))].T
    system = s2 * np.eye(len(gram)) + gram * D[:, None, :]
    sides = np.dstack([np.broadcast_to(gram, system.shape), T])
    solved = np.linalg.solve(system, sides)
    W, v = solved[:, :, :-1], solved[:, :, -1]
    counted = each[:, None, None] * W
    N = 0.5 * (counted - (each[:, None] * v)[:, :, None] * v[:, None, :])

    by_log = D * np.einsum("mjj->mj", N)
    first, second = f @ np.diag(gram), np.sum(f * (f @ gram**2), axis=1)
    by_gram = by_log.sum(axis=1) / np.array([first, -0.5 * second])
    N = N * c2[:, None, None] + by_gram[0, :, None, None] * gram
    N += by_gram[1, :, None, None] * np.matmul(gram * f[:, None, :], gram)
    x = values / own[:, None]
    below = (1.0 - x) ** 2 + e2 * x
    scaled = below * own[:, None] / e2
    L = (1.0 - x[:, :, None] * x[:, None, :]) / (scaled[:, :, None] * below[:, None, :])
    stiffness = np.sum(N * L, axis=0)
    held = 0.5 * np.einsum("mjl,mj->jl", N, f)
    mass = -0.5 * stiffness * (values[:, None] + values) - held - held.T

    off = np.log(2.0 * np.pi * seen.hz) - 0.5 * np.log(own)
    variance = 0.5 * e2 + seen.scatter**2
    by_own = 0.5 * sure * off / variance
    by_own += np.sum(e2 * x * (1.0 - x**2) / below**2 * np.einsum("mjj->mj", N), axis=1)
    np.add.at(stiffness, (k, k), -by_own / own)
    np.add.at(mass, (k, k), by_own)

    b = 2.0 * (1.0 - f)
    by_length = np.diag(gram) / first[:, None] - 2.0 * (f @ gram**2) / second[:, None]
    b += np.sum(f * b * by_length, axis=1)[:, None]
    root = np.sqrt(D)
    P = W * root[:, :, None] * root[:, None, :]
    p, squares, m = np.einsum("mjj->mj", P), P**2, D * v
    left = (1.0 - np.sum(m * (2.0 * T - m @ gram), axis=1)) / s2
    rest, free = p - squares.sum(axis=2), sensors - p.sum(axis=1)
    by_error = 0.5 * np.sum(sure * e2 * (1.0 - off**2 / variance) / variance) + np.sum(by_log * b)
    both = each @ np.sum(b * rest, axis=1)
    pairs = np.sum(b * np.matmul(squares, b[:, :, None])[:, :, 0], axis=1)
    of_error = 0.5 * (sure @ (e2 / variance) ** 2 + each @ pairs)
    of_noise = 2.0 * each @ (free - rest.sum(axis=1))
    information = np.array([[of_error, both], [both, of_noise]])
    errors = np.array([by_error, each @ (free - left)])
    return Slope(errors, information, stiffness, mass, counted)


def diffuse(seen: Seen) -> Diffuse:
    """Return the likelihood of a test at the diffuse error and the noise that make it largest.

    Uphill from the best of a few errors and noises.
    """
    errors, noises = (np.geomspace(*r, MODEL_ERROR.starts) for r in ranges(seen))
    best = max((at(seen, e, noises[len(noises) // 2]) for e in errors), key=lambda d: d.log)
    others = (at(seen, best.error, s) for s in noises if s != best.noise)
    best = max((best, *others), key=lambda d: d.log)
    for _ in range(MODEL_ERROR.steps):
        step, gain = slope(seen, best).towards(seen, best)
        if gain < MODEL_ERROR.tolerance:
            break
        tried = (
            at(seen, *moved(seen, best, h * step)) for h in 0.5 ** np.arange(MODEL_ERROR.dampings)
        )
        better = next((d for d in tried if d.log > best.log), None)
        if better is None:
            break
        best = better
    return best


def ranges(seen: Seen) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the least and largest error and noise of a reading."""
    low, high = MODEL_ERROR.noises
    return MODEL_ERROR.errors, (max(low, seen.reading), max(high, seen.reading))


def moved(seen: Seen, d: Diffuse, step: Floats) -> tuple[float, float]:
    """Return error and noise times the exponentials of a step, within their ranges."""
    error, noise = np.clip(np.array([d.error, d.noise]) * np.exp(step), *np.transpose(ranges(seen)))
    return float(error), float(noise)
