"""How likely the readings of a node are if it reads what a fault would make of its motion."""

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from ...arrays import Floats
from .leave_one_out import Prediction
from .sensor_numbers import SENSORS

LOCAL = np.array(SENSORS.local)
"""Sizes of what a model may have wrong at one node, over the rms of a shape."""


@dataclass(frozen=True, eq=False)
class Node:
    """One node: what was read and what the others say; see `Prediction` for the arrays."""

    mean: Floats
    covariance: Floats
    reading: Floats
    noise: Floats

    @property
    def identity(self) -> Floats:
        """Map of a sound node, (k, k + 3)."""
        return np.eye(self.reading.shape[1], self.mean.shape[1])


def node_of(said: Prediction, number: int, count: int) -> Node:
    """Return one node with its first `count` rows only."""
    k = said.rows
    keep = np.r_[np.arange(count), k : k + 3]
    return Node(
        said.mean[number][:, keep],
        said.covariance[number][:, keep][:, :, keep],
        said.reading[number][:, :count],
        said.noise[number][:, :count],
    )


def likelihood(node: Node, maps: Floats) -> Floats:
    """Log likelihood of the readings of all modes for maps (n, k, k + 3) of motion to reading.

    (n, n_local): for each size in `LOCAL` of what the model has wrong there in every mode by
    itself.
    """
    mean = np.swapaxes(maps @ node.mean.T, 1, 2)
    part = maps[:, None] @ node.covariance
    return likelihood_of(node, mean, part @ np.swapaxes(maps, 1, 2)[:, None])


def likelihood_of(node: Node, mean: Floats, covariance: Floats) -> Floats:
    """Log likelihood of the readings if they should be as given, as `likelihood`.

    Shapes: `mean` (n, n_mode, k), `covariance` (n, n_mode, k, k) without the readings' noise.
    """
    k = node.reading.shape[1]
    C = covariance + SENSORS.gain_scatter**2 * mean[..., :, None] * mean[..., None, :]
    C[..., np.arange(k), np.arange(k)] += node.noise
    off = node.reading - mean
    if k == 1:
        return _mixed(off**2, np.maximum(C[..., 0], SENSORS.least_variance))
    values, vectors = np.linalg.eigh(C)
    r = (np.swapaxes(vectors, -1, -2) @ off[..., None])[..., 0]
    return _mixed(r**2, np.maximum(values, SENSORS.least_variance))


def _mixed(square: Floats, values: Floats) -> Floats:
    """Sum over modes of the log of a mixture of two normal laws, (n, n_local)."""
    out = np.empty((len(square), len(LOCAL)))
    for t, size in enumerate(LOCAL):
        one = values + size**2
        far = one + SENSORS.far**2
        a = -0.5 * np.sum(square / one + np.log(2.0 * np.pi * one), axis=-1)
        b = -0.5 * np.sum(square / far + np.log(2.0 * np.pi * far), axis=-1)
        both = np.logaddexp(np.log1p(-SENSORS.stray) + a, np.log(SENSORS.stray) + b)
        out[:, t] = both.sum(axis=-1)
    return out


def local_shares(sound: Floats) -> Floats:
    """Return the shares of the sizes `LOCAL` among nodes taken as sound (empirical Bayes).

    `sound` (n_node, n_local) are log likelihoods.
    """
    shares = np.array(SENSORS.local_before)
    for _ in range(SENSORS.local_rounds):
        weight = sound + np.log(shares)
        each = np.exp(weight - logsumexp(weight, axis=1, keepdims=True))
        total = each.sum(axis=0) + SENSORS.local_weight * np.array(SENSORS.local_before)
        shares = total / total.sum()
    return np.asarray(shares)


def evidence(node: Node, maps: Floats, shares: Floats) -> Floats:
    """Log likelihood of each map, over all sizes of what the model has wrong there, (n,)."""
    return averaged(likelihood(node, maps), shares)


def averaged(log: Floats, shares: Floats) -> Floats:
    """Log likelihoods (n, n_local) over all sizes of what a model has wrong, (n,)."""
    return np.asarray(logsumexp(log + np.log(shares), axis=1))
