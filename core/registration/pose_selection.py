"""Choose among the positions in which a test fits on a model."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..arrays import Floats
from .pose_families import Family, family_of, members, sampled, step_of
from .pose_score import Scorer
from .poses import Poses, motion_between
from .registration_numbers import ALIGN
from .surface_registration import Cloud, farthest_points, polish, rms_of


@dataclass(frozen=True, eq=False)
class Choice:
    """One position: its pose and score (None without shapes)."""

    pose: Poses
    score: float | None

    @property
    def rms(self) -> float:
        """Root mean square distance from the surface."""
        return float(self.pose.rms[0])

    @property
    def angle(self) -> float:
        """Angle of the rotation, radians."""
        return float(self.pose.angle[0])


@dataclass(frozen=True, eq=False)
class Choices:
    """Positions, the one taken first, and in words what was open and what decided."""

    candidates: tuple[Choice, ...]
    ambiguity: str
    decided: bool
    warnings: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class _Peak:
    """A best position of a family.

    `loose` motions can be followed far without leaving the model; along the `flat` ones of them
    the shapes stay as good, along the others over the length `blur` (d,).
    """

    family: Family
    best: Choice
    loose: tuple[int, ...]
    flat: tuple[int, ...]
    blur: Floats


def margin_of(score: float) -> float:
    """Difference of scores that tells candidates apart: at least 0.01, a tenth of what is missing.

    A model that explains little of the test tells positions apart no better than that.
    """
    return max(ALIGN.told_apart, ALIGN.told_share * (1.0 - score))


def choose(cloud: Cloud, points: Floats, scorer: Scorer | None, poses: Poses) -> Choices:
    """Rank the positions in which test nodes `points` (n, 3) lie on the surface of the analysis.

    Geometry first: the poses that fit about as well as the best, as `search` found them, are
    sorted into families within which the test slides. Every family is sampled and scored, its
    best refined. Between candidates that score alike (`margin_of`) the smaller rotation is taken;
    without a score, geometry and the smaller rotation decide.
    """
    surface = cloud.surface
    share, beside = ALIGN.alike
    limit = max(share * poses.rms[0], poses.rms[0] + beside * surface.size)
    poses = poses.take(np.flatnonzero(poses.rms <= limit))
    few = points[farthest_points(points, ALIGN.points)]
    judge = _Judge(cloud, points, scorer, max(poses.rms[0], ALIGN.exact * surface.size), limit)
    found: list[_Peak] = []
    for _ in range(ALIGN.families):
        family = family_of(surface, few, poses.take(np.array([0])), limit)
        found += _explore(judge, family, sampled(cloud, few, family, limit))
        poses = poses.take(np.flatnonzero(~members(family, few, poses, surface)))
        if not len(poses):
            break
    return _ranked(found, points, surface.size, scorer is not None)


@dataclass(frozen=True, eq=False)
class _Judge:
    """How good a position is: its score, a little less where it leaves the surface."""

    cloud: Cloud
    points: Floats
    scorer: Scorer | None
    floor: float
    limit: float

    def worth(self, poses: Poses) -> Floats:
        """Score less a small share for distance, (k,)."""
        over = np.maximum(self._rms(poses) ** 2 - self.floor**2, 0.0)
        spoiled = ALIGN.distance * over / self.limit**2
        return -spoiled if self.scorer is None else self.scorer.score(poses) - spoiled

    def calm(self, poses: Poses, least: float) -> Floats:
        """Minus the angle of rotation at rest, far less where worth or fit falls short, (k,).

        Motions of a family are known where they set out: what is led far along them settles first.
        """
        start, rounds = (poses.rotation, poses.translation), ALIGN.settled
        poses = polish(self.cloud.surface, self.points, *start, rounds)
        short = np.maximum(least - self.worth(poses), 0.0)
        spoiled = np.maximum(poses.rms / (ALIGN.calm * self.floor) - 1.0, 0.0)
        lost = ALIGN.calm_short * short + ALIGN.calm_off * spoiled
        return np.asarray(-poses.angle - lost)

    def margin(self, worth: float) -> float:
        """Difference of worth that does not count."""
        if self.scorer is not None:
            return margin_of(worth)
        over = (ALIGN.calm**2 - 1.0) * self.floor**2
        return ALIGN.distance * over / self.limit**2

    def rested(self, pose: Poses) -> Choice:
        """Lay one pose on the surface and score it."""
        start, rounds = (pose.rotation, pose.translation), ALIGN.settling
        pose = polish(self.cloud.surface, self.points, *start, rounds)
        score = None if self.scorer is None else float(self.scorer.score(pose)[0])
        return Choice(pose, score)

    def _rms(self, poses: Poses) -> Floats:
        return rms_of(self.cloud.surface, self.points, poses)


def _explore(judge: _Judge, family: Family, samples: Poses) -> list[_Peak]:
    """Score the samples of a family and refine its best positions."""
    values = judge.worth(samples)
    where = _coordinates(family, samples)
    size = judge.cloud.surface.size
    step = step_of(family, judge.cloud.surface)
    found: list[_Peak] = []
    left = np.ones(len(samples), bool)
    for _ in range(ALIGN.peaks):
        top = int(np.argmax(np.where(left, values, -np.inf)))
        if not left[top] or (found and values[top] < values.max() - ALIGN.coarse):
            break
        best, value = _climb(family, where[top], values[top], step, judge.worth)
        apart = _offsets(family, where - best)
        alike = values >= value - judge.margin(value) if judge.scorer else left
        turn = np.radians(ALIGN.open_turn) * family.radius[0]
        far = np.where(family.turning, turn, ALIGN.open_slide * size)
        gap = step * np.where(family.turning, ALIGN.gap_turn, ALIGN.gap_slide)
        reach, blur = _reach(apart, gap), _reach(apart[alike], gap)
        loose = tuple(np.flatnonzero(reach > far))
        flat = tuple(k for k in loose if blur[k] > max(far[k], ALIGN.flat * reach[k]))
        if flat and not found:
            best = _calmest(judge, family, where[alike], value, step)
        found.append(_Peak(family, judge.rested(family.at(best[None])), loose, flat, blur))
        if flat:
            break
        left &= np.any(np.abs(_offsets(family, where - where[top])) > far, axis=1)
        left &= np.any(np.abs(apart) > far, axis=1)
    return found


def _calmest(judge: _Judge, family: Family, where: Floats, value: float, step: Floats) -> Floats:
    """Coordinates of the least rotation among positions that are as good as the best."""
    least = value - judge.margin(value)
    calm = judge.calm(family.at(where), least)
    start = int(np.argmax(calm))
    return _climb(family, where[start], calm[start], step, lambda p: judge.calm(p, least))[0]


def _coordinates(family: Family, poses: Poses) -> Floats:
    """Coordinates of poses along the motions of their family, (k, d)."""
    if not len(family.motions):
        return np.zeros((len(poses), 0))
    motions = motion_between(family.pose, poses, family.centre, family.radius)
    return np.asarray(np.linalg.lstsq(family.motions.T, motions.T, rcond=None)[0].T)


def _climb(
    family: Family, start: Floats, value: float, step: Floats, worth: Callable[[Poses], Floats]
) -> tuple[Floats, float]:
    """Find the nearest maximum along the motions by a pattern search with halved steps."""
    best, d = start, len(start)
    pattern = np.concatenate([np.eye(d), -np.eye(d)])
    halvings = 0
    while d and halvings < ALIGN.halvings:
        trial = best + pattern * step * 0.5**halvings
        values = worth(family.at(trial))
        k = int(np.argmax(values))
        if values[k] > value:
            best, value = trial[k], float(values[k])
        else:
            halvings += 1
    return best, float(value)


def _offsets(family: Family, apart: Floats) -> Floats:
    """Differences of coordinates (k, d) with turns taken the short way round."""
    full = 2 * np.pi * family.radius[0]
    return np.where(family.turning, (apart + full / 2) % full - full / 2, apart)


def _reach(apart: Floats, gap: Floats) -> Floats:
    """How far samples reach along each motion without a gap, (d,); `apart` (k, d) from the best."""
    reach = np.zeros(len(gap))
    for k in range(len(gap)):
        for side in (apart[:, k], -apart[:, k]):
            ahead = np.concatenate([[0.0], np.sort(side[side > 0])])
            gaps = np.flatnonzero(np.diff(ahead) > gap[k])
            reach[k] += ahead[gaps[0]] if len(gaps) else ahead[-1]
    return reach


def _ranked(found: list[_Peak], points: Floats, size: float, scored: bool) -> Choices:
    order = sorted(found, key=lambda e: (-(e.best.score or 0.0), e.best.rms))
    kept: list[_Peak] = []
    for e in order:
        if all(_apart(e.best, other.best, points) > ALIGN.free * size for other in kept):
            kept.append(e)
    top = kept[0].best.score or 0.0
    alike = [e for e in kept if not scored or (e.best.score or 0.0) >= top - margin_of(top)]
    step = np.radians(ALIGN.same_angle)
    alike.sort(key=lambda e: (round(e.best.angle / step), -(e.best.score or 0.0)))
    ranked = alike + [e for e in kept if e not in alike]
    ambiguity = _in_words(ranked, len(alike), scored)
    decided = len(alike) == 1 and not ranked[0].flat
    warnings = () if decided else (ambiguity,)
    return Choices(tuple(e.best for e in ranked), ambiguity, decided, warnings)


def _apart(a: Choice, b: Choice, points: Floats) -> float:
    """Root mean square distance between the same points in two positions."""
    d = (a.pose.apply(points) - b.pose.apply(points))[0]
    return float(np.sqrt((d**2).sum(axis=1).mean()))


def _in_words(ranked: list[_Peak], n_alike: int, scored: bool) -> str:
    chosen = ranked[0]
    motions = [_named(chosen.family, k) for k in chosen.loose]
    if len(ranked) == 1 and not motions:
        return ""
    left = [*motions, f"{len(ranked)} positions"] if len(ranked) > 1 else motions
    text = f"the geometry leaves open {' and '.join(left)}"
    if not scored:
        return f"{text}; without shapes to compare, the smallest rotation was taken"
    scores = [f"{e.best.score:.3f} (turned {np.degrees(e.best.angle):.0f} degrees)" for e in ranked]
    listed = ", ".join(scores[: ALIGN.named]) + (", ..." if len(scores) > ALIGN.named else "")
    undecided = [_named(chosen.family, k) for k in chosen.flat]
    if n_alike > 1:
        undecided.append(f"{n_alike} of the positions")
    if undecided:
        return (
            f"{text}; correlation does not decide {' and '.join(undecided)}: the smallest rotation "
            f"was taken; scores {listed}"
        )
    sharp = " and ".join(_blurred(chosen, k) for k in chosen.loose)
    return f"{text}; correlation decided{' (' + sharp + ')' if sharp else ''}; scores {listed}"


def _blurred(peak: _Peak, k: int) -> str:
    """Say over what range positions along a motion correlate alike."""
    half = peak.blur[k] / 2
    if peak.family.turning[k]:
        return f"the turn to within {np.degrees(half / peak.family.radius[0]):.1f} degrees"
    return f"the slide to within {half:.3g}"


def _named(family: Family, k: int) -> str:
    axis = family.axis_of(k)
    axis = axis * np.sign(axis[np.argmax(np.abs(axis))])
    way = ", ".join(f"{v:.2f}" for v in np.round(axis, 2) + 0.0)
    return f"{'a turn about' if family.turning[k] else 'a slide along'} ({way})"
