"""Datasets 151 (header) and 164 (units)."""

from __future__ import annotations

from ...core.units import METRES
from .container import Section
from .content import Header, Units
from .fields import NotANumber, floats, integers, text
from .source import Source

# What the codes of dataset 164 mean for lengths.
_CODES = {1: "m", 2: "ft", 3: "m", 4: "ft", 5: "mm", 6: "cm", 7: "in", 8: "mm", 10: "mm"}


def read_header(source: Source, section: Section) -> Header:
    """Read dataset 151."""
    lines = [text(line) for line in source.lines(section)] + [""] * 7
    program = " ".join(lines[5].split())
    return Header(lines[0], lines[1], program, " ".join(lines[3].split()[:2]))


def read_model_header(source: Source, section: Section) -> Header:
    """Read dataset 2400: entity name and part number of the model."""
    lines = [text(line) for line in source.lines(section)] + [""] * 6
    return Header(lines[1], lines[2], "", " ".join(lines[4].split()[:2]))


def read_units(source: Source, section: Section, warnings: list[str]) -> Units:
    """Read dataset 164."""
    lines = source.lines(section)
    code = integers(lines[0][:10]) if lines else []
    try:
        factors = floats(lines[1:])
    except NotANumber as error:
        raise source.error(
            section.line + 2 + error.row, f"dataset 164: {error.text!r} is not a number"
        ) from None
    if not code or not len(factors):
        raise source.error(section.line, "dataset 164 is cut off; it needs a code and factors")
    length = float(factors[0])
    if length <= 0.0:
        raise source.error(
            section.line + 2, f"dataset 164: the length factor {length:g} is not positive"
        )
    force, temperature, offset = [*factors[1:4], *(1.0, 1.0, 273.15)[len(factors) - 1 :]][:3]
    unit = _unit(length)
    where = f"{source.name} line {section.line}: dataset 164"
    declared = _CODES.get(code[0])
    if declared and unit != declared and _unit(1.0 / length) == declared:
        warnings.append(
            f"{where} gives the length factor upside down ({length:g} with code {code[0]}); "
            f"lengths are taken in {declared}, as the code says"
        )
        length, unit = 1.0 / length, declared
    elif declared and declared != unit:
        warnings.append(
            f"{where} declares {declared} by its code {code[0]} but the length factor {length:g}; "
            "the factor is used"
        )
    elif unit is None:
        warnings.append(f"{where}: the length factor {length:g} is no unit known here")
    return Units(
        code[0],
        text(lines[0][10:30]),
        length,
        float(force),
        float(temperature),
        float(offset),
        unit if unit in METRES else None,
    )


def _unit(factor: float) -> str | None:
    """Return the unit of length of which `factor` make a metre."""
    for unit, metres in (*METRES.items(), ("cm", 0.01)):
        if abs(factor * metres - 1.0) < 2e-3:
            return unit
    return None
