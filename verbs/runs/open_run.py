"""A run folder read back."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.errors import InputError, Place, path_of

if TYPE_CHECKING:
    from ...adapters.store import StoreContent
    from .folder import Folder


def open_run(folder: Path | str) -> Folder:
    """Read a run folder: what `save` wrote, as the verb gave it.

    Parameters
    ----------
    folder : path

    Returns
    -------
    Correlated, Updated, UpdatedTogether, Discovered, Identified or Solved

    Raises
    ------
    InputError
        No run folder, or one of which a file is missing or cannot be read.
    """
    from .identified import Identified
    from .run import Correlated, Discovered, Updated
    from .solved import Solved
    from .together import UpdatedTogether

    kinds: dict[str, type[Folder]] = {
        kind.schema: kind for kind in (Correlated, Updated, Discovered, Identified, Solved)
    }
    run = path_of(folder, "a run folder")
    result = read_result(run)
    if result["schema"] == UpdatedTogether.schema:
        return UpdatedTogether.of_folder(run, result)
    content = read_content(run)
    kind = kinds.get(str(result["schema"]))
    if kind is None or content is None:
        lacks = "has no result.h5" if kind else f"holds a result of '{result['schema']}'"
        known = ", ".join(k.verb for k in kinds.values())
        raise Place(run).fault(f"{lacks}; give the run folder of {known}")
    try:
        return kind.opened(run, result, content)
    except InputError as error:
        if error.file is not None:
            raise
        raise Place(run / "result.json").error(str(error)) from error
    except OSError as error:
        raise Place(error.filename or run).fault(f"cannot be read: {error.strerror}") from error


def read_result(run: Path) -> dict[str, Any]:
    """Read result.json of a run folder."""
    path = run / "result.json"
    if not path.is_file():
        raise Place(run).fault("is not a run folder: it has no result.json")
    try:
        result = json.loads(path.read_text(encoding="utf-8"))
    except (ValueError, OSError) as error:
        raise Place(path).fault(f"cannot be read: {error}") from error
    if not isinstance(result, dict) or not str(result.get("schema", "")).startswith("trueup/"):
        raise Place(path).fault("is not a result of trueup: it has no schema 'trueup/VERB/1'")
    return result


def read_content(run: Path) -> StoreContent | None:
    """Read result.h5 of a run folder; None where there is none."""
    from ...adapters.store import read_store

    store = run / "result.h5"
    return read_store(store) if store.is_file() else None


def read_diff(run: Path) -> str | None:
    """Read changes.diff of a run folder; None where there is none."""
    diff = run / "changes.diff"
    return diff.read_bytes().decode("utf-8") if diff.is_file() else None
