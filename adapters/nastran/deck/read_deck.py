"""Read a Nastran deck: sections, cards, case control, units."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from .cards import Bulk, Raw, read_bulk, to_float
from .casecontrol import CaseControl, read_case_control
from .catalogue import ELEMENTS_LEFT_OUT, IGNORED, refusal
from .lines import read_sections
from .units import find_length_unit


@dataclass(frozen=True)
class EigenRequest:
    """What EIGRL or EIGR asks for: a frequency range [Hz] and a number of modes; None: no limit."""

    v1: float | None = None
    v2: float | None = None
    nd: int | None = None


@dataclass(frozen=True, eq=False)
class Deck:
    """A Nastran deck as read, before anything is assembled.

    Parameters
    ----------
    path : Path
        The main file.
    files : tuple of Path
        The main file and its INCLUDE files, in the order met.
    bulk : Bulk
        The cards, as pyNastran's card classes hold them; opaque to other rooms.
    case : CaseControl
        Sets that the normal modes subcase selects.
    params : dict
        PARAM values by name, as text in capitals.
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
    refused: tuple[str, ...] = field(default=(), repr=False)

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
            return to_float(text)
        except ValueError:
            raise InputError(
                f"{self.path}: PARAM {name} is {text!r}, which is not a number"
            ) from None


def read_deck(path: str | Path) -> Deck:
    """Read a deck with its INCLUDE files.

    Parameters
    ----------
    path : path
        The main file; executive and case control may be missing (bulk data alone).

    Raises
    ------
    InputError
        A file that cannot be read or is not a deck, a card that cannot be read: file and line.
    """
    path = Path(path)
    sections = read_sections(path)
    bulk, others = read_bulk(sections.bulk, sections.files)
    if not bulk.raw:
        raise InputError(f"{path}: no bulk data card was found: is this a Nastran deck?")
    case, case_warnings = read_case_control(sections.case)
    every_line = (*sections.executive, *sections.case, *sections.bulk)
    unit, unit_warnings = find_length_unit(every_line, bulk)
    skipped, refused, skip_warnings = _skipped(bulk, others)
    counts = {name: _cards(raws) for name, raws in (*bulk.raw.items(), *others.items())}
    eigen = _eigen(bulk, case)
    unfound = () if eigen or case.method is None else (_no_method(path, case.method),)
    return Deck(
        path=path,
        files=sections.files,
        bulk=bulk,
        case=case,
        params=_params(bulk, sections.case),
        length_unit=unit,
        eigen=eigen,
        counts=counts,
        skipped=skipped,
        warnings=(*case_warnings, *unit_warnings, *skip_warnings, *_solution(sections), *unfound),
        refused=refused,
    )


def _cards(raws: list[Raw]) -> int:
    return sum(1 for raw in raws if raw.part == 0)


def _params(bulk: Bulk, case_lines: Any) -> dict[str, str]:
    params = {}
    for line in case_lines:  # PARAM may stand in case control too; bulk data then overrides it
        words = re.split(r"[\s,=]+", line.text.split("$", 1)[0].strip().upper())
        if words[0] == "PARAM" and len(words) > 2:
            params[words[1]] = words[2]
        if words[0].startswith("AUTOSPC") and len(words) > 1:
            params["AUTOSPC"] = words[-1]
    for fields in bulk.listed("PARAM"):
        if len(fields) > 2:
            params[str(fields[1]).upper()] = str(fields[2]).upper()
    return params


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
    return EigenRequest(card.f1, card.f2, card.nd)


def _no_method(path: Path, method: int) -> str:
    return (
        f"{path}: METHOD = {method} selects no EIGRL or EIGR of the deck; how many modes to find "
        "is left to trueup"
    )


def _solution(sections: Any) -> tuple[str, ...]:
    for line in sections.executive:
        words = line.text.split("$", 1)[0].upper().replace(",", " ").split()
        if len(words) > 1 and words[0] == "SOL" and not _is_modal(words[1]):
            return (f"the deck is for SOL {words[1]}; trueup takes its structure for normal modes",)
    return ()


def _is_modal(solution: str) -> bool:
    return solution in ("3", "103", "SEMODES", "MODES", "SEMFREQ", "111", "112", "SEMTRAN", "200")


def _skipped(
    bulk: Bulk, others: dict[str, list[Raw]]
) -> tuple[tuple[dict[str, Any], ...], tuple[str, ...], tuple[str, ...]]:
    skipped, refused, warnings = [], [], []
    for name, raws in others.items():
        first = raws[0]
        file = str(bulk.files[first.file])
        why = refusal(name)
        if why:
            number = _number(first)
            refused.append(f"{file} line {first.line}: {name}{number}: {why}")
        elif name not in IGNORED:
            why = "this card is not known"
            warnings.append(f"{file} line {first.line}: {name} is not known and was left out")
        else:
            why = IGNORED[name]
        count = f"{len(raws)} cards" if len(raws) > 1 else "1 card"
        if name in IGNORED and name in ELEMENTS_LEFT_OUT:
            warnings.append(f"{file} line {first.line}: {name} ({count}) is left out: {why}")
        skipped.append(
            {"what": f"{name} ({count}, first in {file})", "line": first.line, "why": why}
        )
    return tuple(skipped), tuple(refused), tuple(warnings)


def _number(raw: Raw) -> str:
    from .cards import fields_of

    fields = fields_of(raw.lines)
    return f" {fields[1]}" if len(fields) > 1 and fields[1] else ""
