"""``trueup correlate DECK TEST``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..console import working
from ..options import Output
from ..study import Study


def correlate(study: Study, output: Output) -> None:
    """Align, pair, rotate close modes and tabulate."""
    from ..writing import answer

    result, run = run_correlate(study, output)
    answer(result, output, run)


def run_correlate(study: Study, output: Output) -> tuple[dict[str, Any], Path]:
    """Write the run folder of a correlation; return its result and where it is."""
    from ...core.results import correlate_tables
    from ..pipeline import correlated
    from ..runfolder import refuse_existing, run_folder
    from ..writing import default_folder, fill_run_folder

    run = default_folder(study, "correlate")
    refuse_existing(run, output.force)
    with working("correlating", output):
        _, _, found = correlated(study)
    result: dict[str, Any] = {
        "schema": "trueup/correlate/1",
        "deck": str(study.deck),
        "test": [str(p) for p in study.test],
        **correlate_tables(found),
    }
    with run_folder(run, output.force) as work:
        fill_run_folder(work, study, result, found)
    return result, run
