"""The one sentence that a person reads first."""

import math
from collections.abc import Sequence

from ....core.discovery.effects.sentence_parts import mode_ranges
from ....core.discovery.findings import Finding
from ....core.discovery.narrative.sentences import effects_said
from ....core.results.correlation import Compared, Gap, RunTables
from ....core.results.discovery import DiscoverTables
from ....core.results.update import ChangingTables, UpdateTables
from .number_formats import counted, fixed, general, listed

VERDICTS = {
    "effect": "the model lacks something",
    "parameters_only": "known parameters explain it",
    "test_fault": "the test is at fault",
    "no_gap": "nothing is missing",
    "undecided": "undecided",
}
_VERDICT_SENTENCES = {
    "undecided": "The data do not decide what is missing.",
    "parameters_only": "Known parameters alone explain the gap; nothing is missing.",
    "test_fault": "The gap comes from the test, not from the model.",
    "effect": "The model lacks something that the test has.",
}
_FAR = 3.0
"""Deviation in % from which on a correlation points to discover."""
_COARSE = 0.3
"""What the mesh does to frequencies is told from here on, in %."""
_MOVED = 3
"""So many parameters are named where they explain the gap."""


def headline(answer: RunTables) -> str:
    """Return the result of a run in a few plain sentences, ending with a full stop."""
    return " ".join(story(answer))


def story(answer: RunTables) -> list[str]:
    """Return the sentences of the headline, the most important first."""
    if isinstance(answer, UpdateTables):
        return _update(answer)
    if isinstance(answer, DiscoverTables):
        return _discover(answer)
    return _correlate(answer.final)


def _correlate(found: Compared) -> list[str]:
    n_test = len(found.test_modes)
    if not n_test:
        return ["The test holds no modes to pair."]
    if not found.pairs:
        return [f"None of the {counted(n_test, 'test mode')} pairs with the model."]
    worst = max(found.pairs, key=lambda p: abs(p.deviation_percent))
    mean = fixed(found.summary.mean_abs_deviation_percent, 1)
    text = f"{_of(found.summary, n_test)} with the model"
    text += f"; frequencies are {mean} % off on average"
    if len(found.pairs) > 1:
        text += f", {fixed(abs(worst.deviation_percent), 1)} % at worst (test mode {worst.test})"
    alone, told = found.unpaired_test, [text + "."]
    if alone:
        noun, has = ("mode", "has") if len(alone) == 1 else ("modes", "have")
        told.append(f"Test {noun} {listed(alone)} {has} no partner.")
    if any(found.test_hz[t - 1] > 0.0 for t in alone) or abs(worst.deviation_percent) > _FAR:
        told.append("trueup discover, given the same, looks for what explains the difference.")
    return told


def _update(answer: UpdateTables) -> list[str]:
    moved = answer.parameters
    text = f"After updating {counted(len(moved), 'parameter')}, " if moved else ""
    old, new = answer.before, answer.after
    change = _change(old.summary, new.summary, "model", len(new.test_modes))
    told = [_sentence(text + change), *_lost(answer)]
    at_bound = [p.name for p in moved if p.at_bound]
    if at_bound:
        noun = "One parameter" if len(at_bound) == 1 else f"{len(at_bound)} parameters"
        told.append(f"{noun} stopped at a bound: {listed(at_bound)}.")
    return told


def _discover(answer: DiscoverTables) -> list[str]:
    verdict, found = answer.verdict, answer.findings
    best, moved = _found(found), _moved(answer)
    told = _verdict(answer, best, bool(moved))
    if verdict in ("parameters_only", "test_fault"):
        told += moved
    if not answer.adopted and verdict == "undecided":
        told += [f"What fits best, not written: {off}" for off in moved]
    if len(found) == 1:
        told.append(_sentence(found[0].sentence))
    old, new = answer.gap.before, answer.gap.after
    if old == new or not _written(answer):
        told.append(_sentence(_of(new) + " with the model"))
    else:
        adopted = (
            "with that adopted, " if verdict != "undecided" else "with that put into the deck, "
        )
        told.append(_sentence(adopted + _change(old, new, "completed model")))
        told += _lost(answer)
        told += _by_mesh(answer.judgement.mesh) if verdict != "undecided" else []
    rivals = [a for a in answer.alternatives if a.kinds]
    if best and rivals:
        told.append(f"Next best: {rivals[0].where}; {rivals[0].odds}.")
    return told


def _verdict(answer: DiscoverTables, best: str, moved: bool) -> list[str]:
    """Say what the verdict is, and what was found, or what it looks like."""
    verdict, told = answer.verdict, _VERDICT_SENTENCES.get(answer.verdict, f"{answer.verdict}.")
    if verdict == "no_gap" or (verdict == "parameters_only" and not moved):
        told = _nothing_missing(verdict, answer.gap.before)
    if verdict in ("no_gap", "parameters_only"):
        told = told[:-1] + _but_for(answer.judgement.unexplained) + "."
    look = answer.judgement.looks_like
    if best:
        so_far = [told, _sentence(f"the best explanation so far: {best}")]
        return so_far if verdict == "undecided" else [_sentence(best)]
    if look and verdict == "undecided":
        return [told, _sentence(f"it looks like {look}, which no listed effect is")]
    return [told]


