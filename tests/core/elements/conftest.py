"""What the element tests share: Nastran's own matrices and a small dense structure."""

from __future__ import annotations

import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

DATA = Path(__file__).resolve().parents[4] / "shared" / "data" / "nastran"
NODES = {"CQUAD4": 4, "CTRIA3": 3, "CHEXA": 8, "CPENTA": 6, "CTETRA": 4}


def _unpacked(column, n):
    K = np.zeros((n, n))
    rows, cols = np.triu_indices(n)
    K[rows, cols] = column[: n * (n + 1) // 2]
    return K + np.triu(K, 1).T


@pytest.fixture(scope="session")
def nx():
    """NX 2412: element matrices in the basic frame by element, positions, connections."""
    path = DATA / "solid_shell_bar" / "static_solid_shell_bar_kelm.op2"
    if not path.exists():
        pytest.skip(f"{path} is not there")
    pytest.importorskip("pyNastran")
    from pyNastran.op2.op2_geom import read_op2_geom

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = read_op2_geom(str(path), debug=None)
    K, M, kind = {}, {}, {}
    for letter, out in (("K", K), ("M", M)):
        table = model.matdicts[letter + "DICT"]
        columns = iter(model.matrices[letter + "ELM"].data.T)
        for k, name in enumerate(table.element_names):
            for j, eid in enumerate(table.eids[k]):
                word = name.split("-")[0]
                per_node = int(table.dof_per_grids[k])
                n = NODES.get(word, 2) * per_node
                matrix = _unpacked(next(columns), n)
                if table.xforms[k] is not None and word != "CROD":
                    T = np.kron(np.eye(n // 3), table.xforms[k][j].T)
                    matrix = T.T @ matrix @ T
                out[int(eid)] = matrix
                kind[int(eid)] = word
    position = {n: g.get_position() for n, g in model.nodes.items()}
    xyz = {e: np.array([position[n] for n in c.node_ids]) for e, c in model.elements.items()}
    thickness_ratio = float(model.properties[4].tst)
    return SimpleNamespace(K=K, M=M, kind=kind, xyz=xyz, shear_ratio=thickness_ratio)


@pytest.fixture(scope="session")
def msc():
    """MSC: displacements and grid point forces of three modes, by element."""
    path = DATA / "all_elements" / "modes_elements.h5"
    if not path.exists():
        pytest.skip(f"{path} is not there")
    import h5py

    pytest.importorskip("pyNastran")
    from pyNastran.bdf.bdf import read_bdf

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = read_bdf(str(path.with_suffix(".bdf")), xref=False, debug=None)
    with h5py.File(path) as f:
        shapes = f["NASTRAN/RESULT/NODAL/EIGENVECTOR"][:]
        forces = f["NASTRAN/RESULT/NODAL/GRID_FORCE"][:]
    domains = {d: k for k, d in enumerate(sorted(set(shapes["DOMAIN_ID"])))}
    u = {
        (int(r["ID"]), domains[r["DOMAIN_ID"]]): [r[c] for c in ("X", "Y", "Z", "RX", "RY", "RZ")]
        for r in shapes
    }
    f = {
        (int(r["EID"]), int(r["ID"]), domains[r["DOMAIN_ID"]]): [
            r[c] for c in ("F1", "F2", "F3", "M1", "M2", "M3")
        ]
        for r in forces
    }
    out = {}
    for eid, element in model.elements.items():
        nodes = [n for n in element.node_ids if n]
        if (eid, nodes[0], 0) not in f or not set(nodes) <= set(model.nodes):
            continue
        modes = range(len(domains))
        out[eid] = SimpleNamespace(
            xyz=np.array([model.nodes[n].xyz for n in nodes]),
            u=np.array([[u[n, k] for k in modes] for n in nodes]).swapaxes(1, 2),
            f=np.array([[f[eid, n, k] for k in modes] for n in nodes]).swapaxes(1, 2),
        )
    return out


def rigid_motions(xyz, rotations):
    """Six rigid motions, (nodes * (6 or 3), 6)."""
    per_node = 6 if rotations else 3
    R = np.zeros((len(xyz), per_node, 6))
    for k in range(3):
        R[:, k, k] = 1.0
        axis = np.eye(3)[k]
        R[:, :3, 3 + k] = np.cross(axis, xyz)
        if rotations:
            R[:, 3 + k, 3 + k] = 1.0
    return R.reshape(-1, 6)


def assemble(n_node, conn, Ke, per_node=6):
    dof = (conn[:, :, None] * per_node + np.arange(per_node)).reshape(len(conn), -1)
    k = dof.shape[1]
    rows, cols = np.repeat(dof, k, axis=1).ravel(), np.tile(dof, (1, k)).ravel()
    return sp.csc_matrix((Ke.ravel(), (rows, cols)), shape=(n_node * per_node,) * 2)


def solve(K, f, fixed, values=0.0):
    """Displacements with `fixed` dofs held at `values`."""
    u = np.zeros(K.shape[0])
    u[fixed] = values
    free = np.setdiff1d(np.arange(K.shape[0]), fixed)
    u[free] = spsolve(K[free][:, free], (f - K @ u)[free])
    return u


def grid(nx, ny, position):
    """Quads of a mapped grid: positions and connections; `position` maps s, t in 0..1."""
    s, t = np.meshgrid(np.linspace(0, 1, nx + 1), np.linspace(0, 1, ny + 1))
    i = np.arange(nx * ny)
    a = i // nx * (nx + 1) + i % nx
    return position(s.ravel(), t.ravel()), np.stack([a, a + 1, a + nx + 2, a + nx + 1], axis=1)


@pytest.fixture(scope="session")
def structure():
    """Small finite-element helpers."""
    return SimpleNamespace(assemble=assemble, solve=solve, grid=grid, rigid_motions=rigid_motions)
