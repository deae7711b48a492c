"""Keyword arguments of the verbs that compare: the keys of a study file, with the same meaning."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from inspect import signature
from typing import ParamSpec, TypedDict, TypeVar

from ...core.errors import InputError, path_of
from ...core.statespace.damping_choice import Asked
from .study import Study, merge, read_study
from .study_tables import ConfigurationRequest, LoadRequest, StageRequest
from .taking_part import refuse_idle
from .values import unknown

Files = str | os.PathLike[str]
P = ParamSpec("P")
R = TypeVar("R")
Say = Callable[[str], None]
"""Told what a verb is at, a few words at a time."""


class CompareOptions(TypedDict, total=False):
    """What every verb that compares can be told; None is the default, of ``rotate`` "none".

    ``deck_length_unit`` ("m", "mm", "in", "ft"); ``mac_min`` of a pair; ``frequency_tolerance``,
    the largest |analysis − test|/test of a pair; ``cluster_width``, the relative bandwidth within
    which modes are close; ``rotate`` ("analysis", "test", "none"), the side that is rotated;
    ``seed`` of every random number. Where modes are identified in frequency responses on the way,
    what `identify` can be told: ``fmin``, ``fmax``, ``bands``, ``max_order``, ``take``, ``refuse``,
    ``exponential_window``, and its ``modes`` as ``identify_modes``.

    What takes part: ``fmin``, ``fmax`` and ``bands`` of test modes, too; ``exclude_test`` and
    ``exclude_analysis``, numbers of modes ("7,9:12"); ``exclude_sensors``, nodes of the test or
    directions of them ("1112, 40:Z"); ``pairs`` by hand, whatever their MAC ("3:5", test before
    analysis); ``mode_weights`` of test modes beside the others ({3: 0.2}); ``node_map``, test
    nodes to the grids that they are at ({1112: 40}). What has no effect on a verb is refused.
    ``mode_names`` of test modes for tables and report ({3: "first bending"}).
    """

    deck_length_unit: str | None
    mac_min: float | None
    frequency_tolerance: float | None
    cluster_width: float | None
    rotate: str | None
    seed: int | None
    fmin: float | None
    fmax: float | None
    bands: str | Sequence[str | tuple[float, float]] | None
    max_order: int | None
    take: float | Sequence[float] | None
    refuse: float | Sequence[float] | None
    identify_modes: int | None
    exponential_window: float | str | None
    exclude_test: int | str | Sequence[int | str] | None
    exclude_analysis: int | str | Sequence[int | str] | None
    exclude_sensors: int | str | Sequence[int | str] | None
    pairs: str | Sequence[str | tuple[int, int]] | None
    mode_weights: str | Sequence[str] | Mapping[int, float] | None
    node_map: str | Sequence[str] | Mapping[int, int] | None
    mode_names: str | Sequence[str] | Mapping[int, str] | None


class CorrelateOptions(CompareOptions, total=False):
    """What ``correlate`` can be told besides `CompareOptions`.

    ``parameters`` of the model; ``reduction`` of its mass to the sensors ("serep", "guyan", "irs"),
    for the orthogonality of the pairs and their test shapes expanded to all grids (None: neither).
    """

    parameters: str | Sequence[str] | None
    reduction: str | None


class UpdateOptions(CompareOptions, total=False):
    """What ``update`` can be told besides `CompareOptions`.

    ``residuals`` ("frequencies", "shapes", others with commas; None: "both"); ``test_modes`` that
    take part, from 1 (None: all); ``max_iterations`` of a stage; ``frequency_sigma``,
    ``shape_sigma`` and ``regularisation`` weigh the residuals and the parameters; ``stages`` of a
    strategy; ``write_undetermined`` (False): parameters that the test does not determine move, too.

    ``starts`` (0): from how many other factors the update is made as well, to say whether the
    optimum is the only one; ``intervals`` (False): 95 % intervals of the factors by profile;
    ``samples`` (0): how many to draw of the posterior; ``evidence`` (False): for which
    ``prior_sigma`` the test speaks. ``executor`` ("processes": one a core; "processes:4",
    "dask:ADDRESS"): who does the starts.
    ``residuals`` with "prior" and ``prior_sigma``: how far off the deck's values may be.

    ``solver``: the command of the user's own Nastran, "nastran {deck}", whose modes are then those
    that meet the test; it may take ``solver_limit`` seconds (3600) a run.

    What was measured beside modes, in deck units, each for a residual of its own:
    ``measured_mass`` ("mass"), ``measured_centre_of_gravity`` (x, y, z: "centre_of_gravity"),
    ``load_cases`` ("deflections"): each with ``loads`` as "1187:-Z=100" and ``readings`` as
    "40:+Z=-1.25", grids along basic axes. ``mass_sigma``, ``centre_of_gravity_sigma`` and
    ``deflection_sigma`` are their standard deviations, of the mass, of the structure's size, and of
    the largest reading of a case.
    "damping" moves the ratios of complex modes to the test's; ``damping_sigma`` is of a ratio.
    "frfs" moves the log magnitudes of frequency responses (``frf_sigma``), "antiresonances" the
    dips of driving points (``antiresonance_sigma`` of a frequency).
    "relations" holds ratios and sums of parameters to what is known: ``relations`` such as
    "skin / web = 2 ± 0.1" or "front + rear = 12.5 ± 0.2", by their names, in the deck's units.

    ``configurations`` of the structure that are updated together, in place of one deck and test:
    each a mapping with ``deck``, ``test``, a ``name``, and of the keys of a study what is another.
    """

    residuals: str | None
    test_modes: int | Sequence[int] | None
    max_iterations: int | None
    frequency_sigma: float | None
    shape_sigma: float | None
    regularisation: float | None
    stages: Sequence[StageRequest | Mapping[str, object]] | None
    write_undetermined: bool | None
    starts: int | None
    executor: str | None
    intervals: bool | None
    samples: int | None
    evidence: bool | None
    solver: str | None
    solver_limit: float | None
    relations: str | Sequence[str] | None
    measured_mass: float | None
    measured_centre_of_gravity: Sequence[float] | None
    load_cases: Sequence[LoadRequest | Mapping[str, object]] | None
    configurations: Sequence[ConfigurationRequest | Mapping[str, object]] | None


class ParametersOptions(CompareOptions, total=False):
    """What ``parameters`` can be told besides `CompareOptions`; all of it as for ``update``."""

    residuals: str | None
    test_modes: int | Sequence[int] | None
    frequency_sigma: float | None
    shape_sigma: float | None
    relations: str | Sequence[str] | None
    measured_mass: float | None
    measured_centre_of_gravity: Sequence[float] | None
    load_cases: Sequence[LoadRequest | Mapping[str, object]] | None


class DiscoverOptions(CompareOptions, total=False):
    """What ``discover`` can be told besides `CompareOptions`.

    ``parameters`` that may be off besides the usual ones, as on the command line;
    ``frequency_scatter`` and ``shape_scatter``: standard deviations of the test, of a frequency
    over itself and of a reading over the rms of its shape; ``adopt`` ("significant", "all",
    "none"), which of the known parameters that moved along are written into the deck.
    """

    parameters: str | Sequence[str] | None
    frequency_scatter: float | None
    shape_scatter: float | None
    adopt: str | None


class PlantOptions(TypedDict, total=False):
    """What a plant can be told.

    ``inputs`` and ``outputs`` as in "1187:+Z,tip=1187:RZ" and "1187:+Z:acc,40:+X,@3:+Y:vel" (@ is
    a sensor of the test of a run); ``fmi``, 2 or 3; ``platforms``, "linux64,win64" or "all"
    (None: whatever a compiler at hand makes); ``damping``, a ratio, one a mode,
    "1:0.01,2:0.02,0.015", "test", "deck" (None: what test and deck know, 1 % where they do not);
    ``lines`` (1600) of frequency responses; ``residual`` (True), modes for the static contribution
    of what is left out; ``rigid_body`` (True), rigid-body modes; ``units``, "si" or "deck";
    ``deck_length_unit`` ("m", "mm", "in", "ft").
    """

    inputs: str | Sequence[str]
    outputs: str | Sequence[str]
    fmi: int
    platforms: str | Sequence[str] | None
    damping: Asked
    lines: int
    residual: bool
    rigid_body: bool
    units: str
    deck_length_unit: str | None


def study_of(
    verb: str, study: Study | Files | None, given: Mapping[str, object], known: Mapping[str, object]
) -> Study:
    """Return what a verb is asked: the study (a file is read) with keyword arguments on top.

    Raises
    ------
    InputError
        A keyword that the verb does not know, a value of the wrong type or that no run accepts.
    """
    if isinstance(study, str | os.PathLike):
        study = read_study(path_of(study, "a study"))
    if not isinstance(study, Study | None):
        raise InputError(f"{verb}: study is {study!r}; give the path of a study file")
    if "rotate" in given and given["rotate"] is None:
        given = {**given, "rotate": "none"}
    study = study or Study()
    spoken = [key for key, value in given.items() if value is not None]
    refuse_idle(verb, spoken, staged=bool(study.stages) and "stages" not in spoken)
    return merge(study, given, known, verb) if given else study


def checked_call(verb: Callable[P, R]) -> Callable[P, R]:
    """Return a verb that refuses a keyword it does not know, as the verbs that compare do.

    The verb raises `InputError` that names the keyword and those that are known, and one for a
    `progress` that cannot be called. Those of `PlantOptions` count where the verb takes more.
    """
    taken = signature(verb).parameters.values()
    known = [p.name for p in taken if p.kind is not p.VAR_KEYWORD]
    known += PlantOptions.__annotations__ if len(known) < len(taken) else ()

    @wraps(verb)
    def call(*args: P.args, **given: P.kwargs) -> R:
        for name in given:
            if name not in known:
                raise InputError(f"{verb.__name__}: {unknown(name, known)}")
        said_to(given.get("progress", unheard))
        return verb(*args, **given)

    return call


def said_to(progress: object) -> None:
    """Refuse a `progress` that cannot be told anything."""
    if not callable(progress):
        raise InputError(f"progress is {progress!r}; give a function that takes a text, or nothing")


def unheard(_: str) -> None:
    """Take what a verb says and keep it quiet."""
