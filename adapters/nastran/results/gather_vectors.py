"""Eigenvectors gathered from text, point by point, to tables."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ....core.arrays import Bools, Floats, Ints, Numbers
from ....core.errors import Place
from .eigenvector_table import ModeTable

Row = tuple[int, bool, tuple[complex, ...]]
"""A point, whether it is scalar, and its components."""


@dataclass
class Vector:
    """One eigenvector as it stands in a file."""

    subcase: int
    superelement: int
    number: int
    eigenvalue: complex
    rows: list[Row] = field(default_factory=list)


def tables_of(
    vectors: list[Vector], path: Path, masses: Mapping[int, float] | None = None
) -> list[ModeTable]:
    """Put vectors together by subcase and superelement.

    Raises
    ------
    InputError
        Vectors of one subcase that list different points, or a point twice.
    """
    groups: dict[tuple[int, int], dict[int, Vector]] = {}
    for v in vectors:
        group = groups.setdefault((v.subcase, v.superelement), {})
        if v.number in group:  # a vector that goes on over a page, or a second eigensolution
            if group[v.number].eigenvalue != v.eigenvalue:
                raise Place(path).fault(
                    f"holds mode {v.number} of subcase {v.subcase} twice, with different "
                    "eigenvalues: give the file of one run"
                )
            group[v.number].rows += v.rows
        else:
            group[v.number] = replace(v, rows=list(v.rows))
    return [
        _table(*key, [group[n] for n in sorted(group)], path, masses or {})
        for key, group in sorted(groups.items())
    ]


def _table(
    subcase: int, superelement: int, vectors: list[Vector], path: Path, masses: Mapping[int, float]
) -> ModeTable:
    columns = [_column(v, path) for v in vectors]
    points, scalar, _ = columns[0]
    if any(not np.array_equal(points, p) for p, _, _ in columns):
        raise Place(path).error(
            f"the eigenvectors of subcase {subcase} list different points: it is cut "
            "short, or lines are missing"
        )
    numbers = np.array([v.number for v in vectors], np.int64)
    eigenvalues: Numbers = np.array([v.eigenvalue for v in vectors])
    values: Numbers = np.asfortranarray(np.stack([c.ravel() for _, _, c in columns], axis=1))
    if not any(isinstance(v.eigenvalue, complex) for v in vectors):
        eigenvalues, values = eigenvalues.real.astype(float), np.asfortranarray(values.real)
    mass: Floats = np.array([masses.get(int(n), np.nan) for n in numbers])
    return ModeTable(
        subcase=subcase,
        superelement=superelement,
        points=points,
        scalar=scalar,
        numbers=numbers,
        eigenvalues=eigenvalues,
        generalized_mass=mass,
        basic=False,
        values=values,
    )


def _column(v: Vector, path: Path) -> tuple[Ints, Bools, Numbers]:
    points = np.array([r[0] for r in v.rows], np.int64)
    unique, counts = np.unique(points, return_counts=True)
    if len(unique) < len(points):
        raise Place(path).fault(
            f"lists point {unique[counts > 1][0]} twice in mode {v.number}: give the file "
            "of one run"
        )
    values = np.zeros((len(points), 6), np.complex128)
    for k, (_, _, row) in enumerate(v.rows):
        values[k, : len(row)] = row
    return points, np.array([r[1] for r in v.rows], bool), values
