"""Length units of deck and test: converting, checking, inferring."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Floats
from ..data.geometry import Geometry
from ..data.length_units import METRES, length_factor
from ..errors import InputError
from ..sensors.closest_point import place
from ..sensors.outer_surface import Surface, surface_of
from .registration_numbers import ALIGN


@dataclass(frozen=True)
class Units:
    """Length units of deck and test that were declared or found, and how one becomes the other.

    Parameters
    ----------
    deck, test : str or None
        ``m``, ``mm``, ``in``, ``ft``; None where nobody said and only their ratio is known.
    factor : float
        Deck length units in one test length unit.
    warnings : tuple of str
        What was inferred.
    """

    deck: str | None
    test: str | None
    factor: float
    warnings: tuple[str, ...] = ()


def reconcile_units(analysis: Geometry, test: Geometry, deck_unit: str | None = None) -> Units:
    """Decide how test lengths become deck lengths, and refuse what cannot be.

    Parameters
    ----------
    analysis : Geometry
        In deck units; `length_unit` where the deck states it.
    test : Geometry
        In test units; `length_unit` where the file states it (dataset 164).
    deck_unit : str, optional
        What the user says the deck is in; stronger than ``analysis.length_unit``.

    Returns
    -------
    Units
        With both sides declared, their ratio. With one side silent, the only unit that makes
        the two sizes agree or that lays the test on the model, and a warning that says so.

    Raises
    ------
    InputError
        The declared units make the test far larger or smaller than the model, or nothing is
        declared and no unit is plausible.
    """
    deck, measured = deck_unit or analysis.length_unit, test.length_unit
    surface = surface_of(analysis)
    if surface.size == 0.0:
        surface = surface_of(replace(analysis, elements={}, element_ids={}))
    if deck and measured:
        return _checked(surface, test, deck, measured)
    if not deck and not measured:
        return _alike(surface, test)
    choices = {
        unit: length_factor(measured, unit) if measured else length_factor(unit, str(deck))
        for unit in METRES
    }
    unit = _plausible(surface, test, choices)
    silent, option = ("deck", " with deck_length_unit") if measured else ("test", "")
    sizes = _sizes(surface, test, deck, measured)
    if unit is None:
        raise InputError(
            f"the {silent} does not state its length unit and by none of {', '.join(METRES)} are "
            f"both of one size ({sizes}); state it{option}, or check that they are the same "
            "structure" + _apart(test)
        )
    share = choices[unit] * test.size / surface.size
    warning = (
        f"the {silent} does not state its length unit; taken as {unit}, by which the test spans "
        f"{share:.0%} of the model ({sizes}); state it{option} if this is wrong"
    )
    return Units(deck or unit, measured or unit, choices[unit], (warning,))


def _checked(surface: Surface, test: Geometry, deck: str, measured: str) -> Units:
    factor = length_factor(measured, deck)
    units = Units(deck, measured, factor)
    ratio = factor * test.size / surface.size if surface.size > 0 else 1.0
    low, high = ALIGN.possible
    if test.size == 0 or ALIGN.usual[0] <= ratio <= high:
        return units
    others = {unit: length_factor(measured, unit) for unit in METRES if unit != deck}
    better = _plausible(surface, test, others)
    sure = better is not None and _lies_on(surface, others[better] * test.xyz)
    if (low if sure else low / 100) <= ratio <= high and _lies_on(surface, factor * test.xyz):
        return units
    by = METRES[deck] / METRES[better] if better else 1 / ratio
    times = f"{_round(by)} times smaller" if by > 1 else f"{_round(1 / by)} times larger"
    said = f"the test is about {times} than the model ({_sizes(surface, test, deck, measured)})"
    if (low <= ratio <= high and not sure) or (
        better is None and low / ALIGN.far_too_small <= ratio < low
    ):
        return replace(units, warnings=(f"{said}; check the length units of both{_apart(test)}",))
    advice = (
        f"if the deck is in {better}, say so with deck_length_unit={better}; else the test's "
        f"own unit ({measured}) is wrong"
        if better
        else "check the length units of both, and that they are the same structure"
    )
    raise InputError(f"{said}, so their length units cannot both be right: {advice}{_apart(test)}")


def _alike(surface: Surface, test: Geometry) -> Units:
    ratio = test.size / surface.size if surface.size > 0 else 1.0
    if not ALIGN.possible[0] <= ratio <= ALIGN.possible[1]:
        raise InputError(
            "neither the deck nor the test states its length unit and their sizes differ "
            f"({_sizes(surface, test, None, None)}); state the deck's with deck_length_unit"
            + _apart(test)
        )
    said = "neither the deck nor the test states its length unit; taken to be the same"
    return Units(None, None, 1.0, (said,))


def _apart(test: Geometry) -> str:
    """Name the nodes that lie far from all others; empty where there is none."""
    away = np.linalg.norm(test.xyz - np.median(test.xyz, axis=0), axis=1)
    usual = float(np.quantile(away, ALIGN.most_nodes))
    far = np.flatnonzero(away > ALIGN.outlying * usual)
    if not len(far):
        return ""
    near = np.delete(test.xyz, far, axis=0)
    named = ", ".join(map(str, test.ids[far[: ALIGN.named]])) + ", ..." * (len(far) > ALIGN.named)
    return (
        f". Of the test's nodes {named} lie{'s' * (len(far) == 1)} far from the others: without "
        f"that it spans {np.linalg.norm(np.ptp(near, axis=0)):.4g}"
    )


def _plausible(surface: Surface, test: Geometry, choices: dict[str, float]) -> str | None:
    """Return the unit by which the sizes agree, or else the test lies on the model as it is."""
    if test.size == 0 or surface.size == 0:
        return None
    ratio = {unit: factor * test.size / surface.size for unit, factor in choices.items()}
    usual = [unit for unit, r in ratio.items() if ALIGN.usual[0] <= r <= ALIGN.usual[1]]
    inside = [u for u, r in ratio.items() if ALIGN.possible[0] <= r <= ALIGN.possible[1]]
    lying = [u for u in inside if _lies_on(surface, choices[u] * test.xyz)]
    for units in ([u for u in usual if u in lying], lying, usual):
        if len(units) == 1:
            return units[0]
    return None


def _lies_on(surface: Surface, points: Floats) -> bool:
    """Whether nine in ten points are on the model as they stand.

    That is within 1 % of its size, and within a tenth of their own: points close together are
    near whatever one of them is near.
    """
    own = float(np.linalg.norm(np.ptp(points, axis=0)))
    near = min(ALIGN.unit_near * surface.size, ALIGN.unit_own * own)
    at = place(surface, points, reach=2.0 * near)
    return bool(np.mean(at.distance <= near) >= ALIGN.on_model)


def _sizes(surface: Surface, test: Geometry, deck: str | None, measured: str | None) -> str:
    return (
        f"the model spans {surface.size:.4g} {deck or 'deck units'}, "
        f"the test {test.size:.4g} {measured or 'of its own units'}"
    )


def _round(ratio: float) -> str:
    return f"{ratio:.3g}" if ratio < ALIGN.rounded else f"{round(ratio, -1):.0f}"
