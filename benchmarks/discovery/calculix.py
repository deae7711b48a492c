"""Normal modes by CalculiX: S8R shells, B32R beams of rectangular section.

Both are expanded into quadratic solids by CalculiX, so nothing of the solver under test is in
them. Bars have no Poisson's ratio: their sections are rigid wherever they meet another element,
which with one would stiffen them. A rotational spring is a disc of soft material 1 mm thick whose
two faces are held together in translation (modulus k·L/I, Poisson's ratio nil, so bending and, on
square sections, torsion have the stiffness k); an absorber is a mass point on a SPRING2.
"""

from __future__ import annotations

import hashlib
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .mesh import Floats, Ints, Mesh, Structure
from .truth import Preload, Truth

DISC = 1.0
"""Length of the disc that stands for a rotational spring [mm]."""
WANTED = "*NODE FILE, OUTPUT=2D, NSET=NALL\nU\n"


@dataclass(frozen=True, eq=False)
class Modes:
    """Frequencies [Hz] of the elastic modes and their mass-normalised shapes (node, 3, mode)."""

    hz: Floats
    shapes: Floats


class CalculixError(RuntimeError):
    """CalculiX did not give the modes asked for."""


def _rows(ids: Ints) -> str:
    text = [str(i) for i in ids]
    return "".join(", ".join(text[k : k + 12]) + ",\n" for k in range(0, len(text), 12))


Key = tuple[bool, int, float, float, float, float, float]


def _element_keys(s: Structure, m: Mesh, t: Truth) -> dict[Key, Ints]:
    """Elements by (shell?, group, modulus, thickness, density factor, mass per area, offset)."""
    nq, nb = m.quads.shape[0], m.bars.shape[0]
    group = np.concatenate([m.quad_group, m.bar_group])
    young, thick, dense = np.full(nq + nb, t.modulus), np.ones(nq + nb), np.ones(nq + nb)
    own = np.array([t.factors.get(int(g), 1.0) for g in group])
    young[nq:] *= own[nq:]
    extra, aside = np.zeros(nq + nb), np.zeros(nq + nb)
    for p in t.patches:
        touched = np.concatenate([p.quads, nq + p.bars])
        young[touched] *= p.modulus
        extra[p.quads] += p.mass_per_area
    for f in t.fields:
        young *= _stepped(f.modulus)
        thick *= _stepped(f.thickness)
        dense *= _stepped(f.density)
    thick[:nq] *= own[:nq]
    thick[nq:] = 1.0
    aside[nq:] = [t.eccentric.get(int(k), 0.0) for k in m.bar_line]
    keys: dict[Key, list[int]] = {}
    table = np.round(np.stack([young, thick, dense]), 9)
    for e in range(nq + nb):
        factors = (float(table[0, e]), float(table[1, e]), float(table[2, e]))
        key = (e < nq, int(group[e]), *factors, float(extra[e]), float(aside[e]))
        keys.setdefault(key, []).append(e)
    return {k: np.array(v) for k, v in keys.items()}


def _stepped(factor: Floats | float) -> Floats:
    """Return factors in steps of a four-hundredth, so that many elements share a section."""
    return np.asarray(np.round(400.0 * np.asarray(factor)) / 400.0)


def _discs(s: Structure, m: Mesh, t: Truth) -> tuple[Floats, Ints, list[tuple[int, int, int, int]]]:
    """Return nodes, bars with their ends moved onto discs, and discs (inner, mid, outer, k)."""
    xyz, bars = m.xyz.copy(), m.bars.copy()
    discs: list[tuple[int, int, int, int]] = []
    for k, soft in enumerate(t.soft):
        if soft.ground:
            axis = np.array([0.0, 0.0, 1.0])
            new = np.stack([xyz[soft.node] - d * axis for d in (DISC, DISC / 2)])
            n = xyz.shape[0]
            xyz = np.concatenate([xyz, new])
            discs.append((n, n + 1, soft.node, k))
            continue
        mine = np.flatnonzero((m.bar_line == soft.line) & np.any(bars[:, :2] == soft.node, axis=1))
        if mine.size != 1:
            raise CalculixError(f"line {soft.line} does not end at node {soft.node}")
        row = bars[mine[0]]
        end = 0 if row[0] == soft.node else 1
        axis = xyz[row[1 - end]] - xyz[soft.node]
        axis /= np.linalg.norm(axis)
        n = xyz.shape[0]
        xyz = np.concatenate([xyz, xyz[soft.node] + np.outer([DISC / 2, DISC], axis)])
        bars[mine[0], end] = n + 1
        discs.append((soft.node, n, n + 1, k))
    return xyz, bars, discs


