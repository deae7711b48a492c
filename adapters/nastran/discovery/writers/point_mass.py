"""CONM2 for an attached mass, with offset and inertia where the test tells."""

from typing import Any

import numpy as np

from ...editing.find_cards import free_id
from ...text.deck_text import DeckText
from .site import Site, plain
from .tuned_absorber import sprung


def write(text: DeckText, site: Site) -> DeckText:
    """Put the mass on the grids named, each its share: the same, where none is said.

    Equipment sits at a grid that follows them, a mass hangs on the mount that the test tells.

    An offset CONM2 on a grid of a shell would hang on its drilling stiffness, which is next to
    nothing.
    """
    number = free_id(text, "element")
    if "inertia" in site.finding.magnitude:
        return site.added(text, _equipment(text, site, number))
    if "mount_hz" in site.finding.magnitude:
        return sprung(text, site, (1, 2, 3), site.total("mount_hz"))
    grids = site.grids
    if site.arms:
        arm = map(plain, site.arms[0])
        return site.added(text, [("CONM2", number, grids[0], 0, plain(site.total("mass")), *arm)])
    shares = site.finding.where.shares or (1.0 / len(grids),) * len(grids)
    parts = (plain(site.total("mass") * share) for share in shares)
    rows = [
        ("CONM2", number + i, g, None, m) for i, (g, m) in enumerate(zip(grids, parts, strict=True))
    ]
    return site.added(text, rows)


def _equipment(text: DeckText, site: Site, number: int) -> list[list[Any]]:
    grids, where, rows = site.grids, site.finding.where, list[list[Any]]()
    host = grids[0]
    if where.normal is not None:
        host, cd = free_id(text, "grid"), free_id(text, "coordinate")
        rows += _foot(site, host, cd, number)
        number += 2
    elif len(grids) > 1:
        host = free_id(text, "grid")
        rows += [
            ["GRID", host, 0, *map(plain, where.xyz), 0],
            ["RBE3", number, None, host, "123456", 1.0, "123", *grids],
        ]
        number += 1
    none = [(0.0, 0.0, 0.0)]
    parts = (*(site.arms or none), site.finding.magnitude.get("offset", none[0]))
    offset = [plain(sum(along)) for along in zip(*parts, strict=True)]
    j = site.total("inertia")
    inertias = map(plain, site.finding.magnitude.get("inertias", (j, 0.0, j, 0.0, 0.0, j)))
    mass = ["CONM2", number, host, 0, plain(site.total("mass")), *offset, None]
    return [*rows, [*mass, *inertias]]


def _foot(site: Site, host: int, cd: int, number: int) -> list[list[Any]]:
    """Return a grid that follows the first one, but about the normal of their sheet all of them."""
    first, *_ = grids = site.grids
    at, normal = np.array(site.middle([first])), np.array(site.finding.where.normal)
    along = np.eye(3)[np.argmin(np.abs(normal))]
    return [
        ["CORD2R", cd, 0, *map(plain, (*at, *(at + normal), *(at + along)))],
        ["GRID", host, 0, *map(plain, at), cd],
        ["RBE2", number, first, "12345", host],
        ["RBE3", number + 1, None, host, "6", 1.0, "123", *grids],
    ]
