"""Bodies of revolution: CTRIAX6 of MSC and NX; CTRAX3, CTRAX6, CQUADX4, CQUADX8 of NX."""

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements import ELEMENTS
from .....core.elements.volumes.solid import rotate_material
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Values
from ...deck.movable_values import Moves
from ...properties.materials import elastic
from ..element_group import Context, Group, Key, check_shape, connected, numbered, with_material

_MAT3 = (
    "MID:i! EX,ETH,EZ>e:r! NUXTH,NUTHZ,NUZX>nu:r=0. RHO:r=0. / - - GZX:r! AX,ATH,AZ>a:r=0. "
    "TREF:r=0. GE:r=0."
)
_BY_PROPERTY = (
    ("CTRAX3", "triax3", "G1,G2,G3"),
    ("CTRAX6", "triax6", "G1,G2,G3,G4,G5,G6"),
    ("CQUADX4", "quadx4", "G1,G2,G3,G4"),
    ("CQUADX8", "quadx8", "G1,G2,G3,G4,G5,G6,G7,G8"),
)

CARDS = (
    Card(
        "CTRIAX6",
        "EID:i! MID:i! G1,G2,G3,G4,G5,G6>nodes:i! TH>theta:r=0.",
        "eid",
        elements="triax6",
    ),
    *(
        Card(
            name,
            f"EID:i! PID:i! {grids}>nodes:i! THETA:r=0.",
            "eid",
            elements=element,
            properties="PSOLID",
        )
        for name, element, grids in _BY_PROPERTY
    ),
    Card("MAT3", _MAT3, "mid", space="material", moves=Moves(linear=("RHO",))),
)

_CORNERS_FIRST = {"CTRIAX6": [0, 2, 4, 1, 3, 5]}
_ROUNDING = 1e-6
_IN_PLANE = np.array([0, 1, 2, 5])
"""Of xx, yy, zz, xy, yz, zx: radial, circumferential (y), axial, shear."""


def axisymmetric(context: Context) -> list[Group]:
    """Make the groups of sections of bodies of revolution."""
    return [g for c in CARDS if c.elements for g in _groups(context, c)]


def _groups(context: Context, definition: Card) -> list[Group]:
    bulk, name = context.bulk, definition.name
    cards = list(bulk.table(name).values())
    if not cards:
        return []
    element = ELEMENTS[definition.elements]
    order = _CORNERS_FIRST.get(name, list(range(element.nodes)))
    ids, nodes, keys, of = connected(
        context, name, cards, [[c.nodes[k] for k in order] for c in cards]
    )
    xyz = context.points.xyz[nodes]
    size = np.ptp(xyz, axis=(0, 1)).max()
    off = (np.abs(xyz[..., 1]) > _ROUNDING * size) | (xyz[..., 0] < -_ROUNDING * size)
    if off.any():
        raise bulk.place(name, int(ids[off.any(axis=1)][0])).fault(
            "does not lie in the x-z plane of the basic system with x, the radius, not negative"
        )
    check_shape(context, name, element, ids, xyz)
    context.notes.append(
        f"{name}: Nastran's law of {element.unknown} is not known; the body moves alike all round"
    )
    theta = np.radians([c.theta for c in cards])

    def matrices(values: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
        used, position = np.unique(of[rows], return_inverse=True)
        found = [_material(values, keys[k], bulk.place(*keys[k])) for k in used]
        C = np.array([m[0] for m in found])[position]
        K = M = None
        if wanted[0]:
            K = element.stiffness(xyz[rows], _turned(C, theta[rows]))
        if wanted[1] and element.mass:
            density = np.array([m[1] for m in found])[position]
            M = element.mass(xyz[rows], density, context.settings.coupled)
        return K, M

    sources, source_of = numbered(with_material(bulk, keys[k]) for k in of)
    return [Group(name, ids, element, nodes, matrices, sources, source_of)]


def _turned(C: Floats, theta: Floats) -> Floats:
    """Elastic matrices (n, 4, 4) of materials turned from x towards z."""
    c, s = np.cos(theta), np.sin(theta)
    axes = np.zeros((len(C), 3, 3))
    axes[:, 0, 0] = axes[:, 2, 2] = c
    axes[:, 0, 2], axes[:, 2, 0], axes[:, 1, 1] = s, -s, 1.0
    return rotate_material(C, axes)[:, _IN_PLANE[:, None], _IN_PLANE]


def _material(bulk: Bulk, key: Key, place: Place) -> tuple[Floats, float]:
    """Elastic matrix (6, 6) with y around the axis, and density."""
    card: Values = bulk.table(key[0])[key[1]]
    orthotropic = bulk.table("MAT3").get(card.mid)
    if orthotropic is None:
        found = elastic(bulk, card.mid, place)
        return found.C, found.rho
    (ex, eth, ez), (nu_xth, nu_thz, nu_zx) = orthotropic.e, orthotropic.nu
    where = bulk.place("MAT3", int(card.mid))
    if not min(ex, eth, ez, orthotropic.gzx) > 0.0:
        raise where.error("every modulus must be positive")
    S = np.diag([1.0 / ex, 1.0 / eth, 1.0 / ez, 1.0, 1.0, 1.0 / orthotropic.gzx])
    for i, j, value in ((0, 1, nu_xth / ex), (1, 2, nu_thz / eth), (2, 0, nu_zx / ez)):
        S[i, j] = S[j, i] = -value
    if not np.linalg.eigvalsh(S[:3, :3])[0] > 0.0:
        raise where.error("NUXTH, NUTHZ and NUZX are not possible with EX, ETH and EZ")
    return np.linalg.inv(S), orthotropic.rho
