"""What a folder of exported runs holds, and its polynomial terms as matrices."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from ....core.data.parameter import Parameter
from ....core.data.parametric_model import Factor, Model, Term
from ....core.errors import InputError
from ..op4.exported_matrix import SYMMETRIC, DofMap, NastranMatrix
from .exported_runs import matrices_beside, read_index, read_runs


def describe_runs(path: Path | str) -> dict[str, Any]:
    """Say which parameters a ``runs.json`` moves and which runs have their matrices.

    Raises
    ------
    InputError
        A file that cannot be read.
    """
    folder = Path(path).parent
    index = read_index(folder)
    held = [[p.name for p in matrices_beside(folder / r["deck"])] for r in index["runs"]]
    runs = [
        {"deck": r["deck"], "factors": r["factors"], "matrices": names[0] if names else None}
        for r, names in zip(index["runs"], held, strict=True)
    ]
    missing = sum(1 for r in runs if r["matrices"] is None)
    return {
        "format": "runs of trueup export-runs",
        "contents": {
            "deck": index["deck"],
            "parameters": index["parameters"],
            "runs": runs,
            "runs_without_matrices": missing,
        },
        "skipped": [],
    }


def terms_of_runs(path: Path | str) -> list[tuple[NastranMatrix, str]]:
    """Return the constant matrices of K and M over the parameters, and what multiplies each.

    K0 and M0 stand alone; K1, K2, ... and M1, M2, ... are multiplied by Chebyshev polynomials of
    the parameters' factors on their bounds, as the text says.

    Raises
    ------
    InputError
        As `read_runs`.
    """
    model = read_runs(Path(path).parent)
    there = DofMap.of_labels(model.free_labels)
    return [
        (NastranMatrix(name, term.matrix.tocsc(), SYMMETRIC, there, there), said)
        for letter, terms in (("K", model.stiffness), ("M", model.mass))
        for name, term, said in _named(letter, terms, model)
    ]


def _named(letter: str, terms: Sequence[Term], model: Model) -> list[tuple[str, Term, str]]:
    ordered = sorted(terms, key=lambda t: len(t.factors) > 0)
    return [
        (f"{letter}{k}", term, " ".join(_said(f, model.parameters) for f in term.factors) or "1")
        for k, term in enumerate(ordered)
    ]


def _said(factor: Factor, parameters: Sequence[Parameter]) -> str:
    name = parameters[factor.parameter].name
    order = len(factor.coefficients) - 1
    if any(factor.coefficients[:-1]) or factor.coefficients[-1] != 1.0:
        raise InputError(f"the terms of {name} are no single polynomials: this is a defect")
    return f"T{order}({name} on [{factor.lower:g}, {factor.upper:g}])"
