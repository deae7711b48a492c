"""Write ``cards.md`` from the definitions of the cards.

    python docs/make_cards.py [--check]

With ``--check`` nothing is written; the exit status is 1 where the file is not current.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

from trueup.adapters.nastran.cards import FAMILIES
from trueup.adapters.nastran.deck.card_definition import Card
from trueup.adapters.nastran.fields.layouts import value_names
from trueup.core.elements import ELEMENTS

PAGE = Path(__file__).with_name("cards.md")
SHOWN = 12
INTRODUCTION = """# Cards

Made from the definitions by `python docs/make_cards.py`: every card that is read, and the values
of it that may be a parameter (`trueup update -p 'PBAR 11 I1'`). A card with a name that is not on
this page and looks like an element or a constraint is refused by name; any other is listed as
skipped by `trueup inspect`.
"""

LAWS = """Of these elements Nastran's matrices are not known to be met, for want of a reference; the
law here is held to closed forms, its limits or CalculiX, and solving such a deck says so. So is
that of CHEXA and CPENTA with a PCOMPS.
"""


def page() -> str:
    """Return the text of the page."""
    parts = [INTRODUCTION]
    for family in FAMILIES:
        read = [c for c in family.cards if not c.ignored and not c.refused]
        if read:
            parts += [
                f"## {family.name.capitalize()}\n",
                "| card | values that may move |",
                "|---|---|",
            ]
            parts += [f"| {c.name} | {values(c)} |" for c in read]
            parts.append("")
    parts += ["## Laws that stand for Nastran's\n", LAWS, *laws(), ""]
    every = [c for family in FAMILIES for c in family.cards]
    for title, attribute in (("Left out, with the reason", "ignored"), ("Refused", "refused")):
        parts += [f"## {title}\n", *reasons(every, attribute), ""]
    return "\n".join(parts).rstrip() + "\n"


def laws() -> Iterator[str]:
    """Return a line for each element with a law of Nastran's that is not known."""
    for card in (c for family in FAMILIES for c in family.cards):
        for kind in map(ELEMENTS.__getitem__, card.elements.split()):
            if kind.unknown:
                yield f"- {card.name} with {kind.nodes} nodes: {kind.unknown}"


def values(card: Card) -> str:
    """Return the names of the values that may move."""
    names = value_names(card) if card.moves else ()
    return ", ".join(names[:SHOWN]) + (", ..." if len(names) > SHOWN else "")


def reasons(cards: list[Card], attribute: str) -> Iterator[str]:
    """Return a line for each reason with the cards that it is true of."""
    by: dict[str, list[str]] = {}
    for card in cards:
        if why := getattr(card, attribute):
            by.setdefault(why, []).append(card.name)
    yield from (f"- {why}: {', '.join(names)}" for why, names in by.items())


def main(words: list[str]) -> int:
    """Write the page, or say whether it is current."""
    text = page()
    if words == ["--check"]:
        return int(not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != text)
    if words:
        sys.exit(__doc__)
    PAGE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
