"""Where a named value stands on a card: the layouts of the Quick Reference Guide as a table.

A position is the field number printed above the card in the guide, counted on over the
continuations: 1 is the name, 2 to 9 the data of the first line, 12 to 19 of the second, 22 to 29
of the third, whatever format the lines are written in.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable
from dataclasses import dataclass, field

from ...core.errors import InputError
from .editing.numbers import parse_real

Read = Callable[[int], str]
"""Text of the field at a position of one card, stripped and in capitals; "" where blank."""

# One row a card, as the guide prints it from field 2 on; "/" starts the next line, "-" is a field
# that is always blank, parentheses hold what is not a value to move (numbers, names, options).
_LAYOUTS = {
    "CELAS2": "(EID) K (G1) (C1) (G2) (C2) GE S",
    "CELAS4": "(EID) K (S1) (S2)",
    "CDAMP2": "(EID) B (G1) (C1) (G2) (C2)",
    "CDAMP4": "(EID) B (S1) (S2)",
    "CMASS2": "(EID) M (G1) (C1) (G2) (C2)",
    "CMASS4": "(EID) M (S1) (S2)",
    "CONM1": "(EID) (G) (CID) M11 M21 M22 M31 M32 / M33 M41 M42 M43 M44 M51 M52 M53 / "
    "M54 M55 M61 M62 M63 M64 M65 M66",
    "CONM2": "(EID) (G) (CID) M X1 X2 X3 - / I11 I21 I22 I31 I32 I33",
    "CONROD": "(EID) (G1) (G2) (MID) A J C NSM",
    "MAT1": "(MID) E G NU RHO A TREF GE / ST SC SS (MCSID)",
    "MAT2": "(MID) G11 G12 G13 G22 G23 G33 RHO / A1 A2 A3 TREF GE ST SC SS / (MCSID)",
    "MAT3": "(MID) EX ETH EZ NUXTH NUTHZ NUZX RHO / - - GZX AX ATH AZ TREF GE",
    "MAT8": "(MID) E1 E2 NU12 G12 G1Z G2Z RHO / A1 A2 TREF XT XC YT YC S / GE F12 (STRN)",
    "MAT9": "(MID) G11 G12 G13 G14 G15 G16 G22 / G23 G24 G25 G26 G33 G34 G35 G36 / "
    "G44 G45 G46 G55 G56 G66 RHO A1 / A2 A3 A4 A5 A6 TREF GE",
    "MAT10": "(MID) BULK RHO C GE",
    "MAT11": "(MID) E1 E2 E3 NU12 NU13 NU23 G12 / G13 G23 RHO A1 A2 A3 TREF GE",
    "NSM": "(SID) (TYPE) (ID) VALUE1 (ID2) VALUE2 (ID3) VALUE3",
    "NSM1": "(SID) (TYPE) VALUE",
    "NSML": "(SID) (TYPE) (ID) VALUE1 (ID2) VALUE2 (ID3) VALUE3",
    "NSML1": "(SID) (TYPE) VALUE",
    "PBAR": "(PID) (MID) A I1 I2 J NSM - / C1 C2 D1 D2 E1 E2 F1 F2 / K1 K2 I12",
    "PBARL": "(PID) (MID) (GROUP) (TYPE) - - - -",
    "PBEAM": "(PID) (MID) A(A) I1(A) I2(A) I12(A) J(A) NSM(A) / "
    "C1(A) C2(A) D1(A) D2(A) E1(A) E2(A) F1(A) F2(A)",
    "PBEAML": "(PID) (MID) (GROUP) (TYPE) - - - -",
    "PBEND": "(PID) (MID) A I1 I2 J RB THETAB / C1 C2 D1 D2 E1 E2 F1 F2 / K1 K2 NSM RC ZC DELTAN",
    "PBUSH": "(PID)",
    "PBUSH1D": "(PID) K C M - SA SE",
    "PCOMP": "(PID) Z0 NSM SB (FT) TREF GE (LAM)",
    "PCOMPG": "(PID) Z0 NSM SB (FT) TREF GE (LAM)",
    "PDAMP": "(PID) B",
    "PELAS": "(PID) K GE S",
    "PFAST": "(PID) D (MCID) (MFLAG) KT1 KT2 KT3 KR1 / KR2 KR3 MASS GE",
    "PMASS": "(PID) M",
    "PROD": "(PID) (MID) A J C NSM",
    "PSHEAR": "(PID) (MID) T NSM F1 F2",
    "PSHELL": "(PID) (MID1) T (MID2) 12I/T**3 (MID3) TS/T NSM / Z1 Z2 (MID4)",
    "PTUBE": "(PID) (MID) OD T NSM OD2",
    "PVISC": "(PID) CE CR",
    "PWELD": "(PID) (MID) D - - (MSET) - (TYPE)",
}

# Cards that hold several properties, each with its own number, by how many fields apart.
STRIDES = {"CDAMP4": 4, "CMASS4": 4, "PDAMP": 2, "PELAS": 4, "PMASS": 2, "PVISC": 4}

# Dimensions of the section library, and where a station repeats.
_SECTION_DIMENSIONS = {
    "BAR": 2, "BOX": 4, "BOX1": 6, "CHAN": 4, "CHAN1": 4, "CHAN2": 4, "CROSS": 4, "DBOX": 10,
    "H": 4, "HAT": 4, "HAT1": 5, "HEXA": 3, "I": 6, "I1": 4, "L": 4, "ROD": 1, "T": 4, "T1": 4,
    "T2": 4, "TUBE": 2, "TUBE2": 2, "Z": 4,
}  # fmt: skip

_STATION = ("A", "I1", "I2", "I12", "J", "NSM")
_STATION_POINTS = ("C1", "C2", "D1", "D2", "E1", "E2", "F1", "F2")
_PBEAM_TAIL = (
    ("K1", "K2", "S1", "S2", "NSI(A)", "NSI(B)", "CW(A)", "CW(B)"),
    ("M1(A)", "M2(A)", "M1(B)", "M2(B)", "N1(A)", "N2(A)", "N1(B)", "N2(B)"),
)
_PBUSH_LINES = {
    **{f"{kind}{n}": (kind, 3 + n) for kind in ("K", "B", "GE") for n in range(1, 7)},
    **{n: ("RCV", 3 + i) for i, n in enumerate(("SA", "ST", "EA", "ET"), 1)},
    "M": ("M", 4),
}
_STATION_NAME = re.compile(r"(?P<what>[A-Z]+\d*)\((?P<at>A|B|0?\.\d+)\)")
_PLY_NAME = re.compile(r"(?P<what>T|THETA)(?P<ply>[1-9]\d*)")
_DIMENSION_NAME = re.compile(r"DIM(?P<number>[1-9]\d?)(\((?P<at>A|B|0?\.\d+)\))?")

_SYNONYMS = {
    "*": {"RO": "RHO", "DENSITY": "RHO"},
    "CONM2": {"MASS": "M", "I12": "I21", "I13": "I31", "I23": "I32"},
    "CONROD": {"AREA": "A"},
    "MAT1": {"ALPHA": "A"},
    "MAT8": {"E11": "E1", "E22": "E2", "G13": "G1Z", "G23": "G2Z", "G1,Z": "G1Z", "G2,Z": "G2Z"},
    "NSM": {"VALUE": "VALUE1"},
    "NSML": {"VALUE": "VALUE1"},
    "PBAR": {"AREA": "A", "I11": "I1", "I22": "I2"},
    "PBARL": {},
    "PBEAM": {"AREA": "A(A)"},
    "PCOMP": {},
    "PELAS": {"K1": "K", "GE1": "GE", "S1": "S"},
    "PMASS": {"M1": "M", "MASS": "M"},
    "PROD": {"AREA": "A"},
    "PSHELL": {
        **dict.fromkeys(("12I/T3", "12I/T^3", "12I/TTT", "12I/T*3", "BK"), "12I/T**3"),
        "TST": "TS/T",
        "THICKNESS": "T",
    },
    "PTUBE": {"OD1": "OD"},
}  # fmt: skip


@dataclass(frozen=True)
class Layout:
    """Positions of the values of one card that stand at a fixed place."""

    values: dict[str, int] = field(default_factory=dict)
    others: dict[str, int] = field(default_factory=dict)


def _parse_layout(row: str) -> Layout:
    values: dict[str, int] = {}
    others: dict[str, int] = {}
    for line, part in enumerate(row.split(" / ")):
        for column, name in enumerate(part.split(), start=2):
            if name.startswith("("):
                others[name[1:-1]] = 10 * line + column
            elif name != "-":
                values[name] = 10 * line + column
    return Layout(values, others)


LAYOUTS = {card: _parse_layout(row) for card, row in _LAYOUTS.items()}
"""By card name: the values that may move and the other fields, with their positions."""


def canonical_field(card: str, name: str) -> str:
    """Return a field's one name, from the way a user may write it.

    Parameters
    ----------
    card : str
        Card name in capitals, one of `LAYOUTS`.
    name : str
        Field name as in the guide, in any case, or a common synonym; on PBEAM and PBEAML a name
        without a station is end A.

    Raises
    ------
    InputError
        The card has no such value; near spellings are offered.
    """
    if card not in LAYOUTS:
        raise InputError(_unknown_card(card))
    written, name = name, name.upper()
    name = _SYNONYMS.get(card, {}).get(name, _SYNONYMS["*"].get(name, name))
    if card in ("PBEAM", "PBEAML") and f"{name}(A)" in (*_names(card), "NSM(A)"):
        name = f"{name}(A)"
    if name in _names(card) or _is_station(card, name):
        return name
    if name in LAYOUTS[card].others:
        raise InputError(f"{card} {written}: this field holds a number or an option, not a value")
    near = difflib.get_close_matches(name, _names(card), n=3, cutoff=0.5)
    hint = f"did you mean {' or '.join(near)}" if near else f"it has {_list_names(card)}"
    raise InputError(f"{card} has no value {written!r}: {hint}")


def field_position(card: str, name: str, read: Read) -> int | None:
    """Return the position of a value on one card, or None where this card does not hold it.

    Parameters
    ----------
    card, name : str
        In their canonical form.
    read : callable
        Gives the text of the card's fields, for cards whose layout depends on what they hold
        (stations of a PBEAM, section of a PBARL, lines of a PBUSH).
    """
    fixed = LAYOUTS[card].values.get(name)
    if fixed is not None:
        return fixed
    if card in ("PCOMP", "PCOMPG"):
        return _ply_position(card, name, read)
    if card in ("PBARL", "PBEAML"):
        return _section_position(card, name, read)
    if card == "PBUSH":
        return _pbush_position(name, read)
    if card == "PBEAM":
        return _pbeam_position(name, read)
    return None


def _names(card: str) -> tuple[str, ...]:
    """Names of a card's values, one of each kind where there may be any number."""
    more: tuple[str, ...] = ()
    if card in ("PCOMP", "PCOMPG"):
        more = tuple(f"{w}{n}" for n in range(1, 1000) for w in ("T", "THETA"))
    elif card == "PBARL":
        more = (*(f"DIM{n}" for n in range(1, 11)), "NSM")
    elif card == "PBEAML":
        more = (*(f"DIM{n}(A)" for n in range(1, 11)), "NSM(A)")
    elif card == "PBUSH":
        more = tuple(_PBUSH_LINES)
    elif card == "PBEAM":
        more = (*_PBEAM_TAIL[0], *_PBEAM_TAIL[1])
    return (*LAYOUTS[card].values, *more)