def _by_mesh(mesh: float) -> list[str]:
    """Say what frequencies stay off by since the mesh is too coarse, where one would ask."""
    percent = abs(100.0 * mesh)
    if percent < _COARSE:
        return []
    way = "low" if mesh > 0.0 else "high"
    return [f"The deck's mesh makes them about {fixed(percent, 1)} % too {way}."]


def _written(answer: DiscoverTables) -> bool:
    """Whether the deck is another than it came: with effects, or with other values."""
    effects = any(f.side == "model" for f in answer.findings)
    moved = any(p.updated != p.initial for p in answer.parameters)
    return answer.adopted and (effects or moved)


def _found(findings: Sequence[Finding]) -> str:
    """Say what was found, in a few words: effects by kind and place, sensors by number."""
    model = [f for f in findings if f.side == "model"]
    at_fault = [f.where.region or "" for f in findings if f.side == "test"]
    said = []
    if model:
        regions = [f.where.region or "" for f in model]
        said.append(f"the model lacks {effects_said([f.kind for f in model], regions)}")
    if at_fault:
        said.append(f"the test is at fault: {listed(at_fault)}")
    return ", and ".join(said)


def _nothing_missing(verdict: str, gap: Gap) -> str:
    """Say by how much frequencies are off where nothing is missing, on average, and why."""
    if not gap.pairs:
        return "Nothing is missing."
    off = f"{fixed(gap.mean_abs_deviation_percent, 1)} % that frequencies are off"
    why = "mesh and usual errors" if verdict == "no_gap" else "known parameters or the mesh"
    return f"Nothing is missing: {why} explain the {off}."


def _but_for(unexplained: Sequence[int]) -> str:
    """Name the test modes that no mode of the model explains, though the others agree."""
    return f", but for {mode_ranges(unexplained)}, which nothing explains" if unexplained else ""


def _lost(answer: ChangingTables) -> list[str]:
    """Name the test modes that paired with the deck as it came and no longer do."""
    lost = sorted({p.test for p in answer.before.pairs} - {p.test for p in answer.after.pairs})
    if not lost:
        return []
    said, does = mode_ranges(lost), "does" if len(lost) == 1 else "do"
    return [_sentence(f"{said} paired before and no longer {does}")]


def _moved(answer: DiscoverTables) -> list[str]:
    """Name the parameters that moved by more than their scatter, the farthest first."""
    clear = [p for p in answer.parameters if p.significant]
    first = sorted(clear, key=lambda p: -abs(math.log(p.factor)))[:_MOVED]
    said = [f"{p.name} is {general(p.factor, 3)} times the deck's value" for p in first]
    return [_sentence("; ".join(said))] if said else []


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + ("" if text.endswith((".", "!", "?")) else ".")


def _of(now: Gap, n_test: int = 0) -> str:
    return counted_pairs(now.pairs, n_test)


def counted_pairs(pairs: int, n_test: int = 0) -> str:
    """Say how many test modes pair, of how many where that is told."""
    modes = f"{pairs} of {n_test} test modes" if n_test else counted(pairs, "test mode")
    return f"{modes} {'pairs' if pairs == 1 else 'pair'}"


def _change(old: Gap, new: Gap, what: str, n_test: int = 0) -> str:
    text = f"{_of(new, n_test)} with the {what} ({old.pairs} before)"
    if new.mean_abs_deviation_percent is not None:
        text += f" and frequencies are {fixed(new.mean_abs_deviation_percent, 1)} % off on average"
        if old.mean_abs_deviation_percent is not None:
            text += f" ({fixed(old.mean_abs_deviation_percent, 1)} % before)"
    return text


def figures(answer: RunTables) -> list[tuple[str, str, str]]:
    """Return the key figures as (what, now, before or empty), for the strip under the headline."""
    if isinstance(answer, DiscoverTables):
        now, then = _figures(answer.gap.after), _figures(answer.gap.before)
    else:
        now, then = (
            _figures(c.summary, len(c.test_modes)) if c else [""] * 4
            for c in (answer.final, answer.initial)
        )
    what = ("pairs", "mean frequency deviation", "worst frequency deviation",
            "mean MAC of the pairs")  # fmt: skip
    rows = list(zip(what, now, then, strict=True))
    if isinstance(answer, UpdateTables):
        rows.append(("full eigensolutions", str(answer.eigensolutions), ""))
    if isinstance(answer, UpdateTables | DiscoverTables):
        rows.append(("time", f"{general(answer.seconds, 3)} s", ""))
    return [(said, a, "" if a == b else b) for said, a, b in rows if a]


def _figures(gap: Gap, n_test: int = 0) -> list[str]:
    mean, worst, mac = gap.mean_abs_deviation_percent, gap.worst_deviation_percent, gap.mean_mac
    return [
        f"{gap.pairs} of {n_test}" if n_test else str(gap.pairs),
        "" if mean is None else f"{fixed(mean, 2)} %",
        "" if worst is None else f"{fixed(worst, 2)} %",
        "" if mac is None else f"{fixed(100.0 * mac, 1)} %",
    ]
