"""What a run is asked to do: study file, options and keyword arguments, merged and checked."""

from __future__ import annotations

import dataclasses
import math
import os
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, get_type_hints

from ...core.errors import InputError, Place
from .study_tables import ConfigurationRequest, LoadRequest, StageRequest
from .values import Hertz, checked, converted

if TYPE_CHECKING:
    from ...core.correlation.criteria import Criteria
    from ...core.identification.measured_modes import IdentifyOptions
    from ...core.updating.residuals import Residual, Weights

UNITS, ADOPT = ("m", "mm", "in", "ft"), ("significant", "all", "none")
_NO_MATTER = {"deck", "title", "author", "company", "logo", "date", "out", "source"}
"""Of a study, what any run accepts."""


@dataclass(frozen=True)
class Study:
    """Everything a verb that compares can be told; each field is a key of ``study.toml``.

    Paths in a study file are relative to the file. `parameters` are written as in
    ``-p PBAR 11 I1``; `stages` (a strategy of several steps) refer to them by name.
    """

    deck: Path | None = None
    test: tuple[Path, ...] = ()
    modes: Path | None = None
    deck_length_unit: str | None = None
    mac_min: float = 0.7
    frequency_tolerance: float = 0.3
    cluster_width: float = 0.02
    rotate: str = "analysis"
    parameters: tuple[str, ...] = ()
    residuals: str = "both"
    test_modes: tuple[int, ...] = ()
    max_iterations: int = 10
    frequency_scatter: float | None = None
    shape_scatter: float | None = None
    adopt: str = "significant"
    reduction: str | None = None
    regularisation: float = 1e-2
    write_undetermined: bool = False
    starts: int = 0
    executor: str = "processes"
    solver: str | None = None
    solver_limit: float = 3600.0
    intervals: bool = False
    samples: int = 0
    evidence: bool = False
    stages: tuple[StageRequest, ...] = ()
    load_cases: tuple[LoadRequest, ...] = ()
    configurations: tuple[ConfigurationRequest, ...] = ()
    relations: tuple[str, ...] = ()
    measured_mass: float | None = None
    measured_centre_of_gravity: tuple[float, ...] = ()
    fmin: float | None = None
    fmax: float | None = None
    bands: tuple[Hertz, ...] = ()
    max_order: int | None = None
    identify_modes: int | None = None
    take: tuple[float, ...] = ()
    refuse: tuple[float, ...] = ()
    exponential_window: float | str | None = None
    exclude_test: tuple[int, ...] = ()
    exclude_analysis: tuple[int, ...] = ()
    exclude_sensors: tuple[str, ...] = ()
    pairs: tuple[tuple[int, int], ...] = ()
    mode_weights: tuple[tuple[int, float], ...] = ()
    node_map: tuple[tuple[int, int], ...] = ()
    mode_names: tuple[tuple[int, str], ...] = ()
    title: str | None = None
    author: str | None = None
    company: str | None = None
    logo: Path | None = None
    date: str | None = None
    out: Path | None = None
    seed: int = 0
    sigmas: Mapping[str, float] = field(default_factory=dict, metadata={"file_key": False})
    """By the key of its residual, each a key of the file as well: ``frequency_sigma``."""
    source: Path | None = field(default=None, metadata={"file_key": False})

    def __post_init__(self) -> None:
        for name, kind in FIELDS.items():
            if getattr(self, name) is not None:
                own = converted(name, getattr(self, name), kind, Place(shown="Study"))
                object.__setattr__(self, name, own)
        if self.deck_length_unit is not None and self.deck_length_unit not in UNITS:
            raise InputError(
                f"deck_length_unit is '{self.deck_length_unit}'; give one of {', '.join(UNITS)}"
            )
        for name in ("frequency_scatter", "shape_scatter"):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value < 1.0:
                raise InputError(
                    f"{name} is {value:g}; give the standard deviation as a share, 0 to 1"
                )
        if self.adopt not in ADOPT:
            raise InputError(f"adopt is '{self.adopt}'; give one of {', '.join(ADOPT)}")
        if any(m < 1 for m in self.test_modes):
            raise InputError("test_modes are mode numbers in the test file and count from 1")
        self._require_apart()
        self._require_accepted()

    def __repr__(self) -> str:
        return f"Study({', '.join(f'{name}={value!r}' for name, value in self._given.items())})"

    @property
    def _given(self) -> dict[str, Any]:
        """What is not left to its default, by name."""
        every = ((f.name, getattr(self, f.name)) for f in dataclasses.fields(self))
        default = {f.name: f.default for f in dataclasses.fields(self)} | {"sigmas": {}}
        return {name: value for name, value in every if value != default[name]}

    def _require_accepted(self) -> None:
        """Refuse what the core accepts in no run, before any file is read."""
        if self._given.keys() <= _NO_MATTER:
            return  # what judges the others would be imported for nothing
        from ...core.reduction.model_at_sensors import require_method
        from ...core.updating.residuals import residuals_named
        from .executors import require_executor

        _ = self.criteria, self.weights
        require_executor(self.executor)
        if self.reduction is not None:
            require_method(self.reduction)
        for key, least in (("identify_modes", 1), ("max_order", 2), ("starts", 0), ("samples", 0)):
            value = getattr(self, key)
            if value is not None and value < least:
                raise InputError(f"{key} is {value}; it must be {least} or more")
        for words in (self.residuals, *(s.residuals for s in self.stages)):
            residuals_named(words)
        if self.measured_mass is not None and not self.measured_mass > 0.0:
            raise InputError(f"measured_mass is {self.measured_mass:g}; it must be above 0")
        if len(self.measured_centre_of_gravity) not in (0, 3):
            raise InputError("measured_centre_of_gravity is x, y, z; give three numbers")
        if not self.solver_limit > 0.0:
            raise InputError(f"solver_limit is {self.solver_limit:g} s; it must be above 0")
        if min(self.max_iterations, *(s.max_iterations for s in self.stages), 1) < 1:
            raise InputError("max_iterations must be at least 1")

    def _require_apart(self) -> None:
        """Refuse configurations that cannot be told from one another, or from a deck and test."""
        names = [c.name for c in self.configurations]
        if names and (self.deck is not None or self.test):
            raise InputError("each of the configurations has its deck and test; give none beside")
        if len({name.casefold() for name in names}) < len(names):
            raise InputError(
                "two configurations have one name, or names that differ by case only, and so one "
                "folder; give each its own"
            )

    def of(self, one: ConfigurationRequest) -> Study:
        """Return the study of one of its configurations alone."""
        given = {f.name: getattr(one, f.name) for f in dataclasses.fields(one) if f.name != "name"}
        own = {key: value for key, value in given.items() if value not in (None, ())}
        own["parameters"] = (*self.parameters, *one.parameters)
        return dataclasses.replace(self, configurations=(), **own)

    @property
    def criteria(self) -> Criteria:
        """When a test mode and an analysis mode may be a pair."""
        from ...core.correlation.criteria import Criteria
        from ...core.identification.survey.wanted_ranges import wanted_ranges

        parts = wanted_ranges(self.fmin, self.fmax, self.bands)
        limits = tuple((a, b if math.isfinite(b) else None) for a, b in parts)
        return Criteria(
            self.mac_min,
            self.frequency_tolerance,
            self.cluster_width,
            self.rotate,
            self.exclude_test,
            self.exclude_analysis,
            () if limits == ((0.0, None),) else limits,
            self.pairs,
        )

    @property
    def identification(self) -> IdentifyOptions:
        """What is told to the identification of modes in frequency responses, if anything."""
        own = ("fmin", "fmax", "max_order", "take", "refuse", "bands", "exponential_window")
        given = {key: getattr(self, key) for key in own} | {"modes": self.identify_modes}
        known = {key: value for key, value in given.items() if value not in (None, ())}
        return cast("IdentifyOptions", known)

    @property
    def weights(self) -> Weights:
        """What the residuals of an update are weighed by."""
        from ...core.updating.residuals import Weights

        return Weights(self.sigmas, self.regularisation, dict(self.mode_weights))

    @property
    def damped(self) -> bool:
        """Whether the damping of the deck counts."""
        return any(r.damped for r in self.named_residuals)

    @property
    def hears(self) -> bool:
        """Whether frequency responses count."""
        return any(r.hears for r in self.named_residuals)

    @property
    def named_residuals(self) -> list[Residual]:
        """Every residual that is minimised in some stage."""
        from ...core.updating.residuals import residuals_named

        every = (self.residuals, *(s.residuals for s in self.stages))
        return [r for words in every for r in residuals_named(words)]


