"""``trueup correlate DECK TEST``."""

from ...verbs.study import Study
from ..answer import answer, new_folder
from ..console import working
from ..options import Output


def correlate(study: Study, output: Output) -> None:
    """Align, pair, rotate close modes and tabulate."""
    from ...verbs.correlate import correlate as find

    folder = new_folder(study, "correlate", output)
    with working("correlating", output):
        found = find(study=study)
    answer(found, found.save(folder, output.force), output)
