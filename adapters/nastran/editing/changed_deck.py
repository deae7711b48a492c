"""A deck that was changed: to be looked at, compared with what it was, and written."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Self

from ....core.noun import Noun
from ..text.deck_text import DeckText
from .deck_diff import unified_diff
from .write_deck import names_in_tree, write_all_in_place, write_deck


@dataclass(frozen=True, eq=False)
class ChangedDeck(Noun):
    """A deck as it became; the files on disk are the old ones.

    Parameters
    ----------
    text : DeckText
        All files, byte for byte.
    diff : str
        Unified diff against the input deck.
    """

    text: DeckText
    diff: str

    def __repr__(self) -> str:
        lines = [x[:1] for x in self.diff.splitlines() if x[:3] not in ("---", "+++")]
        return f"ChangedDeck({self.name}, lines: +{lines.count('+')} -{lines.count('-')})"

    @property
    def name(self) -> str:
        """Path of the top file below the folder that `write` is given."""
        return names_in_tree(self.text)[0]

    def write(self, folder: Path | str) -> Path:
        """Write the whole deck, same file tree and names; return the path of its top file.

        Raises
        ------
        InputError
            The folder holds files, or cannot be written.
        """
        return write_deck(self.text, folder)

    @classmethod
    def of(cls, original: DeckText, text: DeckText) -> Self:
        """Return what a deck became."""
        return cls(text, unified_diff(original, text))


def put_in_place(decks: Sequence[ChangedDeck]) -> list[tuple[tuple[Path, ...], tuple[Path, ...]]]:
    """Write the files that changed over the originals; return those of each deck, their backups.

    Raises
    ------
    InputError
        As `write_all_in_place`; then none is written.
    """
    backups = {f.resolve(): b for f, b in write_all_in_place([d.text for d in decks]).items()}
    files = [tuple(f.path for f in d.text.files if f.edited) for d in decks]
    return [(own, tuple(backups[f.resolve()] for f in own)) for own in files]
