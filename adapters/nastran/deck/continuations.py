"""Continuation lines that do not follow their card, as in sorted decks: brought back by label."""

from collections.abc import Iterable
from itertools import pairwise

from .logical_lines import Line


def in_order(lines: Iterable[Line]) -> list[Line]:
    """Return the lines with every continuation behind the line whose label it bears.

    Only lines are moved that follow a line without their label while a line with it waits
    elsewhere; labels that fit nowhere, or are left blank, are taken as preprocessors mean them:
    the continuation belongs to the card above it.
    """
    ordered = list(lines)
    stray = [
        k
        for k, (above, line) in enumerate(pairwise(ordered), 1)
        if (label := _head(line.text)) and label != _tail(above.text)
    ]
    if not stray:
        return ordered
    waiting: dict[str, int] = {}
    for k, line in enumerate(ordered):
        label = _tail(line.text)
        follower = ordered[k + 1].text if k + 1 < len(ordered) else ""
        if label and _head(follower) != label:
            waiting[label] = k
    behind = {
        waiting[_head(ordered[k].text)]: k for k in stray if _head(ordered[k].text) in waiting
    }
    moved = set(behind.values())
    out: list[Line] = []
    for k, line in enumerate(ordered):
        if k in moved:
            continue
        out.append(line)
        while k in behind:
            k = behind[k]
            out.append(ordered[k])
    return out


def wrong_labels(ordered: Iterable[Line]) -> list[tuple[Line, str]]:
    """Continuations, in order, whose label is another than the one that the line above calls."""
    return [
        (line, f"'+{_head(line.text)}' follows a line that calls '+{_tail(above.text)}'")
        for above, line in pairwise(ordered)
        if line.text[:1] in ("+", "*")
        and (label := _head(line.text))
        and (called := _tail(above.text))
        and label != called
    ]


def _head(text: str) -> str:
    """Label in the first field of a continuation, "" where there is none."""
    if text[:1] not in ("+", "*"):
        return ""
    first = text.split(",", 1)[0] if "," in text[:10] else text[:8]
    return first[1:].strip().upper()


def _tail(text: str) -> str:
    """Label in the tenth field of a line, "" where there is none."""
    text = text.split("$", 1)[0]
    if "," in text[:10]:
        fields = text.split(",")
        wide = 4 if "*" in fields[0] else 8
        last = fields[wide + 1] if len(fields) > wide + 1 else ""
    else:
        last = text[72:80]
    return last.strip().lstrip("+*").upper()
