"""Whose report it is, and what it was made of."""

from dataclasses import dataclass

from ...core.results.made import MadeTables
from .html.markup import esc, tag


@dataclass(frozen=True)
class Imprint:
    """What a study says of its report; empty what it does not. `logo` is a ``data:`` address.

    There is no date but the one that is given: the same input gives the same page.
    """

    title: str = ""
    author: str = ""
    company: str = ""
    date: str = ""
    logo: str = ""


def letterhead(imprint: Imprint | None) -> str:
    """Return logo, title and who made it, above the report; nothing where nothing is given."""
    if imprint is None or imprint == Imprint():
        return ""
    logo = tag("img", src=imprint.logo, alt=imprint.company or "logo") if imprint.logo else ""
    who = " · ".join(t for t in (imprint.author, imprint.company, imprint.date) if t)
    said = (tag("b", esc(imprint.title)) if imprint.title else "") + tag("span", esc(who))
    return tag("header", tag("div", said), logo, class_="letterhead")


def colophon(answer: MadeTables) -> str:
    """Return the foot of the page: version, what runs it again, the inputs with their hashes."""
    made = f"trueup {answer.version}".strip()
    again = (
        f"trueup {answer.verb.split('-')[0]} --study study.toml, in the run folder, runs it again."
    )
    rows = "".join(
        tag("li", esc(row.path), " ", tag("code", esc(row.sha256[:16]))) for row in answer.inputs
    )
    inputs = tag("p", "Inputs, with the first sixteen digits of their SHA-256:") + tag("ul", rows)
    return tag(
        "footer", tag("p", esc(f"{made} · {answer.schema}. {again}")), inputs if rows else ""
    )
