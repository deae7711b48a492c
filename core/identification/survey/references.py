"""References against each other: exchanged, reversed, driving points that are none."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ...arrays import Floats, Ints, Numbers
from .driving_points import coupled, positive_share, resonates
from .faults import Fault, listed
from .neighbours import Neighbours
from .survey_data import Survey, told
from .survey_numbers import SURVEY


@dataclass(frozen=True)
class DrivingPoint:
    """What the function of a driving point says.

    Parameters
    ----------
    function : str
        Response and reference as the file has them.
    positive_share : float
        Power that it takes, less what it gives back, over both, -1..1.
    phase_deg : float
        Phase of its residues against that of a normal mode, mean over the modes by their size;
        NaN without modes.
    """

    function: str
    positive_share: float
    phase_deg: float


@dataclass(frozen=True)
class Reciprocity:
    """A function between two driving points and its reciprocal.

    Parameters
    ----------
    function, reciprocal : str
    correlation : float
        Real part of the correlation of both, -1..1.
    difference : float
        Of their residues, over their size, 0..√2; NaN without modes.
    """

    function: str
    reciprocal: str
    correlation: float
    difference: float


def references_mended(survey: Survey, points: Floats, neighbours: Neighbours | None) -> Survey:
    """Exchange references that stand under each other's name, turn reversed ones, name the rest.

    Exchanged are two whose exchange makes driving points of what is none, and functions between
    them reciprocal. Of a driving point that gives power back, the function alone is reversed where
    its point and its reference are reciprocal with another, the whole reference where the
    neighbours of the point stand by the point. Where neither tells, nothing is turned.

    Parameters
    ----------
    survey : Survey
    points : (n_input, n_output) float
        From `driving_points`.
    neighbours : Neighbours, optional
    """
    n = survey.values.shape[1]
    now = _disagreement(survey, points)
    errors = {(a, b): _disagreement(_exchanged(survey, a, b), points)
              for a, b in combinations(range(n), 2)} if now > SURVEY.disagree else {}  # fmt: skip
    if errors and min(errors.values()) < SURVEY.exchanged * now:
        a, b = min(errors, key=lambda pair: errors[pair])
        names = tuple(survey.function(o, i) for i in (a, b) for o in range(len(survey.values)))
        sentence = (
            f"{survey.inputs.labels[a]} and {survey.inputs.labels[b]} stand under each other's "
            "name, as driving points and reciprocity say; exchanged"
        )
        survey = _exchanged(survey, a, b)
        survey = told(survey, Fault("swapped_references", names, sentence, "exchanged"))
    functions = _between(survey, points)
    share = {i: positive_share(f) for (i, j), f in functions.items() if i == j and resonates(f)}
    for i in (i for i, s in share.items() if s <= SURVEY.gives):
        if share[i] > SURVEY.takes:
            survey = told(survey, _no_driving_point(survey, i, points))
            continue
        sound = [j for j, s in share.items() if s > SURVEY.gives]
        alike = [_correlation(functions[i, j], functions[j, i])
                 for j in sound if (i, j) in functions and (j, i) in functions]  # fmt: skip
        rows = np.flatnonzero(points[i])
        if len(rows) == 1 and max(alike, default=0.0) > SURVEY.reciprocal:
            survey = _turned(survey, rows, i, "reciprocity")
        elif neighbours and (neighbours.unlike_now[rows] < SURVEY.neighbour_left).all():
            survey = _turned(survey, np.flatnonzero(survey.measured[:, i]), i, "the neighbours")
        else:
            survey = told(survey, _reversed(survey, i, points))
    return told(survey, *_of_other_size(survey, points))


def _of_other_size(survey: Survey, points: Floats) -> list[Fault]:
    """Name functions that are reciprocal but for a factor."""
    functions = _between(survey, points)
    said: list[str] = []
    names: list[str] = []
    sound = {i for (i, j), f in functions.items() if i == j and resonates(f)}
    for i, j in (pair for pair in _pairs(functions) if {*pair} <= sound):
        there, back = functions[i, j], functions[j, i]
        factor = float(np.linalg.norm(there) / max(float(np.linalg.norm(back)), 1e-300))
        large = abs(np.log(max(factor, 1e-300))) > np.log(SURVEY.gain_least)
        if large and _correlation(there, back) > SURVEY.reciprocal_surely:
            pair = function_between(survey, i, j, points), function_between(survey, j, i, points)
            said.append(f"{pair[0]} is {factor:.3g} times {pair[1]}")
            names += pair
    if not said:
        return []
    sentence = (
        f"{listed(said)}, which is reciprocal: the calibration of a reference, or of its point, is "
        "wrong, and modal masses with it"
    )
    return [Fault("wrong_gain", tuple(dict.fromkeys(names)), sentence)]


def _no_driving_point(survey: Survey, i: int, points: Floats) -> Fault:
    name = function_between(survey, i, i, points)
    sentence = (
        f"{name}: not the function of a driving point, it gives power back at some of its "
        "resonances; another point, direction or channel is under that name"
    )
    return Fault("driving_point", (name,), sentence)


def _reversed(survey: Survey, i: int, points: Floats) -> Fault:
    name, label = function_between(survey, i, i, points), survey.inputs.labels[i]
    sentence = (
        f"{name}: the driving point gives power back: this function has the wrong sign, or all of "
        f"{label} as a reference, or all of this point; nothing tells which, not turned"
    )
    return Fault("wrong_sign", (name,), sentence)


def _turned(survey: Survey, rows: Ints, i: int, teller: str) -> Survey:
    values = survey.values.copy()
    values[rows, i] *= -1.0
    names = tuple(survey.function(int(o), i) for o in rows)
    which = names[0] if len(names) == 1 else f"{survey.inputs.labels[i]}: all its functions"
    sentence = f"{which}: of the wrong sign, as the driving point and {teller} say; turned"
    return told(replace(survey, values=values), Fault("wrong_sign", names, sentence, "turned"))


def function_between(survey: Survey, i: int, j: int, points: Floats) -> str:
    """Name the function(s) at the driving point of input `i` for input `j`."""
    return " + ".join(survey.function(o, j) for o in np.flatnonzero(points[i]))


def _between(survey: Survey, points: Floats) -> dict[tuple[int, int], Numbers]:
    """Functions measured at the driving point of one input for another, without weights."""
    found = {}
    for i in np.flatnonzero(np.isfinite(points).all(axis=1)):
        rows = np.flatnonzero(points[i])
        factors = points[i, rows] / survey.output_weight[rows]
        for j in np.flatnonzero(survey.measured[rows].all(axis=0)):
            if j == i or np.isfinite(points[j]).all():
                found[int(i), int(j)] = factors @ survey.values[rows, j] / survey.input_weight[j]
    return found


def _pairs(functions: dict[tuple[int, int], Numbers]) -> list[tuple[int, int]]:
    """Return the inputs whose functions, there and back, can be held against each other."""
    n = 1 + max((i for i, _ in functions), default=-1)
    size = np.full((n, n), np.nan)
    for i, j in functions:
        size[i, j] = np.linalg.norm(functions[i, j])
    held = np.triu(coupled(size))
    return [(int(i), int(j)) for i, j in zip(*np.nonzero(held), strict=True)]


def _correlation(there: Numbers, back: Numbers) -> float:
    size = float(np.linalg.norm(there) * np.linalg.norm(back))
    return float(np.vdot(there, back).real / size) if size > 0.0 else 1.0


def _disagreement(survey: Survey, points: Floats) -> float:
    """Mean failure of driving points and reciprocity, 0 (they hold) to 1 (they are reversed)."""
    functions = _between(survey, points)
    share = [positive_share(f) for (i, j), f in functions.items() if i == j]
    share += [_correlation(functions[i, j], functions[j, i]) for i, j in _pairs(functions)]
    return float(np.mean((1.0 - np.array(share)) / 2.0)) if share else 0.0


def _exchanged(survey: Survey, a: int, b: int) -> Survey:
    """Give each of two inputs the functions of the other, their weights with them."""
    values, weight = survey.values.copy(), survey.input_weight.copy()
    measured = survey.measured.copy()
    values[:, [a, b]], weight[[a, b]] = values[:, [b, a]], weight[[b, a]]
    measured[:, [a, b]] = measured[:, [b, a]]
    return replace(survey, values=values, input_weight=weight, measured=measured)


def checked_references(
    survey: Survey, points: Floats, poles: Numbers, shapes: Numbers, participation: Numbers
) -> tuple[tuple[DrivingPoint, ...], tuple[Reciprocity, ...]]:
    """Return how far driving points and reciprocity hold, the functions' and the modes' word.

    Parameters
    ----------
    survey : Survey
    points : (n_input, n_output) float
        From `driving_points`.
    poles : (n_mode,) complex
    shapes : (n_output, n_mode) complex
    participation : (n_input, n_mode) complex
        In physical units.
    """
    functions = _between(survey, points)
    peak = np.abs(poles) ** 2 / np.abs(poles.real)

    def residues(i: int, j: int) -> Numbers:
        return np.asarray((points[i] @ shapes) * participation[j] * peak)

    driving, pairs = [], []
    reciprocal = _pairs(functions)
    for (i, j), function in functions.items():
        if i == j:
            turned = 2j * residues(i, i)
            size = float(np.sum(np.abs(turned)))
            off = np.abs(np.angle(turned, deg=True))
            phase = float(np.sum(off * np.abs(turned)) / size) if size > 0.0 else np.nan
            share = positive_share(function)
            driving.append(DrivingPoint(function_between(survey, i, i, points), share, phase))
        elif (i, j) in reciprocal:
            there, back = residues(i, j), residues(j, i)
            size = float(np.sqrt(np.sum(np.abs(there) ** 2 + np.abs(back) ** 2)))
            apart = float(np.linalg.norm(there - back)) / size if size > 0.0 else np.nan
            between = [function_between(survey, x, y, points) for x, y in ((i, j), (j, i))]
            alike = _correlation(function, functions[j, i])
            pairs.append(Reciprocity(between[0], between[1], alike, apart))
    return tuple(driving), tuple(pairs)
