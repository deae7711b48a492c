"""What samples of the posterior say, and for which prior the test speaks."""

from collections.abc import Sequence

from ....core.results.update import UpdateTables
from ..tables.number_formats import fixed, general
from ..tables.table import Cell, Table, left
from .section import Section


def _samples(answer: UpdateTables) -> Sequence[Table]:
    numbers = ("mean", "std. dev.", "2.5 %", "median", "97.5 %")
    cells = [
        (
            r.name,
            *(fixed(v, 4) for v in (r.mean, r.standard_deviation, r.low, r.median, r.high)),
            fixed(r.effective, 0),
        )
        for r in answer.samples or ()
    ]
    note = "Worth: how many independent samples would tell the mean as well."
    headings = [*left("parameter"), *numbers, "worth"]
    return [Table.of("Samples of the posterior", headings, cells, note)] if cells else ()


def _evidence(answer: UpdateTables) -> Sequence[Table]:
    rows = answer.evidence or ()
    most = max((r.log_evidence for r in rows), default=0.0)
    cells: list[list[Cell | str]] = [
        [
            Cell(general(r.prior_sigma), "good" if r.log_evidence == most else ""),
            *(fixed(v, 2) for v in (r.log_evidence - most, r.misfit)),
            general(r.moved),
            fixed(r.effective, 2),
        ]
        for r in rows
    ]
    headings = ["prior_sigma", "ln evidence", "misfit", "moved", "determined"]
    note = (
        "ln evidence: below that of the prior for which the test speaks most. Misfit of the test "
        "and squared motion of the factors are the axes of the L-curve; determined: how many "
        "parameters the test determines rather than the prior."
    )
    return [Table.of("Evidence for the prior", headings, cells, note)] if cells else ()


SAMPLES = Section("Samples of the posterior", "samples", UpdateTables, _samples)
EVIDENCE = Section("Evidence for the prior", "evidence", UpdateTables, _evidence)
