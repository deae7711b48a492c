"""Straight bars of constant section: CBAR."""

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.lines.bar import bar_mass, bar_stiffness
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Known
from ...deck.field_values import Fields, take
from ...deck.movable_values import Doubt, Moves, Read, Variable, after
from ...properties.cross_sections import dimension_count, dimensions, section
from ...properties.materials import isotropic
from ..element_group import Context, Group, Key
from .line_elements import Lines, line_groups


def _section(fields: Fields, card: Known) -> tuple[object, ...]:
    """DIM1, DIM2, ... of the section, then NSM."""
    dim = dimensions(fields, 9, card["type"])
    return dim, take(fields, 9 + len(dim), "NSM:r=0.")


_CBAR = (
    "EID:i! PID:i=EID GA,GB>nodes:i! X1,X2,X3>x:ir OFFT:iw=GGG / PA:i PB:i "
    "W1A,W2A,W3A>wa:r=0. W1B,W2B,W3B>wb:r=0."
)


def _find(name: str, read: Read) -> int | None:
    """Position of DIM1..DIMn and NSM, from the second line on."""
    count = dimension_count(read(5))
    if name == "NSM":
        return after(12, count) if count else None
    number = int(name.removeprefix("DIM"))
    return after(12, number - 1) if number <= count else None


_DIMENSIONS = tuple(f"DIM{n}" for n in range(1, 11))
_NAMES = (*_DIMENSIONS, "NSM")

CARDS = (
    Card(
        "CBAR",
        _CBAR,
        "eid",
        blanks_from="BAROR",
        elements="bar",
        properties="PBAR PBARL",
        moves=Moves(),
    ),
    Card("BAROR", "- PID:i - - X1,X2,X3>x:ir OFFT:iw"),
    Card(
        "PBAR",
        "PID:i! MID:i! A:r=0. I1:r=0. I2:r=0. J:r=0. NSM:r=0. - / "
        "C1,C2,D1,D2,E1,E2,F1,F2>points:r=0. / K1:r K2:r I12:r=0.",
        "pid",
        space="bar property",
        moves=Moves(
            also={"AREA": "A", "I11": "I1", "I22": "I2"},
            linear=("A", "I1", "I2", "I12", "J", "NSM"),
            doubt=Doubt(("I1", "I2"), 0.4, 0.25, 4.0, binding="I12"),
        ),
    ),
    Card(
        "PBARL",
        "PID:i! MID:i! GROUP:w=MSCBML0 TYPE:w!",
        "pid",
        space="bar property",
        more=_section,
        extra="dim nsm",
        moves=Moves(linear=("NSM",), variable=Variable(_NAMES, _NAMES.__contains__, _find)),
    ),
)

_MASS = 9  # columns of a bar's constants, after E, G, A, I1, I2, I12, J, K1, K2: mass and inertia


def bars(context: Context) -> list[Group]:
    """Make the groups of CBAR."""

    def make(
        bulk: Bulk,
        keys: list[Key],
        position: Ints,
        at: Lines,
        extra: Floats | float,
        wanted: tuple[bool, bool],
    ) -> Matrices:
        c = np.array([_constants(bulk, key) for key in keys])[position].T
        ends, K, M = (at.xa, at.xb, at.v), None, None
        if wanted[0]:
            E, G, A, I1, I2, I12, J, k1, k2 = c[:_MASS]
            pins = at.pins[:, :6], at.pins[:, 6:]
            K = bar_stiffness(*ends, E, G, A, I1, I2, I12, J, k1, k2, *pins)
        if wanted[1]:
            spin = c[_MASS + 1] if context.settings.bars_spin else None
            M = bar_mass(*ends, c[_MASS] + extra, context.settings.coupled, spin)
        return K, M

    return line_groups(context, "CBAR", make)


def _constants(bulk: Bulk, key: Key) -> list[float]:
    place = bulk.place(*key)
    card = bulk.table(key[0])[key[1]]
    E, G, _, rho = isotropic(bulk, card.mid, place)
    if key[0] == "PBARL":
        s = section(card.type, card.dim, place)
        sheared = s.I12 == 0.0
        k1, k2 = (s.K1, s.K2) if sheared else (0.0, 0.0)
        line = (rho * s.A + card.nsm, rho * (s.I1 + s.I2))
        return [E, G, s.A, s.I1, s.I2, s.I12, s.J, k1, k2, *line]
    values = [card.a, card.i1, card.i2, card.i12, card.j]
    A, I1, I2, I12, _ = values  # K1 and K2 do not count beside an I12 (Quick Reference, PBAR)
    if min(A, I1, I2) < 0.0 or I12**2 > I1 * I2 * (1.0 + 1e-9):
        raise place.error("its area and inertias are not those of a real section")
    k1, k2 = (0.0 if k is None or I12 != 0.0 else k for k in (card.k1, card.k2))
    return [E, G, *values, k1, k2, rho * A + card.nsm, rho * (I1 + I2)]
