"""Hold a result of `discover` against the truth that was hidden."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

Json = dict[str, Any]

PLACE = 0.1
"""A place is right within this part of the structure's largest dimension."""


@dataclass(frozen=True)
class Named:
    """One hidden effect or fault and the finding that comes nearest; `found` is '' if none."""

    kind: str
    found: str
    placed: bool
    distance: float | None
    ratio: float | None
    in_interval: bool | None
    in_credible: bool | None
    confidence: float | None
    solved: bool


@dataclass(frozen=True)
class Score:
    """What one case came to; `false_alarms` are kinds named that are not there.

    Where the cause is outside the list, what an undecided answer considers is none.
    """

    expected: str
    verdict: str
    solved: bool
    safe: bool
    named: tuple[Named, ...]
    false_alarms: tuple[tuple[str, float], ...]

    @property
    def claims(self) -> bool:
        """Return whether something is claimed that is not there: false, and not said in doubt."""
        wrong = bool(self.false_alarms) or not self.named
        return self.verdict in ("effect", "test_fault") and wrong and not self.solved


def expected_verdicts(truth: Json) -> tuple[str, ...]:
    """Return the verdicts that are right; a coarse mesh alone may ask for parameters.

    Where the cause is outside the list of effects, the truth says what is honest.
    """
    if "expected" in truth:
        return tuple(truth["expected"])
    if truth["effects"]:
        return ("effect",)
    if truth["faults"]:
        return ("test_fault",)
    return ("parameters_only",) if truth["scatter"] else ("no_gap", "parameters_only")


def spot_of(effect: Json) -> tuple[list[float] | None, float]:
    """Return where an effect is [mm] and half the extent of a region."""
    if "truth_node_xyz" in effect:
        return effect["truth_node_xyz"], 0.0
    if "box_lo" in effect:
        lo, hi = effect["box_lo"], effect["box_hi"]
        half = max(abs(b - a) for a, b in zip(lo, hi, strict=True)) / 2.0
        return [(a + b) / 2.0 for a, b in zip(lo, hi, strict=True)], half
    return None, 0.0


def _middle(xyz: Any) -> list[float] | None:
    if not xyz:
        return None
    if isinstance(xyz[0], (list, tuple)):
        return [sum(c) / len(c) for c in zip(*xyz, strict=True)]
    return [float(c) for c in xyz]


def _gap(effect: Json, finding: Json) -> float | None:
    spot, half = spot_of(effect)
    got = _middle((finding.get("where") or {}).get("xyz"))
    return None if spot is None or got is None else max(0.0, math.dist(spot, got) - half)


def _credible(effect: Json, finding: Json, size: float) -> bool:
    for place in finding.get("credible_set") or []:
        if (place.get("kind") or finding.get("kind")) != effect["kind"]:
            continue
        gap = _gap(effect, {"where": {"xyz": place.get("xyz")}})
        if gap is not None and gap <= PLACE * size:
            return True
    return False


def _effect(effect: Json, finding: Json, size: float) -> Named:
    kind = effect["kind"]
    gap = _gap(effect, finding)
    placed = gap is not None and gap <= PLACE * size
    key = next((k for k in ("mass", "factor", "stiffness", "damping") if k in effect), None)
    got = (finding.get("magnitude") or {}).get(key)
    got = got[0] if isinstance(got, list) and got else got
    ratio = got / effect[key] if key and got else None
    interval = finding.get("interval")
    if isinstance(interval, dict):
        interval = interval.get(key)
    right = finding.get("kind") == kind
    inside = None
    if right and key and isinstance(interval, (list, tuple)) and len(interval) == 2:
        inside = bool(interval[0] <= effect[key] <= interval[1])
    tolerance = 1.3 if key == "mass" else 2.0
    sized = ratio is not None and 1.0 / tolerance <= ratio <= tolerance
    return Named(
        kind,
        str(finding.get("kind")),
        placed,
        None if gap is None else gap / size,
        ratio if right else None,
        inside,
        (right and placed) or _credible(effect, finding, size),
        finding.get("confidence"),
        right and placed and sized,
    )


def _shared(may: Json, finding: Json, size: float) -> bool:
    """Return whether a finding is what the cause and an effect of the list have in common."""
    gap = _gap(may, finding)
    return bool(finding.get("kind") == may["kind"] and gap is not None and gap <= PLACE * size)


def _fault(fault: Json, findings: list[Json]) -> tuple[Named, Json | None]:
    nodes = {fault["node"], fault.get("other_node", fault["node"])}
    for f in findings:
        sensors = set((f.get("where") or {}).get("sensors") or [])
        if sensors & nodes:
            right = f.get("kind") == fault["kind"]
            gain = (f.get("magnitude") or {}).get("factor")
            ratio = gain / fault["factor"] if right and gain and "factor" in fault else None
            named = Named(
                fault["kind"],
                str(f.get("kind")),
                True,
                None,
                ratio,
                None,
                None,
                f.get("confidence"),
                right,
            )
            return named, f
    return Named(fault["kind"], "", False, None, None, None, None, None, False), None


def _sensor_key(finding: Json) -> tuple[str, tuple[int, ...]]:
    """Return what makes two findings one: a fault named for each axis of a sensor."""
    sensors = (finding.get("where") or {}).get("sensors") or []
    return str(finding.get("kind")), tuple(sorted(sensors))


def _worth(named: Named) -> int:
    """Return how well a finding names an effect: solved, of its kind, at its place."""
    return 4 * named.solved + 2 * (named.kind == named.found) + named.placed


def score(truth: Json, result: Json) -> Score:
    """Return what a result is worth against the truth."""
    size = float(truth["dimension"])
    findings = result.get("findings") or []
    model = [f for f in findings if f.get("side") == "model"]
    test = list({_sensor_key(f): f for f in findings if f.get("side") == "test"}.values())
    expected = expected_verdicts(truth)
    effects = truth["effects"]
    tries = [[_effect(effect, f, size) for f in model] for effect in effects]
    worth = np.array([[_worth(t) for t in row] for row in tries]).reshape(len(effects), len(model))
    paired = dict(zip(*linear_sum_assignment(worth, maximize=True), strict=True))
    named = [
        tries[i][paired[i]]
        if i in paired
        else Named(effect["kind"], "", False, None, None, None, None, None, False)
        for i, effect in enumerate(effects)
    ]
    model = [f for j, f in enumerate(model) if j not in paired.values()]
    held = all(n.in_credible for n in named)
    for fault in truth["faults"]:
        hit, finding = _fault(fault, test)
        named.append(hit)
        if finding is not None:
            test.remove(finding)
    verdict = str(result.get("verdict"))
    if "expected" in truth:
        shared = [f for f in model if any(_shared(m, f, size) for m in truth.get("may", ()))]
        expected += ("effect",) * bool(shared)
        model = [] if verdict == "undecided" else [f for f in model if f not in shared]
    false = [(str(f.get("kind")), float(f.get("confidence") or 0.0)) for f in (*model, *test)]
    solved = verdict in expected and all(n.solved for n in named) and not false
    safe = solved or (verdict == "undecided" and held)
    return Score("/".join(expected), verdict, solved, safe, tuple(named), tuple(false))
