"""CONM2 for an attached mass, with offset and inertia where the test tells."""

from typing import Any

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
    grids, host, rows = site.grids, site.grids[0], list[list[Any]]()
    if len(grids) > 1:
        host = free_id(text, "grid")
        at = [float(v) for v in site.finding.where.xyz]
        rows += [
            ["GRID", host, 0, *map(plain, at), 0],
            ["RBE3", number, None, host, "123456", 1.0, "123", *grids],
        ]
        number += 1
    none = [(0.0, 0.0, 0.0)]
    parts = (*(site.arms or none), site.finding.magnitude.get("offset", none[0]))
    offset = [plain(sum(along)) for along in zip(*parts, strict=True)]
    j = plain(site.total("inertia"))
    mass = ["CONM2", number, host, 0, plain(site.total("mass")), *offset, None]
    return [*rows, [*mass, j, 0.0, j, 0.0, 0.0, j]]
