"""OUTPUT4 files of any kind."""

from collections.abc import Collection, Iterator
from pathlib import Path

from ....core.errors import Place
from ....core.files import reading
from .exported_matrix import NastranMatrix
from .op4_ascii import is_ascii_op4, read_ascii
from .op4_binary import Header, Names, layout_of, read_binary

_HEAD = 512


def is_op4(path: Path) -> bool:
    """Whether a file starts as OP4 does, in any of its kinds."""
    head = _head(path)
    return layout_of(head) is not None or is_ascii_op4(head)


def _head(path: Path) -> bytes:
    with reading(path), path.open("rb") as stream:
        return stream.read(_HEAD)


def read_op4(path: Path | str, names: Collection[str] | None = None) -> tuple[NastranMatrix, ...]:
    """Read the matrices of an OP4 file, binary or formatted; the kind is told by the contents.

    Parameters
    ----------
    path : path
    names : collection of str, optional
        Only these; the numbers of the others are stepped over. Default: all.

    Returns
    -------
    tuple of NastranMatrix
        In the order of the file, without dof maps: OP4 has none. Sparse, whatever the file says.

    Raises
    ------
    InputError
        A file that is not OP4, is cut short or damaged.
    """
    wanted = None if names is None else frozenset(n.upper() for n in names)
    return tuple(m for m in _matrices(Path(path), wanted) if isinstance(m, NastranMatrix))


def list_op4(path: Path | str) -> tuple[Header, ...]:
    """Return the headers of all matrices of an OP4 file without reading their numbers."""
    found = _matrices(Path(path), frozenset())
    return tuple(m for m in found if isinstance(m, Header))


def kind_of(path: Path) -> str:
    """Say in words which kind of OP4 a file is."""
    layout = layout_of(_head(path))
    if layout is None:
        return "formatted"
    order = "little" if layout.order == "<" else "big"
    return f"binary, {8 * layout.word} bit words, {order} endian"


def _matrices(path: Path, wanted: Names) -> Iterator[NastranMatrix | Header]:
    with reading(path):
        head = _head(path)
        layout = layout_of(head)
        if layout is not None:
            yield from read_binary(path, layout, wanted)
        elif is_ascii_op4(head):
            yield from read_ascii(path, wanted)
        else:
            raise Place(path).fault(
                "is not an OP4 file: it starts neither as a binary nor as a formatted one"
            )
