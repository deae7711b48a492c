"""A study as the text of a file that runs it again."""

from __future__ import annotations

import dataclasses
import os
from functools import partial
from pathlib import Path
from typing import Any, get_type_hints

from .study import FIELDS, Study, moved
from .study_tables import LoadRequest
from .values import TABLES


def seen_from(folder: Path, study: Study) -> Study:
    """Return the study with its paths as seen from a folder, so that both can be moved together."""
    deck, modes, logo = (p and _seen_from(folder, p) for p in (study.deck, study.modes, study.logo))
    test = tuple(_seen_from(folder, p) for p in study.test)
    every = tuple(moved(c, partial(_seen_from, folder)) for c in study.configurations)
    return dataclasses.replace(
        study, deck=deck, test=test, modes=modes, logo=logo, configurations=every
    )


def _seen_from(folder: Path, path: Path) -> Path:
    try:
        return Path(os.path.relpath(path.parent.resolve() / path.name, folder.resolve()))
    except ValueError:  # on another drive
        return path.absolute()


def study_toml(study: Study) -> str:
    """Write the study as TOML that runs it again, defaults included."""
    lines = ["# trueup study: run it again with  trueup VERB --study study.toml"]
    for name in FIELDS:
        value = getattr(study, name)
        if name in {*TABLES, "out"} or value is None or (name == "test" and not value):
            continue
        lines.append(f"{name} = {_toml(value)}")
    lines += [f"{key} = {sigma!r}" for key, sigma in study.weights.all.items()]
    for name, kind in TABLES.items():
        for table in getattr(study, name):
            lines += ["", f"[[{name}]]"]
            held = {n: getattr(table, n) for n in get_type_hints(kind)}
            lines += [f"{n} = {_toml(v)}" for n, v in held.items() if v not in (None, ())]
    return "\n".join(lines) + "\n"


def write_study(work: Path, study: Study) -> None:
    """Write the study of a run folder, its paths as seen from there."""
    text = study_toml(seen_from(work, study))
    (work / "study.toml").write_text(text, encoding="utf-8", newline="\n")


def _toml(value: Any) -> str:
    if isinstance(value, tuple | list):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    if isinstance(value, LoadRequest):
        return f"{{loads = {_toml(value.loads)}, readings = {_toml(value.readings)}}}"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, int | float):
        return repr(value)
    text = str(value).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{text}"'
