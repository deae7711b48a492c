"""``--in-place``: the changed deck over the user's own, with backups."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def put_in_place(changed: Any, work: Path, result: dict[str, Any]) -> None:
    """Write the files of a deck that changed over the originals, and say so in result.json.

    Called when everything else of the run folder `work` is written and checked: a run that fails
    leaves the deck alone.

    Parameters
    ----------
    changed : DeckText
    work : path
        The run folder.
    result : dict
        Gets ``in_place``: ``files`` and their ``backups``.

    Raises
    ------
    InputError
        A file changed on disk meanwhile, or cannot be written; then none is.
    """
    from ..adapters.nastran import write_in_place
    from .runfolder import write_json

    files = [str(f.path) for f in changed.files if f.edited]
    backups = [str(path) for path in write_in_place(changed)]
    result["in_place"] = {"files": files, "backups": backups}
    write_json(work / "result.json", result)