def _is_station(card: str, name: str) -> bool:
    if card == "PBEAM":
        match = _STATION_NAME.fullmatch(name)
        return bool(match) and match["what"] in (*_STATION, *_STATION_POINTS)  # type: ignore[index]
    if card == "PBEAML":
        match = _STATION_NAME.fullmatch(name)
        return bool(_DIMENSION_NAME.fullmatch(name)) or (
            bool(match) and match["what"] == "NSM"  # type: ignore[index]
        )
    return False


def _list_names(card: str) -> str:
    names = _names(card)
    return ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")


def _unknown_card(card: str) -> str:
    if card in ("PSOLID", "PLSOLID", "PLPLANE", "PCOMPS"):
        return f"{card} has no value to move: name the material, such as MAT1 1 E"
    near = difflib.get_close_matches(card, LAYOUTS, n=3, cutoff=0.6)
    hint = f"did you mean {' or '.join(near)}" if near else "see the cards that hold values"
    if not near:
        hint = "cards with values to move are " + ", ".join(sorted(LAYOUTS))
    return f"no parameter can be taken from a card {card!r}: {hint}"


def after(position: int, steps: int) -> int:
    """Return the position `steps` data fields after another, over the line ends.

    >>> after(8, 3)
    13
    """
    line, column = divmod(position, 10)
    data = line * 8 + (column - 2) + steps
    return 10 * (data // 8) + data % 8 + 2


def _ply_position(card: str, name: str, read: Read) -> int | None:
    """Each ply has four fields on PCOMP, a line on PCOMPG; a ply that is not there has none."""
    match = _PLY_NAME.fullmatch(name)
    if not match:
        return None
    column = {"T": 1, "THETA": 2}[match["what"]]
    fields, number = (4, 0) if card == "PCOMP" else (8, 1)
    start = after(12, fields * (int(match["ply"]) - 1))
    there = any(read(after(start, k)) for k in range(number + 4))
    return after(start, number + column) if there else None


def _section_position(card: str, name: str, read: Read) -> int | None:
    """DIM1..DIMn, NSM (and on PBEAML SO, X/XB before each further station) from line 2 on."""
    n = _SECTION_DIMENSIONS.get(read(5))
    if n is None:
        return None
    start: int | None = 12
    what, at = name, "A"
    match = re.fullmatch(r"(?P<what>\w+)\((?P<at>[^)]*)\)", name)
    if match:
        what, at = match["what"], match["at"]
    if card == "PBEAML" and at != "A":
        start = _find_station(after(12, n + 1), n + 3, at, read)
        start = None if start is None else after(start, 2)
    if start is None:
        return None
    if what == "NSM":
        return after(start, n)
    number = int(what.removeprefix("DIM"))
    return after(start, number - 1) if number <= n else None


def _find_station(position: int, stride: int, at: str, read: Read) -> int | None:
    """Position of the SO field of the station at X/XB `at` ("B" is 1.0)."""
    wanted = 1.0 if at == "B" else float(at)
    while read(position) in ("YES", "YESA", "NO"):
        if _is_near(read(after(position, 1)), wanted):
            return position
        position = after(position, stride)
    return None


def _is_near(text: str, wanted: float) -> bool:
    try:
        return abs(parse_real(text) - wanted) < 1e-6
    except ValueError:
        return False


def _pbush_position(name: str, read: Read) -> int | None:
    """Each line of a PBUSH starts with the word that says what it holds."""
    flag, column = _PBUSH_LINES[name]
    lines = [line for line in range(8) if read(10 * line + 3) == flag]
    return 10 * lines[0] + column if lines else None


def _pbeam_position(name: str, read: Read) -> int | None:
    """Stations (one or two lines each) may stand between end A and the last two lines."""
    line = 1 if read(12) in ("YES", "YESA", "NO") else 2
    stations: list[int] = []
    while read(10 * line + 2) in ("YES", "YESA", "NO"):
        stations.append(line)
        line += 2 if read(10 * line + 2) == "YES" else 1
    for row, names in enumerate(_PBEAM_TAIL):
        if name in names:
            return 10 * (line + row) + 2 + names.index(name)
    match = _STATION_NAME.fullmatch(name)
    if not match or match["at"] == "A":
        return None
    wanted = 1.0 if match["at"] == "B" else float(match["at"])
    for station in stations:
        if _is_near(read(10 * station + 3), wanted):
            if match["what"] in _STATION:
                return 10 * station + 4 + _STATION.index(match["what"])
            if read(10 * station + 2) == "YES":
                return 10 * station + 12 + _STATION_POINTS.index(match["what"])
    return None
