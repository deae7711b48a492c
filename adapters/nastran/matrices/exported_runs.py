"""Derivative matrices from a small set of runs of the user's own Nastran."""

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

from ....core.data.parametric_model import Model, Term
from ....core.errors import InputError, Place
from ..deck.read_deck import Deck
from ..deck_reader import read_deck
from ..editing.add_cards import add_cards
from ..editing.set_values import set_values
from ..editing.write_deck import write_deck
from ..fields.parameter_references import ParameterSpec, moved, parse_parameter
from ..op4.exported_matrix import RUNS_SCHEMA, DofMap, NastranMatrix
from ..op4.op4 import list_op4
from ..text.deck_text import read_deck_text
from ..text.real_numbers import writable
from .dmig import read_dmig
from .hdf5_matrices import list_hdf5_matrices
from .matrix_model import model_of_matrices, stiffness_and_mass
from .op2_matrices import list_op2_matrices
from .read_matrices import matrix_file_kind, read_matrices
from .sample_design import Design, design_of

INDEX = "runs.json"
_REQUEST = ("PARAM", "EXTOUT", "DMIGPCH")
_WHY = "trueup: stiffness and mass of the a-set go to the punch file (KAAX, MAAX)"
_SUFFIXES = (".pch", ".op4", ".op2", ".h5")
_NOTHING = 1e-14


def write_runs(path: Path | str, specs: Sequence[ParameterSpec], out: Path | str) -> dict[str, Any]:
    """Write a deck at the parameter values from which its matrices follow at all others.

    Each run is a folder of its own with the whole deck, only the moved values changed, and
    ``PARAM,EXTOUT,DMIGPCH`` added unless the deck has EXTOUT itself: MSC and NX Nastran then punch
    KAAX and MAAX.

    Parameters
    ----------
    path : path
        The deck.
    specs : sequence of ParameterSpec
    out : path
        Folder that takes ``run_000`` ... and ``runs.json``; must exist.

    Returns
    -------
    dict
        What ``runs.json`` holds: ``parameters``, and ``runs`` with their factors and decks.

    Raises
    ------
    InputError
        A parameter that the deck does not have, too many runs.
    """
    if not specs:
        raise InputError("no parameter was named: give at least one, such as -p 'PSHELL 3 T'")
    out = Path(out)
    deck, text = read_deck(path), read_deck_text(path)
    design = design_of(deck, specs)
    if "EXTOUT" not in deck.params:
        text = add_cards(text, [_REQUEST], _WHY)
    runs = []
    for number, point in enumerate(design.points):
        values = moved(specs, design.parameters, point)
        top = write_deck(set_values(text, values), out / f"run_{number:03d}")
        runs.append({"deck": top.relative_to(out.absolute()).as_posix(), "factors": point.tolist()})
    index = {
        "schema": RUNS_SCHEMA,
        "deck": str(path),
        "parameters": [
            f"{s.name} = {', '.join(map(str, s.fields))} [{s.lower!r}, {s.upper!r}]" for s in specs
        ],
        "runs": runs,
    }
    (out / INDEX).write_text(json.dumps(index, indent=1) + "\n", encoding="utf-8")
    return index


def read_runs(folder: Path | str) -> Model:
    """Make a model with parameters of the matrices that the runs of `write_runs` exported.

    In each run's folder one punch, OP4, OP2 or HDF5 file with a pair of stiffness and mass is
    looked for. With as many runs as terms, the terms are those that give every run's matrices
    exactly.

    Raises
    ------
    InputError
        A folder without ``runs.json``, a run without matrices: which one is missing.
    """
    folder = Path(folder)
    index = read_index(folder)
    specs = [parse_parameter(text) for text in index["parameters"]]
    tops = [folder / run["deck"] for run in index["runs"]]
    deck = read_deck(tops[0])
    design = design_of(deck, specs)
    points = np.array([run["factors"] for run in index["runs"]])
    if points.shape != design.points.shape or not np.allclose(points, design.points, rtol=1e-12):
        raise Place(folder / INDEX).error("the runs are not those of its parameters; write anew")
    pairs = [_matrices_of(top, deck) for top in tops]
    stiffness, mass = [p[0] for p in pairs], [p[1] for p in pairs]
    frame = model_of_matrices(stiffness, mass, deck)
    exact = _as_written(design)
    return replace(
        frame,
        stiffness=_terms(stiffness, exact, frame),
        mass=_terms(mass, exact, frame),
        parameters=design.parameters,
        warnings=deck.warnings,
    )


