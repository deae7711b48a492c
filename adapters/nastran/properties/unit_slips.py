"""Units that do not go together: what the materials are, and how large the structure is."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import inf, log10
from typing import NamedTuple

from ....core.data.length_units import METRES
from ..deck.read_deck import Deck


class _System(NamedTuple):
    """Pascals, kg/m³, metres and seconds in units that go together; how usual, in decades."""

    name: str
    stress: float
    density: float
    length: float
    usual: float
    time: float = 1.0


_SYSTEMS = (
    _System("mm, t, N", 1e6, 1e12, 1e-3, 0.0),
    _System("m, kg, N", 1.0, 1.0, 1.0, 0.0),
    _System("in, lbf s²/in, lbf", 6894.757, 1.0686896e7, 0.0254, 0.0),
    _System("ft, slug, lbf", 47.880259, 515.37882, 0.3048, 1.0),
    _System("mm, kg, mN", 1e3, 1e9, 1e-3, 1.0),
    _System("mm, kg, kN, ms", 1e9, 1e9, 1e-3, 2.0, 1e-3),
    _System("mm, g, N, ms", 1e6, 1e6, 1e-3, 2.0, 1e-3),
    _System("mm, kgf s²/mm, kgf", 9.80665e6, 9.80665e9, 1e-3, 2.0),
    _System("m, t, kN", 1e3, 1e3, 1.0, 2.0),
    _System("cm, g, dyn", 0.1, 1e3, 1e-2, 2.0),
)
_STRESS = {
    "Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "psf": 47.880259, "psi": 6894.757,
    "ksi": 6.894757e6, "Msi": 6.894757e9,
}  # fmt: skip
_DENSITY = {
    "kg/m³": 1.0, "g/cm³": 1e3, "kg/mm³": 1e9, "t/mm³": 1e12, "lb/in³": 27679.905,
    "lbf s²/in⁴": 1.0686896e7, "slug/ft³": 515.37882, "lb/ft³": 16.018463,
    "N/mm³ (a weight)": 1.0197162e8, "N/m³ (a weight)": 0.10197162,
}  # fmt: skip
_METALS = {"steel": (2.05e11, 7850.0), "aluminium": (7e10, 2700.0), "titanium": (1.12e11, 4430.0)}
"""E [Pa] and density [kg/m³] of what is recognised in any units."""
_OTHERS = (
    (4.5e10, 1770.0), (1.1e11, 8500.0), (2.1e11, 8900.0), (1.2e11, 7200.0), (3e10, 2400.0),
    (1.1e10, 500.0), (1.3e11, 1580.0), (6e10, 1550.0), (3e10, 1900.0), (2.5e9, 1150.0),
    (7e10, 2500.0), (1.6e10, 11300.0), (3.5e11, 3900.0), (4e11, 19000.0), (5e9, 170.0),
)  # fmt: skip
"""Magnesium, brass, nickel, cast iron, concrete, wood, composites, plastics, glass, lead, ..."""
_METAL = (1.15, 1.08)
"""Factors by which E and density of a recognised metal may differ."""
_ORTHOTROPIC = {
    "MAT8": ("a fibre laminate", (8e10, 1750.0), (5.0, 1.3)),
    "MAT9": ("a solid", (8e10, 3500.0), (5.0, 2.7)),
}
"""First modulus and density of other materials, and factors by which they may differ."""
_Kind = tuple[str, tuple[float, float], tuple[float, float]]
_DECADES = (0.1, 10.0, 0.01, 100.0)
"""Factors that a slip of the exponent makes."""
_OTHER_MASS = {"mm, t, N": ("kg", 1000.0), "in, lbf s²/in, lbf": ("lb", 386.0886)}
"""Unit of mass that is often taken for that of a system, and how many of it that is."""
_STEEL = 7850.0
"""Density [kg/m³] by which the size of a concentrated mass is judged."""
_LIKE = (1.6, 1.35)
"""The same of any material that makes sense in a system."""
_SIZE = (3e-3, 500.0)
"""Sizes [m] that no one asks about."""
_USUAL = (0.03, 100.0)
"""Sizes [m] that coordinates in another unit have to make to be told."""
_GRAVITY = {386.0886: "0.00259", 9806.65: "1.02E-4", 9.80665: "0.102", 32.174: "0.0311"}
"""Weight over mass by system, and PARAM WTMASS that makes up for it."""


@dataclass(frozen=True)
class _Slip:
    """What is to be multiplied by `factor` so that all is in `system`; `cost` in decades."""

    what: str
    factor: float
    system: _System
    read: str
    cost: float


def unit_slips(deck: Deck, size: float) -> tuple[str, ...]:
    """Return at most one sentence: the likeliest slip in the units of a deck, and its factor.

    Steel, aluminium and titanium are recognised by E and density together, in any units; where
    no consistent system has both, one of them was typed in another, or PARAM WTMASS is wrong.
    Where time is in ms, frequencies are not in Hz. Then the length unit that goes with the
    materials is held against the one declared and the size of the structure, `size` in deck
    units, and the thickest shell and the concentrated masses against that.
    """
    wtmass = deck.param("WTMASS", 1.0)
    systems: list[_System] = []
    for card, E, rho in _materials(deck):
        kind = _ORTHOTROPIC.get(card.split()[0])
        rho *= wtmass
        fitting = [s for s in _SYSTEMS if _makes_sense(E * s.stress, rho * s.density, kind)]
        told = "" if kind else _wtmass_slip(card, E, rho / wtmass, wtmass, size, fitting)
        if told:
            return (told,)
        if not fitting:
            slip = min(_slips(E, rho, size, kind), key=lambda s: s.cost, default=None)
            if slip:
                return (_said(card, E, rho / wtmass, wtmass, slip),)
            if not kind and (told := _decade_slip(card, E, rho)):
                return (told,)
        elif all(s.time < 1.0 for s in fitting):
            return (_not_in_hertz(card, fitting[0]),)
        systems += fitting
    return (
        _length_slip(deck.length_unit, size, systems)
        or _thickness_slip(deck, size)
        or _mass_slip(deck, size, systems, wtmass)
    )


def _materials(deck: Deck) -> Iterator[tuple[str, float, float]]:
    """Name, first modulus and density of the materials that have both."""
    table = deck.bulk.table
    read = [(f"MAT1 {mid}", card.e, card.rho) for mid, card in table("MAT1").items()]
    read += [(f"MAT8 {mid}", card.e1, card.rho) for mid, card in table("MAT8").items()]
    read += [(f"MAT9 {mid}", card.g[0], card.rho) for mid, card in table("MAT9").items()]
    yield from ((name, E, rho) for name, E, rho in read if (E or 0.0) > 0.0 < (rho or 0.0))


def _near(a: float, b: float, factor: float) -> bool:
    return 1.0 / factor < a / b < factor


def _makes_sense(E: float, rho: float, kind: _Kind | None = None) -> bool:
    if kind:
        _, (modulus, density), (wide, heavy) = kind
        return _near(E, modulus, wide) and _near(rho, density, heavy)
    known = (*_METALS.values(), *_OTHERS)
    return any(_near(E, e, _LIKE[0]) and _near(rho, r, _LIKE[1]) for e, r in known)


def _slips(E: float, rho: float, size: float, kind: _Kind | None = None) -> Iterator[_Slip]:
    known = {kind[0]: kind[1]} if kind else _METALS
    wide, heavy = kind[2] if kind else _METAL
    for metal, (modulus, density) in known.items():
        for stress, pascals in _STRESS.items():
            if not _near(E * pascals, modulus, wide):
                continue
            for unit, kilograms in _DENSITY.items():
                if not _near(rho * kilograms, density, heavy):
                    continue
                read = f"{metal} in {stress} and {unit}"
                for s in _SYSTEMS:
                    cost = s.usual + abs(log10(size * s.length)) if size > 0.0 else s.usual
                    if _near(pascals, s.stress, 1.001):
                        yield _Slip("density", kilograms / s.density, s, read, cost)
                    if _near(kilograms, s.density, 1.001):
                        yield _Slip("E", pascals / s.stress, s, read, cost)


def _said(card: str, E: float, rho: float, wtmass: float, slip: _Slip) -> str:
    weight = next((w for g, w in _GRAVITY.items() if _near(slip.factor * g, 1.0, 1.01)), None)
    remedy = f"in {slip.system.name} its {slip.what} is to be multiplied by {slip.factor:.3g}"
    if slip.what == "density" and weight and wtmass == 1.0:
        remedy = f"PARAM,WTMASS,{weight} seems to be forgotten (a factor {slip.factor:.3g} on mass)"
    return (
        f"the units of {card} do not go together: E {E:g} with density {rho:g} is {slip.read}; "
        f"{remedy}; {_off(1.0 / slip.factor if slip.what == 'E' else slip.factor)}"
    )


def _wtmass_slip(
    card: str, E: float, rho: float, wtmass: float, size: float, fitting: list[_System]
) -> str:
    """Say what is wrong with PARAM WTMASS where another makes a more usual system; else ""."""
    usual = min((s.usual for s in fitting), default=inf)
    if wtmass == 1.0 or usual == 0.0:
        return ""
    given = f"the units of {card} do not go together: with PARAM,WTMASS,{wtmass:g}"
    for s in _SYSTEMS:
        if s.usual < usual and _makes_sense(E * s.stress, rho * s.density):
            return (
                f"{given}, but its density {rho:g} is a mass in {s.name} as it stands: WTMASS "
                f"seems to be one too many; {_off(1.0 / wtmass)}"
            )
    for slip in sorted(_slips(E, rho, size), key=lambda s: s.cost):
        if slip.what != "density" or slip.system.usual >= usual or _near(slip.factor, wtmass, 1.01):
            continue
        for gravity, weight in _GRAVITY.items():
            if _near(slip.factor * gravity, 1.0, 1.01):
                return (
                    f"{given}; E {E:g} with density {rho:g} is {slip.read}, for which it is to be "
                    f"{weight}; {_off(slip.factor / wtmass)}"
                )
    return ""


def _off(mass: float) -> str:
    """Say how far frequencies are off where the mass is to be multiplied by `mass`."""
    times = mass**0.5
    high_or_low = "high" if times > 1.0 else "low"
    return f"all frequencies come out {max(times, 1.0 / times):.3g} times too {high_or_low}"


def _decade_slip(card: str, E: float, rho: float) -> str:
    """Say that a metal is recognised by E and the digits of its density; else ""."""
    for s in (s for s in _SYSTEMS if s.usual == 0.0):
        for metal, (modulus, density) in _METALS.items():
            for factor in _DECADES if _near(E * s.stress, modulus, _METAL[0]) else ():
                if _near(rho * s.density * factor, density, _METAL[1]):
                    return (
                        f"the units of {card} do not go together: by its E it is {metal} in "
                        f"{s.name}, and its density is {1.0 / factor:g} times too large: a slip of "
                        f"the exponent? {_off(factor)}"
                    )
    return ""


def _not_in_hertz(card: str, system: _System) -> str:
    usual = _SYSTEMS[0]
    return (
        f"the units of {card} are {system.name}: frequencies come out in kHz, where Hz is said, "
        f"1000 times too low; in {usual.name} its E is to be multiplied by "
        f"{system.stress / usual.stress:.3g}, its density by {system.density / usual.density:.3g}"
    )


def _thickness_slip(deck: Deck, size: float) -> tuple[str, ...]:
    shells = deck.bulk.table("PSHELL").items()
    thickness, pid = max(((card.t or 0.0, pid) for pid, card in shells), default=(0.0, 0))
    if not 0.0 < size < thickness:
        return ()
    return (
        f"the units of PSHELL {pid} do not go together with those of the grids: T is {thickness:g} "
        f"where the whole structure is {size:.3g} large",
    )


def _length_slip(declared: str | None, size: float, systems: list[_System]) -> tuple[str, ...]:
    """Hold the length unit that the materials imply against the declared one and the size."""
    if not systems or size <= 0.0:
        return ()
    usual = min(systems, key=lambda s: s.usual)
    lengths = {s.length for s in systems}
    if declared and METRES[declared] not in lengths:
        return (
            f"the deck declares the length unit {declared}, but its materials are in {usual.name}: "
            f"if it is right, multiply the coordinates by {METRES[declared] / usual.length:.3g}",
        )
    if any(_SIZE[0] < size * length < _SIZE[1] for length in lengths):
        return ()
    likely = min(METRES, key=lambda unit: abs(log10(size * METRES[unit])))
    if not _USUAL[0] < size * METRES[likely] < _USUAL[1]:
        return ()
    return (
        f"the structure is {size * usual.length:.3g} m long by its materials ({usual.name}): its "
        f"coordinates seem to be in {likely}; multiply them by {METRES[likely] / usual.length:.3g}",
    )


def _mass_slip(deck: Deck, size: float, systems: list[_System], wtmass: float) -> tuple[str, ...]:
    """Name a concentrated mass that would not fit into the structure, but would in another unit."""
    usual = min(systems, key=lambda s: s.usual, default=None)
    masses = deck.bulk.table("CONM2").items()
    mass, eid = max(((card.m, eid) for eid, card in masses), default=(0.0, 0))
    if not usual or usual.name not in _OTHER_MASS or not (mass > 0.0 and size > 0.0):
        return ()
    unit, number = _OTHER_MASS[usual.name]
    kilograms = mass * wtmass * usual.density * usual.length**3
    edge, extent = (kilograms / _STEEL) ** (1.0 / 3.0), size * usual.length
    seismic = log10(mass).is_integer()  # a base that is made heavy on purpose
    if wtmass != 1.0 or seismic or not extent < edge < 0.5 * extent * number ** (1.0 / 3.0):
        return ()
    return (
        f"the units of CONM2 {eid} do not go together with the size of the structure, {extent:.3g} "
        f"m: its mass {mass:g} is {kilograms:.3g} kg in {usual.name}; if it is {mass:g} {unit}, "
        f"write {mass / number:.4g}",
    )
