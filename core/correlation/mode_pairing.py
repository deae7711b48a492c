"""Pair test modes with analysis modes, close ones turned onto the test first."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from ..arrays import Bools, Floats, Numbers, frozen
from ..noun import Noun
from .correlation_numbers import CORRELATION
from .criteria import Criteria
from .mac import mac, realised
from .subspace_rotation import ClusterRotation, clusters_by_bandwidth, rotate_cluster, subspace_mac

Groups = tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class Pair:
    """One test mode with one analysis mode (0-based columns)."""

    test: int
    analysis: int
    test_hz: float
    analysis_hz: float
    mac: float
    cluster: int | None = None
    rotation_deg: float | None = None

    @property
    def deviation_percent(self) -> float:
        """100·(analysis − test)/test."""
        return 100.0 * (self.analysis_hz - self.test_hz) / self.test_hz


@dataclass(frozen=True)
class Cluster:
    """Close modes of one side and the modes of the other side they were turned onto."""

    analysis: tuple[int, ...]
    test: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Correlation(Noun):
    """What pairs with what.

    `mac` (n_test, n_analysis) is as measured; `mac_rotated` after rotation. `transformation`
    (n_turned, n_turned) is block-orthogonal on the side that was turned: the shapes used for
    `mac_rotated` and the pairs are ``shapes @ transformation``.
    """

    pairs: tuple[Pair, ...]
    unpaired_test: tuple[int, ...]
    unpaired_analysis: tuple[int, ...]
    clusters: tuple[Cluster, ...]
    mac: Floats
    mac_rotated: Floats
    transformation: Floats
    criteria: Criteria

    @property
    def mean_abs_deviation_percent(self) -> float | None:
        """Mean of |deviation| over the pairs; None without pairs."""
        off = [abs(p.deviation_percent) for p in self.pairs]
        return float(np.mean(off)) if off else None

    @property
    def worst_deviation_percent(self) -> float | None:
        """Largest |deviation| of the pairs; None without pairs."""
        return max((abs(p.deviation_percent) for p in self.pairs), default=None)

    @property
    def mean_mac(self) -> float | None:
        """Mean MAC of the pairs; None without pairs."""
        return float(np.mean([p.mac for p in self.pairs])) if self.pairs else None


def correlate(
    analysis_hz: Floats,
    analysis_shapes: Floats,
    test_hz: Floats,
    test_shapes: Numbers,
    criteria: Criteria | None = None,
    rigid_body_modes: int = 0,
) -> Correlation:
    """Correlate modes given at the same sensors.

    Parameters
    ----------
    analysis_hz : (n_analysis,) float
    analysis_shapes : (n_sensor, n_analysis) float
        Mass-normalised, so that an orthogonal transformation of a cluster stays so.
    test_hz : (n_test,) float
    test_shapes : (n_sensor, n_test) float or complex
        Any scaling. Complex shapes enter the MAC as they are and rotation by their principal
        phase.
    criteria : Criteria
    rigid_body_modes : int
        The first so many analysis modes are rigid-body motions: never paired with an elastic
        test mode.

    Returns
    -------
    Correlation

    Raises
    ------
    InputError
        When shapes are not at the same sensors or no test mode has a frequency above zero.

    References
    ----------
    Equations (7)–(10) of the source paper, see `rotation` and `pairing`.
    """
    criteria = criteria or Criteria()
    measured = mac(test_shapes, analysis_shapes)
    part_test = criteria.test_modes(test_hz)
    part_analysis = criteria.analysis_modes(len(analysis_hz), rigid_body_modes)
    by_hand = [(t - 1, a - 1) for t, a in criteria.pairs if a <= len(analysis_hz)]
    free_test, free_analysis = part_test.copy(), part_analysis.copy()
    free_test[[t for t, _ in by_hand]] = False
    free_analysis[[a for _, a in by_hand]] = False
    near = np.abs(analysis_hz[None, :] - test_hz[:, None]) <= (
        criteria.frequency_tolerance * test_hz[:, None]
    )
    near &= free_analysis[None, :] & free_test[:, None]
    real = realised(test_shapes)
    groups: Groups = ()
    if criteria.rotate == "analysis":
        hz = np.where(free_analysis, analysis_hz, 0.0)
        groups = clusters_by_bandwidth(hz, criteria.cluster_width)
        turned = _turn(analysis_shapes, real, groups, near.T, criteria.mac_min)
        matrix = _transformation(len(analysis_hz), groups, turned)
        rotated = mac(test_shapes, analysis_shapes @ matrix)
    elif criteria.rotate == "test":
        groups = clusters_by_bandwidth(np.where(free_test, test_hz, 0.0), criteria.cluster_width)
        scaled = real / np.maximum(np.linalg.norm(real, axis=0), np.finfo(float).tiny)
        turned = _turn(scaled, analysis_shapes, groups, near, criteria.mac_min)
        matrix = _transformation(len(test_hz), groups, turned)
        rotated = mac(scaled @ matrix, analysis_shapes)
    else:
        turned, rotated, matrix = [], measured, np.eye(len(analysis_hz))
    chosen = sorted([*by_hand, *assign(rotated, (rotated >= criteria.mac_min) & near)])
    clusters = [(g, r) for g, r in zip(groups, turned, strict=True) if len(g) > 1 and r.test]

    def pair(t: int, a: int) -> Pair:
        member = a if criteria.rotate == "analysis" else t
        cluster = next((k for k, (g, _) in enumerate(clusters) if member in g), None)
        turn = np.degrees(np.arccos(np.clip(matrix[member, member], -1.0, 1.0)))
        angle = None if cluster is None else float(turn)
        hz = float(test_hz[t]), float(analysis_hz[a])
        return Pair(t, a, *hz, float(rotated[t, a]), cluster, angle)

    pairs = [pair(t, a) for t, a in chosen]
    return Correlation(
        tuple(pairs),
        tuple(sorted(set(np.flatnonzero(part_test).tolist()) - {p.test for p in pairs})),
        tuple(sorted(set(np.flatnonzero(part_analysis).tolist()) - {p.analysis for p in pairs})),
        tuple(
            Cluster(g, r.test) if criteria.rotate == "analysis" else Cluster(r.test, g)
            for g, r in clusters
        ),
        frozen(measured),
        frozen(rotated),
        frozen(matrix),
        criteria,
    )


def _turn(
    shapes: Floats, targets: Floats, groups: Groups, near: Bools, mac_min: float
) -> list[ClusterRotation]:
    """Assign targets to groups, at most one per member, and turn each group onto its own."""
    slots = [k for k, g in enumerate(groups) for _ in g]
    if not slots:
        return []
    score = np.array([subspace_mac(shapes[:, g], targets) for g in groups])
    reachable = np.array([near[list(g)].any(axis=0) for g in groups])
    allowed = (score >= mac_min) & reachable
    taken: list[list[int]] = [[] for _ in groups]
    for slot, target in assign(score[slots], allowed[slots]):
        taken[slots[slot]].append(target)
    return [
        rotate_cluster(shapes[:, g], targets, tuple(sorted(t)), mac_min)
        if len(g) > 1
        else ClusterRotation(np.eye(1), tuple(t))
        for g, t in zip(groups, taken, strict=True)
    ]


def _transformation(n: int, groups: Groups, turned: list[ClusterRotation]) -> Floats:
    """Block-orthogonal matrix whose columns keep the numbers of the modes they resemble most."""
    matrix = np.eye(n)
    for g, r in zip(groups, turned, strict=True):
        if len(g) > 1 and r.test:
            resembles = assign(r.matrix.T**2 + CORRELATION.tie, np.ones((len(g), len(g)), bool))
            columns = np.empty_like(r.matrix)
            for column, member in resembles:
                columns[:, member] = r.matrix[:, column]
            matrix[np.ix_(g, g)] = columns * np.where(np.diag(columns) < 0.0, -1.0, 1.0)
    return matrix


def assign(score: Floats, allowed: Bools) -> tuple[tuple[int, int], ...]:
    """One-to-one assignment of rows to columns that maximises the summed score.

    Parameters
    ----------
    score : (n_row, n_col) float
        For modes: the MAC.
    allowed : (n_row, n_col) bool
        Pairs that may be formed at all; the assignment forms as many of these as add to the
        sum and never another.

    Returns
    -------
    tuple of (row, column)
        By rising row.

    References
    ----------
    Kuhn (1955), the Hungarian method, in scipy's implementation.
    """
    if score.size == 0:
        return ()
    gain = np.where(allowed, np.maximum(score, 0.0), 0.0)
    rows, cols = linear_sum_assignment(gain, maximize=True)
    return tuple((int(r), int(c)) for r, c in zip(rows, cols, strict=True) if allowed[r, c])