def _as_written(design: Design) -> Design:
    """Return the design at the values as decks hold them, to sixteen columns."""
    points = np.array(design.points)
    for k, parameter in enumerate(design.parameters):
        value = parameter.deck_values[0]
        points[:, k] = [writable(value * f) / value if f != 1.0 else 1.0 for f in points[:, k]]
    return replace(design, points=points)


def read_index(folder: Path) -> dict[str, Any]:
    """Read the ``runs.json`` of a folder.

    Raises
    ------
    InputError
        There is none, or it is not one of export-runs.
    """
    try:
        index = json.loads((folder / INDEX).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Place(folder / INDEX).fault(f"cannot be read: {error}") from None
    if not isinstance(index, dict) or index.get("schema") != RUNS_SCHEMA:
        raise Place(folder / INDEX).fault("was not written by trueup export-runs")
    return index


def matrices_beside(top: Path) -> list[Path]:
    """Return the files beside a run's deck that hold a pair of stiffness and mass."""
    if not top.parent.is_dir():
        return []
    return sorted(p for p in top.parent.iterdir() if _holds_matrices(p))


def _matrices_of(top: Path, deck: Deck) -> tuple[NastranMatrix, NastranMatrix]:
    found = matrices_beside(top)
    if not found:
        raise Place(top.parent).fault(
            f"has no punch, OP4, OP2 or HDF5 file with a pair of stiffness and mass "
            f"matrices: run Nastran on {top.name} there"
        )
    if len(found) > 1:
        raise Place(top.parent).fault(
            f"has several files with matrices ({found[0].name}, {found[1].name}): keep one"
        )
    return stiffness_and_mass(read_matrices(found[0], deck))


def _holds_matrices(path: Path) -> bool:
    suffix = path.suffix.lower()
    if not path.is_file() or not (suffix in _SUFFIXES or suffix.startswith(".pch")):
        return False
    try:
        kind = matrix_file_kind(path)
        if kind == "punch":  # of modes or of DMIG
            names = {m.name for m in read_dmig(path)}
        else:
            names = {name for name, _ in _LISTS[kind](path)}
    except InputError:
        return False
    return any(n[:1] == "K" and "M" + n[1:] in names for n in names)


_LISTS: dict[str, Callable[[Path], Iterable[tuple[str, tuple[int, int]]]]] = {
    "op4": lambda path: [(h.name, h.shape) for h in list_op4(path)],
    "op2": list_op2_matrices,
    "hdf5": list_hdf5_matrices,
}


def _terms(matrices: Sequence[NastranMatrix], design: Design, frame: Model) -> tuple[Term, ...]:
    """Solve for the constant matrices, entry by entry on the union of all patterns."""
    keys = DofMap.of_labels(frame.free_labels).keys
    n = len(keys)
    entries = []
    for m in matrices:
        assert m.rows is not None
        at, coo = np.searchsorted(keys, m.rows.keys), m.matrix.tocoo()
        entries.append((at[coo.row].astype(np.int64) * n + at[coo.col], coo.data))
    places = np.unique(np.concatenate([e[0] for e in entries]))
    values = np.zeros((len(entries), len(places)))
    for k, (at, data) in enumerate(entries):
        np.add.at(values[k], np.searchsorted(places, at), data)
    constants = np.linalg.solve(design.collocation, values)
    largest = np.abs(values).max(initial=0.0)
    terms = []
    for factors, data in zip(design.terms, constants, strict=True):
        if np.abs(data).max(initial=0.0) > _NOTHING * largest or not factors:
            matrix = sp.coo_matrix((data, (places // n, places % n)), shape=(n, n)).tocsr()
            terms.append(Term(((matrix + matrix.T) / 2.0).tocsr(), factors))
    return tuple(terms)
