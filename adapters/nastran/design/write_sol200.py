"""A deck for SOL 200 that moves the parameters of an update to the frequencies of its test.

Formats: MSC Nastran Quick Reference Guide, bulk data entries DESVAR, DVPREL1, DVMREL1, DVCREL1,
DRESP1 (FREQ), DRESP2, DEQATN, MODTRAK, DOPTPRM; case control ANALYSIS, DESOBJ, MODTRAK.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ....core.data.parameter import Parameter
from ....core.errors import InputError, Place
from ..editing.add_cards import add_lines
from ..editing.find_cards import names_in
from ..editing.rewrite_fields import Value, format_card
from ..editing.set_values import splice
from ..fields.parameter_references import ParameterSpec
from ..text.deck_text import DeckText
from .relations import RELATIONS, relation_of

_OURS = ("DESVAR", *RELATIONS, "DRESP1", "DRESP2", "DEQATN", "MODTRAK", "DOPTPRM")
_ITERATIONS = 20
_STEP = 0.5
"""By which a property and a variable may change in one design cycle, as shares (DELP, DELX)."""
_ALIKE = 0.7
"""Correlation of shapes by mass from which on MODTRAK says that a mode is the one it was."""
_MARGIN = 10
"""Modes beyond the highest that is aimed at, among which it is tracked."""
_FIRST, _WIDE = 56, 64
"""Characters of an equation on its first and on each further line."""


@dataclass(frozen=True)
class Aim:
    """A frequency that a mode shall have.

    Parameters
    ----------
    mode : int
        Number of the analysis mode, from 1, rigid-body modes included.
    hz : float
        Of the test.
    sigma : float
        Standard deviation of its eigenvalue, over itself.
    """

    mode: int
    hz: float
    sigma: float


def sol200(
    deck: DeckText,
    specs: Sequence[ParameterSpec],
    parameters: Sequence[Parameter],
    aims: Sequence[Aim],
    regularisation: float,
    modes: int | None = None,
) -> DeckText:
    """Return the deck as one of SOL 200 whose design variables are the factors of parameters.

    The objective is equation (2): Σ ((f/f_test)² − 1)²/σ² + w Σ (x − 1)².

    Parameters
    ----------
    deck : DeckText
        For normal modes; not changed.
    specs, parameters
        Of a model of the deck, in the same order.
    aims : sequence of Aim
    regularisation : float
        Weight w of the factors' distance from the deck's.
    modes : int, optional
        How many the deck asks for.

    Raises
    ------
    InputError
        A value that SOL 200 does not move; a deck without executive control, or with design
        variables of its own; nothing to aim at, or modes that the deck does not ask for.
    """
    top = Place(deck.files[0].path, shown=deck.files[0].path.name)
    there = [name for name in _OURS if name in names_in(deck)]
    if there:
        raise top.fault(f"has {there[0]} cards of its own")
    if not aims or not specs:
        raise InputError("SOL 200 needs a parameter and a pair of modes to aim at")
    highest = max(a.mode for a in aims)
    if modes is not None and modes < highest:
        raise InputError(f"mode {highest} is aimed at, and the deck asks for {modes} modes")
    tracked = min(highest + _MARGIN, modes or highest + _MARGIN)
    cards = [*_variables(specs, parameters), *_responses(len(specs), aims, tracked)]
    lines = [line for card in cards for line in format_card(card)]
    terms = [
        f"(({_real(1.0 / a.hz)}*F{k})**2-1.)**2*{_real(a.sigma**-2)}" for k, a in enumerate(aims, 1)
    ]
    weights = [regularisation * s.weight for s in specs]
    terms += [f"{_real(w)}*(X{k}-1.)**2" for k, w in enumerate(weights, 1) if w]
    names = [*(f"X{k}" for k in range(1, len(specs) + 1))]
    names += [f"F{k}" for k in range(1, len(aims) + 1)]
    lines += _equation(1, f"J({','.join(names)})={'+'.join(terms)}")
    comment = "trueup: parameters of an update as design variables, factors on the deck's values"
    return add_lines(_controlled(deck, top, len(aims) + 1), lines, comment, None)


def _variables(
    specs: Sequence[ParameterSpec], parameters: Sequence[Parameter]
) -> Iterator[list[Value]]:
    taken: set[str] = set()
    for k, spec in enumerate(specs, 1):
        label = re.sub(r"\W+", "", spec.name, flags=re.ASCII).upper()[:8]
        if not label[:1].isalpha() or label in taken:
            label = f"X{k}"
        taken.add(label)
        yield ["DESVAR", k, label, 1.0, float(spec.lower), float(spec.upper)]
    number = 0
    for k, (spec, parameter) in enumerate(zip(specs, parameters, strict=True), 1):
        for ref, value in zip(spec.fields, parameter.deck_values, strict=True):
            number += 1
            relation, name = relation_of(ref)
            head: list[Value] = [relation, number, ref.card, ref.id, name, None, None, 0.0, None]
            yield [*head, k, float(value)]


def _responses(variables: int, aims: Sequence[Aim], tracked: int) -> Iterator[list[Value]]:
    for k, aim in enumerate(aims, 1):
        yield ["DRESP1", k, f"F{k}", "FREQ", None, None, aim.mode]
    number = len(aims) + 1
    head: list[Value] = ["DRESP2", number, "MISFIT", 1, *[None] * 5]
    yield [*head, *_row("DESVAR", range(1, variables + 1)), *_row("DRESP1", range(1, number))]
    yield ["MODTRAK", 1, min(a.mode for a in aims), tracked, _ALIKE]
    yield ["DOPTPRM", "DESMAX", _ITERATIONS, "DELP", _STEP, "DELX", _STEP]


def _row(flag: str, numbers: Sequence[int]) -> Iterator[Value]:
    """Yield the fields of a list that a word begins, seven numbers a line."""
    for k in range(0, len(numbers), 7):
        part = numbers[k : k + 7]
        yield from (flag if k == 0 else None, *part, *[None] * (7 - len(part)))


def _equation(number: int, text: str) -> Iterator[bytes]:
    """Yield the lines of a DEQATN, cut before an operator or behind a comma."""
    pieces = re.findall(r"[^,+]*(?:,|(?=\+)|$)|\+[^,+]*,?", text)
    line, room = f"DEQATN  {number:<8d}", _FIRST
    for piece in filter(None, pieces):
        if len(piece) > room:
            yield line.encode("ascii")
            line, room = "+" + " " * 7, _WIDE
        line, room = line + piece, room - len(piece)
    yield line.encode("ascii")


def _real(value: float) -> str:
    """Return a number as Fortran has it."""
    mantissa, exponent = f"{value:.9E}".split("E")
    return f"{mantissa}E{int(exponent)}"


def _controlled(deck: DeckText, top: Place, objective: int) -> DeckText:
    """Return the deck with SOL 200 and the objective in executive and case control."""
    file = deck.files[0]
    solution = re.search(rb"(?im)^[ \t]*SOL[ \t,]+(\w+)", file.data)
    end = re.search(rb"(?im)^[ \t]*CEND[^\r\n]*(\r?\n|$)", file.data)
    if solution is None or end is None or solution.start() > end.start():
        raise top.fault("has no SOL and CEND, where SOL 200 would stand")
    commands = (b"ANALYSIS = MODES", b"DESOBJ(MIN) = %d" % objective, b"MODTRAK = 1")
    block = file.newline.join((*commands, b""))
    pieces = [(*solution.span(1), b"200"), (end.end(), end.end(), block)]
    return deck.with_file_data({0: splice(file.data, pieces)})
