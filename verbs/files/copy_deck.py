"""A deck to another place: its files byte for byte, or all of them as one."""

from __future__ import annotations

from pathlib import Path

from ...adapters.nastran import write_deck
from ...adapters.nastran.editing.write_deck import merged, names_in_tree
from ...adapters.nastran.text.deck_text import read_deck_text
from ...core.errors import Place
from ...core.files import replacing
from .write_fmu import Converted

SUFFIXES = (".bdf", ".dat", ".nas", ".dck", ".blk")


def copy_deck(source: Path, destination: Path, merge: bool = False) -> Converted:
    """Copy a deck with its INCLUDE files into a folder, or into one file.

    Parameters
    ----------
    source : Path
        The top deck.
    destination : Path
        A folder, which does not exist or is empty, for the same file tree; or a file.
    merge : bool
        Put what the INCLUDE files hold in place of the statements; else only a deck without
        INCLUDE files is copied to a file.

    Raises
    ------
    InputError
        A deck that cannot be read, a folder that holds files, INCLUDE files beside one to write.
    """
    deck = read_deck_text(source)
    count, notes = len(deck.files), []
    if destination.suffix.lower() in SUFFIXES and not destination.is_dir():
        if count > 1 and not merge:
            raise Place(source).error(
                f"the deck has {count - 1} INCLUDE files: give a folder, or merge=True for one file"
            )
        with replacing(destination) as fresh:
            fresh.write_bytes(merged(deck) if merge else deck.files[0].data)
        written = f"{count} in one" if merge else "1, as it was"
    elif merge:
        raise Place(destination).error(
            f"merge=True makes one file: give it one of the suffixes {', '.join(SUFFIXES)}"
        )
    else:
        write_deck(deck, destination)
        apart = [name for name in names_in_tree(deck) if Path(name).is_absolute()]
        notes = [f"{name} is included by its full path: it stays where it is" for name in apart]
        written = f"{count - len(apart)}, as they were"
    return Converted(
        sources=(str(source),),
        destination=str(destination),
        format="deck",
        written={"files": written},
        lost=(),
        warnings=tuple(notes),
    )
