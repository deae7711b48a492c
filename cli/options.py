"""Options that every verb that compares takes, declared once."""

import functools
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from ..core.errors import InputError
from ..verbs.study import Study, merge, read_study

JsonOption = Annotated[
    str | None,
    typer.Option("--json", metavar="FILE|-", help="Write result.json here; '-' is stdout."),
]
OutOption = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="The run folder to write.")
]
ForceOption = Annotated[bool, typer.Option("--force", help="Replace an existing run folder.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="No progress, no tables.")]
InPlaceOption = Annotated[
    bool,
    typer.Option("-ip", "--in-place", help="Change the deck itself as well; keeps backups."),
]
VerboseOption = Annotated[bool, typer.Option("--verbose", "-v", help="Say more.")]
LengthUnitOption = Annotated[
    str | None,
    typer.Option("--deck-length-unit", metavar="m|mm|in|ft", help="Length unit of the deck."),
]


@dataclass(frozen=True)
class Output:
    """Where and how loudly a verb answers."""

    json: str | None = None
    force: bool = False
    quiet: bool = False
    verbose: bool = False
    in_place: bool = False


_STUDY: dict[str, Any] = {
    "mac_min": Annotated[
        float | None, typer.Option("--mac-min", help="Smallest MAC of a pair. [default: 0.7]")
    ],
    "frequency_tolerance": Annotated[
        float | None,
        typer.Option(
            "--frequency-tolerance",
            help="Largest relative frequency difference of a pair. [default: 0.3]",
        ),
    ],
    "cluster_width": Annotated[
        float | None,
        typer.Option(
            "--cluster-width",
            help="Relative bandwidth within which modes count as close. [default: 0.02]",
        ),
    ],
    "rotate": Annotated[
        str | None,
        typer.Option(
            "--rotate", metavar="analysis|test|none", help="Side to rotate. [default: analysis]"
        ),
    ],
    "modes": Annotated[
        Path | None,
        typer.Option("--modes", metavar="FILE", help="Analysis modes of your own Nastran run."),
    ],
    "deck_length_unit": LengthUnitOption,
    "parameters": Annotated[
        list[str] | None,
        typer.Option(
            "-p",
            "--parameter",
            metavar="PARAMETER",
            help="For example 'PBAR 11 I1' or 'front = PBAR 11 I1, PBAR 11 I2 [0.2, 5]'.",
        ),
    ],
    "out": OutOption,
}

UPDATE: dict[str, Any] = {
    "residuals": Annotated[
        str | None,
        typer.Option(
            "--residuals",
            metavar="both|frequencies|shapes|...",
            help="What the update minimises; several with commas. [default: both]",
        ),
    ],
    "test_modes": Annotated[
        list[int] | None,
        typer.Option("--test-mode", help="Use only these test modes (repeatable, from 1)."),
    ],
    "max_iterations": Annotated[
        int | None, typer.Option("--max-iterations", help="Per stage. [default: 10]")
    ],
}


def comparing(
    verb: Callable[[Study, Output], None],
    extra: dict[str, Any] | None = None,
    *,
    changes_deck: bool = False,
) -> Callable[..., None]:
    """Return a typer command for a verb that compares a deck with a test.

    The command takes DECK, TEST..., ``--study``, the shared options and `extra` ones (by key of
    `Study`), merges them (command line over study file) and calls `verb`. One that changes the
    deck takes ``--in-place`` too.
    """
    shared = {**_STUDY, **(extra or {})}

    @functools.wraps(verb)
    def command(**given: Any) -> None:
        study_file: Path | None = given.pop("study")
        output = Output(
            given.pop("json"),
            given.pop("force"),
            given.pop("quiet"),
            given.pop("verbose"),
            given.pop("in_place", False),
        )
        filed = read_study(study_file) if study_file else Study()
        try:
            study = merge(filed, given, given, "options")
        except InputError as error:
            raise typer.BadParameter(str(error)) from None
        if study.deck is None or not study.test:
            raise typer.BadParameter("give DECK and TEST, or a study file (--study) naming both")
        verb(study, output)

    def keyword(name: str, annotation: Any, default: Any = None) -> inspect.Parameter:
        return inspect.Parameter(
            name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=annotation
        )

    signature = [
        keyword("deck", Annotated[Path | None, typer.Argument(metavar="DECK")]),
        keyword("test", Annotated[list[Path] | None, typer.Argument(metavar="TEST...")]),
        keyword(
            "study",
            Annotated[
                Path | None,
                typer.Option("--study", metavar="FILE", help="Study file (TOML); options win."),
            ],
        ),
        *(keyword(name, annotation) for name, annotation in shared.items()),
        *([keyword("in_place", InPlaceOption, False)] if changes_deck else []),
        keyword("json", JsonOption),
        keyword("force", ForceOption, False),
        keyword("quiet", QuietOption, False),
        keyword("verbose", VerboseOption, False),
    ]
    command.__signature__ = inspect.Signature(signature)  # type: ignore[attr-defined]
    command.__annotations__ = {p.name: p.annotation for p in signature}
    return command
