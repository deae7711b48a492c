"""The fields of a card: cut from its lines, brought into the form pyNastran's classes take."""

from __future__ import annotations

import re

Fields = list[str | None]

_NOT_FINITE = frozenset(("NAN", "INF", "INFINITY"))


def fields_of(lines: list[str]) -> Fields:
    """Return a card's fields, name first, eight a line, None where blank, none blank at the end."""
    fields: Fields = []
    for k, line in enumerate(lines):
        if "," in line[:10]:
            part = line.split(",")
            wide = 4 if "*" in part[0] else 8
            part = [*part[: wide + 1], *[""] * (wide + 1 - len(part))]
        else:
            text = line.expandtabs() if "\t" in line else line
            if "*" in text[:8]:
                part = [text[:8], text[8:24], text[24:40], text[40:56], text[56:72]]
            else:
                part = [text[i : i + 8] for i in range(0, 72, 8)]
        fields.extend([f.strip() or None for f in (part if k == 0 else part[1:])])
    if fields and fields[0]:
        fields[0] = fields[0].rstrip("*").upper()
    while fields and fields[-1] is None:
        fields.pop()
    return fields


_EXPONENT = re.compile(r"(?<=[\d.])([+-]\d+)$")


def to_float(text: str) -> float:
    """Return a Nastran real: ``7.85-9``, ``1.D3``, ``2.`` (ValueError when it is none)."""
    text = text.upper().replace("D", "E")
    if "E" not in text:
        text = _EXPONENT.sub(r"E\1", text)
    if "_" in text or text.strip().lstrip("+-") in _NOT_FINITE:
        raise ValueError(text)
    return float(text)


# cards of two scalar ends: the first end's fields, the second end's
_ENDS = {
    **dict.fromkeys(("CELAS1", "CELAS2", "CMASS1", "CMASS2", "CDAMP1", "CDAMP2"), ((3, 4), (5, 6))),
    **dict.fromkeys(
        ("CELAS3", "CELAS4", "CMASS3", "CMASS4", "CDAMP3", "CDAMP4", "CDAMP5"), ((3,), (4,))
    ),
}


def not_finite(fields: Fields) -> int | None:
    """Position of a word that Python would read as a number and Nastran would not."""
    for k, text in enumerate(fields[1:], start=1):
        if text is not None and text.lstrip("+-").upper() in _NOT_FINITE:
            return k
    return None


def as_pynastran_reads(name: str, fields: Fields) -> Fields:
    """Return the fields as pyNastran's classes want them, where Nastran takes more.

    A scalar element grounded at its first end has its ends exchanged, which changes nothing; a
    range of grids on an RBE2 is written out.
    """
    if name in _ENDS:
        return _first_end_there(fields, *_ENDS[name])
    if name == "EIGR" and len(fields) > 9 and str(fields[9]).upper() != "POINT":
        return fields[:10]  # G and C have a meaning with NORM = POINT only
    if name == "RBE2" and "THRU" in [str(f).upper() for f in fields]:
        return _written_out(fields, 4)
    return fields


def _first_end_there(fields: Fields, first: tuple[int, ...], second: tuple[int, ...]) -> Fields:
    padded = [*fields, *[None] * (second[-1] + 1 - len(fields))]
    if padded[first[0]] not in (None, "0") or padded[second[0]] in (None, "0"):
        return fields
    for i, j in zip(first, second, strict=True):
        padded[i], padded[j] = padded[j], padded[i]
    while padded[-1] is None:
        padded.pop()
    return padded


def _written_out(fields: Fields, start: int) -> Fields:
    """Fields with every ``a THRU b`` from `start` on replaced by the numbers themselves."""
    out = list(fields[:start])
    k = start
    while k < len(fields):
        bounds = (fields[k - 1], fields[k + 1]) if k + 1 < len(fields) else (None, None)
        ends = [int(b) for b in bounds if b is not None and b.isdigit()]
        if str(fields[k]).upper() == "THRU" and len(ends) == 2:
            out.extend(str(n) for n in range(ends[0] + 1, ends[1] + 1))
            k += 2
        else:
            out.append(fields[k])
            k += 1
    return out
