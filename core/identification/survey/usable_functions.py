"""Which functions of a file are frequency responses with a value at every line."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import Bools, Floats, Numbers
from ...data.dofs import Dofs
from ...errors import InputError
from .faults import Fault, listed
from .survey_numbers import SURVEY

_OF_MANY = {"is": "are", "has": "have", "holds": "hold"}


@dataclass(frozen=True, eq=False)
class Said:
    """What is said of the functions of a file, as it is found."""

    source: str
    responses: Dofs
    references: Dofs
    faults: list[Fault] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def name(self, kind: str, bad: Bools, what: tuple[str, str], done: str = "") -> None:
        """Name the functions (n_response, n_reference) that are bad; `what` begins with a verb."""
        rows, columns = np.nonzero(bad)
        if not len(rows):
            return
        o, i = self.responses.labels, self.references.labels
        names = tuple(f"{o[a]}/{i[b]}" for a, b in zip(rows, columns, strict=True))
        verb, rest = what
        verb = _OF_MANY[verb] if len(names) > 1 else verb
        sentence = f"{self.source}: {listed(names)} {verb} {rest}" + (f": {done}" if done else "")
        self.faults.append(Fault(kind, names, sentence, done))
        self.warnings.append(sentence)


def lines_with_values(values: Numbers, frequencies_hz: Floats, said: Said) -> Bools:
    """Tell the lines at which most functions have a value, (n_line,); names the others."""
    functions = ~np.isnan(values).all(axis=2)
    without = np.count_nonzero(_without(values) & functions[:, :, None], axis=(0, 1))
    bad = without > SURVEY.line_without * np.count_nonzero(functions)
    if bad.any() and not bad.all():
        said.warnings.append(
            f"{said.source}: most functions have no value at {_at(frequencies_hz, bad)}: left out"
        )
    return np.asarray(~bad | bad.all())


def usable(values: Numbers, frequencies_hz: Floats, said: Said) -> Bools:
    """Which combinations are frequency responses, (n_response, n_reference); names the others."""
    measured = ~np.isnan(values).all(axis=2)
    with np.errstate(invalid="ignore", over="ignore"):
        constant = measured & (np.abs(values - values[:, :, :1]).max(axis=2) == 0.0)
        real = measured & ~constant & (np.abs(values.imag).max(axis=2) == 0.0)
        without = _without(values)
        gaps = measured & ~constant & ~real & without.any(axis=2)
        low, high = values.real.min(axis=2), values.real.max(axis=2)
        unit = real & (low >= 0.0) & (high <= 1.0 + SURVEY.coherence_most)
    somewhere = without[gaps].any(axis=0)
    for bad, verb, rest in (
        (gaps, "has", f"no value (not finite, or nil) at up to {_at(frequencies_hz, somewhere)}"),
        (constant, "is", "the same at every line (a dead channel)"),
        (unit, "is", "real and between 0 and 1 (a coherence, not a frequency response)"),
        (real & ~unit, "is", "real (a spectrum or a time record, not a frequency response)"),
    ):
        kind = "dead_channel" if bad is constant else "no_response"
        said.name(kind, bad, (verb, rest), "left out")
    return np.asarray(measured & ~gaps & ~constant & ~real)


def _without(values: Numbers) -> Bools:
    """Lines of each function that hold no value: what is measured is never nil."""
    with np.errstate(invalid="ignore", over="ignore"):
        return np.asarray(~np.isfinite(np.abs(values) ** 2) | (values == 0.0))


def _at(frequencies_hz: Floats, bad: Bools) -> str:
    f = frequencies_hz[bad]
    if len(f) == 1:
        return f"one line, {f[0]:.4g} Hz"
    return f"{len(f)} lines between {f.min():.4g} and {f.max():.4g} Hz" if len(f) else "any line"


def refuse_copies(functions: Numbers, name: str) -> None:
    """Raise when all functions (n_function, n_line) are one and the same."""
    if len(functions) >= SURVEY.copies and all(np.array_equal(functions[0], f) for f in functions):
        raise InputError(
            f"all {len(functions)} functions of {name} are equal to the last digit: one function "
            "was written under many names"
        )
