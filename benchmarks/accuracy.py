"""The embedded solver against what MSC or NX Nastran gave for the same deck.

    python benchmarks/accuracy.py [--modes] [--data DIR]

Reads decks and results from the data folder beside the checkout (../shared/data), solves each deck
and prints a table: the largest difference of the first ten elastic frequencies, the smallest MAC of
their shapes (modes within 0.1 % of each other as one subspace), and mass and centre of gravity
beside the grid point weight generator's where the run printed it. With --modes one line for every
mode. Ends with one line of JSON. The references are read from the results of the runs, never typed
in.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import numpy as np

from trueup import Dofs, InputError, Modes
from trueup.adapters.nastran import build_model, read_deck, read_modes, weight
from trueup.core.eigen.normal_modes import modes_of, solve

MOST = 10
"""Elastic modes compared."""
TOGETHER = 1e-3
"""Modes nearer than this, relative, are compared as one subspace."""


@dataclass(frozen=True)
class Case:
    """A deck, the results of its run, and the solver that made them, as far as they say."""

    deck: str
    results: str
    solver: str
    weighed: str = ""


CASES = (
    Case("nastran/truss_72/modes.dat", "nastran/truss_72/modes.h5", "MSC 2019",
         "nastran/truss_72/modes.f06"),
    Case("nastran/ten_bar/modes.dat", "nastran/ten_bar/modes.h5", "MSC 2019",
         "nastran/ten_bar/modes.f06"),
    Case("nastran/svanberg_beam/modes.dat", "nastran/svanberg_beam/modes.h5", "MSC 2019",
         "nastran/svanberg_beam/modes.f06"),
    Case("nastran/frame/noReduction-000.dat", "nastran/frame/noreduction-000.h5", "MSC 2019",
         "nastran/frame/noreduction-000.f06"),
    Case("nastran/cantilever/noReduction.dat", "nastran/cantilever/noReduction.h5", "MSC 2019"),
    Case("nastran/cantilever/guyanReduction.dat", "nastran/cantilever/guyanReduction.h5",
         "MSC 2019"),
    Case("nastran/space_truss/full.dat", "nastran/space_truss/full.op2", "NX 9"),
    Case("nastran/plate/plate_py.dat", "nastran/plate/plate_py.op2", "MSC or NX"),
    Case("nastran/mast/pn_mwe_s-solution_1.dat", "nastran/mast/pn_mwe_s-solution_1.op2",
         "NX 2022.1"),
    Case("nastran/beam_pairs/beam_modes.dat", "nastran/beam_pairs/beam_modes_m1.op2",
         "Simcenter 2019.2", "nastran/beam_pairs/beam_modes.f06"),
    Case("nastran/solid_shell_bar/mode_solid_shell_bar.bdf",
         "nastran/solid_shell_bar/mode_solid_shell_bar.op2", "MSC 2005 r2"),
    Case("matrices/dmig_punch/test_case.bdf", "matrices/dmig_punch/test_case.f06", "MSC 2013"),
    Case("matrices/dmig_punch_swept/sol103_swept_plane.bdf",
         "matrices/dmig_punch_swept/sol103_swept_plane.f06", "MSC 2013"),
)  # fmt: skip


class Result(NamedTuple):
    """Frequencies of the elastic modes [Hz], MAC of each, mass and centre beside the table's."""

    theirs: np.ndarray
    ours: np.ndarray
    mac: np.ndarray | None
    mass: float | None
    centre: float | None


def compare(case: Case, folder: Path) -> Result:
    """Solve a deck and compare it with the results of its run."""
    deck = read_deck(folder / case.deck)
    try:
        reference: Modes | None = read_modes(folder / case.results, deck)
        given = reference.frequencies_hz
    except InputError:  # a run that printed its eigenvalues alone
        reference, given = None, _printed(folder / case.results)
    model = build_model(deck)
    solution = solve(model, n_modes=min(len(given) + 8, model.n_free))
    found = modes_of(model, solution)
    free = solution.rigid_body_modes
    ours = found.frequencies_hz[free:]
    order = np.argsort(given)
    order = order[given[order] > 0.1 * ours[0]]  # without its rigid-body modes
    count = min(MOST, len(order), len(ours))
    mac = None
    if reference is not None:
        mac = _mac(reference, order[:count], found, free, model.geometry.size)
    mass, centre = _weighed(folder / case.weighed, weight(deck)) if case.weighed else (None, None)
    return Result(given[order[:count]], ours[:count], mac, mass, centre)


