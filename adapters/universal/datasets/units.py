"""Dataset 164: units."""

from collections.abc import Iterator
from dataclasses import dataclass

from ....core.data.length_units import METRES
from ..container import Section
from ..open_file import Source
from ..text.number_fields import floats, integers, text
from ..text.printing import dataset, name_field
from ..universal_content import Units
from .dataset_kind import DatasetKind, Gathered, Outgoing
from .section_lines import Lines

# What the codes of dataset 164 mean for lengths.
_CODES = {1: "m", 2: "ft", 3: "m", 4: "ft", 5: "mm", 6: "cm", 7: "in", 8: "mm", 10: "mm"}


UNITS = {
    "m": Units(1, "SI: Meter (newton)", 1.0, length_unit="m"),
    "mm": Units(10, "MN: mm (newton)", 1000.0, length_unit="mm"),
    "in": Units(7, "IN: Inch (pound f)", 1 / 0.0254, 0.2248089430997105, 1.8, 459.67, "in"),
    "ft": Units(2, "BG: Foot (pound f)", 1 / 0.3048, 0.2248089430997105, 1.8, 459.67, "ft"),
}


@dataclass(frozen=True)
class DeclaredUnits:
    """Units with the file and line that declare them."""

    units: Units
    path: str
    line: int


def _read(source: Source, section: Section, into: Gathered) -> int:
    lines = Lines(source, section, source.lines(section))
    head = lines.take(bytes)
    code = integers(head[:10])
    with lines.numbers(1):
        factors = floats(lines.lines[1:])
    if not code or not len(factors):
        raise lines.error(-1, "it is cut off; it needs a code and factors")
    length = float(factors[0])
    if length <= 0.0:
        raise lines.error(1, f"the length factor {length:g} is not positive")
    force, temperature, offset = [*factors[1:4], *(1.0, 1.0, 273.15)[len(factors) - 1 :]][:3]
    unit = _unit(length)
    where = f"{source.name} line {section.line}: dataset 164"
    declared = _CODES.get(code[0])
    if declared and unit != declared and _unit(1.0 / length) == declared:
        into.warnings.append(
            f"{where} gives the length factor upside down ({length:g} with code {code[0]}); "
            f"lengths are taken in {declared}, as the code says"
        )
        length, unit = 1.0 / length, declared
    elif declared and declared != unit:
        into.warnings.append(
            f"{where} declares {declared} by its code {code[0]} but the length factor {length:g}; "
            "the factor is used"
        )
    elif unit is None:
        into.warnings.append(f"{where}: the length factor {length:g} is no unit known here")
    rest = float(force), float(temperature), float(offset)
    units = Units(code[0], text(head[10:30]), length, *rest, unit if unit in METRES else None)
    into.add(DeclaredUnits(units, source.name, section.line))
    return 1


def _unit(factor: float) -> str | None:
    """Return the unit of length of which `factor` make a metre."""
    for unit, metres in (*METRES.items(), ("cm", 0.01)):
        if abs(factor * metres - 1.0) < 2e-3:
            return unit
    return None


def _write(out: Outgoing) -> Iterator[bytes]:
    units = out.units
    if units is None:
        return
    factors = (
        units.length_factor,
        units.force_factor,
        units.temperature_factor,
        units.temperature_offset,
    )
    printed = [(b"%25.17E" % f).replace(b"E", b"D") for f in factors]
    head = b"%10d" % units.code + name_field(units.name, 20) + b"%10d\n" % 2
    yield dataset(164, head, b"".join(printed[:3]) + b"\n", printed[3] + b"\n")


UNITS_164 = DatasetKind(
    164, "units", _read, lambda content: {"length_unit": content.length_unit}, _write, vital=True
)
