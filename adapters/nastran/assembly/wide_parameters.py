"""Parameters that name many cards, some elements, or bounds in units: what they are in a deck."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....core.errors import InputError
from ..cards import holders
from ..deck.bulk import Bulk
from ..deck.read_deck import Deck
from ..deck_reader import read_deck
from ..editing.split_property import split_property
from ..fields.parameter_references import (
    FieldRef,
    NamedValues,
    ParameterRequest,
    ParameterSpec,
    Region,
    parse_request,
)
from ..properties.grids import read_points
from .candidate_parameters import referring
from .variation import value_of


def parameters_of(deck: Deck, texts: Sequence[str]) -> tuple[Deck, tuple[ParameterSpec, ...]]:
    """Return what the user's parameters are in a deck.

    Where a value moves for some elements of a property alone, these get a copy of it.

    Parameters
    ----------
    deck : Deck
    texts : sequence of str
        See `parse_request`.

    Returns
    -------
    deck : Deck
        The same, or with properties split.
    specs : tuple of ParameterSpec

    Raises
    ------
    InputError
        A name that is malformed or that stands for nothing in the deck.
    """
    specs = []
    for request in map(parse_request, texts):
        deck, spec = _spec(deck, request)
        specs.append(spec)
    return deck, tuple(specs)


def stands_in(deck: Deck, text: str) -> bool:
    """Whether any of the cards that a parameter names is in a deck."""
    for named in parse_request(text).values:
        first, last = named.numbers or (0, np.inf)
        if any(first <= n <= last for n in deck.bulk.table(named.card)):
            return True
    return False


def _spec(deck: Deck, request: ParameterRequest) -> tuple[Deck, ParameterSpec]:
    fields: list[FieldRef] = []
    for named in request.values:
        refs = _cards(deck, named)
        if named.region is not None:
            deck, refs = _split(deck, named, refs, named.region)
        fields += refs
    bounds = request.lower, request.upper
    if request.in_units:
        bounds = _factors(deck, request, fields)
    return deck, ParameterSpec(request.name, tuple(fields), *bounds)


def _cards(deck: Deck, named: NamedValues) -> list[FieldRef]:
    """Return the values that a name stands for; of many cards those that have one."""
    try:
        if named.numbers and named.numbers[0] == named.numbers[1]:
            return [FieldRef(named.card, named.numbers[0], named.field)]
        first, last = named.numbers or (0, np.inf)
        there = [n for n in sorted(deck.bulk.table(named.card)) if first <= n <= last]
        refs = [FieldRef(named.card, n, named.field) for n in there or [1]]
    except InputError as error:
        raise InputError(f"parameter {named.text!r}: {error}") from None
    held = [ref for ref in refs if there and _holds(deck, ref)]
    if not held:
        which = f"no {named.card} of these numbers" if not there else f"none of its {named.card}"
        has = "is in the deck" if not there else f"has a value {refs[0].field}"
        raise InputError(f"parameter {named.text!r}: {which} {has}")
    return held


def _holds(deck: Deck, ref: FieldRef) -> bool:
    try:
        value_of(deck, ref)
    except InputError:
        return False
    return True


def _factors(
    deck: Deck, request: ParameterRequest, fields: Sequence[FieldRef]
) -> tuple[float, float]:
    """Return bounds in the card's unit as factors that keep every value between them."""
    values = [value_of(deck, ref) for ref in fields]
    lower, upper = request.lower, request.upper
    for ref, value in zip(fields, values, strict=True):
        if not min(lower, upper) <= value <= max(lower, upper):
            raise InputError(
                f"parameter {request.text!r}: {ref} is {value:g}, outside the bounds "
                f"[={lower:g}, ={upper:g}]"
            )
    ends = [sorted((lower / v, upper / v)) for v in values]
    return max(e[0] for e in ends), min(e[1] for e in ends)


def _split(
    deck: Deck, named: NamedValues, refs: Sequence[FieldRef], region: Region
) -> tuple[Deck, list[FieldRef]]:
    """Give the elements of a region copies of what the values belong to; return those values."""
    out: list[FieldRef] = []
    for ref in refs:
        moved = False
        own = [(ref.card, ref.id)] if holders(ref.card) else referring(deck.bulk).get(ref.id, [])
        for card, number in own:
            every = _members(deck.bulk, card, number)
            chosen = _within(deck, every, region)
            if not chosen:
                continue
            moved = True
            material = ref.card != card
            if len(chosen) == len(every) and not material:
                out.append(ref)
                continue
            split = split_property(
                deck.text, card, number, chosen, f"trueup: {named.text}", copy_materials=material
            )
            deck = replace(read_deck(split.deck), on_disk=deck.on_disk)
            copy = split.materials[ref.id] if material else split.property
            out.append(FieldRef(ref.card, copy, ref.field))
        if not moved:
            raise InputError(
                f"parameter {named.text!r}: none of these elements has {ref.card} {ref.id}"
            )
    return deck, out


def _members(bulk: Bulk, card: str, number: int) -> dict[int, tuple[int, ...]]:
    """Return the nodes of the elements of a property, by element."""
    return {
        element: tuple(n for n in values.nodes if n)
        for name in holders(card)
        for element, values in bulk.table(name).items()
        if values.pid == number
    }


def _within(deck: Deck, elements: dict[int, tuple[int, ...]], region: Region) -> list[int]:
    """Return the elements of a region."""
    if region.box is None:
        return [e for e in elements if any(a <= e <= b for a, b in region.elements)]
    points = read_points(deck.bulk)
    low, high = np.sort(np.reshape(region.box, (2, 3)), axis=0)
    middles = {
        e: points.xyz[np.searchsorted(points.ids, nodes)].mean(axis=0)
        for e, nodes in elements.items()
    }
    return [e for e, at in middles.items() if ((low <= at) & (at <= high)).all()]
