"""What of a mesh is seen: outer faces, coarse enough, not hidden."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from hypothesis import given, strategies as st
from hypothesis.extra import numpy as hnp

from trueup.adapters.report.pictures.scene import Mark, scene
from trueup.adapters.report.pictures.seen_surface import (
    _keys,
    coarsened,
    depth_buffer,
    isometric,
    surface,
    with_neighbours,
)
from trueup.core.data.geometry import Geometry
from trueup.core.results.paired_shapes import DrawnMesh


def block(n: int) -> Geometry:
    """A cube of n³ hexahedra."""
    side = np.arange(n + 1)
    xyz = np.stack(np.meshgrid(side, side, side, indexing="ij"), -1).reshape(-1, 3) / n
    at = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    low, high = slice(0, n), slice(1, n + 1)
    ends = [(low, low), (high, low), (high, high), (low, high)]
    hexa = np.stack([at[i, j, k] for k in (low, high) for i, j in ends], -1).reshape(-1, 8)
    return Geometry(np.arange(len(xyz)) + 1, xyz, "mm", {"hexa": hexa})


def sheet(n: int, height: float = 0.0) -> DrawnMesh:
    """A square of n² quads across the line of sight, `height` nearer to the eye."""
    side = np.arange(n + 1) / n
    xyz = np.stack(np.meshgrid(side, side, [-height], indexing="ij"), -1).reshape(-1, 3)
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    faces = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4)
    return DrawnMesh(xyz, faces, np.zeros((0, 2), int), np.arange(len(xyz)), np.arange(len(xyz)))


@pytest.mark.parametrize("n", [1, 2, 5])
def test_a_block_shows_its_outer_faces_only(n: int) -> None:
    assert len(surface(block(n)).faces) == 6 * n**2


@pytest.mark.parametrize(
    ("shape", "corners", "faces"), [("tetra", 4, 4), ("pyramid", 5, 5), ("penta", 6, 5)]
)
def test_every_solid_has_its_faces(shape: str, corners: int, faces: int) -> None:
    xyz = np.random.default_rng(1).normal(size=(corners, 3))
    geometry = Geometry(np.arange(corners), xyz, None, {shape: [np.arange(corners)]})
    found = surface(geometry).faces
    assert len(found) == faces
    assert set(found.ravel()) == set(range(corners))


def test_neighbouring_solids_of_different_shape_hide_their_common_face() -> None:
    xyz = np.random.default_rng(1).normal(size=(9, 3))
    elements = {"hexa": [np.arange(8)], "pyramid": [[4, 5, 6, 7, 8]]}
    assert len(surface(Geometry(np.arange(9), xyz, None, elements)).faces) == 5 + 4


def test_coarse_meshes_keep_within_the_budget_and_on_the_structure() -> None:
    fine = sheet(80)
    coarse = coarsened(fine, 500)
    assert 150 < len(coarse.faces) <= 500
    np.testing.assert_array_equal(coarse.xyz, fine.xyz[coarse.original])
    moved = np.linalg.norm(coarse.xyz[coarse.node_of] - fine.xyz, axis=1)
    assert moved.max() < 0.08 * fine.size
    corners = coarse.xyz[coarse.faces]
    area = 0.5 * np.abs(
        np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])[:, 2]
    )
    assert area.sum() == pytest.approx(1.0, rel=0.1)


@given(hnp.arrays(np.int64, st.tuples(st.integers(0, 12), st.just(4)),
                  elements=st.one_of(st.integers(0, 2), st.integers(0, 2**20))))  # fmt: skip
def test_rows_share_a_key_only_when_equal(rows: np.ndarray[Any, Any]) -> None:
    same = (rows[:, None] == rows[None, :]).all(axis=2)
    keys = _keys(rows)
    np.testing.assert_array_equal(keys[:, None] == keys[None, :], same)


def test_small_meshes_are_drawn_as_they_are() -> None:
    fine = sheet(5)
    assert coarsened(fine, 25) is fine


def test_a_sheet_hides_what_lies_behind_it() -> None:
    near, far = sheet(4, height=1.0), sheet(4)
    xyz = np.vstack([far.xyz, near.xyz])
    faces = np.vstack([far.faces, near.faces + len(far.xyz)])
    buffer, seen = depth_buffer(xyz, faces)
    assert seen.tolist() == [False] * 16 + [True] * 16
    points = np.array([[0.5, 0.5, 0.0], [0.5, 0.5, -1.0], [0.5, 0.5, -2.0]])
    assert buffer.sees(points, 0.01).tolist() == [False, True, True]


def test_the_view_is_a_rotation_with_z_up() -> None:
    for behind in (False, True):
        axes = isometric(behind=behind).axes
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        right, down, _ = isometric(behind=behind).project(np.array([[0.0, 0.0, 1.0]]))[0]
        assert right == pytest.approx(0.0)
        assert down < 0.0
    front, back = isometric().axes[0], isometric(behind=True).axes[0]
    np.testing.assert_allclose(front, -back)


def test_faces_that_cannot_be_seen_are_not_drawn() -> None:
    fine = surface(block(8))
    view = isometric()
    _, seen = depth_buffer(view.project(fine.xyz), fine.faces)
    middle = fine.xyz[fine.faces].mean(axis=1)
    toward = (middle[:, 0] == 1.0) | (middle[:, 1] == 0.0) | (middle[:, 2] == 1.0)
    assert np.all(seen[toward])
    assert np.count_nonzero(seen[~toward]) < 0.25 * np.count_nonzero(~toward)  # at the rim
    svg = scene(block(8), "Block")
    drawn = sum(d.count("z") for d in re.findall(r'<path class="f\d" d="([^"]*)"', svg))
    assert drawn == np.count_nonzero(seen)
    assert "from behind" not in svg


@pytest.mark.parametrize(("role", "faint"), [("sensor", False), ("effect", True)])
def test_what_the_front_hides_is_shown_from_behind(role: str, faint: bool) -> None:
    marks = [Mark(np.array([0.0, 1.0, 0.5]), role), Mark(np.array([1.0, 0.0, 0.5]), "sensor")]
    svg = scene(block(2), "Block", marks=marks)
    assert "from behind" in svg
    front, back = svg.split("<svg")[1:]
    assert ('<g class="hidden">' in front) == faint
    assert '<g class="hidden">' not in back
    assert back.count("<circle") == 1


def test_a_sensor_hidden_from_both_sides_is_shown_faint() -> None:
    svg = scene(block(2), "Block", marks=[Mark(np.array([0.5, 0.5, 0.5]), "sensor")])
    assert svg.count('<g class="hidden"><g class="hot sensor">') == 2


def test_neighbours_share_a_node() -> None:
    mesh = sheet(5)
    chosen = np.zeros(25, bool)
    chosen[12] = True  # the middle one
    inside = np.zeros((5, 5), bool)
    inside[1:4, 1:4] = True
    np.testing.assert_array_equal(with_neighbours(chosen, mesh), inside.ravel())


def test_faces_take_the_colour_of_their_nodes() -> None:
    values = np.where(block(1).xyz[:, 2] > 0.5, 1.0, np.nan)
    svg = scene(block(1), "Block", values=values)
    assert 'class="c19"' in svg
    assert 'class="c19"' not in scene(block(1), "Block")


def test_lines_take_the_colour_of_their_ends_and_are_never_too_pale_to_see() -> None:
    x = [[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]]
    frame = Geometry(np.arange(4), x, None, {"line": [[0, 1], [1, 2], [2, 3]]})
    svg = scene(frame, "Frame", values=np.array([0.0, 0.0, 1.0, 1.0]))
    assert [svg.count(f'class="bar k{k}"') for k in (3, 10, 19)] == [1, 1, 1]


def test_marks_far_off_do_not_shrink_the_structure() -> None:
    away = Mark(np.array([1e9, 0.0, 0.0]), "effect", text="1")
    assert (
        scene(block(1), "Block", marks=[away]).split("aria")[0]
        == (scene(block(1), "Block").split("aria")[0])
    )


def test_a_flat_sheet_and_a_line_can_be_drawn() -> None:
    line = Geometry(
        np.arange(3), [[0, 0, 0], [1, 0, 0], [2, 0, 0]], None, {"line": [[0, 1], [1, 2]]}
    )
    assert scene(line, "Beam").count('class="bar"') >= 1
    point = Geometry([1], [[0.0, 0.0, 0.0]])
    assert "<svg" in scene(point, "Point", marks=[Mark(np.zeros(3), "sensor")])
    assert scene(Geometry(np.zeros(0), np.zeros((0, 3))), "Empty") == ""
