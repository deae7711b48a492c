"""A modal test of the truth: sensors, noise, faults, and the universal file."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from .calculix import Modes
from .mesh import Floats, Ints, Mesh, Structure
from .truth import Truth

Entry = dict[str, Any]


@dataclass(frozen=True)
class Noise:
    """Scatter of shapes (of their rms), gains and frequencies (relative), and positions [mm]."""

    shape: float = 0.02
    gain: float = 0.01
    frequency: float = 0.001
    position: float = 1.0

    def times(self, factor: float) -> Noise:
        """Return so many times the scatter of what is measured; positions stay as good."""
        return Noise(
            factor * self.shape, factor * self.gain, factor * self.frequency, self.position
        )

    def of_a_real_test(self, rng: np.random.Generator) -> Noise:
        """Return the scatter of a poor survey: a MAC of 0.9 with itself, frequencies to 0.5 %."""
        shape, gain, frequency = rng.uniform((0.15, 0.02, 0.001), (0.35, 0.05, 0.005))
        return Noise(float(shape), float(gain), float(frequency), 5.0 * self.position)


@dataclass(frozen=True, eq=False)
class Test:
    """A measured survey in the deck's frame: labels, xyz [mm], shapes (sensor, 3, mode).

    `directions` (sensor, channel, 3) is what each measures along.
    """

    labels: Ints
    xyz: Floats
    nodes: Ints
    hz: Floats
    damping: Floats
    shapes: Floats
    directions: Floats


def sensors(s: Structure, m: Mesh, truth: Mesh, rng: np.random.Generator) -> Ints:
    """Return random corner nodes that the truth has, a fortieth of the structure apart."""
    held = np.union1d(m.clamped, truth.clamped)
    free = rng.permutation(np.setdiff1d(np.intersect1d(m.corners, truth.used), held))
    wanted = int(rng.integers(*s.sensors))
    chosen: list[int] = []
    for node in free:
        gap = np.linalg.norm(m.xyz[chosen] - m.xyz[node], axis=1) if chosen else np.array([np.inf])
        if gap.min() > s.size / 40.0:
            chosen.append(int(node))
        if len(chosen) == wanted:
            break
    return np.array(sorted(chosen))


def channels(s: Structure, m: Mesh, nodes: Ints) -> Floats:
    """Return unit directions (sensor, channel, 3) of what each sensor measures."""
    if s.axes == "normal":
        p = m.normals()[nodes]
        lost = np.linalg.norm(p, axis=1) < 0.5
        p[lost] = (0.0, 0.0, 1.0)
        return p[:, None, :]
    rows = np.eye(3)[["xyz".index(c) for c in s.axes]]
    return np.tile(rows, (nodes.size, 1, 1))


def damped(t: Truth, modes: Modes, ratios: Floats) -> tuple[Floats, Floats, Any]:
    """Return frequencies [Hz], damping ratios and the modes on the undamped ones, with dashpots.

    The quadratic eigenproblem in the basis of the normal modes; a structure without dashpots
    keeps its own, real.
    """
    n, omega = modes.hz.size, 2.0 * np.pi * modes.hz
    if not t.dampers:
        return modes.hz, ratios, np.eye(n)
    u = np.array([np.sqrt(b) * modes.shapes[node, c - 1] for node, c, b in t.dampers])
    D = u.T @ u + np.diag(2.0 * ratios * omega)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(omega**2), -D]])
    poles, vectors = np.linalg.eig(A)
    up = np.flatnonzero(poles.imag > 0.0)
    order = up[np.argsort(np.abs(poles[up]))][:n]
    poles, Q = poles[order], vectors[:n, order]
    if order.size < n:
        raise ValueError("a dashpot so large that a mode does not swing is no local damper")
    length = np.sqrt(np.sum(Q**2, axis=0))
    return np.abs(poles) / (2.0 * np.pi), -poles.real / np.abs(poles), Q / length


def merged(runs: list[Modes], parts: list[Ints]) -> Modes:
    """Return what is put together of runs that each measured a part of the nodes.

    Each mode of the first run takes its partner of the largest MAC over all nodes from every
    other one, turned to the same sign; frequencies are the means.
    """
    first = runs[0]
    flat = np.nan_to_num(first.shapes).reshape(-1, first.hz.size)
    hz, shapes = first.hz.copy(), first.shapes.copy()
    for run, part in zip(runs[1:], parts[1:], strict=True):
        other = np.nan_to_num(run.shapes).reshape(flat.shape)
        alike = flat.T @ other / np.linalg.norm(flat, axis=0)[:, None]
        _, partner = linear_sum_assignment(-np.abs(alike / np.linalg.norm(other, axis=0)))
        sign = np.sign(alike[np.arange(hz.size), partner])
        shapes[part] = run.shapes[part][:, :, partner] * sign
        hz += run.hz[partner]
    return Modes(hz / len(runs), shapes)


def measure(
    s: Structure,
    m: Mesh,
    nodes: Ints,
    t: Truth,
    modes: Modes,
    noise: Noise,
    rng: np.random.Generator,
) -> Test:
    """Measure the truth; shapes are complex where dashpots make them so."""
    d = channels(s, m, nodes)
    n = modes.hz.size
    gains = 1.0 + noise.gain * rng.standard_normal(d.shape[:2])
    errors = noise.shape * rng.standard_normal((*d.shape[:2], n))
    signs = rng.choice([-1.0, 1.0], size=n)
    start = int(rng.choice([1, 101, 1001]))
    xyz = m.xyz[nodes] + noise.position * rng.standard_normal((nodes.size, 3))
    scatter = 1.0 + noise.frequency * rng.standard_normal(n)
    hz, ratios, turn = damped(t, modes, rng.uniform(0.002, 0.012, n))
    y = np.einsum("sci,sim->scm", d, modes.shapes[nodes]) @ turn
    rms = np.sqrt(np.mean(np.abs(y) ** 2, axis=(0, 1)))
    if np.iscomplexobj(y):
        errors = errors + 1j * noise.shape * rng.standard_normal(errors.shape)
        signs = np.exp(2j * np.pi * rng.random(n))
    y = (y * gains[:, :, None] + errors * rms) * signs
    return Test(
        start + np.arange(nodes.size),
        xyz,
        nodes,
        hz * scatter,
        ratios,
        np.einsum("sci,scm->sim", d, y),
        d,
    )


def _loud(test: Test) -> Ints:
    level = np.sum(np.abs(test.shapes) ** 2, axis=(1, 2))
    return np.flatnonzero(level > np.median(level) * 0.5)


def fault(
    test: Test, m: Mesh, kind: str, rng: np.random.Generator, hurt: set[int]
) -> tuple[Test, Entry]:
    """Return the test with one more fault, at sensors that move and are not in `hurt`."""
    y = test.shapes.copy()
    candidates = [int(i) for i in _loud(test) if int(i) not in hurt]
    i = int(rng.choice(candidates))
    entry: Entry = {
        "kind": kind,
        "sensor": i,
        "node": int(test.labels[i]),
        "xyz": m.xyz[test.nodes[i]].tolist(),
    }
    if kind == "sensor_polarity":
        y[i] *= -1.0
    elif kind == "sensor_gain":
        factor = float(rng.choice([0.5, 0.6, 1.5, 1.8]))
        y[i] *= factor
        entry["factor"] = factor
    elif kind == "sensor_axis":
        angle = float(rng.choice([30.0, 45.0, 90.0]))
        c, q = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        y[i] = np.array([[c, q, 0.0], [-q, c, 0.0], [0.0, 0.0, 1.0]]) @ y[i]
        entry["angle_deg"] = angle
    elif kind == "sensor_swap":
        flat = y.reshape(y.shape[0], -1)
        unit = flat / np.linalg.norm(flat, axis=1)[:, None]
        alike = np.abs(unit @ unit[i].conj())
        others = [j for j in candidates if j != i and alike[j] < 0.6]
        j = int(rng.choice(others or [k for k in candidates if k != i]))
        d = test.directions[[i, j]]
        read = np.einsum("sci,sim->scm", d, y[[i, j]])
        y[[i, j]] = np.einsum("sci,scm->sim", d, read[::-1])
        entry |= {"other": j, "other_node": int(test.labels[j])}
        hurt.add(j)
    hurt.add(i)
    return replace(test, shapes=y), entry


def _block(number: int, body: str) -> str:
    return f"    -1\n{number:6d}\n{body}    -1\n"


def _parts(vector: Any) -> list[float]:
    """Return the values of one node as a file holds them: real, or real and imaginary in turn."""
    if np.iscomplexobj(vector):
        return [float(v) for z in vector for v in (z.real, z.imag)]
    return [float(v) for v in vector]


def write_test(path: Path, s: Structure, test: Test, rotation: Floats, shift: Floats) -> None:
    """Write datasets 151, 164, 15 and 55 in metres; positions are 0.001·(R·x + shift)."""
    stamp = "01-Jan-26 00:00:00"
    out = _block(
        151,
        f"{s.title}\nmodal test\nmodal\n{stamp}           0         0         0\n"
        f"{stamp}\nmodal\n{stamp}\n",
    )
    one = "   1.0000000000000000D+00"
    out += _block(
        164,
        f"{1:10d}{'  SI: Meter (newton)':20s}{1:10d}\n{one * 3}\n   2.7314999999999998D+02\n",
    )
    place = 1e-3 * (test.xyz @ rotation.T + shift)
    out += _block(
        15,
        "".join(
            f"{label:10d}{0:10d}{0:10d}{11:10d}{p[0]:13.5E}{p[1]:13.5E}{p[2]:13.5E}\n"
            for label, p in zip(test.labels, place, strict=True)
        ),
    )
    y = 1e-3 * np.einsum("ij,sjm->sim", rotation, test.shapes)
    swings = np.iscomplexobj(y)
    for k, (hz, zeta) in enumerate(zip(test.hz, test.damping, strict=True)):
        head = f"{s.title}\nmode {k + 1}\nNONE\nNONE\nNONE\n"
        if swings:
            omega = 2.0 * np.pi * hz
            kind, facts = (1, 3, 2, 12, 5, 3), (2, 6, 1, k + 1)
            values = (-zeta * omega, omega * np.sqrt(1.0 - zeta**2), 1.0, 0.0, 1.0, 0.0)
        else:
            kind, facts = (1, 2, 2, 12, 2, 3), (2, 4, 1, k + 1)
            values = (hz, 1.0, zeta, 0.0)
        head += "".join(f"{v:10d}" for v in kind) + "\n"
        head += "".join(f"{v:10d}" for v in facts) + "\n"
        head += "".join(f"{v:13.5e}" for v in values) + "\n"
        rows = "".join(
            f"{label:10d}\n" + "".join(f"{v:13.5e}" for v in _parts(vector)) + "\n"
            for label, vector in zip(test.labels, y[:, :, k], strict=True)
        )
        out += _block(55, head + rows)
    path.write_text(out)
