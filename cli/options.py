"""Options that every verb that compares takes, declared once."""

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.errors import InputError
from ..verbs.studies.study import Study, merge, read_study
from ..verbs.studies.taking_part import refuse_idle

JsonOption = Annotated[
    str | None,
    typer.Option("--json", metavar="FILE|-", help="Write result.json here; '-' is stdout."),
]
ForceOption = Annotated[bool, typer.Option("--force", help="Replace an existing run folder.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="No progress, no tables.")]
InPlaceOption = Annotated[
    bool, typer.Option("-ip", "--in-place", help="Change the deck itself as well; keeps backups.")
]
ResumeOption = Annotated[
    bool, typer.Option("--resume", help="Go on where this run was cut off (DIR.unfinished).")
]
VerboseOption = Annotated[bool, typer.Option("--verbose", "-v", help="Say more.")]

StudyOption = Annotated[
    Path | None,
    typer.Option("--study", metavar="FILE", help="Study file (TOML); options win."),
]
FminOption = Annotated[
    float | None, typer.Option("--fmin", help="Lines and test modes from here [Hz] take part.")
]
FmaxOption = Annotated[
    float | None, typer.Option("--fmax", help="Lines and test modes up to here [Hz] take part.")
]
UpToOption = Annotated[float | None, typer.Option("--fmax", help="Modes up to here [Hz].")]
NumberOption = Annotated[
    int | None, typer.Option("-n", "--number", help="Modes of a deck, rigid-body ones too.")
]
BandsOption = Annotated[
    list[str] | None,
    typer.Option("--band", metavar="A:B", help="Those in this band only [Hz] (repeatable)."),
]
MaxOrderOption = Annotated[
    int | None, typer.Option("--max-order", help="Highest model order in a band.")
]
TakeOption = Annotated[
    list[float] | None,
    typer.Option("--take", metavar="HZ", help="A rejected root that is a mode (repeatable)."),
]
RefuseOption = Annotated[
    list[float] | None,
    typer.Option("--refuse", metavar="HZ", help="A mode that is none (repeatable)."),
]

ExponentialWindowOption = Annotated[
    str | None,
    typer.Option(
        "--exponential-window",
        metavar="TAU|END",
        help="Take its damping out: its time constant [s], or its value at the record's end (1%).",
    ),
]


@dataclass(frozen=True)
class Output:
    """Where and how loudly a verb answers."""

    json: str | None = None
    force: bool = False
    quiet: bool = False
    verbose: bool = False
    in_place: bool = False
    resume: bool = False


def _option(kind: Any, said: str, *names: str, metavar: str | None = None) -> Any:
    """Return an option that may be left out; its name is that of the key of `Study`, or `names`."""
    return Annotated[kind | None, typer.Option(*names, metavar=metavar, help=said)]


_STUDY: dict[str, Any] = {
    "mac_min": _option(float, "Smallest MAC of a pair. [default: 0.7]"),
    "frequency_tolerance": _option(
        float, "Largest relative frequency difference of a pair. [default: 0.3]"
    ),
    "cluster_width": _option(
        float, "Relative bandwidth within which modes count as close. [default: 0.02]"
    ),
    "rotate": _option(str, "Side to rotate. [default: analysis]", metavar="analysis|test|none"),
    "modes": _option(Path, "Analysis modes of your own Nastran run.", metavar="FILE"),
    "deck_length_unit": _option(str, "Length unit of the deck.", metavar="m|mm|in|ft"),
    "parameters": _option(
        list[str], "For example 'PBAR 11 I1' or 'front = PBAR 11 I1, PBAR 11 I2 [0.2, 5]'.",
        "-p", "--parameter", metavar="PARAMETER",
    ),
    "fmin": FminOption,
    "fmax": FmaxOption,
    "bands": BandsOption,
    "max_order": MaxOrderOption,
    "take": TakeOption,
    "refuse": RefuseOption,
    "exponential_window": ExponentialWindowOption,
    "identify_modes": _option(int, "How many modes to identify: the best founded.", metavar="N"),
    "exclude_test": _option(
        list[str], "Test modes that take no part (repeatable).", metavar="7,9:12"
    ),
    "exclude_analysis": _option(
        list[str], "Analysis modes that take no part (repeatable).", metavar="3"
    ),
    "exclude_sensors": _option(
        list[str], "A node of the test, or one direction of it (repeatable).",
        "--exclude-sensor", metavar="1112|40:Z",
    ),
    "pairs": _option(
        list[str], "This pair, whatever its MAC (repeatable).", "--pair", metavar="TEST:ANALYSIS"
    ),
    "mode_weights": _option(
        list[str], "What a test mode counts beside the others (repeatable).",
        "--weight", metavar="TEST=0.2",
    ),
    "node_map": _option(
        list[str], "A test node is at this grid, wherever it lies (repeatable).",
        "--node", metavar="TEST=GRID",
    ),
    "mode_names": _option(
        list[str], "What the report calls a test mode (repeatable).",
        "--mode-name", metavar="TEST=NAME",
    ),
    "out": _option(Path, "The run folder to write.", metavar="DIR"),
}  # fmt: skip

CORRELATE: dict[str, Any] = {
    "reduction": _option(
        str, "Orthogonality of the pairs, and test shapes expanded to all grids, by the model "
        "reduced to the sensors so.", metavar="serep|guyan|irs",
    ),
}  # fmt: skip

UPDATE: dict[str, Any] = {
    "residuals": _option(
        str, "What the update minimises; several with commas. [default: both]",
        metavar="both|frequencies|shapes|...",
    ),
    "test_modes": _option(
        list[int], "Use only these test modes (repeatable, from 1).", "--test-mode"
    ),
    "max_iterations": _option(int, "Per stage. [default: 10]"),
    "measured_mass": _option(
        float, "What the structure weighed, in the deck's unit, for the residual mass."
    ),
    "solver": _option(
        str, "Your own Nastran, which then is what meets the test.", metavar="'CMD {deck}'"
    ),
    "solver_limit": _option(float, "Seconds that it may take. [default: 3600]"),
    "starts": _option(int, "Begin from so many other factors as well.", metavar="N"),
    "executor": _option(
        str, "Who does independent pieces of work. [default: processes, one a core]",
        metavar="processes:N|dask:ADDRESS",
    ),
    "intervals": _option(bool, "95 % intervals of the factors by profile.", "--intervals"),
    "samples": _option(int, "Draw so many samples of the posterior.", metavar="N"),
    "evidence": _option(bool, "For which prior_sigma the test speaks.", "--evidence"),
    "write_undetermined": _option(
        bool, "Move what the test does not determine, too.", "--write-undetermined"
    ),
}  # fmt: skip

PARAMETERS: dict[str, Any] = {
    key: UPDATE[key] for key in ("residuals", "test_modes", "measured_mass")
}

DISCOVER: dict[str, Any] = {
    "adopt": _option(
        str, "Which known parameters that moved are written. [default: significant]",
        metavar="significant|all|none",
    ),
}  # fmt: skip


def comparing(
    verb: Callable[[Study, Output], None],
    extra: dict[str, Any] | None = None,
    *,
    changes_deck: bool = False,
    goes_on: bool = False,
    needs_test: bool = True,
) -> Callable[..., None]:
    """Return a typer command for a verb that compares a deck with a test.

    The command takes DECK, TEST..., ``--study``, the shared options and `extra` ones (by key of
    `Study`), merges them (command line over study file) and calls `verb`. One that changes the
    deck takes ``--in-place`` too, one that `goes_on` ``--resume``; `needs_test` says whether it can
    do without TEST.
    """
    shared = {**_STUDY, **(extra or {})}

    @functools.wraps(verb)
    def command(**given: Any) -> None:
        study_file: Path | None = given.pop("study")
        spoken = {f.name: given.pop(f.name) for f in fields(Output) if f.name in given}
        output = Output(**spoken)
        filed = read_study(study_file) if study_file else Study()
        try:
            there = {name: value for name, value in given.items() if value not in (None, [], ())}
            study = merge(filed, there, given, "options")
            refuse_idle(verb.__name__, there, needs_test or bool(study.test), bool(study.stages))
        except InputError as error:
            raise typer.BadParameter(str(error)) from None
        together = verb.__name__ == "update" and study.configurations
        if not together and (study.deck is None or (needs_test and not study.test)):
            what = "DECK and TEST" if needs_test else "DECK"
            raise typer.BadParameter(f"give {what}, or a study file (--study) naming it")
        verb(study, output)

    def keyword(name: str, annotation: Any, default: Any = None) -> inspect.Parameter:
        return inspect.Parameter(
            name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation
        )

    signature = [
        keyword("deck", Annotated[Path | None, typer.Argument(metavar="DECK")]),
        keyword("test", Annotated[list[Path] | None, typer.Argument(metavar="TEST...")]),
        keyword("study", StudyOption),
        *(keyword(name, annotation) for name, annotation in shared.items()),
        *([keyword("in_place", InPlaceOption, False)] if changes_deck else []),
        *([keyword("resume", ResumeOption, False)] if goes_on else []),
        keyword("json", JsonOption),
        keyword("force", ForceOption, False),
        keyword("quiet", QuietOption, False),
        keyword("verbose", VerboseOption, False),
    ]
    command.__signature__ = inspect.Signature(signature)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in signature}
    return command
