"""A run folder: written whole or not at all."""

from __future__ import annotations

import json
import math
import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..core.errors import InputError

_OWN = {
    "changes.diff",
    "deck",
    "modes.h5",
    "modes.unv",
    "modes_complex.unv",
    "report.html",
    "result.h5",
    "result.json",
    "stabilisation.html",
    "study.toml",
}


@contextmanager
def run_folder(path: Path, force: bool) -> Iterator[Path]:
    """Give a temporary folder beside `path` that takes its name when all went well.

    Raises
    ------
    InputError
        When `path` exists and `force` is not given, or cannot be written.
    """
    refuse_existing(path, force)
    path.parent.mkdir(parents=True, exist_ok=True)
    work = Path(tempfile.mkdtemp(prefix=f".{path.name}.", dir=path.parent))
    try:
        yield work
        work.chmod(0o755)
        if path.exists():
            old = Path(tempfile.mkdtemp(prefix=f".{path.name}.old.", dir=path.parent))
            os.replace(path, old / path.name)
            os.replace(work, path)
            _keep_foreign(old / path.name, path)
            shutil.rmtree(old)
        else:
            os.replace(work, path)
    finally:
        shutil.rmtree(work, ignore_errors=True)


def _keep_foreign(old: Path, new: Path) -> None:
    """Move what trueup did not write from a replaced run folder to the new one."""
    for entry in old.iterdir():
        if entry.name not in _OWN and not (new / entry.name).exists():
            os.replace(entry, new / entry.name)


def refuse_existing(path: Path, force: bool) -> None:
    """Raise `InputError` when a run folder would be written over an existing one."""
    if path.exists() and not force:
        raise InputError(f"{path} exists; give --force to replace it or another --out")
    if path.exists() and not (path.is_dir() and (path / "result.json").exists()):
        raise InputError(f"{path} exists and is not a run folder; give another --out")


def json_text(result: dict[str, Any]) -> str:
    """Return strict JSON (a value that is not a number becomes null), keys in order."""
    return json.dumps(_plain(result), indent=1, allow_nan=False) + "\n"


def write_json(path: Path, result: dict[str, Any]) -> None:
    """Write a result atomically."""
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        with os.fdopen(handle, "w", encoding="utf-8") as stream:
            stream.write(json_text(result))
        Path(name).chmod(0o644)
        os.replace(name, path)
    except OSError as error:
        raise InputError(f"{path} cannot be written: {error.strerror or error}") from error


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Path):
        return str(value)
    return value
