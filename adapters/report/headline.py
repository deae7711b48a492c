"""The one sentence that a person reads first."""

from __future__ import annotations

import math

from . import reading
from .formats import counted, fixed, general, listed
from .reading import Result, Summary

VERDICTS = {
    "effect": "the model lacks something",
    "parameters_only": "only known parameters are off",
    "test_fault": "the test is at fault",
    "no_gap": "nothing is missing",
    "undecided": "undecided",
}

_MOVED = 3
"""So many parameters are named where they explain the gap."""


def headline(result: Result) -> str:
    """Return the result of a run in one or two plain sentences.

    Parameters
    ----------
    result : mapping
        The content of a run folder's ``result.json`` (``trueup/correlate/1``,
        ``trueup/update/1``, ``trueup/discover/1``). Keys that are absent are passed over.

    Returns
    -------
    str
        Plain text, ending with a full stop.
    """
    return " ".join(story(result))


def story(result: Result) -> list[str]:
    """Return the sentences of the headline, the most important first."""
    said = {"update": _update, "discover": _discover}.get(reading.verb(result), _correlate)
    return said(result)


def _correlate(result: Result) -> list[str]:
    found = reading.final(result)
    if not found:
        return ["The run holds no correlation of test and analysis."]
    now = reading.summary(found)
    if not now.test_modes:
        return ["The test holds no modes to pair."]
    if not now.pairs:
        return [f"None of the {counted(now.test_modes, 'test mode')} pairs with the model."]
    text = f"{_of(now)} with the model"
    deviations = {
        n: reading.number(p.get("deviation_percent"))
        for n, p in reading.pair_by_test(found).items()
    }
    known = {n: abs(d) for n, d in deviations.items() if d is not None}
    if known:
        worst = max(known, key=lambda n: known[n])
        mean = fixed(sum(known.values()) / len(known), 1)
        text += f"; frequencies are {mean} % off on average"
        if len(known) > 1:
            text += f", {fixed(known[worst], 1)} % at worst (test mode {worst})"
    alone = [n for n, _ in reading.unpaired(found, "test")]
    if not alone:
        return [text + "."]
    noun, has = ("mode", "has") if len(alone) == 1 else ("modes", "have")
    return [text + ".", f"Test {noun} {listed(alone)} {has} no partner."]


def _update(result: Result) -> list[str]:
    before, after = reading.initial(result), reading.part(result, "after")
    if not before:
        return _correlate(result)
    old, new = reading.summary(before), reading.summary(after)
    parameters = reading.records(result, "parameters")
    text = f"After updating {counted(len(parameters), 'parameter')}, " if parameters else ""
    told = [_sentence(text + _change(old, new, "model"))]
    at_bound = [str(p.get("name", "?")) for p in parameters if p.get("at_bound")]
    if at_bound:
        noun = "One parameter" if len(at_bound) == 1 else f"{len(at_bound)} parameters"
        told.append(f"{noun} stopped at a bound: {listed(at_bound)}.")
    return told


def _discover(result: Result) -> list[str]:
    verdict = str(result.get("verdict", ""))
    findings = reading.records(result, "findings")
    said = [str(f["sentence"]).strip() for f in findings if f.get("sentence")]
    told = [_sentence(said[0] if said else _verdict_sentence(verdict))]
    if said and verdict == "undecided":
        told = [_verdict_sentence(verdict), f"The best explanation so far: {told[0]}"]
    elif verdict == "parameters_only":
        told += _moved(result)
    if said and len(findings) > 1:
        told.append(f"{counted(len(findings) - 1, 'further finding')} below.")
    gap = reading.part(result, "gap")
    old = reading.summary(reading.part(gap, "before"))
    new = reading.summary(reading.part(gap, "after"))
    if old.pairs is not None and new.pairs is not None:
        if verdict in ("no_gap", "undecided") or old == new:
            told.append(_sentence(_of(new) + " with the model"))
        else:
            told.append(_sentence("with that adopted, " + _change(old, new, "completed model")))
    told = [t for t in told if t]
    return told or _correlate(result)


def _moved(result: Result) -> list[str]:
    """Name the parameters that moved by more than their scatter, the farthest first."""
    clear = {
        str(p.get("name", "?")): reading.number(p.get("factor"))
        for p in reading.records(result, "parameters")
        if p.get("significant")
    }
    known = {name: factor for name, factor in clear.items() if factor}
    first = sorted(known, key=lambda name: -abs(math.log(known[name])))[:_MOVED]
    said = [f"{name} is {general(known[name], 3)} times the deck's value" for name in first]
    return [_sentence("; ".join(said))] if said else []


def _sentence(text: str) -> str:
    if not text:
        return ""
    return text[0].upper() + text[1:] + ("" if text.endswith((".", "!", "?")) else ".")


def _verdict_sentence(verdict: str) -> str:
    said = {
        "no_gap": "Nothing is missing: model and test agree within the scatter of the test.",
        "undecided": "The data do not decide what is missing.",
        "parameters_only": "Known parameters alone explain the gap; nothing is missing.",
        "test_fault": "The gap comes from the test, not from the model.",
        "effect": "The model lacks something that the test has.",
    }
    return said.get(verdict, "")


def _of(now: Summary) -> str:
    of = f"{now.pairs} of {now.test_modes} test modes"
    modes = of if now.test_modes else counted(now.pairs or 0, "test mode")
    return f"{modes} {'pairs' if now.pairs == 1 else 'pair'}"


def _change(old: Summary, new: Summary, what: str) -> str:
    text = f"{_of(new)} with the {what} ({old.pairs} before)"
    if new.mean_percent is not None:
        text += f" and frequencies are {fixed(new.mean_percent, 1)} % off on average"
        if old.mean_percent is not None:
            text += f" ({fixed(old.mean_percent, 1)} % before)"
    return text


def figures(result: Result) -> list[tuple[str, str, str]]:
    """Return the key figures as (what, now, before or empty).

    For the strip under the headline and for the terminal.
    """
    gap = reading.part(result, "gap")
    if reading.part(gap, "after"):
        new = reading.summary(reading.part(gap, "after"))
        old: Summary | None = reading.summary(reading.part(gap, "before"))
    else:
        new = reading.summary(reading.final(result))
        before = reading.initial(result)
        old = reading.summary(before) if before else None
    pairs = [_pairs_of(s) if s else "" for s in (new, old)]
    rows = [
        ("pairs", *pairs),
        (
            "mean frequency deviation",
            *[_suffixed(s.mean_percent, 2, "%") if s else "" for s in (new, old)],
        ),
        (
            "worst frequency deviation",
            *[_suffixed(s.worst_percent, 2, "%") if s else "" for s in (new, old)],
        ),
        (
            "mean MAC of the pairs",
            *[
                _suffixed(None if s.mean_mac is None else 100.0 * s.mean_mac, 1, "%") if s else ""
                for s in (new, old)
            ],
        ),
    ]
    solves = reading.number(result.get("eigensolutions"))
    if solves is not None:
        rows.append(("full eigensolutions", general(int(solves)), ""))
    seconds = reading.number(result.get("seconds"))
    if seconds is not None:
        rows.append(("time", f"{general(seconds, 3)} s", ""))
    return [(what, now, "" if then == now else then) for what, now, then in rows if now]


def _pairs_of(s: Summary) -> str:
    if s.pairs is None:
        return ""
    return f"{s.pairs} of {s.test_modes}" if s.test_modes else str(s.pairs)


def _suffixed(value: float | None, digits: int, unit: str) -> str:
    return "" if value is None else f"{fixed(value, digits)} {unit}"
