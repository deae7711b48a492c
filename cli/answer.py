"""Where a verb writes and how it answers."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..verbs.studies.study import Study
from .console import emit_json, speaks, stdout, tell
from .options import Output

if TYPE_CHECKING:
    from ..verbs.runs.run import Changing, Run
    from ..verbs.runs.together import UpdatedTogether


def new_folder(study: Study, verb: str, output: Output) -> Path:
    """Return ``--out``, or DECK_VERB in the current folder, numbered if that is taken.

    Raises
    ------
    InputError
        It exists and ``--force`` is not given.
    """
    from ..adapters.run_folder.write_run import refuse_existing

    name = study.deck.stem if study.deck else "configurations"
    folder = study.out or free_folder(f"{name}_{verb}")
    refuse_existing(folder, output.force)
    return folder


def free_folder(name: str) -> Path:
    """Return a folder of this name in the current one, numbered if that is taken."""
    base = Path(name)
    path, number = base, 2
    while path.exists():
        path, number = Path(f"{base}_{number}"), number + 1
    return path


def answer_changed(found: Changing | UpdatedTogether, folder: Path, output: Output) -> None:
    """Write the run folder and, where asked, the changed decks over the user's own; answer.

    A deck is changed when everything else is written and checked: a run that fails leaves it
    alone.
    """
    from ..adapters.run_folder.write_run import run_folder, write_json

    with run_folder(folder, output.force) as work:
        found.fill(work)
        if output.in_place:
            found = found.put_in_place()
            for name, own in _decks(found).items():
                write_json(work / name / "result.json", own.to_dict())
    answer(found, folder, output)
    if speaks(output):
        put = [d.in_place for d in _decks(found).values() if d.in_place]
        both = (row for p in put for row in zip(p.files, p.backups, strict=True))
        for file, backup in dict.fromkeys(both):
            stdout().print(f"changed in place: {file} (before: {backup})", markup=False)


def _decks(found: Changing | UpdatedTogether) -> Mapping[str, Changing]:
    """Return what was changed, by the folder of its own below the run folder."""
    from ..verbs.runs.together import UpdatedTogether

    return found.results if isinstance(found, UpdatedTogether) else {"": found}


def answer(found: Run | UpdatedTogether, folder: Path, output: Output) -> None:
    """Give the result: JSON where asked, else the sentence and the tables; then the warnings."""
    emit_json(found.to_dict(), output)
    if speaks(output):
        from .terminal_tables import result_tables, sentences

        console = stdout()
        first, *rest = sentences(found)
        console.print(first, markup=False)
        if rest:
            console.print(" ".join(rest), markup=False)
        for table in result_tables(found, console.width):
            console.print(table)
        console.print(f"run folder: {folder}", markup=False)
    tell(output, "warning", found.warnings)
