"""Read a Nastran deck: sections, cards, case control, units."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ....core.errors import InputError, Place
from ....core.noun import Noun
from ..text.deck_text import DeckText, read_deck_text
from ..text.real_numbers import parse_real
from .bulk import Bulk, read_bulk
from .card_definition import Card
from .case_control import CaseControl, read_case_control
from .deck_length_unit import find_length_unit
from .logical_lines import read_sections
from .number_spaces import space_of
from .pynastran_bridge import bdf_of
from .raw_cards import Raw, fields_of

_NOT_KNOWN = "this card is not known"
_MODAL = ("3", "103", "SEMODES", "MODES", "SEMFREQ", "111", "112", "SEMTRAN", "200")


_BARMASS = re.compile(r"\b(?:BARMASS|SYSTEM *\( *398 *\)) *= *(\d+)")
_BARE = re.compile(r"\bSYSTEM *\( *414 *\) *= *[1-9]")
_ASSIGN = re.compile(
    r"ASSIGN\s+INPUTT4\s*=\s*'(?P<file>[^']+)'[^']*?UNIT\s*=\s*(?P<unit>\d+)", re.IGNORECASE
)


_SHAPING = {
    **dict.fromkeys(("QR6ROT", "QRSHEAR", "GEV1417", "RMRBE3RT"), ("0", "")),
    **dict.fromkeys(("DELELAS", "DELMASS", "DELWELD", "DELFAST", "DELSEAM"), ("0.",)),
    "OFFDEF": ("ELMOFF",),
    "SHEARP": ("GARVEY",),
}
"""MDLPRM that changes stiffness or mass, with the values that are what is done here (QRG 2022)."""


@dataclass(frozen=True, eq=False)
class External:
    """Stiffness and mass (m, m) of an external superelement on (grid, component), 0: scalar."""

    points: tuple[tuple[int, int], ...]
    stiffness: Any
    mass: Any


@dataclass(frozen=True)
class EigenRequest:
    """What EIGRL or EIGR asks for: a frequency range [Hz] and a number of modes; None: no limit."""

    v1: float | None = None
    v2: float | None = None
    nd: int | None = None


@dataclass(frozen=True, eq=False)
class Deck(Noun):
    """A Nastran deck as read, before anything is assembled.

    Parameters
    ----------
    path : Path
        The main file.
    files : tuple of Path
        The main file and its INCLUDE files, in the order met.
    bulk : Bulk
        The cards.
    case : CaseControl
        Sets that the normal modes subcase selects.
    params : dict
        PARAM values by name, as text in capitals, and BARMASS of the NASTRAN statement.
    length_unit : {"m", "mm", "in", "ft"} or None
        What the deck declares, None where it does not.
    eigen : EigenRequest or None
        What the selected EIGRL or EIGR asks for.
    counts : dict of str to int
        Number of cards by name, in the order met.
    skipped : tuple of dict
        ``what``, ``line``, ``why`` of every kind of card that is not used.
    warnings : tuple of str
        What was assumed.
    parts : mapping of int to Bulk
        Superelements (BEGIN SUPER) as they stand; `bulk` holds them too, joined.
    assigned : mapping of int to Path
        Files of matrices (ASSIGN INPUTT4) by their units.
    external : tuple of External
        Matrices of external superelements.
    """

    path: Path
    files: tuple[Path, ...]
    bulk: Bulk
    case: CaseControl
    params: dict[str, str]
    length_unit: str | None
    eigen: EigenRequest | None
    counts: dict[str, int]
    skipped: tuple[dict[str, Any], ...] = ()
    warnings: tuple[str, ...] = ()
    parts: Mapping[int, Bulk] = field(default_factory=dict, repr=False)
    assigned: Mapping[int, Path] = field(default_factory=dict, repr=False)
    external: tuple[External, ...] = field(default=(), repr=False)
    refused: tuple[InputError, ...] = field(default=(), repr=False)
    changed: DeckText | None = field(default=None, repr=False)
    on_disk: bool = True
    """Whether `path` holds what was read: not of a changed deck or of an object of pyNastran."""

    @property
    def told(self) -> str:
        """How results name it."""
        return str(self.path) if self.on_disk else f"{self.path.name} (an object, not the file)"

    @property
    def text(self) -> DeckText:
        """All its files, byte for byte: as they are on disk, or as a changed deck was read."""
        return self.changed or read_deck_text(self.path)

    def __repr__(self) -> str:
        held = Counter[str]()
        for name, count in self.counts.items():
            held[space_of(name, self.bulk.definitions)] += count
        return (
            f"Deck({self.path.name!r}: {self.counts.get('GRID', 0):,} grids, "
            f"{held['element']:,} elements, {held['property']:,} properties)"
        )

    def to_pynastran(self) -> Any:
        """Return pyNastran's `BDF` of this deck, without cross-references.

        Raises
        ------
        InputError
            pyNastran is not installed, or does not read the deck; the deck was changed and is
            not on disk.
        """
        if self.changed:
            raise Place(self.path).fault("was changed: write the deck and read that")
        return bdf_of(self.path)

    def param(self, name: str, default: float) -> float:
        """Return a PARAM value as a number.

        Raises
        ------
        InputError
            The value is not a number.
        """
        text = self.params.get(name)
        if text is None:
            return default
        try:
            return parse_real(text)
        except ValueError:
            cards = (p for card, p in self.bulk.placed("PARAM") if card.n == name)
            place = next(cards, Place(self.path, card=f"PARAM {name}"))
            raise place.error(f"{name} is {text!r}, which is not a number") from None


def read_deck(source: str | Path | DeckText, definitions: Mapping[str, Card]) -> Deck:
    """Read a deck with its INCLUDE files.

    Parameters
    ----------
    source : path or DeckText
        The main file; executive and case control may be missing (bulk data alone).
    definitions : mapping
        By card name: the cards that are read.

    Raises
    ------
    InputError
        A file that cannot be read or is not a deck, a card that cannot be read: file and line.
    """
    changed = source if isinstance(source, DeckText) else None
    path = source.files[0].path if isinstance(source, DeckText) else Path(source)
    sections = read_sections(changed or path)
    bulk, others, bulk_warnings = read_bulk(sections.bulk, sections.files, definitions)
    parts = {}
    for number, lines in sections.parts.items():
        parts[number], more, told = read_bulk(lines, sections.files, definitions)
        bulk_warnings += told
        for name, raws in more.items():
            others.setdefault(name, []).extend(raws)
    if not (bulk.raw or parts):
        raise Place(path).error("no bulk data card was found: is this a Nastran deck?")
    solution = _solution(sections)
    in_turn = solution not in _MODAL
    case, case_warnings = read_case_control(sections.case, sections.files, in_turn)
    every_line = (*sections.executive, *sections.case, *sections.bulk)
    every_bulk = (bulk, *parts.values())
    unit, unit_warnings = find_length_unit(every_line, bulk)
    skipped, refused, skip_warnings = _skipped(bulk, others, case)
    counts: dict[str, int] = {}
    for name, raws in (*(item for b in every_bulk for item in b.raw.items()), *others.items()):
        counts[name] = counts.get(name, 0) + sum(raw.part == 0 for raw in raws)
    eigen = _eigen(bulk, case)
    warnings = [
        *sections.warnings,
        *case_warnings,
        *bulk_warnings,
        *unit_warnings,
        *skip_warnings,
        *_other_solution(solution),
        *(f"{path}: {told}" for told in _direct_matrices(sections, bulk, case)),
    ]
    params = _cells(sections) | _params(bulk, sections.case, case.subcase)
    not_followed = _not_followed(sections, params, case, others)
    warnings += [f"{path}: {told}" for told in not_followed]
    if eigen is None and case.method is not None:
        warnings.append(
            f"{path}: METHOD = {case.method} selects no EIGRL or EIGR of the deck; how many modes "
            "to find is left to trueup"
        )
    return Deck(
        path=path,
        files=sections.files,
        bulk=bulk,
        case=case,
        params=params,
        length_unit=unit,
        eigen=eigen,
        counts=counts,
        skipped=skipped,
        warnings=tuple(warnings),
        parts=parts,
        assigned=_assigned(sections, path),
        refused=refused,
        changed=changed,
        on_disk=changed is None,
    )


def _cells(sections: Any) -> dict[str, str]:
    """Cells of the NASTRAN statement that shape matrices, as if they were PARAM values."""
    text = " ".join(line.text.split("$", 1)[0].upper() for line in sections.executive)
    found = _BARMASS.search(text)
    return {"BARMASS": found[1]} if found else {}


def _params(bulk: Bulk, case_lines: Any, subcase: int) -> dict[str, str]:
    """Values of PARAM: bulk data overrides the subcase, what stands above subcases bulk data."""
    above: dict[str, str] = {}
    inside: dict[str, str] = {}
    params = above
    for line in case_lines:
        words = re.split(r"[\s,=]+", line.text.split("$", 1)[0].strip().upper())
        if words[0].startswith("SUBC"):
            others = words[1:] and words[1].isdecimal() and int(words[1]) != subcase
            params = {} if others else inside
        if words[0] == "PARAM" and len(words) > 2:
            params[words[1]] = words[2]
        if words[0].startswith("AUTOSPC") and len(words) > 1:
            params["AUTOSPC"] = words[-1]
    given = {card.n: card.v1 for card in bulk.listed("PARAM") if card.v1 is not None}
    return inside | given | above


def _eigen(bulk: Bulk, case: CaseControl) -> EigenRequest | None:
    names = ("EIGRL", "EIGR")
    found = bulk.find(names, case.method) if case.method is not None else None
    if found is None and case.method is None:
        every = [(n, c) for n in names for c in bulk.table(n).values()]
        found = every[0] if len(every) == 1 else None
    if found is None:
        return None
    name, card = found
    if name == "EIGRL":
        return EigenRequest(card.v1, card.v2, card.nd)
    nd = 3 * card.ne if card.nd is None and card.ne and card.method == "INV" else card.nd
    return EigenRequest(card.f1, card.f2, nd)


def _assigned(sections: Any, path: Path) -> dict[int, Path]:
    text = " ".join(line.text.split("$", 1)[0] for line in sections.executive)
    return {int(m["unit"]): path.parent / m["file"].strip() for m in _ASSIGN.finditer(text)}


def _solution(sections: Any) -> str:
    for line in sections.executive:
        words = line.text.split("$", 1)[0].upper().replace(",", " ").split()
        if len(words) > 1 and words[0] == "SOL":
            return str(words[1])
    return ""


def _other_solution(solution: str) -> Iterator[str]:
    if solution and solution not in _MODAL:
        yield f"the deck is for SOL {solution}; trueup takes its structure for normal modes"


def _direct_matrices(sections: Any, bulk: Bulk, case: CaseControl) -> Iterator[str]:
    """Say of matrices of DMIG what is not added, or not everywhere."""
    for command, names in case.not_added:
        yield (
            f"{command} = {' + '.join(names)} is for response analyses; normal modes go without it"
        )
    words = {w for line in sections.case for w in re.split(r"\W+", line.text.upper())}
    for name in dict.fromkeys(card.name for card in bulk.listed("DMIG")):
        if name not in words:
            yield f"DMIG {name} is added nowhere: case control (K2GG, M2GG, ...) does not select it"


def _not_followed(
    sections: Any, params: Mapping[str, str], case: CaseControl, others: dict[str, list[Raw]]
) -> Iterator[str]:
    """Say of parameters and selections that shape stiffness or mass and are not read."""
    for name, beside in (("CK1", "K2GG"), ("CM1", "M2GG"), ("CB1", "B2GG"), ("CK3", None)):
        try:
            given: float | None = parse_real(params.get(name, "1."))
        except ValueError:
            given = None
        if given != 1.0 and (beside is None or getattr(case, beside.lower())):
            yield (
                f"PARAM {name} = {params[name]} is not read: the matrices of the elements go in "
                "as they are"
            )
    if any(_BARE.search(line.text.split("$", 1)[0].upper()) for line in sections.executive):
        yield "SYSTEM(414) is not read: lumped masses of CBAR and CBEAM are as without it"
    for raw in others.get("SET3", ()):
        number, kind = [*fields_of(raw.lines)[1:3], None, None][:2]
        if str(kind).upper() in ("RBEIN", "RBEEX") and number == str(case.mpc):
            yield f"SET3 {number} selects rigid elements ({kind}), which is not read: all are used"
    cells = [
        field for raw in others.get("MDLPRM", ()) for field in fields_of(raw.lines)[1:] if field
    ]
    for name, value in zip(cells, [*cells[1:], ""], strict=False):
        if name.upper() in _SHAPING and value.upper() not in _SHAPING[name.upper()]:
            yield f"MDLPRM {name.upper()} {value} is not read: elements are as without it"


def _skipped(
    bulk: Bulk, others: dict[str, list[Raw]], case: CaseControl
) -> tuple[tuple[dict[str, Any], ...], tuple[InputError, ...], tuple[str, ...]]:
    skipped, refused, warnings = [], [], []
    for name, raws in others.items():
        first = raws[0]
        file = str(bulk.files[first.file])
        seen = seen_from(bulk.files[0], bulk.files[first.file])
        card = bulk.definitions.get(name) or _unknown(name)
        why = card.refused or card.ignored
        count = f"{len(raws)} cards" if len(raws) > 1 else "1 card"
        idle = bool(card.selected_by) and card.selected_by[:4] not in case.commands
        if idle:
            why = f"{card.selected_by} selects none"
        if card.refused and not idle:
            named = " ".join([name, *filter(None, fields_of(first.lines)[1:2])])
            refused.append(bulk.at(first).error(f"{named}: {why}", named))
        elif card.ignored == _NOT_KNOWN:
            warnings.append(f"{file} line {first.line}: {name} is not known and was left out")
        elif card.warned or idle:
            warnings.append(f"{file} line {first.line}: {name} ({count}) is left out: {why}")
        where = f", first in {seen}" if first.file else ""  # the deck itself goes without saying
        skipped.append({"what": f"{name} ({count}{where})", "line": first.line, "why": why})
    return tuple(skipped), tuple(refused), tuple(warnings)


def seen_from(main: Path, file: Path) -> str:
    """Name a file of a deck as its INCLUDE would: short where it lies below the deck's folder."""
    try:
        return str(file.resolve().relative_to(main.resolve().parent))
    except ValueError:
        return str(file)


def _unknown(name: str) -> Card:
    """Refuse a card that nobody knows where its name is that of an element or a constraint."""
    if name.startswith(("C", "R", "SPC", "MPC")):
        why = f"{_NOT_KNOWN} and its name is that of an element or a constraint"
        return Card(name, refused=why)
    return Card(name, ignored=_NOT_KNOWN)
