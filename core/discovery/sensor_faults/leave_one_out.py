"""What all the other sensors say of each.

A measured shape is, whatever the model lacks, nearly a combination of analysis shapes of
neighbouring frequency. So the readings of a mode are a Gaussian process whose covariance is
spanned by those shapes, and every node of the test can be predicted from all the other nodes
(Rasmussen and Williams 2006, section 2.1 for the weights, 5.4.2 for leaving out).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...arrays import Bools, Floats, Ints
from ...numerics.lapack import lower_solved
from ..likelihood.likelihood_numbers import LIKELIHOOD
from .sensor_numbers import SENSORS


@dataclass(frozen=True, eq=False)
class Survey:
    """Measured shapes by nodes.

    Parameters
    ----------
    shapes : (n_sensor, n_mode) float
    frequencies_hz : (n_mode,) float
    node, component : (n_sensor,) int
        Of the test; components 4 to 6 are rotations.
    axis, xyz : (n_sensor, 3) float
        In the frame of the analysis.
    errors : (n_sensor, n_mode) float, optional
        Standard errors over the rms of each shape.
    """

    shapes: Floats
    frequencies_hz: Floats
    node: Ints
    component: Ints
    axis: Floats
    xyz: Floats
    errors: Floats | None = None

    @property
    def moves(self) -> Floats:
        """Return how much each sensor reads in all modes alike, (n_sensor,)."""
        rms = np.linalg.norm(self.shapes, axis=0)
        return np.asarray(np.linalg.norm(self.shapes / np.where(rms > 0.0, rms, 1.0), axis=1))

    @property
    def slots(self) -> Ints:
        """Rows of each node in the order of the nodes, -1 where there are fewer, (n_node, k)."""
        _, first, of = np.unique(self.node, return_index=True, return_inverse=True)
        rank = np.empty(len(first), np.int64)
        rank[np.argsort(first)] = np.arange(len(first))
        of = rank[of]
        order = np.argsort(of, kind="stable")
        start = np.searchsorted(of[order], np.arange(len(first)))
        place = np.arange(len(of)) - start[of[order]]
        out = np.full((len(first), int(place.max()) + 1), -1, np.int64)
        out[of[order], place] = order
        return out

    def rows(self, node: int) -> Ints:
        """Return the rows of a node by its number in `slots`."""
        own = self.slots[node]
        return np.asarray(own[own >= 0])

    def unit(self) -> Floats:
        """Return the shapes with unit rms."""
        rms = np.sqrt(np.mean(self.shapes**2, axis=0))
        return np.asarray(self.shapes / np.maximum(rms, np.finfo(float).tiny))


@dataclass(frozen=True, eq=False)
class Span:
    """Shapes of a model where the test measured.

    Parameters
    ----------
    rows : (n_sensor, n_shape) float
        Along each sensor.
    around : (n_node, 3, n_shape) float
        In all three directions of the frame at each node, in the order of the nodes.
    frequencies_hz : (n_shape,) float
    """

    rows: Floats
    around: Floats
    frequencies_hz: Floats

    def seen(self) -> Span:
        """Return the shapes that the sensors see, each of unit rms at them."""
        length = np.sqrt(np.mean(self.rows**2, axis=0))
        keep = length > np.sqrt(LIKELIHOOD.unseen) * length.max()
        scale = length[keep]
        return Span(
            self.rows[:, keep] / scale, self.around[:, :, keep] / scale, self.frequencies_hz[keep]
        )

    def along_only(self) -> Span:
        """Return the shapes without the other directions, `around` (n_node, 0, n_shape)."""
        return Span(self.rows, self.around[:, :0], self.frequencies_hz)


@dataclass(frozen=True, eq=False)
class Prediction:
    """Motion of every node as the others say it.

    Parameters
    ----------
    mean : (n_node, n_mode, k + 3) float
        Along the k rows of a node (see `Survey.slots`), then in the directions of the span.
    covariance : (n_node, n_mode, k + 3, k + 3) float
    reading : (n_node, n_mode, k) float
        What was read, zero where a node has fewer rows.
    noise : (n_node, n_mode, k) float
        Variance of a reading; so large where a node has fewer rows that these say nothing.
    """

    mean: Floats
    covariance: Floats
    reading: Floats
    noise: Floats

    @property
    def rows(self) -> int:
        """Rows of a node k."""
        return int(self.reading.shape[2])


def predict(survey: Survey, span: Span, sigma: float, width: Floats, masked: Bools) -> Prediction:
    """Predict every node from all the other nodes, by a span as `Span.seen`.

    `sigma` is the noise of a reading over the rms of the shape, besides the survey's own errors;
    `width` (n_mode,) of ln f how far off in frequency analysis shapes take part in each test shape;
    nodes that are `masked` (n_node,) are left out of the predictions of all others.
    """
    slots = survey.slots
    there = slots >= 0
    (n, k), q = slots.shape, slots.shape[1] + span.around.shape[1]
    y = survey.unit()
    variance = np.full(y.shape, sigma**2)
    if survey.errors is not None:
        variance = variance + survey.errors**2
    near = np.maximum(span.frequencies_hz, SENSORS.nearest * survey.frequencies_hz[:, None])
    h = 1.0 / (1.0 + (np.log(near / survey.frequencies_hz[:, None]) / width[:, None]) ** 2) ** 2
    h = h / h.sum(axis=1, keepdims=True)
    sound = np.sort(slots[there & ~masked[:, None]])
    weight, modes = 1.0 / variance[sound], y.shape[1]
    m, C = np.zeros((n, modes, q)), np.zeros((n, modes, q, q))
    reading = np.where(there[:, None, :], y[slots].transpose(0, 2, 1), 0.0)
    noise = np.where(there[:, None, :], variance[slots].transpose(0, 2, 1), SENSORS.absent)
    none = np.zeros((1, span.rows.shape[1]))
    rows = np.concatenate([span.rows, span.around.reshape(-1, none.size), none])
    at = np.hstack([slots, np.arange(len(y), len(rows) - 1).reshape(n, -1)])  # -1: none
    for j in range(modes):
        used = h[j] > SENSORS.faint * h[j].max()
        X = rows[:, used] * np.sqrt(h[j, used])
        known = X[sound].T * weight[:, j]
        L = np.linalg.cholesky(np.eye(len(known)) + known @ X[sound])
        Z = lower_solved(L, X.T)
        m[:, j] = (lower_solved(L, known @ y[sound, j, None])[:, 0] @ Z)[at]
        own = Z.T[at]
        C[:, j] = own @ own.transpose(0, 2, 1)
    cross = np.swapaxes(C[..., :k], 2, 3)
    T = -C[..., :k, :k]
    T[..., np.arange(k), np.arange(k)] += noise
    lever = np.swapaxes(np.linalg.solve(T, cross), 2, 3)
    lever = np.where(masked[:, None, None, None], 0.0, lever)
    mean = m - np.matmul(lever, (reading - m[..., :k])[..., None])[..., 0]
    covariance = C + lever @ cross
    return Prediction(mean, covariance, reading, noise)
