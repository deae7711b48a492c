"""``trueup correlate``, ``update`` and ``discover DECK TEST``."""

import typer

from ...verbs.study import Study
from ..answer import answer, answer_changed, new_folder
from ..console import working
from ..options import Output


def correlate(study: Study, output: Output) -> None:
    """Align, pair, rotate close modes and tabulate."""
    from ...verbs.correlate import correlate as find

    folder = new_folder(study, "correlate", output)
    with working("correlating", output):
        found = find(study=study)
    answer(found, found.save(folder, output.force), output)


def update(study: Study, output: Output) -> None:
    """Move the named parameters to the test, by sensitivities."""
    from ...verbs.update import update as move

    if not study.parameters:
        raise typer.BadParameter(
            "no parameter is named; say what may move, for example -p 'PBAR 11 I1' (repeatable)"
        )
    folder = new_folder(study, "update", output)
    with working("reading and correlating", output) as say:
        done = move(study=study, progress=say)
    answer_changed(done, folder, output)


def discover(study: Study, output: Output) -> None:
    """Find where and what the model lacks, or what is wrong in the test."""
    from ...verbs.discover import discover as find

    folder = new_folder(study, "discover", output)
    with working("reading and placing", output) as say:
        told = find(study=study, progress=say)
    answer_changed(told, folder, output)
