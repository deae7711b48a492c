"""General elements: GENEL, a stiffness or flexibility between any degrees of freedom."""

import itertools
from functools import partial
from typing import Any

import numpy as np

from .....core.arrays import Floats, Ints, Matrices
from .....core.elements.connectors.lumped import GENERAL, general_stiffness
from .....core.errors import Place
from ...deck.bulk import Bulk
from ...deck.card_definition import Card, Known, Values
from ...deck.field_values import FieldError, Fields, take
from ...properties.grids import Points
from ..element_group import Context, Group

_WORDS = ("UD", "K", "Z", "S")


def _parts(fields: Fields, _: Known) -> list[Any]:
    """Pairs of UI, then lines that start with UD, with K or Z, and with S."""
    starts = [
        k for k in range(9, len(fields), 8) if str(fields[k]).upper() in _WORDS
    ] + [len(fields)]  # fmt: skip
    held = {str(fields[a]).upper(): (a, b) for a, b in itertools.pairwise(starts)}
    free = _pairs(fields, 3, starts[0])
    dependent = _pairs(fields, held["UD"][0] + 2, held["UD"][1]) if "UD" in held else []
    word = "K" if "K" in held else "Z"
    if word not in held or not free:
        raise FieldError(9, "K or Z", "and the degrees of freedom UI must be given")
    m, n = len(free), len(dependent)
    matrix = _numbers(fields, *held[word], word, m * (m + 1) // 2)
    support = _numbers(fields, *held["S"], "S", m * n) if "S" in held else ()
    nodes, components = zip(*free, *dependent, strict=True)
    return [nodes, components, m, word, matrix, support]


def _pairs(fields: Fields, first: int, stop: int) -> list[tuple[int, int]]:
    return [
        (take(fields, k, "U:i!"), take(fields, k + 1, "C:i=0"))
        for k in range(first, stop, 2)
        if fields[k] is not None
    ]


def _numbers(fields: Fields, first: int, stop: int, word: str, count: int) -> tuple[float, ...]:
    given = fields[first + 1 : stop]
    while given and given[-1] is None:
        given.pop()
    if len(given) > count:
        raise FieldError(first + 1 + count, word, f"has {len(given)} numbers where {count} fit")
    return tuple(take(fields, first + 1 + k, f"{word}:r=0.") for k in range(count))


CARDS = (
    Card(
        "GENEL",
        "EID:i!",
        "eid",
        more=_parts,
        extra="nodes components free word matrix support",
        elements="general",
    ),
)


def general_elements(context: Context) -> list[Group]:
    """Make a group of every GENEL."""
    return [_group(context, card) for card in context.bulk.table("GENEL").values()]


def _group(context: Context, card: Values) -> Group:
    place = context.bulk.place("GENEL", card.eid)
    at = [
        context.points.dof(node, component, place)
        for node, component in zip(card.nodes, card.components, strict=True)
    ]
    m, n = card.free, len(at) - card.free
    matrix = np.zeros((m, m))
    column, row = np.triu_indices(m)
    matrix[row, column] = matrix[column, row] = card.matrix
    if card.word == "Z":
        if np.linalg.matrix_rank(matrix) < m:
            raise place.error("its flexibility Z is singular")
        matrix = np.linalg.inv(matrix)
    if n and not card.support:
        S = _rigid_support(context.points, at[:m], at[m:], place)
    else:
        S = np.reshape(card.support, (m, n))
    K = general_stiffness(matrix[None], S[None])
    ids = np.array([card.eid], dtype=np.int64)
    sources, of = (frozenset([("GENEL", card.eid)]),), np.zeros(1, dtype=np.int64)
    return Group("GENEL", ids, GENERAL, np.array([at]), partial(_matrices, K), sources, of)


def _matrices(K: Floats, _bulk: Bulk, rows: Ints, wanted: tuple[bool, bool]) -> Matrices:
    return (K[rows] if wanted[0] else None), None


def _rigid_support(points: Points, free: list[int], support: list[int], place: Place) -> Floats:
    """Rigid motions of the free degrees of freedom by those of the six that hold the element."""
    every = np.array([*free, *support])
    if (every >= 6 * len(points.ids)).any() or len(support) != 6:
        raise place.error("without S its UD must be six components of grids")
    grid, component = np.divmod(every, 6)
    motions = points.motions(grid, points.xyz[grid].mean(axis=0))[np.arange(len(every)), component]
    size = np.linalg.norm(np.ptp(points.xyz[grid], axis=0)) or 1.0
    motions = motions / np.array([1.0, 1.0, 1.0, size, size, size])
    held = motions[len(free) :]
    if np.linalg.cond(held) > 1e10:
        raise place.error("its UD do not hold it as a rigid body: give S, or other UD")
    return np.asarray(motions[: len(free)] @ np.linalg.inv(held))
