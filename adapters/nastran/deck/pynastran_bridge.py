"""pyNastran's objects where a file is taken, and given back; the library is imported when asked."""

import atexit
import shutil
import tempfile
from pathlib import Path
from typing import Any

from ....core.errors import InputError, Place


def file_of(source: str | Path | Any) -> str | Path:
    """Return the file of a path, a pyNastran `BDF` or a pyNastran `OP2`.

    An `OP2` gives the file it was read from. A `BDF` is written with all digits to a temporary
    file, which lasts as long as the program.

    Raises
    ------
    InputError
        An object that is neither, or whose file is gone.
    """
    if isinstance(source, str | Path):
        return source
    kinds = {c.__name__ for c in type(source).__mro__ if c.__module__.startswith("pyNastran.")}
    if "OP2" in kinds:
        path = Path(str(source.op2_filename))
        if not path.is_file():
            raise InputError(f"this OP2 object names no file that is there ({path})")
        return path
    if "BDF" in kinds:
        return _written(source)
    raise InputError(
        f"a path or an object of pyNastran (BDF, OP2) is expected, not {type(source).__name__}"
    )


def _written(bdf: Any) -> Path:
    folder = Path(tempfile.mkdtemp(prefix="trueup-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    path = folder / Path(str(bdf.bdf_filename or "model.bdf")).name
    bdf.write_bdf(str(path), size=16, is_double=True, interspersed=False, close=True)
    return path


def bdf_of(path: Path) -> Any:
    """Return pyNastran's `BDF` of a deck and its INCLUDE files, without cross-references.

    Raises
    ------
    InputError
        pyNastran is not installed, or does not read the deck.
    """
    try:
        from pyNastran.bdf.bdf import BDF
    except ImportError:
        raise InputError(
            "pyNastran is not installed: pip install pyNastran (Python 3.12 or older)"
        ) from None
    bdf = BDF(debug=None)
    try:
        bdf.read_bdf(str(path), xref=False)
    except Exception as error:
        why = str(error).strip().splitlines() or [type(error).__name__]
        raise Place(path).error(f"pyNastran does not read this deck: {why[0][:120]}") from error
    return bdf
