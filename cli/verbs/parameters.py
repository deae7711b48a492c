"""``trueup parameters DECK [TEST]``."""

from ...verbs.studies.study import Study
from ..console import emit_json, speaks, stdout, tell, working
from ..options import Output

_FEW = 40
"""Rows of properties that are shown without --verbose."""


def parameters(study: Study, output: Output) -> None:
    """Say what may be moved, and what modes or a test can tell of it."""
    from ...verbs.parameters import parameters as find

    with working("reading", output) as say:
        found = find(study=study, progress=say)
    if study.out is not None:
        found.save(study.out, output.force)
    emit_json(found.to_dict(), output)
    if speaks(output):
        from ..terminal_tables import candidates_table, properties_table

        console = stdout()
        console.print(properties_table(found, None if output.verbose else _FEW))
        console.print(candidates_table(found))
        if found.recommended:
            named = " ".join(f"-p '{name}'" for name in found.recommended)
            console.print(f"recommended: {named}", markup=False, soft_wrap=True)
        else:
            console.print("recommended: none: no parameter is determined", markup=False)
    tell(output, "warning", found.warnings)
