"""Points against their neighbours: reversed ones, and two under each other's name."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ...arrays import Floats, Numbers
from ...data.geometry import Geometry
from .faults import Fault, listed
from .survey_data import Survey, named_and_left_out, told
from .survey_numbers import SURVEY


@dataclass(frozen=True, eq=False)
class Neighbours:
    """How the functions of each output follow from those of its neighbours.

    Parameters
    ----------
    weights : (n_output, n_output) float
        Rows of an interpolation, linear in space, from the nearest outputs of the same direction;
        0 where they are too few.
    unlike_now : (n_output,) float
        Square of what is left of each output's functions, over that of the functions themselves;
        infinite where there are no neighbours.
    """

    weights: Floats
    unlike_now: Floats

    def unlike(self, survey: Survey, o: int, functions: Numbers) -> float:
        """Return what is left of other functions (n_input, n_line) at output `o`."""
        if not np.isfinite(self.unlike_now[o]):
            return np.inf
        own = functions / survey.output_weight[o]
        there = self.expected(survey, o)
        return float(np.sum(np.abs(own - there) ** 2) / max(np.sum(np.abs(own) ** 2), 1e-300))

    def factor(self, survey: Survey, o: int) -> float:
        """Real factor by which the functions of output `o` are nearest to what is expected."""
        own = survey.values[o] / survey.output_weight[o]
        there = self.expected(survey, o)
        return float(np.vdot(own, there).real / max(np.sum(np.abs(own) ** 2), 1e-300))

    def expected(self, survey: Survey, o: int) -> Numbers:
        """Functions (n_input, n_line) of output `o` that follow from its neighbours' ones."""
        near = np.flatnonzero(self.weights[o])
        scale = self.weights[o, near] / survey.output_weight[near]
        return np.asarray(np.tensordot(scale, survey.values[near], axes=1))


def neighbours_of(survey: Survey, geometry: Geometry | None) -> Neighbours | None:
    """Return how neighbours tell each other's functions; None where they typically do not."""
    if geometry is None or not len(geometry.ids):
        return None
    weights = _interpolation(survey, geometry)
    whole = survey.measured.all(axis=1)
    told_by = (weights != 0.0).any(axis=1) & whole & ~(weights[:, ~whole] != 0.0).any(axis=1)
    found = Neighbours(weights, np.where(told_by, 0.0, np.inf))
    unlike = np.full(len(weights), np.inf)
    for o in np.flatnonzero(told_by):
        unlike[o] = found.unlike(survey, o, survey.values[o])
    if not told_by.any() or np.median(unlike[told_by]) > SURVEY.neighbour_left:
        return None
    return replace(found, unlike_now=unlike)


def _interpolation(survey: Survey, geometry: Geometry) -> Floats:
    outputs = survey.outputs
    at = geometry.index_of(outputs.node)
    weights = np.zeros((len(outputs), len(outputs)))
    usable = (at >= 0) & (outputs.component <= 3)
    for o in np.flatnonzero(usable):
        same = np.flatnonzero(usable & (np.abs(outputs.axis @ outputs.axis[o]) > SURVEY.one_way))
        arm = geometry.xyz[at[same]] - geometry.xyz[at[o]]
        distance = np.linalg.norm(arm, axis=1)
        near = np.argsort(np.where(distance > 0.0, distance, np.inf))[: SURVEY.neighbours]
        near = near[distance[near] > 0.0]
        if len(near) < SURVEY.neighbours:
            continue
        reach = distance[near].max()
        trust = (reach / distance[near])[:, None]
        terms = np.hstack([np.ones((len(near), 1)), arm[near] / reach]) * trust
        slope = SURVEY.neighbour_slope * np.diag([0.0, 1.0, 1.0, 1.0])
        value = np.linalg.solve(terms.T @ terms + slope, terms.T * trust[:, 0])[0]
        weights[o, same[near]] = value * np.sign(outputs.axis[same[near]] @ outputs.axis[o])
    return weights


