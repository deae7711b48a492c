"""The structure as a picture: shaded mesh, sensors on it, effects at their place."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ....core.arrays import Bools, Floats, Ints
from ....core.data.geometry import Geometry
from ....core.results.paired_shapes import DrawnMesh
from ..html.markup import centred, esc, short, svg, svg_text, tag
from .colour import STEPS
from .seen_surface import View, coarsened, depth_buffer, isometric, surface, with_neighbours

_SHADES = 6
_SLICES = 48
_PALEST = 3
"""Step of the ramp below which a line on the page would not be seen."""
_LIGHT = np.array([0.35, -0.55, 0.76])


@dataclass(frozen=True, eq=False)
class Mark:
    """Something at a place: `role` is the style (``sensor``, ``effect``, ``credible``, ``fault``).

    `axes` (n, 3) are directions drawn as ticks; `value` 0..1 colours the mark; `text` is written
    beside it, `note` appears on hover; `name` is what it is called (a sensor's node).
    """

    xyz: Floats
    role: str
    note: str = ""
    text: str = ""
    axes: Floats | None = None
    value: float | None = None
    name: str = ""


def scene(
    geometry: Geometry,
    title: str,
    *,
    marks: Sequence[Mark] = (),
    values: Floats | None = None,
    width: int = 510,
    height: int = 480,
    most: int = 1500,
    behind: bool = True,
) -> str:
    """Return a figure of the structure from the front, and from behind where that shows more.

    Parameters
    ----------
    geometry : Geometry
        Drawn coarser where it has more than about `most` faces and lines.
    title : str
    marks : sequence of Mark
        Drawn over it; faint where the structure hides them.
    values : (n_node,) float, optional
        0..1 by node of the geometry, NaN unknown: colours the faces.
    width, height : int
        Pixels of one view.
    most : int
        Faces and lines drawn at most in one view, about.
    behind : bool
        Whether there may be a view from behind.
    """
    if not len(geometry.ids):
        return ""
    fine = surface(geometry)
    marks = _nearby(marks, fine)
    told = f"{title}: {len(geometry.ids)} nodes, {len(marks)} marks"
    shots = [_shot(fine, isometric(), marks, most)]
    if behind and not shots[0].visible.all():
        shots.append(_shot(fine, isometric(behind=True), marks, most))
    elsewhere = np.any([s.visible for s in shots], axis=0)
    names = ["from the front", "from behind"] if len(shots) > 1 else [""]
    size, pictures = (width, height), []
    for shot, name in zip(shots, names, strict=True):
        shown = [m.role != "sensor" or v or not e
                 for m, v, e in zip(marks, shot.visible, elsewhere, strict=True)]  # fmt: skip
        label = ", ".join(t for t in (told, name) if t)
        pictures.append(_picture(fine, shot, size, label, marks, shown, values, name))
    caption = tag("figcaption", tag("b", esc(title)))
    return tag("figure", caption, tag("div", *pictures, class_="row"))


def still(mesh: DrawnMesh, title: str, values: Floats, width: int = 480, height: int = 420) -> str:
    """Return one view of a mesh, its faces coloured by values of 0..1 at its rows."""
    plain = replace(mesh, node_of=np.arange(len(mesh.xyz)))
    shot = _shot(plain, isometric(), [], len(mesh.faces) + len(mesh.lines))
    return _picture(plain, shot, (width, height), title, values=values)


@dataclass(frozen=True, eq=False)
class _Shot:
    """What is seen in one view: the mesh without its hidden faces, and which of the marks."""

    view: View
    mesh: DrawnMesh
    visible: Bools


def _shot(fine: DrawnMesh, view: View, marks: Sequence[Mark], most: int) -> _Shot:
    mesh = coarsened(fine, 2 * most)
    projected = view.project(mesh.xyz)
    buffer, seen = depth_buffer(projected, mesh.faces)
    slack = 0.02 * fine.size
    if mesh is not fine:  # what was clustered leaves gaps beside what it hides
        seen = with_neighbours(seen, mesh)
    lit = buffer.sees(projected[mesh.lines].mean(axis=1), slack)
    mesh = coarsened(replace(mesh, faces=mesh.faces[seen], lines=mesh.lines[lit]), most)
    at = np.array([m.xyz for m in marks]).reshape(-1, 3)
    return _Shot(view, mesh, buffer.sees(view.project(at), slack))


def _picture(
    fine: DrawnMesh,
    shot: _Shot,
    size: tuple[int, int],
    label: str,
    marks: Sequence[Mark] = (),
    shown: Sequence[bool] = (),
    values: Floats | None = None,
    name: str = "",
) -> str:
    view = shot.view
    page = _Page.around(view.project(fine.xyz), marks, view, *size)
    drawn = [
        (visible, _mark(mark, view, page, fine.size))
        for mark, visible, show in zip(marks, shot.visible, shown, strict=True)
        if show
    ]
    kind = "coarse mesh" if len(shot.mesh.xyz) < len(fine.xyz) else "mesh"
    body = tag("g", _mesh(shot.mesh, view, page, values), class_=kind)
    hidden = "".join(m for visible, m in drawn if not visible)
    body += tag("g", hidden, class_="hidden") if hidden else ""
    body += "".join(m for visible, m in drawn if visible) + _triad(view, page)
    body += svg_text(4, 12, name) if name else ""
    return svg("scene", (page.width, page.height), label, body)


def _nearby(marks: Sequence[Mark], mesh: DrawnMesh) -> list[Mark]:
    """Return the marks that are on the picture at all: within a size of the structure."""
    middle = (mesh.xyz.min(axis=0) + mesh.xyz.max(axis=0)) / 2.0
    reach = 1.5 * mesh.size if mesh.size > 0.0 else np.inf
    return [m for m in marks if np.linalg.norm(m.xyz - middle) <= reach]


@dataclass(frozen=True, eq=False)
class _Page:
    scale: float
    shift: Floats
    width: int
    height: int

    @classmethod
    def around(
        cls, projected: Floats, marks: Sequence[Mark], view: View, width: int, height: int
    ) -> Self:
        points = projected[:, :2]
        if marks:
            points = np.vstack([points, view.project(np.array([m.xyz for m in marks]))[:, :2]])
        low, extent = points.min(axis=0), np.maximum(np.ptp(points, axis=0), 1e-30)
        room = np.array([width - 48.0, height - 48.0])
        scale = float((room / extent).min())
        needed = extent * scale + 48.0
        return cls(scale, 24.0 - low * scale, int(max(needed[0], 120)), int(needed[1]) + 34)

    def at(self, projected: Floats) -> Floats:
        return np.asarray(projected[..., :2] * self.scale + self.shift)


def _mesh(mesh: DrawnMesh, view: View, page: _Page, values: Floats | None) -> str:
    """Painter's order by slices of depth, one path a slice and colour; units of half a pixel."""
    if not len(mesh.faces) + len(mesh.lines):
        return ""
    projected = view.project(mesh.xyz)
    pixels = np.rint(page.at(projected) * 2.0).astype(np.int64)
    shapes = [pixels[_corners(face)] for face in mesh.faces] + [pixels[line] for line in mesh.lines]
    classes = [*_face_classes(mesh, values), *_line_classes(mesh, values)]
    depth = np.concatenate([projected[e, 2].mean(axis=1) for e in (mesh.faces, mesh.lines)])
    depth[len(mesh.faces) :] -= 0.004 * mesh.size
    order = np.argsort(-depth)
    slices = np.floor((depth.max() - depth) / max(np.ptp(depth), 1e-300) * _SLICES)
    painted: dict[tuple[float, str], str] = {}
    for k in order:
        key = (slices[k], classes[k])
        end = "" if classes[k].startswith("~bar") else "z"
        painted[key] = painted.get(key, "") + _outline(shapes[k]) + end
    paths = "".join(
        f'<path class="{name.lstrip("~")}" d="{d}"/>' for (_, name), d in sorted(painted.items())
    )
    return f'<g transform="scale(.5)">{paths}</g>'


def _corners(face: Ints) -> Ints:
    return face[:3] if face[3] == face[2] else face


def _outline(pixels: Ints) -> str:
    steps = np.diff(pixels, axis=0).tolist()
    rest = "".join(f"{'' if x < 0 else ' '}{x}{'' if y < 0 else ' '}{y}" for x, y in steps)
    return f"M{pixels[0, 0]} {pixels[0, 1]}l{rest.strip()}"


def _face_classes(mesh: DrawnMesh, values: Floats | None) -> list[str]:
    corners = mesh.xyz[mesh.faces]
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    flat = np.linalg.norm(normal, axis=1) == 0.0
    normal[flat] = np.cross(
        corners[flat, 1] - corners[flat, 0], corners[flat, 2] - corners[flat, 0]
    )
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    lit = np.abs(normal @ (_LIGHT / np.linalg.norm(_LIGHT))) / length
    shade = np.minimum((lit * _SHADES).astype(int), _SHADES - 1)
    if values is None:
        return [f"f{s}" for s in shade]
    step = _steps(mesh, values, mesh.faces)
    return [f"c{c}" if c >= 0 else f"f{s}" for c, s in zip(step, shade, strict=True)]


def _line_classes(mesh: DrawnMesh, values: Floats | None) -> list[str]:
    if values is None:
        return ["~bar"] * len(mesh.lines)
    steps = _steps(mesh, values, mesh.lines)
    return [f"~bar k{max(c, _PALEST)}" if c >= 0 else "~bar" for c in steps]


def _steps(mesh: DrawnMesh, values: Floats, cells: Ints) -> Ints:
    """Return the step of the ramp of faces or lines, the mean of their nodes; −1 unknown."""
    coloured = _node_means(mesh, values)[cells]
    known = np.isfinite(coloured)
    mean = np.nan_to_num(coloured).sum(axis=1) / np.maximum(known.sum(axis=1), 1)
    step = np.clip((mean * STEPS).astype(int), 0, STEPS - 1)
    return np.asarray(np.where(known.any(axis=1), step, -1))


def _node_means(mesh: DrawnMesh, values: Floats) -> Floats:
    known = np.isfinite(values)
    rows, n = mesh.node_of[known], len(mesh.xyz)
    total = np.bincount(rows, weights=values[known], minlength=n)
    count = np.bincount(rows, minlength=n)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _mark(mark: Mark, view: View, page: _Page, size: float) -> str:
    x, y = page.at(view.project(mark.xyz[None, :]))[0]
    body = tag("title", esc(mark.note)) if mark.note else ""
    if mark.axes is not None and len(mark.axes):
        tips = page.at(view.project(mark.xyz[None, :] + 0.028 * size * mark.axes))
        d = "".join(f"M{short(x)} {short(y)}L{short(u)} {short(v)}" for u, v in tips)
        body += tag("path", d=d)
    radius = {"effect": 11.0, "fault": 9.0, "credible": 3.2}.get(mark.role, 2.6)
    colour = None
    if mark.value is not None:
        colour = f"c{min(int(np.clip(mark.value, 0.0, 1.0) * STEPS), STEPS - 1)}"
        radius = 4.0
    body += tag("circle", cx=short(x), cy=short(y), r=radius, class_=colour)
    if mark.text:
        body += centred(x, y + 4, mark.text)
    return tag("g", body, class_=f"hot {mark.role}")


def _triad(view: View, page: _Page) -> str:
    origin = np.array([30.0, page.height - 30.0])
    arrows = ""
    for name, axis in zip("xyz", view.project(np.eye(3))[:, :2] * 22.0, strict=True):
        tip, end = origin + axis, origin + 1.32 * axis
        line = "L".join(f"{short(u)} {short(v)}" for u, v in (origin, tip))
        arrows += tag("path", d=f"M{line}")
        arrows += centred(end[0], end[1] + 3.5, name)
    return tag("g", arrows, class_="triad")
