"""``trueup correlate``, ``update`` and ``discover DECK TEST``."""

import shutil

import typer

from ...core.errors import CheckError, InputError
from ...verbs.studies.study import Study
from ..answer import answer, answer_changed, new_folder
from ..console import what_is_left, working
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
    from ...verbs.studies.design_variables import NOT_NAMED
    from ...verbs.update import update as move

    folder = new_folder(study, "update", output)
    keep = folder.with_name(f"{folder.name}.unfinished")
    if not output.resume:
        shutil.rmtree(keep, ignore_errors=True)
    try:
        with working("reading and correlating", output, keep) as say:
            done = move(study=study, keep=keep, progress=say)
    except CheckError as error:
        raise CheckError(f"{error}{what_is_left(keep)}") from None
    except InputError as error:
        if str(error).startswith(NOT_NAMED):
            raise typer.BadParameter(str(error)) from None
        raise
    answer_changed(done, folder, output)
    shutil.rmtree(keep, ignore_errors=True)


def discover(study: Study, output: Output) -> None:
    """Find where and what the model lacks, or what is wrong in the test."""
    from ...verbs.discover import discover as find

    folder = new_folder(study, "discover", output)
    with working("reading and placing", output) as say:
        told = find(study=study, progress=say)
    answer_changed(told, folder, output)
