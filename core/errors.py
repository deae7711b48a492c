"""The one exception family of trueup, and the places its sentences speak of."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self


class TrueupError(Exception):
    """Base of everything trueup raises on purpose; the message is one sentence for the user.

    Attributes
    ----------
    file : Path or None
        The file at fault.
    line : int or None
        Its line, counted from 1.
    card : str or None
        The card at fault by name and number: ``CBAR 12``.
    """

    def __init__(
        self,
        sentence: str = "",
        *,
        file: Path | str | None = None,
        line: int | None = None,
        card: str | None = None,
    ) -> None:
        super().__init__(sentence)
        self.file = None if file is None else Path(file)
        self.line = line
        self.card = card

    def reworded(self, sentence: str) -> Self:
        """Return the same error in other words."""
        same = type(self).__new__(type(self), sentence)
        vars(same).update(vars(self))
        return same


class InputError(TrueupError):
    """The input is at fault: which file, line or card, what is wrong, what to do."""


class CheckError(TrueupError):
    """The work ended without meeting its own check (for example, a mode was missed)."""


def path_of(given: object, what: str, instead: str = "a path") -> Path:
    """Return a path that was given as text or as a path.

    Raises
    ------
    InputError
        Something else, which `what` should be; a null byte. The sentence asks for `instead`.
    """
    if not isinstance(given, str | os.PathLike) or isinstance(os.fspath(given), bytes):
        raise InputError(f"{what} is given as {type(given).__name__}; give {instead}")
    if "\0" in os.fspath(given):
        raise InputError(f"{what} is given as {os.fspath(given)!r}; a path holds no null byte")
    return Path(given)


def require_kind(given: object, kind: type, what: str) -> None:
    """Raise `InputError` when `what` is given as something else than it should be."""
    if not isinstance(given, kind):
        raise InputError(f"{what} is given as {type(given).__name__}; it must be {kind.__name__}")


@dataclass(frozen=True, slots=True)
class Place:
    """Where something stands: ``CBAR 12 (models/wing.bdf line 40)``, ``models/wing.bdf line 40``.

    `shown` is how sentences name the file where that is not its whole path.
    """

    file: Path | str | None = None
    line: int | None = None
    card: str | None = None
    shown: str | None = None

    def __str__(self) -> str:
        at = self.shown or ("" if self.file is None else str(self.file))
        if self.line is not None:
            at = f"{at} line {self.line}"
        if self.card is None:
            return at
        return f"{self.card} ({at})" if at else self.card

    def error(self, sentence: str, card: str | None = None) -> InputError:
        """Return the error ``PLACE: sentence``; `card` is the one that the sentence names."""
        return replace(self, card=card or self.card).about(f"{self}: {sentence}")

    def fault(self, predicate: str) -> InputError:
        """Return the error ``PLACE predicate``, such as "is not a text file"."""
        return self.about(f"{self} {predicate}")

    def about(self, sentence: str) -> InputError:
        """Return the error of a whole sentence, which tells of the place itself."""
        return InputError(sentence, file=self.file, line=self.line, card=self.card)


@contextmanager
def naming(file: Path | str | None) -> Iterator[None]:
    """Put the name of the file at fault, where it is known, before sentences that know of none."""
    try:
        yield
    except TrueupError as error:
        if file is None or error.file is not None:
            raise
        named = error.reworded(f"{file}: {error}")
        named.file = Path(file)
        raise named from error
