"""Put the test into the frame of the analysis."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Floats
from ..data.geometry import Geometry
from ..data.length_units import length_factor
from ..data.modes import Modes
from ..errors import InputError
from ..sensors.closest_point import place
from ..sensors.outer_surface import Surface, surface_of
from ..sensors.rigid_transform import Transform
from ..sensors.sensor_map import default_tolerance
from .pose_score import Scorer, scorer_of
from .pose_selection import choose
from .poses import Poses
from .registration_numbers import ALIGN
from .surface_registration import Cloud, cloud_of, polish, rms_of, search


@dataclass(frozen=True, eq=False)
class Candidate:
    """A position that the geometry allows.

    Parameters
    ----------
    transform : Transform
    rms : float
        Root mean square distance of the test nodes from the model, deck length unit.
    score : float or None
        Share of the test shapes that the analysis explains there (`frame_score.Scorer`).
    """

    transform: Transform
    rms: float
    score: float | None


@dataclass(frozen=True, eq=False)
class Alignment(Transform):
    """The move from test to analysis coordinates and how it was decided.

    Parameters
    ----------
    rotation, translation, scale
        See `Transform`; `scale` comes from the declared length units only.
    rms : float
        Root mean square distance of the test nodes from the model, deck length unit.
    method : {"as it is", "fitted"}
        Whether the frames agreed or were fitted.
    score : float or None
        Share of the test shapes that the analysis explains (1 perfect, 0 chance).
    candidates : tuple of Candidate
        Positions the geometry allows, best first; the first is the one taken.
    ambiguity : str
        In words what the geometry left open and what decided; empty where nothing was open.
    decided : bool
        False where something stayed open that neither geometry nor correlation could tell.
    warnings : tuple of str
    """

    rms: float = 0.0
    method: str = "as it is"
    score: float | None = None
    candidates: tuple[Candidate, ...] = ()
    ambiguity: str = ""
    decided: bool = True
    warnings: tuple[str, ...] = ()


def align(
    geometry: Geometry,
    test_geometry: Geometry,
    modes: Modes | None = None,
    test_modes: Modes | None = None,
    *,
    tolerance: float | None = None,
    seed: int = 0,
) -> Alignment:
    """Find the rigid move that puts the test onto the model.

    Frames that agree are left exactly as they are. Otherwise the test nodes are laid on the
    model's surface from many starts (`rigid_fit.search`). What the geometry leaves open (half
    turns of a panel, any turn of a duct, sliding along a beam) is decided by correlation: the
    position is taken in which the analysis explains most of the test shapes. Mirror images are
    not considered, and the scale is that of the declared units.

    Parameters
    ----------
    geometry, test_geometry : Geometry
        With their length units; where one is unknown the two are taken to be in the same unit
        (see `units.reconcile_units`).
    modes : Modes, optional
        Of the analysis; without them and `test_modes`, symmetric geometry stays undecided.
    test_modes : Modes, optional
        On the directions that were measured (see `measured_directions`); only their nodes are
        laid on the model.
    tolerance : float, optional
        Distance from the model, deck length unit, at which a test node still lies on it.
        Default: `observation.default_tolerance`.
    seed : int
        Of the random starts.

    Raises
    ------
    InputError
        Fewer than half of the test nodes can be brought onto the model.
    """
    scale = 1.0
    if geometry.length_unit and test_geometry.length_unit:
        scale = length_factor(test_geometry.length_unit, geometry.length_unit)
    points = scale * _measured_points(test_geometry, test_modes)
    scorer = None
    if modes is not None and test_modes is not None and len(modes) and len(test_modes):
        scorer = scorer_of(geometry, modes, test_geometry, test_modes, scale)
    surface = surface_of(geometry) if scorer is None else scorer.grids.surface
    here = Poses(np.eye(3)[None], np.zeros((1, 3)), np.zeros(1))
    here = replace(here, rms=rms_of(surface, points, here))
    score = None if scorer is None else float(scorer.score(here)[0])
    lies = _share_on(surface, points, here, tolerance) >= ALIGN.on_model
    if lies and (score is None or score >= ALIGN.poor):
        return _as_it_is(surface, points, here, score, scale)
    cloud = cloud_of(surface)
    poses = search(cloud, points, seed)
    if not lies:
        _require_on_model(cloud, points, poses.take(np.array([0])), tolerance, seed)
    choice = choose(cloud, points, scorer, poses)
    best = choice.candidates[0]
    better = ALIGN.good if score is None else max(ALIGN.good, score + ALIGN.ahead)
    if lies and (score is None or best.score is None or best.score < better):
        kept = _as_it_is(surface, points, here, score, scale)
        return replace(kept, warnings=kept.warnings + _said_of_signs(scorer, here, score))
    warnings = choice.warnings + _said_of_signs(scorer, here, best.score)
    if lies:
        warnings += (
            f"the test lies on the model as it is, but its shapes fit poorly there (score "
            f"{score:.2f}) and well in another position ({best.score:.2f}), which was taken; "
            "check the coordinate frame of the test",
        )
    share = _share_on(surface, points, best.pose, tolerance)
    if share < ALIGN.on_model:
        warnings += (
            f"only {share:.0%} of the test nodes lie on the model in the best position (rms "
            f"{best.rms:.3g}); check that both are the same structure"
            + _said_of_mirrored(cloud, points, share, tolerance, seed),
        )
    candidates = tuple(
        Candidate(Transform(c.pose.rotation[0], c.pose.translation[0], scale), c.rms, c.score)
        for c in choice.candidates
    )
    move, told = candidates[0].transform, (choice.ambiguity, choice.decided, warnings)
    return Alignment(
        move.rotation, move.translation, scale, best.rms, "fitted", best.score, candidates, *told
    )


def _measured_points(test_geometry: Geometry, test_modes: Modes | None) -> Floats:
    """Different positions of the nodes that were measured, (n, 3)."""
    xyz = test_geometry.xyz
    if test_modes is not None and len(test_modes.dofs):
        rows = test_geometry.index_of(np.unique(test_modes.dofs.node))
        if np.any(rows < 0):
            lost = np.unique(test_modes.dofs.node)[rows < 0][0]
            raise InputError(
                f"the test measured node {lost}, which its geometry does not define; "
                "add the file with the test's geometry"
            )
        xyz = xyz[rows]
    if not len(xyz):
        raise InputError("the test has no nodes with positions; add the file with its geometry")
    return np.asarray(np.unique(xyz, axis=0))


def _share_on(surface: Surface, points: Floats, pose: Poses, tolerance: float | None) -> float:
    at = place(surface, pose.apply(points)[0])
    limit = default_tolerance(surface, at) if tolerance is None else tolerance
    return float(np.mean(at.distance <= limit))


def _as_it_is(
    surface: Surface, points: Floats, here: Poses, score: float | None, scale: float
) -> Alignment:
    """Keep the frame exactly; say so where a small move would lay the test much closer."""
    warnings: tuple[str, ...] = ()
    rms = float(here.rms[0])
    closer = polish(surface, points, here.rotation, here.translation)
    least = ALIGN.closer_least * surface.size
    if rms > max(ALIGN.closer * closer.rms[0], least):
        moved = np.linalg.norm(closer.apply(points) - points, axis=2).max()
        warnings = (
            f"the test lies on the model within {rms:.3g}, but a move by at most {moved:.3g} would "
            f"bring it to {closer.rms[0]:.3g}; the frame was left as it is",
        )
    candidate = Candidate(Transform(np.eye(3), np.zeros(3), scale), rms, score)
    return Alignment(
        np.eye(3), np.zeros(3), scale, rms, "as it is", score, (candidate,), warnings=warnings
    )


def _said_of_mirrored(
    cloud: Cloud, points: Floats, share: float, tolerance: float | None, seed: int
) -> str:
    """Say that the mirror image of a test lies on the model, where it does and the test does not.

    Mirroring at any plane will do: the others follow by a rotation.
    """
    mirrored = points * np.array([1.0, 1.0, -1.0])
    best = search(cloud, mirrored, seed).take(np.array([0]))
    other = _share_on(cloud.surface, mirrored, best, tolerance)
    if other < ALIGN.on_model or other <= share:
        return ""
    return (
        f"; mirrored, {other:.0%} of the nodes would lie on it: one axis of the test's frame "
        "points the wrong way, or it is the other hand of the structure"
    )


def _said_of_signs(scorer: Scorer | None, here: Poses, score: float | None) -> tuple[str, ...]:
    """Say that the shapes fit where one axis of the test has the other sign, where they do.

    The geometry alone cannot tell where the structure is symmetric.
    """
    if scorer is None or score is None or score >= ALIGN.good:
        return ()
    tried = []
    for k, name in enumerate("xyz"):
        sign = 1.0 - 2.0 * np.eye(3)[k]
        for axis, what in ((scorer.axis, "of its positions"), (scorer.axis * sign, "")):
            other = replace(scorer, node_xyz=scorer.node_xyz * sign, axis=axis)
            tried.append((float(other.score(here)[0]), " ".join((name, what)).strip()))
    best, what = max(tried)
    if best < max(ALIGN.good, score + ALIGN.ahead):
        return ()
    return (
        f"the shapes of the test fit poorly (score {score:.2f}) and would fit with {what} of the "
        f"other sign ({best:.2f}): the geometry of the test seems mirrored",
    )


def _require_on_model(
    cloud: Cloud, points: Floats, best: Poses, tolerance: float | None, seed: int
) -> None:
    surface = cloud.surface
    share = _share_on(surface, points, best, tolerance)
    if share < ALIGN.fewest:
        raise InputError(
            f"the test does not fit on the model in any position: in the best only {share:.0%} of "
            f"its {len(points)} nodes lie on it (rms distance {best.rms[0]:.3g}; the model spans "
            f"{surface.size:.4g}, the test {np.linalg.norm(np.ptp(points, axis=0)):.4g}); check "
            "the length units of deck and test, and that both are the same structure"
            + _said_of_mirrored(cloud, points, share, tolerance, seed)
        )
