"""Hold the known properties that an answer writes against those that were changed."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from .structures import STRUCTURES

Json = dict[str, Any]

_OWN = re.compile(r"(PSHELL|PBAR|MAT1) (\d+) ")
_OF_BARS = 100
"""The material of bars of a group has its number and this."""


@dataclass(frozen=True)
class Written:
    """What an answer makes of one property: a thickness, the stiffness of bars, the modulus.

    `factor` is what it writes, 1 where it leaves it, `deviation` the standard deviation of its log,
    `truth` what was hidden.
    """

    name: str
    factor: float
    deviation: float
    truth: float

    @property
    def off(self) -> float:
        """Return by how many standard deviations it is wrong, 0 where nothing is written."""
        return abs(math.log(self.factor / self.truth)) / self.deviation if self.deviation else 0.0


def written(truth: Json, result: Json) -> tuple[Written, ...]:
    """Return every property of a case of `case.make` as its answer has it.

    Bars have their stiffness from their inertias, of two the mean, and their own modulus.
    """
    seed = int(truth["case"].split("_")[0])
    s = STRUCTURES[truth["structure"]](np.random.default_rng([seed, 2]))
    hidden = {g: truth["scatter"].get(word, 1.0) for g, word in s.wording.items()}
    said: dict[str, list[Json]] = {}
    for p in result.get("parameters") or []:
        found = _OWN.match(p["name"])
        if found:
            card, number = found[1], int(found[2])
            group = number - _OF_BARS if card == "MAT1" and number > _OF_BARS else number
            bars = card == "PBAR" or (card == "MAT1" and number > _OF_BARS)
            said.setdefault(f"PBAR {group}" if bars else f"{card} {number}", []).append(p)
    return tuple(_one(name, own, hidden) for name, own in said.items())


def _one(name: str, own: list[Json], hidden: dict[int, float]) -> Written:
    card, number = name.split()
    moved = [p for p in own if p["updated"] != p["initial"]]
    bending = [math.log(p["factor"]) for p in moved if not p["name"].endswith(" E")]
    modulus = [math.log(p["factor"]) for p in moved if p["name"].endswith(" E")]
    log = sum(modulus) + (sum(bending) / len(bending) if bending else 0.0)
    deviation = max((p["standard_error"] / p["factor"] for p in moved), default=0.0)
    truth = 1.0 if card == "MAT1" else hidden.get(int(number), 1.0)
    return Written(name, math.exp(log), deviation, truth)