def points_of_wrong_gain_left_out(survey: Survey, geometry: Geometry | None) -> Survey:
    """Leave out, one by one, the points that do as their neighbours do, but far more or less."""
    while (neighbours := neighbours_of(survey, geometry)) is not None:
        known = np.flatnonzero(np.isfinite(neighbours.unlike_now))
        factor = np.array([neighbours.factor(survey, o) for o in known])
        size = np.abs(np.log(np.maximum(factor, 1e-300))) * (factor > 0.0)
        k = int(np.argmax(size))
        o = int(known[k])
        scaled = factor[k] * survey.values[o]
        if (
            size[k] < np.log(SURVEY.neighbour_gain)
            or neighbours.unlike(survey, o, scaled) > SURVEY.neighbour_left
        ):
            break
        bad = np.zeros(survey.measured.shape, bool)
        bad[o] = survey.measured[o]
        what = (
            f"all functions of {survey.outputs.labels[o]} are about {1.0 / factor[k]:.2g} times "
            "what the neighbours say (a wrong unit, range or calibration?)"
        )
        survey = named_and_left_out(survey, "wrong_gain", bad, what)
    return survey


def points_mended(survey: Survey, neighbours: Neighbours | None) -> Survey:
    """Turn the points that are the reverse of their neighbours, exchange two that fit crosswise.

    Parameters
    ----------
    survey : Survey
    neighbours : Neighbours, optional
        Nothing is done without.
    """
    if neighbours is None:
        return survey
    odd = np.flatnonzero(np.isfinite(neighbours.unlike_now)
                         & (neighbours.unlike_now > SURVEY.neighbour_odd))  # fmt: skip
    odd = odd[np.argsort(-neighbours.unlike_now[odd])][: SURVEY.neighbour_most]
    values, weight = survey.values.copy(), survey.output_weight.copy()
    labels = survey.outputs.labels
    reversed_points = []
    for o in odd:
        if neighbours.unlike(survey, o, -survey.values[o]) < SURVEY.neighbour_left:
            values[o] *= -1.0
            reversed_points.append(int(o))
    faults = []
    if reversed_points:
        names = tuple(survey.function(o, i) for o in reversed_points
                      for i in range(values.shape[1]))  # fmt: skip
        sentence = (
            f"{listed([labels[o] for o in reversed_points])}: of the wrong sign, as the neighbours "
            "say (a sensor or a hammer the other way round); turned"
        )
        faults.append(Fault("wrong_sign", names, sentence, "turned"))
    left = [int(o) for o in odd if o not in reversed_points]
    for a, b in combinations(left, 2):
        if not (
            neighbours.unlike(survey, a, _under(survey, a, b)) < SURVEY.neighbour_odd
            and neighbours.unlike(survey, b, _under(survey, b, a)) < SURVEY.neighbour_odd
        ):
            continue  # fmt: skip
        swapped = _exchanged(survey, a, b)
        then = [neighbours.unlike(swapped, o, swapped.values[o]) for o in (a, b)]
        if max(then) < SURVEY.neighbour_left:
            values[[a, b]], weight[[a, b]] = values[[b, a]], weight[[b, a]]
            names = tuple(survey.function(o, i) for o in (a, b) for i in range(values.shape[1]))
            sentence = (
                f"{labels[a]} and {labels[b]} stand under each other's name, as their neighbours "
                "say; exchanged"
            )
            faults.append(Fault("swapped_points", names, sentence, "exchanged"))
    return told(replace(survey, values=values, output_weight=weight), *faults)


def _under(survey: Survey, a: int, b: int) -> Numbers:
    """Functions of output `b` in the weighting of output `a`."""
    return np.asarray(survey.values[b] * (survey.output_weight[a] / survey.output_weight[b]))


def _exchanged(survey: Survey, a: int, b: int) -> Survey:
    """Give each of two outputs the functions of the other, their weights with them."""
    values, weight = survey.values.copy(), survey.output_weight.copy()
    values[[a, b]], weight[[a, b]] = values[[b, a]], weight[[b, a]]
    return replace(survey, values=values, output_weight=weight)
