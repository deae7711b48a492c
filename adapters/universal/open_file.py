"""An open universal file."""

import mmap
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Self

from ...core.errors import InputError, Place
from ...core.files import reading
from .container import Scan, Section, first_lines
from .universal_content import Skipped


class DatasetError(InputError):
    """One dataset that cannot be read; the others of its file may be."""

    def __init__(self, path: str, line: int, why: str) -> None:
        super().__init__(f"{path} line {line}: {why}", file=path, line=line)
        self.why = why

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self.file), self.line, self.why)


@dataclass(frozen=True, eq=False)
class Source:
    """An open universal file with its datasets; a context manager that closes it."""

    path: Path
    stream: BinaryIO
    sections: tuple[Section, ...] = ()
    skipped: tuple[Skipped, ...] = ()
    warnings: tuple[str, ...] = ()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stream.close()

    @property
    def name(self) -> str:
        """How messages call the file."""
        return str(self.path)

    def read(self, begin: int, end: int) -> bytes:
        """Bytes of the file between two offsets."""
        self.stream.seek(begin)
        return self.stream.read(end - begin)

    def lines(self, section: Section) -> list[bytes]:
        """All lines of a dataset, without their ends."""
        return self.read(section.begin, section.end).splitlines()

    def head(self, section: Section, n: int) -> tuple[list[bytes], int]:
        """Return the first `n` lines of a dataset and the offset of what follows them."""
        lines, at = first_lines(self.read, section.begin, section.end, n)
        return [line.rstrip(b"\r\n") for line in lines], at

    def error(self, line: int, what: str) -> DatasetError:
        """Return the error that names this file and a line of it."""
        return DatasetError(self.name, line, what)


def open_source(path: Path, exact_lines: bool = True) -> Source:
    """Open a universal file and find its datasets.

    Parameters
    ----------
    path : Path
        The file.
    exact_lines : bool
        Count line ends within binary blocks too, as an editor does; that reads the whole file.

    Raises
    ------
    InputError
        The file does not exist, is empty, or holds no dataset.
    """
    with reading(path):
        stream = path.open("rb", buffering=0)
    try:
        # The file is mapped only to look for delimiters: pages that were mapped count as memory.
        with mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as data:
            scan = Scan(path, data, exact_lines)
            sections = tuple(scan.sections())
    except ValueError as error:
        stream.close()
        raise Place(path).fault("is empty; a universal file is expected") from error
    if not sections:
        stream.close()
        raise Place(path).fault(
            "is not a universal file: no line '    -1' followed by a dataset number; "
            "give a .unv or .uff file"
        )
    return Source(path, stream, sections, tuple(scan.skipped), tuple(scan.warnings))