def _mac(reference: Modes, chosen: np.ndarray, found: Modes, free: int, size: float) -> np.ndarray:
    """MAC of each mode with the span of all of ours that are as good as its equals, (count,).

    Over all degrees of freedom, rotations by a tenth of the structure's size.
    """
    keys = {key: k for k, key in enumerate(zip(*_keys(found.dofs), strict=True))}
    rows = np.array([keys.get(key, -1) for key in zip(*_keys(reference.dofs), strict=True)])
    there = rows >= 0
    turns = reference.dofs.component[there] > 3
    arm = np.where(turns, 0.1 * (size or 1.0), 1.0)[:, None]
    a = reference.shapes[there] * arm
    b = found.shapes[rows[there], free:] * arm
    f, g = reference.frequencies_hz, found.frequencies_hz[free:]
    mac = []
    for place, k in enumerate(chosen):
        near = np.flatnonzero(np.abs(g / f[k] - 1.0) < TOGETHER)
        Q, _ = np.linalg.qr(b[:, near if len(near) else [place]])
        mac.append(float(np.sum((Q.T @ a[:, k]) ** 2) / (a[:, k] @ a[:, k])))
    return np.array(mac)


def _keys(dofs: Dofs) -> tuple[list[int], list[int]]:
    return dofs.node.tolist(), dofs.component.tolist()


def _printed(f06: Path) -> np.ndarray:
    """Frequencies [Hz] of the first table of real eigenvalues."""
    text = f06.read_text("latin-1")
    table = text[text.index("R E A L   E I G E N V A L U E S") :].split("\n1 ")[0]
    number = r"\s+([-+]?\d\.\d+E[-+]\d+)"
    rows = re.findall(r"^\s+\d+\s+\d+" + 5 * number, table, re.MULTILINE)
    return np.array([float(row[2]) for row in rows])


def _weighed(f06: Path, ours) -> tuple[float, float]:
    """Largest relative difference of mass, and of the centre beside its distance, to the table."""
    text = f06.read_text("latin-1")
    table = text[text.index("MASS AXIS SYSTEM (S)") :].splitlines()[1:4]
    number = r"[-+]?\d\.\d+E[-+]\d+"
    rows = np.array([[float(x) for x in re.findall(number, line)] for line in table])
    centre = np.array([rows[1, 1], rows[0, 2], rows[0, 3]])
    size = max(float(np.linalg.norm(centre)), 1e-30)
    mass = float(np.abs(ours.masses / rows[:, 0] - 1.0).max())
    return mass, float(np.linalg.norm(ours.centre_of_gravity - centre)) / size


def main() -> None:
    """Print the table and one line of JSON."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--modes", action="store_true", help="every mode, not the worst alone")
    options.add_argument("--data", type=Path, default=Path(__file__).parents[2] / "shared" / "data")
    given = options.parse_args()
    if not given.data.is_dir():
        sys.exit(f"{given.data} is not there; name the folder with --data")
    say = sys.stdout.write
    say("| deck | reference | modes | worst | reference Hz | trueup Hz | difference | MAC |"
        " mass | centre |\n")  # fmt: skip
    say("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|\n")
    worst: dict[str, float | None] = {}
    shapes: dict[str, float] = {}
    for case in CASES:
        name = "/".join(Path(case.deck).with_suffix("").parts[1:])
        try:
            r = compare(case, given.data)
        except InputError as error:
            say(f"| {name} | {case.solver} | | | | | refused: {error} | | | |\n")
            worst[name] = None
            continue
        off = 100.0 * (r.ours / r.theirs - 1.0)
        shown = range(len(off)) if given.modes else [int(np.argmax(np.abs(off)))]
        table = [f"{x:.1e}" if x is not None else "" for x in (r.mass, r.centre)]
        for k in shown:
            mac = "" if r.mac is None else f"{r.mac[k] if given.modes else r.mac.min():.6f}"
            say(
                f"| {name} | {case.solver} | {len(off)} | {k + 1} | {r.theirs[k]:.6g} "
                f"| {r.ours[k]:.6g} | {off[k]:+.3f} % | {mac} | {' | '.join(table)} |\n"
            )
        worst[name] = round(float(np.abs(off).max()), 5)
        if r.mac is not None:
            shapes[name] = round(float(r.mac.min()), 6)
    say(json.dumps({"worst_difference_percent": worst, "worst_mac": shapes}) + "\n")


if __name__ == "__main__":
    main()