def _input(s: Structure, m: Mesh, t: Truth, modes: int) -> str:
    xyz, bars, discs = _discs(s, m, t)
    nq, nb = m.quads.shape[0], m.bars.shape[0]
    out = ["*NODE, NSET=NALL\n"]
    out += [f"{i + 1}, {p[0]:.8f}, {p[1]:.8f}, {p[2]:.8f}\n" for i, p in enumerate(xyz)]
    if nq:
        out.append("*ELEMENT, TYPE=S8R\n")
        out += [
            f"{e + 1}, " + ", ".join(str(i + 1) for i in q) + "\n" for e, q in enumerate(m.quads)
        ]
    if nb:
        out.append("*ELEMENT, TYPE=B32R\n")
        out += [f"{nq + e + 1}, {b[0] + 1}, {b[2] + 1}, {b[1] + 1}\n" for e, b in enumerate(bars)]
    mat = s.material
    pieces = 0
    swelling = dict(t.preload.strains) if t.preload else {}
    for k, (key, elements) in enumerate(_element_keys(s, m, t).items()):
        shell, group, young, thick, dense, extra, aside = key
        h = s.shells[group] * thick if shell else 0.0
        rho = mat.density * dense + (extra / h if shell else 0.0)
        out.append(
            f"*MATERIAL, NAME=M{k}\n*ELASTIC\n"
            f"{mat.young * young:.9g}, {mat.poisson if shell else 0.0}\n"
        )
        out.append(f"*DENSITY\n{rho:.9g}\n")
        if swelling:
            out.append(f"*EXPANSION\n{swelling.get(group, 0.0):.9g}\n")
        if shell:
            out.append(f"*ELSET, ELSET=E{k}\n{_rows(elements + 1)}")
            out.append(f"*SHELL SECTION, ELSET=E{k}, MATERIAL=M{k}\n{h:.9g}\n")
            continue
        for plane in np.unique(m.plane[elements - nq], axis=0):
            same = elements[np.all(m.plane[elements - nq] == plane, axis=1)]
            name = f"E{k}P{pieces}"
            pieces += 1
            out.append(f"*ELSET, ELSET={name}\n{_rows(same + 1)}")
            out.append(_section(s, group, name, f"M{k}", plane, aside))
    out += _attachments(s, m, t, xyz, discs, nq + nb)
    out.append(_preloaded(m, t.preload, nq + nb) if t.preload else "*STEP\n")
    out.append(f"*FREQUENCY\n{modes}\n{WANTED}*END STEP\n")
    return "".join(out)


def _preloaded(m: Mesh, load: Preload, elements: int) -> str:
    """Return the static step and the head of the next; a free structure is held at three nodes."""
    out = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nNALL, 0.\n*STEP\n*STATIC\n"
    if not m.clamped.size:
        c = m.corners
        a = int(c[np.argmin(m.xyz[c].sum(axis=1))])
        b = int(c[np.argmax(np.linalg.norm(m.xyz[c] - m.xyz[a], axis=1))])
        line = m.xyz[b] - m.xyz[a]
        away = np.linalg.norm(np.cross(m.xyz[c] - m.xyz[a], line), axis=1)
        d = int(c[np.argmax(away)])
        along = int(np.argmax(np.abs(line)))
        normal = int(np.argmax(np.abs(np.cross(line, m.xyz[d] - m.xyz[a]))))
        out += f"*BOUNDARY\n{a + 1}, 1, 3\n"
        out += "".join(f"{b + 1}, {k + 1}, {k + 1}\n" for k in range(3) if k != along)
        out += f"{d + 1}, {normal + 1}, {normal + 1}\n"
    if load.strains:
        out += "*TEMPERATURE\nNALL, 1.\n"
    size = float(np.linalg.norm(load.acceleration))
    if size:
        unit = ", ".join(f"{v / size:.9g}" for v in load.acceleration)
        out = out.replace("*INITIAL", f"*ELSET, ELSET=EALL, GENERATE\n1, {elements}\n*INITIAL", 1)
        out += f"*DLOAD\nEALL, GRAV, {size:.9g}, {unit}\n"
    released = "" if m.clamped.size else "*BOUNDARY, OP=NEW\n"
    return out + f"{WANTED}*END STEP\n*STEP, PERTURBATION\n{released}"


