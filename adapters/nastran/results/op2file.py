"""OP2 files through pyNastran, every failure told as one sentence and nothing printed."""

from __future__ import annotations

import struct
import warnings
from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

from ....core.errors import InputError


def read_op2_file(path: Path, wanted: Sequence[str]) -> Any:
    """Read some kinds of results, and all matrices, of an OP2 file.

    Parameters
    ----------
    path : path
    wanted : sequence of str
        Names of results as pyNastran has them.

    Returns
    -------
    pyNastran.op2.op2.OP2

    Raises
    ------
    InputError
        The file cannot be read as OP2.
    """
    from cpylog import SimpleLogger
    from pyNastran.op2.errors import FatalError, FortranMarkerError
    from pyNastran.op2.op2 import OP2

    model = OP2(log=SimpleLogger("critical", log_func=lambda *_: None))
    model.include_exclude_results(include_results=list(wanted))
    try:
        with warnings.catch_warnings(), redirect_stdout(StringIO()), redirect_stderr(StringIO()):
            warnings.simplefilter("ignore")
            model.read_op2(str(path), build_dataframe=False)
    except OSError as error:
        if error.errno is not None:
            raise InputError(f"cannot read {path}: {error.strerror}") from None
        raise InputError(f"{path} is not an OP2 file: a binary Nastran file is expected") from None
    except (
        ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError, NameError,
        RuntimeError, SyntaxError, TypeError, ValueError, struct.error, FatalError,
        FortranMarkerError,
    ) as error:  # fmt: skip
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        raise InputError(f"{path} cannot be read as OP2, it may be cut short: {reason}") from None
    return model
