"""``trueup update DECK TEST``."""

import typer

from ...verbs.study import Study
from ..answer import answer_changed, new_folder
from ..console import working
from ..options import Output


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
