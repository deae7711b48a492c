"""The fields of a card, cut from its lines."""

from __future__ import annotations

from .card_definition import Fields


def fields_of(lines: list[str]) -> Fields:
    """Return a card's fields, name first, eight a line, None where blank, none blank at the end."""
    if len(lines) == 1 and not any(mark in lines[0] for mark in ",*\t"):
        line = lines[0]
        fields: Fields = [line[i : i + 8].strip() or None for i in range(0, min(len(line), 72), 8)]
        fields[0] = fields[0].upper() if fields[0] else None
        while fields and fields[-1] is None:
            fields.pop()
        return fields
    fields = []
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