_HINTS = get_type_hints(Study)
FIELDS = {
    f.name: _HINTS[f.name] for f in dataclasses.fields(Study) if f.metadata.get("file_key", True)
}


def study_keys() -> tuple[str, ...]:
    """Return every key of a study file."""
    return (*FIELDS, *_sigma_fields())


def _sigma_fields() -> dict[str, Any]:
    from ...core.updating.residuals import RESIDUALS

    return {r.weight: float for r in RESIDUALS}


def _study_values(
    table: Mapping[str, object], fields: Mapping[str, Any], who: Place
) -> dict[str, Any]:
    """Check values by key of the file and put the standard deviations of residuals together."""
    values = checked(table, fields, who)
    sigmas = {name: values.pop(name) for name in _sigma_fields() if name in values}
    return {**values, "sigmas": sigmas} if sigmas else values


def read_study(path: Path) -> Study:
    """Read a study file.

    Raises
    ------
    InputError
        A file that cannot be read or is not TOML, an unknown key, a value of the wrong type.
    """
    here = Place(path, shown=f"study file {path}")
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise here.error(error.strerror or str(error)) from error
    except UnicodeDecodeError as error:
        raise here.fault("is not UTF-8 text") from error
    except tomllib.TOMLDecodeError as error:
        raise here.fault(f"is not valid TOML: {error}") from error
    values = _study_values(table, {**FIELDS, **_sigma_fields()}, here)
    for name in ("deck", "modes", "logo", "out"):
        if values.get(name) is not None:
            values[name] = _under(path.parent, values[name])
    values["test"] = tuple(_under(path.parent, t) for t in values.get("test", ()))
    values["configurations"] = tuple(
        moved(c, partial(_under, path.parent)) for c in values.get("configurations", ())
    )
    try:
        return Study(**values, source=path)
    except InputError as error:
        raise here.about(str(error)) from None


