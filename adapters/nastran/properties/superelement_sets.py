"""Sets of constraints that subcases of superelements select for them."""

from dataclasses import replace

from ..deck.bulk import Bulk
from ..deck.card_definition import Values
from ..deck.raw_cards import Raw
from ..deck.read_deck import Deck

_HOLDING = {"SPC": ("SPC", "SPC1"), "MPC": ("MPC",)}


def with_sets_of_parts(deck: Deck, notes: list[str]) -> Deck:
    """Select a set for the whole where subcases of superelements select theirs.

    Those of superelements in the main bulk (SESET) are put into it; what is missing goes to
    `notes`.
    """
    bulks, case, kinds = (*deck.parts.values(), deck.bulk), deck.case, deck.bulk.table("SEBULK")
    names = (*_HOLDING["SPC"], *_HOLDING["MPC"], "SPCADD", "MPCADD")
    sids = (card.sid for bulk in bulks for name in names for card in bulk.listed(name))
    free = 1 + max(sids, default=0)
    whole = {"SPC": case.spc, "MPC": case.mpc}
    lists, raw = dict(deck.bulk.lists), dict(deck.bulk.raw)
    for seid, sets in case.of_parts:
        source = kinds[seid].rseid if seid in kinds and seid not in deck.parts else seid
        part = deck.parts.get(source, deck.bulk)
        for (kind, names), own in zip(_HOLDING.items(), sets, strict=True):
            if own is None or (part is deck.bulk and own == whole[kind]):
                continue
            into = whole[kind] or free
            every = {name: _of_set(part, name, own, into) for name in names}
            if not any(every.values()):
                notes.append(
                    f"{deck.path}: case control asks for {kind} = {own} of superelement {seid}, "
                    f"which has no {kind} cards of that set: nothing is constrained by it"
                )
                continue
            whole[kind] = into
            for name in names if part is deck.bulk else ():
                lists[name] = [*lists.get(name, ()), *(c for c, _ in every[name])]
                raw[name] = [*raw.get(name, ()), *(r for _, r in every[name])]
    case = replace(case, spc=whole["SPC"], mpc=whole["MPC"])
    return replace(deck, case=case, bulk=replace(deck.bulk, lists=lists, raw=raw))


def _of_set(bulk: Bulk, name: str, own: int | None, whole: int) -> list[tuple[Values, Raw]]:
    """Cards of a name in one set, or what it adds together, as cards of the set of the whole."""
    added = (c.sets for c in bulk.listed(f"{name[:3]}ADD") if c.sid == own)
    wanted = {own, *(s for sets in added for s in sets)}
    both = zip(bulk.listed(name), bulk.raw.get(name, ()), strict=True)
    return [(c._replace(sid=whole), r) for c, r in both if c.sid in wanted]


def of_own_subcase(deck: Deck, seid: int, part: Bulk) -> Bulk:
    """Leave of a part the constraints that its own subcase selects, in the set of the whole."""
    sets = dict(deck.case.of_parts).get(seid)
    if sets is None:
        return part
    lists, raw = {**part.lists, "SPCADD": [], "MPCADD": []}, dict(part.raw)
    for names, own, whole in zip(
        _HOLDING.values(), sets, (deck.case.spc, deck.case.mpc), strict=True
    ):
        for name in names:
            kept = _of_set(part, name, own, whole or 0)
            lists[name], raw[name] = [c for c, _ in kept], [r for _, r in kept]
    return replace(part, lists=lists, raw={**raw, "SPCADD": [], "MPCADD": []})
