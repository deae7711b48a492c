"""A joint that gives: the end of a beam that is not rigidly connected."""

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints
from ..reduction.elements_and_supports import Members, Structure, unit, used
from ..reduction.reduction_numbers import REDUCTION
from .candidates import Candidates
from .effect_kind import STIFFNESS, EffectKind, Scale
from .effect_laws import ReleaseLaw
from .effect_numbers import EFFECTS


def _places(structure: Structure, scale: Scale) -> tuple[Candidates, ...]:
    """Give each beam end that meets others a finite rotational stiffness, all axes alike."""
    beams = [m for m in structure.members if m.element.dimension == 1 and m.element.freedoms == 6]
    ends = _joints(structure, beams)
    roots, own, xyz, where, elastic = [], [], [], [], []
    p = structure.model.deck_point
    for m, chosen in zip(beams, ends, strict=True):
        if not len(chosen):
            continue
        Q, D = _turning(m.stiffness(chosen[:, 0], p), chosen[:, 1])
        d, R = np.linalg.eigh(D)
        stiff = d[:, 0] > REDUCTION.free * d[:, -1]
        if not stiff.any():
            continue
        chosen, Q, d, R = chosen[stiff], Q[stiff], d[stiff], R[stiff]
        rows, ends = chosen.T
        elastic.append(np.zeros((*d.shape, len(p))))
        for k in range(len(p)):
            slope = _turning(m.slope(rows, p, k), ends)[1]
            elastic[-1][:, :, k] = np.einsum("nia,nij,nja->na", R, slope, R) / d
        roots.append(_rows(np.matmul(Q, R), m.coordinates(rows), structure))
        own.append(d)
        grids = m.corners[rows, ends]
        xyz.append(structure.model.geometry.xyz[grids])
        numbers = structure.model.geometry.ids[grids].tolist()
        where += [
            {"grids": [g], "elements": [e], "components": [4, 5, 6]}
            for g, e in zip(numbers, m.ids[rows].tolist(), strict=True)
        ]
    if not roots:
        return ()
    stiffness = np.concatenate(own)
    typical = float(np.median(np.log(stiffness)))
    made = Candidates(
        kind=KIND,
        xyz=np.concatenate(xyz),
        law=ReleaseLaw(stiffness, np.concatenate(elastic), np.zeros(len(p))),
        trials=(typical + np.log(EFFECTS.joint_trials))[:, None],
        root=sp.vstack(roots).tocsr(),
        rows_each=3,
        where=tuple(where),
        typical=np.array([typical - EFFECTS.joint_softer]),
        spread=np.array([EFFECTS.spring_spread]),
    )
    return (made,)


def _turning(K: Floats, ends: Ints) -> tuple[Floats, Floats]:
    """Return the columns of stiffness (n, m, m) that turn an end, (n, m, 3), and (n, 3, 3)."""
    turning = 6 * ends[:, None] + np.arange(3, 6)
    Q = np.take_along_axis(K, turning[:, None, :], axis=2)
    return Q, np.take_along_axis(Q, turning[:, :, None], axis=1)


def _joints(structure: Structure, beams: list[Members]) -> list[Ints]:
    """Element rows and ends (n, 2) where a beam meets more than its own continuation."""
    n = len(structure.model.geometry.ids)
    count = np.zeros(n, np.int64)
    along: list[list[Floats]] = [[] for _ in range(n)]
    for m in structure.members:
        if m.element.dimension == 1:
            np.add.at(count, m.corners.ravel(), 1)
    for m in beams:
        x = structure.model.geometry.xyz[m.corners]
        for (a, b), direction in zip(m.corners, unit(x[:, 1] - x[:, 0]), strict=True):
            along[a].append(direction)
            along[b].append(-direction)
    kinked = np.array([len(d) == 2 and d[0] @ d[1] > -EFFECTS.straight for d in along])
    kinked &= count == 2
    joint = ((count >= 3) | kinked) & ~used(structure, 2)
    return [np.argwhere(joint[m.corners]) for m in beams]


def _rows(Q: Floats, at: Ints, structure: Structure) -> sp.csr_matrix:
    """Rows (3 n, n_free) of the forces Q (n, m, 3) at the coordinates `at` (n, m)."""
    n, m, k = Q.shape
    rows = np.repeat(np.arange(n * k), m)
    columns = np.repeat(at, k, axis=0).ravel()
    F = sp.csr_matrix(
        (Q.transpose(0, 2, 1).ravel(), (rows, columns)), (n * k, structure.displacement.shape[0])
    )
    return (F @ structure.displacement).tocsr()


KIND = EffectKind(
    name="joint_flexibility",
    label="flexible joint",
    sentence="The joint gives {region} with a rotational stiffness of {size}: it",
    magnitudes=(STIFFNESS,),
    places=_places,
)
