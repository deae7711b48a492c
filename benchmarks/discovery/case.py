"""One case from one seed: what it is, deck, test and truth on disk."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from . import calculix, hide, measure, outside
from .deck import write_deck
from .mesh import Ints, mesh
from .structures import STRUCTURES, Structure

SCENARIOS = (
    ("effect", 15),
    ("effect+scatter", 10),
    ("two effects", 5),
    ("several masses", 4),
    ("twins", 3),
    ("nothing", 4),
    ("scatter", 6),
    ("fault", 4),
    ("effect+fault", 3),
    ("outside", 22),
    ("outside+scatter", 11),
    ("effect+outside", 5),
    ("real", 4),
    ("effect+real", 4),
)
"""What a case hides, and how often; `real` is a model that is off everywhere and a poor test."""
_ADDED = ("scatter", "effect+scatter", "outside+scatter", "real", "effect+real")
_BESIDE = ("geometry", "field", "physics")
_SMALL = ("tower", "frame", "bracket", "plate", "wing", "cowl")
NEGLIGIBLE = 0.4
"""Largest shift of a frequency [%] that may be called no gap: four times a test's scatter."""
_USUAL = measure.Noise()


@dataclass(frozen=True)
class Plan:
    """What one case is made of; `kinds` and `faults` are the hidden ones, in order."""

    seed: int
    structure: str
    scenario: str
    kinds: tuple[str, ...]
    faults: tuple[str, ...]
    outside: str = ""

    @property
    def name(self) -> str:
        """Return a folder name that says what is hidden."""
        hidden = [*self.kinds, *self.faults, *[self.outside] * bool(self.outside)] or [
            self.scenario
        ]
        return f"{self.seed:04d}_{self.structure}_" + "_".join(hidden)


def plan(seed: int) -> Plan:
    """Return the plan of a seed: structures (small ones twice as often), scenarios and kinds."""
    rng = np.random.default_rng([seed, 1])
    name = str(rng.choice([*STRUCTURES, *_SMALL]))
    s = STRUCTURES[name](np.random.default_rng([seed, 2]))
    weights = np.array([w for _, w in SCENARIOS], dtype=float)
    scenario = SCENARIOS[int(rng.choice(len(SCENARIOS), p=weights / weights.sum()))][0]
    n = 2 if scenario == "two effects" else 1 if "effect" in scenario else 0
    possible = hide.possible(s)
    if "real" in scenario or "outside" in scenario:
        possible.remove("local_damper")
    rarely = np.array([hide.RARE if k in hide.SELDOM else 1.0 for k in possible])
    kinds = tuple(
        str(k) for k in rng.choice(possible, size=n, replace=False, p=rarely / rarely.sum())
    )
    if scenario == "several masses":
        kinds = ("point_mass",) * int(rng.integers(2, 4))
    if scenario == "twins":
        kinds = ("point_mass", "point_mass")
    cause = ""
    if "outside" in scenario:
        families = _BESIDE if n else list(outside.FAMILIES)
        causes = outside.possible(s, str(rng.choice(families)))
        cause = str(rng.choice([c for c in causes if not n or c != "preload"]))
    faults: tuple[str, ...] = ()
    if "fault" in scenario:
        choice = ["sensor_polarity", "sensor_gain", "sensor_swap"]
        choice += ["sensor_axis"] * (s.axes != "normal")
        size = 1 if "effect" in scenario else int(rng.integers(1, 3))
        faults = tuple(str(k) for k in rng.choice(choice, size=size, replace=False))
    return Plan(seed, name, scenario, kinds, faults, cause)


