"""OUTPUT4 files of any kind."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ....core.errors import InputError
from .content import NastranMatrix
from .op4_ascii import is_ascii_op4, read_ascii
from .op4_binary import Header, layout_of, read_binary

_HEAD = 512


def is_op4(path: Path) -> bool:
    """Whether a file starts as OP4 does, in any of its kinds."""
    with path.open("rb") as stream:
        head = stream.read(_HEAD)
    return layout_of(head) is not None or is_ascii_op4(head)


def read_op4(path: Path | str) -> tuple[NastranMatrix, ...]:
    """Read all matrices of an OP4 file, binary or formatted; the kind is told by the contents.

    Returns
    -------
    tuple of NastranMatrix
        In the order of the file, without dof maps: OP4 has none. Sparse, whatever the file says.

    Raises
    ------
    InputError
        A file that is not OP4, is cut short or damaged.
    """
    return tuple(m for m in _matrices(Path(path), True) if isinstance(m, NastranMatrix))


def list_op4(path: Path | str) -> tuple[Header, ...]:
    """Return the headers of all matrices of an OP4 file without reading their numbers."""
    return tuple(m for m in _matrices(Path(path), False) if isinstance(m, Header))


def kind_of(path: Path) -> str:
    """Say in words which kind of OP4 a file is."""
    with path.open("rb") as stream:
        layout = layout_of(stream.read(_HEAD))
    if layout is None:
        return "formatted"
    order = "little" if layout.order == "<" else "big"
    return f"binary, {8 * layout.word} bit words, {order} endian"


def _matrices(path: Path, values: bool) -> Iterator[NastranMatrix | Header]:
    try:
        with path.open("rb") as stream:
            head = stream.read(_HEAD)
        layout = layout_of(head)
        if layout is not None:
            yield from read_binary(path, layout, values)
        elif is_ascii_op4(head):
            yield from read_ascii(path, values)
        else:
            raise InputError(
                f"{path} is not an OP4 file: it starts neither as a binary nor as a formatted one"
            )
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from None
