"""Files of any format: what fails is said in one sentence, what is written is whole or absent."""

import mmap
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from .errors import InputError, Place


@contextmanager
def reading(path: Path | str) -> Iterator[None]:
    """Tell why a file cannot be read: `InputError` instead of what the system raises."""
    try:
        yield
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}", file=path) from error


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a path at which a file is written that takes its name when all went well.

    Raises
    ------
    InputError
        It cannot be written; then what was there before is there still.
    """
    try:
        with TemporaryDirectory(prefix=f".{path.name}.", dir=path.parent) as beside:
            fresh = Path(beside) / path.name
            yield fresh
            os.replace(fresh, path)
    except OSError as error:
        raise Place(path).fault(f"cannot be written: {error.strerror or error}") from error


def release(data: mmap.mmap, start: int, stop: int) -> None:
    """Let the system take back the memory of mapped bytes that have been read."""
    first = -(-start // mmap.PAGESIZE) * mmap.PAGESIZE
    whole = (stop - first) // mmap.PAGESIZE * mmap.PAGESIZE
    if whole > 0 and hasattr(mmap, "MADV_DONTNEED"):
        data.madvise(mmap.MADV_DONTNEED, first, whole)