def _section(
    s: Structure, group: int, elset: str, material: str, plane: Floats, aside: float = 0.0
) -> str:
    bar = s.bars[group]
    direction = ", ".join(f"{c:.9g}" for c in plane)
    offset = f", OFFSET1={aside:.6g}" if aside else ""
    return (
        f"*BEAM SECTION, ELSET={elset}, MATERIAL={material}, SECTION=RECT{offset}\n"
        f"{bar.height:.9g}, {bar.width:.9g}\n{direction}\n"
    )


def _attachments(
    s: Structure,
    m: Mesh,
    t: Truth,
    xyz: Floats,
    discs: list[tuple[int, int, int, int]],
    elements: int,
) -> list[str]:
    out: list[str] = []
    e, n = elements, xyz.shape[0]
    held: list[str] = []
    equations: list[str] = []
    grounded = {soft.node for soft in t.soft if soft.ground}
    for inner, mid, outer, k in discs:
        soft = t.soft[k]
        bar_rows = np.flatnonzero(np.any(m.bars[:, :2] == soft.node, axis=1))
        row = bar_rows[0] if soft.ground else bar_rows[m.bar_line[bar_rows] == soft.line][0]
        group = int(m.bar_group[row])
        inertia = 0.5 * (s.bars[group].i1 + s.bars[group].i2)
        e += 1
        out.append(
            f"*ELEMENT, TYPE=B32R, ELSET=DISC{k}\n{e}, {inner + 1}, {mid + 1}, {outer + 1}\n"
        )
        out.append(
            f"*MATERIAL, NAME=DISC{k}\n*ELASTIC\n{soft.stiffness * DISC / inertia:.9g}, 0.\n"
        )
        out.append("*DENSITY\n1.e-15\n" + _section(s, group, f"DISC{k}", f"DISC{k}", m.plane[row]))
        if soft.ground:
            held.append(f"{inner + 1}, 1, 6\n{outer + 1}, 1, 3\n")
        else:
            equations += [f"2\n{outer + 1}, {c}, 1., {inner + 1}, {c}, -1.\n" for c in (1, 2, 3)]
    for k, (node, mass) in enumerate(t.masses):
        e += 1
        out.append(
            f"*ELEMENT, TYPE=MASS, ELSET=MASS{k}\n{e}, {node + 1}\n"
            f"*MASS, ELSET=MASS{k}\n{mass:.9g}\n"
        )
    for k, (node, component, stiffness) in enumerate(t.springs):
        e += 1
        out.append(f"*ELEMENT, TYPE=SPRING1, ELSET=GROUND{k}\n{e}, {node + 1}\n")
        out.append(f"*SPRING, ELSET=GROUND{k}\n{component}\n{stiffness:.9e}\n")
    for k, a in enumerate(t.absorbers):
        n += 1
        p = xyz[a.node]
        out.append(f"*NODE, NSET=ABSORBERS\n{n}, {p[0]:.8f}, {p[1]:.8f}, {p[2]:.8f}\n")
        out.append(f"*ELEMENT, TYPE=SPRING2, ELSET=TUNED{k}\n{e + 1}, {a.node + 1}, {n}\n")
        out.append(f"*SPRING, ELSET=TUNED{k}\n{a.component}, {a.component}\n{a.stiffness:.9e}\n")
        out.append(
            f"*ELEMENT, TYPE=MASS, ELSET=TUNEDM{k}\n{e + 2}, {n}\n"
            f"*MASS, ELSET=TUNEDM{k}\n{a.mass:.9g}\n"
        )
        held += [f"{n}, {c}, {c}\n" for c in (1, 2, 3) if c != a.component]
        e += 2
    out += _links_and_stands(s, t, xyz, e, n)
    freed = set(t.freed)
    for i in m.clamped:
        if int(i) in grounded:
            continue
        held += [f"{i + 1}, {c}, {c}\n" for c in range(1, 7) if (int(i), c) not in freed]
    if equations:
        out.append("*EQUATION\n" + "".join(equations))
    if held:
        out.append("*BOUNDARY\n" + "".join(held))
    return out


