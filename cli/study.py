"""What a run is asked to do: options and the study file, merged and checked."""

from __future__ import annotations

import dataclasses
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from ..core.errors import InputError

UNITS = ("m", "mm", "in", "ft")


@dataclass(frozen=True)
class StageRequest:
    """One ``[[stages]]`` table of a study: parameters move on the named residuals."""

    parameters: tuple[str, ...] = ()
    residuals: str = "both"
    max_iterations: int = 10


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
    frequency_sigma: float = 0.01
    shape_sigma: float = 0.1
    frequency_scatter: float | None = None
    shape_scatter: float | None = None
    regularisation: float = 1e-2
    stages: tuple[StageRequest, ...] = ()
    out: Path | None = None
    seed: int = 0
    source: Path | None = field(default=None, metadata={"file_key": False})

    def __post_init__(self) -> None:
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
        if any(m < 1 for m in self.test_modes):
            raise InputError("test_modes are mode numbers in the test file and count from 1")


_FIELDS = {f.name: f for f in dataclasses.fields(Study) if f.metadata.get("file_key", True)}
_STAGE_FIELDS = {f.name: f for f in dataclasses.fields(StageRequest)}


def read_study(path: Path) -> Study:
    """Read a study file.

    Raises
    ------
    InputError
        A file that cannot be read or is not TOML, an unknown key, a value of the wrong type.
    """
    try:
        text = path.read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"study file {path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise InputError(f"study file {path} is not UTF-8 text") from error
    try:
        table = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(f"study file {path} is not valid TOML: {error}") from error
    values = _checked(table, _FIELDS, path)
    for key in ("deck", "modes", "out"):
        if values.get(key) is not None:
            values[key] = path.parent / values[key]
    values["test"] = tuple(path.parent / t for t in values.get("test", ()))
    return Study(**values, source=path)


def merge(study: Study, options: Mapping[str, Any]) -> Study:
    """Return the study with the options that were given on the command line on top."""
    given: dict[str, Any] = {
        k: tuple(v) if isinstance(v, list) else v
        for k, v in options.items()
        if v is not None and v != () and v != []
    }
    return dataclasses.replace(study, **given)


def study_toml(study: Study) -> str:
    """Write the study as TOML that runs it again, defaults included."""
    lines = ["# trueup study: run it again with  trueup VERB --study study.toml"]
    for name in _FIELDS:
        value = getattr(study, name)
        if name in {"stages", "out"} or value is None:
            continue
        lines.append(f"{name} = {_toml(value)}")
    for stage in study.stages:
        lines += ["", "[[stages]]"]
        lines += [f"{n} = {_toml(getattr(stage, n))}" for n in _STAGE_FIELDS]
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    if isinstance(value, int | float) and not isinstance(value, bool):
        return repr(value)
    text = str(value).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{text}"'


def _checked(
    table: Mapping[str, Any], fields: Mapping[str, dataclasses.Field[Any]], path: Path
) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in fields:
            near = get_close_matches(key, fields, n=1)
            hint = f"; did you mean '{near[0]}'?" if near else f"; known: {', '.join(fields)}"
            raise InputError(f"study file {path}: unknown key '{key}'{hint}")
        values[key] = _converted(key, value, str(fields[key].type), path)
    return values


def _converted(key: str, value: Any, kind: str, path: Path) -> Any:
    wrong = InputError(f"study file {path}: '{key}' has a value of the wrong type: {value!r}")
    if kind.startswith("tuple[StageRequest"):
        if not isinstance(value, list) or not all(isinstance(v, dict) for v in value):
            raise wrong
        return tuple(StageRequest(**_checked(v, _STAGE_FIELDS, path)) for v in value)
    if kind.startswith("tuple"):
        items = value if isinstance(value, list) else [value]
        item_kind = kind.removeprefix("tuple[").split(",")[0]
        return tuple(_converted(key, v, item_kind, path) for v in items)
    accepted: dict[str, type | tuple[type, ...]] = {
        "Path": str,
        "str": str,
        "int": int,
        "float": (int, float),
    }
    base = kind.removesuffix(" | None")
    if isinstance(value, bool) or not isinstance(value, accepted[base]):
        raise wrong
    return {"Path": Path, "str": str, "int": int, "float": float}[base](value)
