"""Frequencies of the embedded solver against those that MSC or NX Nastran gave for the same deck.

    python benchmarks/accuracy.py [--modes] [--data DIR]

Reads decks and results from the data folder beside the checkout (../shared/data), solves each deck
and prints a table, with --modes one of every mode, then one line of JSON. The references are read
from the results of the runs, never typed in.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from trueup import InputError, build_model, read_deck, read_modes, solve

MOST = 10
"""Elastic modes compared."""


@dataclass(frozen=True)
class Case:
    """A deck, the results of its run, and the solver that made them, as far as they say."""

    deck: str
    results: str
    solver: str


CASES = (
    Case("truss_72/modes.dat", "truss_72/modes.h5", "MSC 2019"),
    Case("ten_bar/modes.dat", "ten_bar/modes.h5", "MSC 2019"),
    Case("svanberg_beam/modes.dat", "svanberg_beam/modes.h5", "MSC 2019"),
    Case("frame/noReduction-000.dat", "frame/noreduction-000.h5", "MSC 2019"),
    Case("cantilever/noReduction.dat", "cantilever/noReduction.h5", "MSC 2019"),
    Case("space_truss/full.dat", "space_truss/full.op2", "NX 9"),
    Case("plate/plate_py.dat", "plate/plate_py.op2", "MSC or NX"),
    Case("mast/pn_mwe_s-solution_1.dat", "mast/pn_mwe_s-solution_1.op2", "NX 2022.1"),
    Case("beam_pairs/beam_modes.dat", "beam_pairs/beam_modes_m1.op2", "Simcenter 2019.2"),
    Case("solid_shell_bar/mode_solid_shell_bar.bdf",
         "solid_shell_bar/mode_solid_shell_bar.op2", "MSC 2005 r2"),
)  # fmt: skip


def compare(case: Case, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return the first elastic frequencies of the reference and of trueup, Hz, (n,) each."""
    deck = read_deck(folder / case.deck)
    theirs = read_modes(folder / case.results, deck).frequencies_hz
    model = build_model(deck)
    solution = solve(model, n_modes=min(len(theirs) + 6, model.n_free))
    ours = solution.frequencies_hz[solution.rigid_body_modes :]
    theirs = np.sort(theirs[theirs > 0.1 * ours[0]])  # without its rigid-body modes
    count = min(MOST, len(theirs), len(ours))
    return theirs[:count], ours[:count]


def main() -> None:
    """Print the table and one line of JSON."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--modes", action="store_true", help="every mode, not the worst alone")
    options.add_argument(
        "--data", type=Path, default=Path(__file__).parents[2] / "shared" / "data" / "nastran"
    )
    given = options.parse_args()
    if not given.data.is_dir():
        sys.exit(f"{given.data} is not there; name the decks with --data")
    say = sys.stdout.write
    say("| deck | reference | modes | reference Hz | trueup Hz | difference |\n")
    say("|---|---|---:|---:|---:|---:|\n")
    worst = {}
    for case in CASES:
        name = case.deck.split("/")[0]
        try:
            theirs, ours = compare(case, given.data)
        except InputError as error:
            say(f"| {name} | {case.solver} | – | – | – | refused: {error} |\n")
            worst[name] = None
            continue
        off = 100.0 * (ours / theirs - 1.0)
        shown = range(len(off)) if given.modes else [int(np.argmax(np.abs(off)))]
        for k in shown:
            which = f"{k + 1}" if given.modes else f"worst of {len(off)}"
            say(
                f"| {name} | {case.solver} | {which} | {theirs[k]:.6g} | {ours[k]:.6g} "
                f"| {off[k]:+.3f} % |\n"
            )
        worst[name] = round(float(np.abs(off).max()), 5)
    say(json.dumps({"worst_difference_percent": worst}) + "\n")


if __name__ == "__main__":
    main()
