"""A deck reduced to boundary grids and component modes, as BSET and QSET would."""

import re
from dataclasses import replace

import numpy as np

from ....core.data.parametric_model import Model
from ....core.eigen.normal_modes import solve
from ....core.errors import Place
from ..deck.bulk import Bulk
from ..deck.raw_cards import Raw
from ..deck.read_deck import Deck, EigenRequest
from .build_model import build_model

_GRIDS = re.compile(r"(\d+)(?:-(\d+))?(?::([1-6]+))?")


def craig_bampton(deck: Deck, boundary: str, n_modes: int = 20, fmax: float | None = None) -> Model:
    """Reduce a deck to its boundary and the modes of its inside with the boundary held.

    The frequencies of what is returned are compared with those of the whole deck; a warning says
    how far they are apart.

    Parameters
    ----------
    deck : Deck
        Without an analysis set of its own.
    boundary : str
        Grids, all their free components or some: ``"11, 20-25, 31:123"``.
    n_modes : int
        How many component modes.
    fmax : float, optional
        None above this frequency [Hz].

    Raises
    ------
    InputError
        A boundary that cannot be read, that names grids that do not exist or is not free.
    """
    cards = []
    bulk = deck.bulk
    for part in re.split(r"[,\s]+", boundary.strip()):
        match = _GRIDS.fullmatch(part)
        if not match:
            raise Place(deck.path).error(
                f"boundary: {part!r} is none of 11 (a grid), 20-25 (grids), 31:123 (components)"
            )
        first, last = int(match[1]), int(match[2] or match[1])
        grids = tuple(g for g in bulk.table("GRID") if first <= g <= last)
        if not grids:
            raise Place(deck.path).error(f"boundary: there is no grid {part}")
        cards.append(bulk.definitions["BSET1"].type(match[3] or "123456", grids))
    if own := [
        n for n in ("ASET", "OMIT", "BSET", "CSET", "QSET") for n in (n, f"{n}1") if bulk.listed(n)
    ]:
        raise Place(deck.path).error(f"the deck has a reduction of its own ({own[0]})")
    start = 1 + max(*bulk.table("GRID"), *(k for c in bulk.listed("SPOINT") for k in c.nodes), 0)
    modal = (range(start, start + n_modes),)
    bulk = _with(bulk, "BSET1", cards)
    bulk = _with(bulk, "SPOINT", [bulk.definitions["SPOINT"].type(modal)])
    bulk = _with(bulk, "QSET1", [bulk.definitions["QSET1"].type("0", modal)])
    reduced = build_model(replace(deck, bulk=bulk, eigen=EigenRequest(None, fmax, n_modes)))
    found = sum(int(label.split(":")[0]) >= start for label in reduced.free_labels)
    told = _checked(build_model(deck), reduced, found)
    return replace(reduced, warnings=(*reduced.warnings, told))


def _with(bulk: Bulk, name: str, cards: list[object]) -> Bulk:
    raws = [*bulk.raw.get(name, []), *(Raw(name, [], 0, 1) for _ in cards)]
    lists = {**bulk.lists, name: [*bulk.listed(name), *cards]}
    return replace(bulk, lists=lists, raw={**bulk.raw, name: raws})


def _checked(whole: Model, reduced: Model, n_modes: int) -> str:
    """Compare elastic frequencies, half as many as there are component modes."""
    number = min(6 + max(n_modes // 2, 1), reduced.n_free, whole.n_free)
    found, small = (solve(model, number) for model in (whole, reduced))
    rigid = max(found.rigid_body_modes, small.rigid_body_modes)
    a, b = found.frequencies_hz[rigid:], small.frequencies_hz[rigid:]
    a, b = a[: len(b)], b[: len(a)]
    if not len(a):
        return "the reduced model has no elastic mode to compare with those of the whole one"
    off = 100.0 * np.abs(b / a - 1.0)
    return (
        f"the first {len(a)} elastic frequencies of the reduced model (to {a[-1]:.4g} Hz) are off "
        f"those of the whole one by {off[0]:.2g} % (the first) to {off.max():.2g} % (the worst)"
    )
