"""Laws that the deck does not know: stress, stiff joints, frequency, errors everywhere."""

from __future__ import annotations

import numpy as np

from ..calculix import Modes
from ..hide import Scene
from ..mesh import Floats, Mesh
from ..truth import Field, Preload, Truth
from .cause import Cause, centres, nodes_of, size


def preload(scene: Scene) -> Cause:
    """Stress the structure: some groups have grown (heat, welding), or it stands under load."""
    s, rng = scene.structure, scene.rng
    groups = [*s.shells, *s.bars]
    if len(groups) > 1 and s.shells:
        group = int(rng.choice(groups))
        strain = size(scene, 1e-5, 5e-4) * float(rng.choice([-1.0, 1.0]))
        entry = {"kind": "preload", "group": s.wording[group], "strain": strain}
        return Cause(scene.mesh, entry, Truth(preload=Preload(strains=((group, strain),))))
    load = 9810.0 * size(scene, 1.0, 60.0) * float(rng.choice([-1.0, 1.0]))
    entry = {"kind": "preload", "acceleration": load}
    return Cause(scene.mesh, entry, Truth(preload=Preload((0.0, 0.0, load))))


def rigid_joints(scene: Scene) -> Cause:
    """Make everything stiffer near where members or panels meet: welds, fillets, gussets."""
    m = scene.mesh
    frame = not m.quads.size
    factor = 1.0 + size(scene, 0.05, 8.0 if frame else 1.0)
    p = centres(m)
    if frame:
        ends = np.concatenate([nodes_of(m, int(k))[[0, -1]] for k in np.unique(m.bar_line)])
    else:
        sharp = np.linalg.norm(_mean_normals(m), axis=1) < 0.9
        ends = np.concatenate([np.flatnonzero(sharp), m.clamped, m.bars.ravel()])
    joints = m.xyz[np.unique(ends)]
    reach = size(scene, 0.01, 0.05 if frame else 0.025) * scene.structure.size
    near = np.array([np.min(np.linalg.norm(joints - c, axis=1)) for c in p]) <= reach
    stiff = np.where(near, factor, 1.0)
    entry = {"kind": "rigid_joints", "factor": factor, "reach": reach}
    return Cause(m, entry, Truth(fields=(Field(stiff),)))


def _mean_normals(m: Mesh) -> Floats:
    """Return the mean of the unit normals at every node: shorter than 1 at an edge or a bend."""
    p = m.xyz[m.quads[:, :4]]
    n = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    n /= np.linalg.norm(n, axis=1)[:, None]
    total, count = np.zeros_like(m.xyz), np.zeros(m.xyz.shape[0])
    np.add.at(total, m.quads.ravel(), np.repeat(n, m.quads.shape[1], axis=0))
    np.add.at(count, m.quads.ravel(), 1.0)
    return np.asarray(total / np.maximum(count, 1.0)[:, None])


def frequency_dependent(scene: Scene) -> Cause:
    """Let the material stiffen with frequency: the modulus is a power of it."""
    power = size(scene, 0.001, 0.06)
    middle = float(np.median(scene.modes.hz))

    def felt(modes: Modes) -> Modes:
        return Modes(modes.hz * (modes.hz / middle) ** (power / 2.0), modes.shapes)

    return Cause(scene.mesh, {"kind": "frequency_dependent", "power": power}, felt=felt)


def model_error(scene: Scene) -> Cause:
    """Be wrong everywhere a little: K = Λ^½ (I + ε E) Λ^½ in modal coordinates (Soize 2000)."""
    return diffuse(scene, size(scene, 0.002, 0.06))


def diffuse(scene: Scene, size: float) -> Cause:
    """Return a model error of a given ε; E is from the Gaussian orthogonal ensemble."""
    n = scene.modes.hz.size + 20
    E = scene.rng.standard_normal((n, n))
    E = size * (E + E.T) / np.sqrt(2.0)

    def felt(modes: Modes) -> Modes:
        k = modes.hz.size
        root = 2.0 * np.pi * modes.hz
        square, Q = np.linalg.eigh(root[:, None] * (np.eye(k) + E[:k, :k]) * root)
        hz = np.sqrt(np.maximum(square, 0.0)) / (2.0 * np.pi)
        return Modes(hz, modes.shapes @ Q)

    return Cause(scene.mesh, {"kind": "model_error", "epsilon": size}, felt=felt)