def _links_and_stands(s: Structure, t: Truth, xyz: Floats, e: int, n: int) -> list[str]:
    """Return springs between nodes and equipment on stands; elements from e + 1, nodes from n + 1.

    A stand is of bars without mass that are stiff beside everything else.
    """
    out: list[str] = []
    for k, (a, b, stiffness) in enumerate(t.links):
        e += 1
        out.append(f"*ELEMENT, TYPE=SPRINGA, ELSET=LINK{k}\n{e}, {a + 1}, {b + 1}\n")
        out.append(f"*SPRING, ELSET=LINK{k}\n\n{stiffness:.9e}\n")
    for k, stand in enumerate(t.stands):
        middle = xyz[stand.node] + np.array(stand.offset)
        ends = [middle, middle + np.array(stand.arm), middle - np.array(stand.arm)]
        out.append("*NODE, NSET=STANDS\n")
        out += [f"{n + i}, {p[0]:.8f}, {p[1]:.8f}, {p[2]:.8f}\n" for i, p in enumerate(ends, 1)]
        out.append(f"*ELEMENT, TYPE=B31, ELSET=STAND{k}\n")
        pairs = ((stand.node + 1, n + 1), (n + 1, n + 2), (n + 1, n + 3))
        out += [f"{e + i}, {p}, {q}\n" for i, (p, q) in enumerate(pairs, 1)]
        out.append(f"*MATERIAL, NAME=STAND{k}\n*ELASTIC\n{50.0 * s.material.young:.9g}, 0.\n")
        out.append(f"*DENSITY\n1.e-15\n*BEAM SECTION, ELSET=STAND{k}, MATERIAL=STAND{k}, ")
        out.append("SECTION=RECT\n12., 12.\n0.361, 0.527, 0.769\n")
        out.append(f"*ELEMENT, TYPE=MASS, ELSET=STANDM{k}\n{e + 4}, {n + 2}\n{e + 5}, {n + 3}\n")
        out.append(f"*MASS, ELSET=STANDM{k}\n{stand.mass / 2.0:.9g}\n")
        n, e = n + 3, e + 5
    return out


def solve(s: Structure, m: Mesh, t: Truth, cache: Path, modes: int) -> Modes:
    """Return the lowest `modes` elastic modes; what was solved before is read from `cache`.

    Raises
    ------
    CalculixError
        If CalculiX fails or gives fewer modes.
    """
    text = _input(s, m, t, modes + 6)
    store = cache / f"{hashlib.sha256(text.encode()).hexdigest()[:24]}.npz"
    if store.exists():
        with np.load(store) as held:
            return Modes(held["hz"], held["shapes"])
    cache.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=cache) as place:
        folder = Path(place)
        (folder / "truth.inp").write_text(text)
        done = subprocess.run(
            ["ccx", "-i", "truth"],
            cwd=folder,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        frd = folder / "truth.frd"
        if "Job finished" not in done.stdout or not frd.exists():
            raise CalculixError(done.stdout[-1500:])
        hz, shapes = read_frd(frd, m.xyz.shape[0])
    elastic = np.arange(hz.size) > 5 if t.suspended else hz > 0.02 * hz[6]
    hz, shapes = hz[elastic][:modes], shapes[:, :, elastic][:, :, :modes]
    if hz.size < modes or not np.all(np.isfinite(shapes[m.used])):
        raise CalculixError(f"{hz.size} whole elastic modes of {modes}")
    np.savez_compressed(store, hz=hz, shapes=shapes)
    return Modes(hz, shapes)


def read_frd(path: Path, n_node: int) -> tuple[Floats, Floats]:
    """Read frequencies [Hz] and displacement shapes (node, 3, mode) of an ASCII frd file."""
    values: list[float] = []
    shapes: list[Floats] = []
    lines = iter(path.read_text().splitlines())
    current: Floats | None = None
    hz, modal = 0.0, False
    for line in lines:
        if line.startswith("  100CL"):
            modal, hz = "MODAL" in line, float(line[12:24])
        elif line.startswith(" -4  DISP") and modal:
            values.append(hz)
            current = np.full((n_node, 3), np.nan)
        elif line.startswith(" -3") and current is not None:
            shapes.append(current)
            current = None
        elif line.startswith(" -1") and current is not None:
            node = int(line[3:13])
            if node <= n_node:
                current[node - 1] = [float(line[13 + 12 * c : 25 + 12 * c]) for c in range(3)]
    return np.array(values), np.stack(shapes, axis=2)