def make(p: Plan, folder: Path, cache: Path, noise: measure.Noise = _USUAL) -> Path:
    """Write deck, test and truth of a plan into folder/NAME and return that folder.

    Raises
    ------
    calculix.CalculixError
        If CalculiX does not give the modes.
    """
    place = folder / p.name
    if (place / "truth.json").exists():
        return place
    s = STRUCTURES[p.structure](np.random.default_rng([p.seed, 2]))
    rng = np.random.default_rng([p.seed, 3])
    fine = mesh(s, s.refine, True)
    bare = calculix.solve(s, fine, hide.joined([], {}), cache, s.modes)
    scene = hide.Scene(s, fine, bare, rng)
    drawn = hide.twins(scene) if p.scenario == "twins" else []
    drawn += [_noticed(k, scene, cache) for k in p.kinds[len(drawn) :]]
    factors: dict[int, float] = {}
    if p.scenario in _ADDED or (
        p.scenario in ("fault", "two effects", "several masses", "twins", "effect+fault")
        and rng.random() < 0.5
    ):
        factors = hide.scatter(scene)
    cause = outside.Cause(fine, {})
    if p.outside:
        cause = outside.CAUSES[p.outside](scene)
    elif "real" in p.scenario:
        cause = outside.diffuse(scene, float(rng.uniform(0.01, 0.04)))
        noise = noise.of_a_real_test(rng)
    truth = hide.joined([t for t, _ in drawn] + [cause.truth], factors)
    nodes = measure.sensors(s, fine, cause.mesh, rng)
    modes = _felt(s, cause, truth, nodes, cache)
    test = measure.measure(s, fine, nodes, truth, modes, noise, rng)
    hurt: set[int] = set()
    faults = []
    for kind in p.faults:
        test, entry = measure.fault(test, fine, kind, rng, hurt)
        faults.append(entry)
    rotation, shift = np.eye(3), np.zeros(3)
    if s.turned and rng.random() < 0.3:
        rotation = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
        shift = np.array([200.0, 160.0, -300.0])
    deck = write_deck(place, s, mesh(s, 1, False))
    measure.write_test(place / f"{deck.stem}_test.unv", s, test, rotation, shift)
    record = {
        "case": p.name,
        "scenario": p.scenario,
        "structure": p.structure,
        "dimension": s.size,
        "scatter": {s.wording[g]: f for g, f in factors.items()},
        "effects": [e for _, e in drawn],
        "outside": [cause.entry] if cause.entry else [],
        "faults": faults,
        "freq_hz": test.hz.tolist(),
        "exact_hz": modes.hz.tolist(),
        "bare_hz": bare.hz.tolist(),
        "damping": test.damping.tolist(),
        "units": "mm t N s",
        "frame": {"rotation": rotation.tolist(), "shift": shift.tolist(), "scale": 0.001},
        "sensors": int(test.nodes.size),
        "modes": int(modes.hz.size),
        "noise": asdict(noise),
        "visibility": visibility(test.nodes, bare, modes),
    }
    if cause.entry and not drawn:
        record |= {"expected": _honest(p, record["visibility"]), "may": cause.may}
    (place / "truth.json").write_text(json.dumps(record, indent=1))
    return place


def _noticed(kind: str, scene: hide.Scene, cache: Path) -> tuple[hide.Truth, hide.Entry]:
    """Draw an effect until it alone moves some mode by 1.5 % (a damper always counts)."""
    s, m = scene.structure, scene.mesh
    for _ in range(6):
        truth, entry = hide.KINDS[kind](scene)
        if truth.dampers:
            break
        alone = calculix.solve(s, m, hide.joined([truth], {}), cache, s.modes)
        if np.max(np.abs(alone.hz / scene.modes.hz - 1.0)) > 0.015:
            break
    return truth, entry


def _felt(
    s: Structure, cause: outside.Cause, truth: hide.Truth, nodes: Ints, cache: Path
) -> calculix.Modes:
    """Return the modes as a test would feel them: run by run, with what the cause does to them."""
    own = replace(s, bars={**s.bars, **cause.sections})
    parts = np.array_split(nodes, cause.runs)
    runs = []
    for part in parts:
        sensors = tuple((int(n), cause.sensor_mass / part.size) for n in part if cause.sensor_mass)
        loaded = replace(truth, masses=truth.masses + sensors)
        runs.append(calculix.solve(own, cause.mesh, loaded, cache, s.modes))
    modes = measure.merged(runs, parts)
    return cause.felt(modes) if cause.felt else modes


def _honest(p: Plan, seen: dict[str, float]) -> list[str]:
    """Return the verdicts that are right where no effect of the list is hidden."""
    unseen = "real" in p.scenario or seen["largest_shift_percent"] < NEGLIGIBLE
    return ["undecided", "parameters_only"] + ["no_gap"] * unseen


def visibility(nodes: Ints, a: calculix.Modes, b: calculix.Modes) -> dict[str, float]:
    """Return how much what is hidden changes: largest frequency shift [%] and smallest MAC."""
    x, y = (q.shapes[nodes].reshape(3 * nodes.size, -1) for q in (a, b))
    mac = (x.T @ y) ** 2 / np.outer(np.sum(x**2, axis=0), np.sum(y**2, axis=0))
    shift = 100.0 * np.abs(b.hz / a.hz - 1.0)
    return {
        "largest_shift_percent": float(shift.max()),
        "smallest_mac": float(mac.max(axis=0).min()),
    }