def moved(one: ConfigurationRequest, to: Callable[[Path], Path]) -> ConfigurationRequest:
    """Return a configuration with its paths elsewhere."""
    deck = one.deck and to(one.deck)
    return dataclasses.replace(one, deck=deck, test=tuple(map(to, one.test)))


def _under(folder: Path, path: Path) -> Path:
    """Return a path of a study file in a folder, without steps up."""
    up = ".." in path.parts
    return Path(os.path.normpath(folder.resolve() / path)) if up else folder / path


def merge(
    study: Study, given: Mapping[str, object], known: Mapping[str, object], who: str
) -> Study:
    """Return the study with what was given on top; what is None was not given.

    Parameters
    ----------
    study : Study
    given : mapping
        By key of `Study`.
    known : mapping
        The keys that may be given.
    who : str
        Begins the sentence of an error.

    Raises
    ------
    InputError
        A key that is not known, a value of the wrong type or that no run accepts.
    """
    fields = {name: kind for name, kind in FIELDS.items() if name in known}
    if "residuals" in known:
        fields |= _sigma_fields()
    there = {k: v for k, v in given.items() if k not in fields or v is not None}
    values = _study_values(there, fields, Place(shown=who))
    if values.get("test_modes") == ():
        raise InputError(f"{who}: test_modes is empty; give mode numbers, or None for all modes")
    values["sigmas"] = {**study.sigmas, **values.get("sigmas", {})}
    return dataclasses.replace(study, **values)
