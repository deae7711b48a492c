"""What the case control section asks of normal modes."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from ....core.errors import Place
from ..text.real_numbers import parse_real
from .logical_lines import Line

_COMMAND = re.compile(
    r"^\s*(?P<key>[A-Za-z]\w*)\s*(?:\((?P<option>[^)]*)\))?\s*(?:=\s*|\s+)(?P<value>\S.*)$"
)
_SETS = {"SPC": "spc", "MPC": "mpc", "NSM": "nsm", "SUPORT1": "suport1"}
_MATRICES = ("K2GG", "M2GG", "B2GG", "K42GG")
_NOT_ADDED = ("K2PP", "M2PP", "B2PP")
_MOST = 9999
"""Superelements of a set between two numbers."""
_LOADED = (
    "the deck asks for modes of the structure under loads (STATSUB, or steps before them); those "
    "of the unloaded structure are found: without stress stiffness, large motions and damage",
)
_WEIGHTED = re.compile(r"(?:\(?\s*(?P<factor>[-+.\dEeDd]+)\s*\)?\s*\*\s*)?(?P<name>[A-Za-z]\w*)")


@dataclass(frozen=True)
class CaseControl:
    """Sets and matrices that the normal modes subcase selects; None or empty where it does not.

    Parameters
    ----------
    subcase : int
        Number of the subcase, 0 when the deck has none.
    spc, mpc, method, nsm, suport1, temperature : int or None
        Set numbers; `temperature` is that of TEMPERATURE(INITIAL), or (MATERIAL) or (BOTH),
        which is meant without an option.
    k2gg, m2gg, b2gg, k42gg : tuple of (name, factor)
        Names of DMIG matrices.
    not_added : tuple of (command, (name, ...))
        Those of the p-set (PP), which is for response analyses.
    analysis, loaded
        What the subcase is for, and whether loads stiffen its structure (STATSUB).
    sdamping : int or None
        Table of modal damping (TABDMP1).
    superelement : int
        The one that the subcase is for, 0 for the residual structure or all.
    of_parts : tuple of (superelement, (spc, mpc))
        Constraint sets that subcases of their own select for superelements.
    commands : frozenset of str
        Commands of all subcases, four letters of each.
    """

    subcase: int = 0
    spc: int | None = None
    mpc: int | None = None
    method: int | None = None
    nsm: int | None = None
    suport1: int | None = None
    temperature: int | None = None
    k2gg: tuple[tuple[str, float], ...] = ()
    m2gg: tuple[tuple[str, float], ...] = ()
    b2gg: tuple[tuple[str, float], ...] = ()
    k42gg: tuple[tuple[str, float], ...] = ()
    not_added: tuple[tuple[str, tuple[str, ...]], ...] = ()
    analysis: str = field(default="", compare=False)
    loaded: bool = field(default=False, compare=False)
    sdamping: int | None = field(default=None, compare=False)
    superelement: int = field(default=0, compare=False)
    of_parts: tuple[tuple[int, tuple[int | None, int | None]], ...] = ()
    commands: frozenset[str] = field(default=frozenset(), compare=False)


def read_case_control(
    lines: Iterable[Line], files: Sequence[Path], in_turn: bool = True
) -> tuple[CaseControl, tuple[str, ...]]:
    """Return the facts of the first normal modes subcase, and warnings.

    A subcase that asks for modes is the first with METHOD (its own or the one above all
    subcases) and no other ANALYSIS; without one it is the first that is not for heat. Subcases
    that select other constraints are named in a warning. Where subcases follow each other
    (`in_turn`: the nonlinear solutions), loads of those before stiffen the structure.

    Raises
    ------
    InputError
        A factor that is no number: file and line.
    """
    matches = [(line, _COMMAND.match(line.text.split("$", 1)[0])) for line in lines]
    above = CaseControl(commands=frozenset(m["key"].upper()[:4] for _, m in matches if m))
    subcases: list[CaseControl] = []
    sets: dict[str, str] = {}
    for line, match in matches:
        if not match:
            continue
        key, value = match["key"].upper(), match["value"].strip()
        if key.startswith("SUBC") and value.split()[0].isdecimal():
            subcases.append(replace(above, subcase=int(value.split()[0])))
            continue
        if key == "SET":
            number, _, listed = value.partition("=")
            sets[number.strip()] = listed
            continue
        try:
            case = _apply(subcases[-1] if subcases else above, key, match["option"], value)
        except ValueError as error:
            raise Place(files[line.file], line.number).error(f"{key}: {error}") from None
        if subcases:
            subcases[-1] = case
        else:
            above = case
    if not subcases:
        return above, _LOADED * above.loaded
    of = [(c, _numbers(sets.get(str(c.superelement), str(c.superelement)))) for c in subcases]
    parts = tuple((k, (c.spc, c.mpc)) for c, some in of for k in some if k)
    whole = [c for c, some in of if 0 in some] or subcases
    modal = [c for c in whole if c.method is not None and c.analysis in ("", "MODES")]
    candidates = modal or [c for c in whole if c.analysis != "HEAT"] or whole
    chosen = replace(candidates[0], of_parts=parts)
    others = [c.subcase for c in candidates[1:] if (c.spc, c.mpc) != (chosen.spc, chosen.mpc)]
    before = [c for c in subcases if c.subcase < chosen.subcase]
    steps = in_turn and chosen.analysis == "MODES" and any(c.analysis == "STATICS" for c in before)
    loaded = _LOADED * (chosen.loaded or steps)
    if not others:
        return chosen, loaded
    return chosen, (
        *loaded,
        f"subcase {chosen.subcase} is used; subcases {', '.join(map(str, others))} select other "
        "constraints and are left out",
    )


def _numbers(listed: str) -> list[int]:
    """Read the superelements of a set: ``0, 3 THRU 6``."""
    found = re.findall(r"(\d+)(?:\s+THRU\s+(\d+))?", listed.upper())
    ends = [(int(a), min(int(b or a), int(a) + _MOST)) for a, b in found]
    return [k for a, b in ends for k in range(a, b + 1)]


def _apply(case: CaseControl, key: str, option: str | None, value: str) -> CaseControl:
    option = (option or "").upper()
    number = int(value.split()[0]) if value.split()[0].isdecimal() else None
    if key in _SETS:
        return replace(case, **{_SETS[key]: number})  # type: ignore[arg-type]
    if key.startswith("METH") and not option.startswith("FLU"):
        return replace(case, method=number)
    if key.startswith("TEMP") and option[:3] in ("INI", "BOT", "MAT", ""):
        taken = case.temperature is not None and not option.startswith("INI")
        return case if taken else replace(case, temperature=number)
    if key.startswith("SDAM") and not option.startswith("FLU"):
        return replace(case, sdamping=number)
    if key == "SUPER":
        return replace(case, superelement=number or 0)
    if key.startswith("STATS"):
        return replace(case, loaded=True)
    if key.startswith(("ANAL", "THER")):  # THERMAL is the output of heat transfer
        named = value.upper() if key.startswith("ANAL") else case.analysis or "HEAT"
        return replace(case, analysis=named)
    if key in (*_MATRICES, *_NOT_ADDED):
        return _with_matrices(case, key, value)
    return case


def _with_matrices(case: CaseControl, key: str, value: str) -> CaseControl:
    named = tuple(
        (m["name"].upper(), parse_real(m["factor"] or "1")) for m in _WEIGHTED.finditer(value)
    )
    if key in _MATRICES:
        return replace(case, **{key.lower(): named})  # type: ignore[arg-type]
    others = tuple(pair for pair in case.not_added if pair[0] != key)
    return replace(case, not_added=(*others, (key, tuple(name for name, _ in named))))
