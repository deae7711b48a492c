"""Cards that replicate the one above them, ``=``, ``==``, ``*(n)`` and ``=(n)``, written out."""

import re
from collections.abc import Iterable, Iterator, Sequence
from decimal import Decimal
from pathlib import Path

from ....core.errors import Place
from ..text.real_numbers import parse_real
from .logical_lines import Line

_AGAIN = re.compile(r"=\s*\(?\s*(\d+)\s*\)?")
_STEP = re.compile(r"\*\s*\(?\s*([^()\s]+)\s*\)?")


def written_out(lines: Iterable[Line], files: Sequence[Path]) -> Iterator[Line]:
    """Yield the lines of bulk data with replicated ones in full, in free fields.

    ``=`` takes the field of the card above, ``==`` that and all behind it, ``*(n)`` adds n to it;
    ``=(n)`` in place of the name does so n times, by the steps of the line above where it has
    none of its own, and a card of the same name may take single fields. Lines of cards are
    replicated, not their continuations.

    Raises
    ------
    InputError
        Nothing to be replicated, a step of what is no number: file and line.
    """
    above: list[str] = []
    pattern: list[str] = []
    for line in lines:
        text = line.text.split("$", 1)[0].rstrip() if "$" in line.text else line.text
        if text[:1] != "=" and text[:8].lstrip()[:1] != "=":
            if text.strip():
                before, above = above, [] if text[0] in "+*, \t" else _fields(text)
                pattern = []
                if "=" in text and _takes(above, before):
                    at = Place(files[line.file], line.number)
                    above = _next([above[0], *before[1:]], above[1:], at)
                    line = line._replace(text=",".join(above))
            yield line
            continue
        at = Place(files[line.file], line.number)
        head, *steps = _fields(text)
        again = _AGAIN.fullmatch(head)
        if head not in ("=", "==") and not again:
            raise at.error(f"{head!r} is neither '=' nor '=(n)'")
        if not above:
            raise at.error("'=' replicates the card above, and that is not a card of one line")
        if any(steps) or head == "==":
            pattern = ["=="] if head == "==" else steps
        elif not pattern:
            raise at.error("'=(n)' has no steps, and neither has the line above")
        for _ in range(int(again[1]) if again else 1):
            above = _next(above, pattern, at)
            yield line._replace(text=",".join(above))


def _takes(fields: list[str], above: list[str]) -> bool:
    """Whether a card takes fields of the one above, of the same name."""
    return bool({"=", "=="} & {*fields[1:]}) and fields[:1] == above[:1]


def _fields(text: str) -> list[str]:
    """Return the name and the fields of a line, without a label of a continuation."""
    if "," in text[:10] or ("," in text and text.lstrip()[:1] == "="):
        fields = [f.strip() for f in text.split(",")]
        return fields[: 5 if "*" in fields[0] else 9]
    text = text.expandtabs()
    wide = 16 if "*" in text[:8] and text.lstrip()[:1] != "=" else 8
    ends = range(8, min(len(text), 72), wide)
    return [text[:8].strip(), *(text[k : min(k + wide, 72)].strip() for k in ends)]


def _next(above: list[str], pattern: list[str], at: Place) -> list[str]:
    out = [above[0]]
    for k, step in enumerate(pattern, 1):
        before = above[k] if k < len(above) else ""
        if step == "==":
            return [*out, *above[k:]]
        found = _STEP.fullmatch(step)
        out.append(before if step == "=" else _stepped(before, found[1], at) if found else step)
    return out


def _stepped(text: str, step: str, at: Place) -> str:
    try:
        if text.lstrip("+-").isdigit() and step.lstrip("+-").isdigit():
            return str(int(text) + int(step))
        total = Decimal(repr(parse_real(text))) + Decimal(repr(parse_real(step)))
    except ValueError:
        raise at.error(f"*({step}) steps a field that holds {text!r}") from None
    return repr(float(total))
