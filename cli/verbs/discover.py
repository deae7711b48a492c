"""``trueup discover DECK TEST``."""

from ...verbs.study import Study
from ..answer import answer_changed, new_folder
from ..console import working
from ..options import Output


def discover(study: Study, output: Output) -> None:
    """Find where and what the model lacks, or what is wrong in the test."""
    from ...verbs.discover import discover as find

    folder = new_folder(study, "discover", output)
    with working("reading and placing", output) as say:
        told = find(study=study, progress=say)
    answer_changed(told, folder, output)
