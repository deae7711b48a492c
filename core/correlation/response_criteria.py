"""How well frequency responses agree."""

import numpy as np

from ..arrays import Floats, Numbers
from ..errors import InputError


def frac(analysis: Numbers, test: Numbers) -> Floats:
    """Frequency response assurance criterion of each function, (n_function,).

    |sum a* t|^2 / (sum |a|^2 sum |t|^2) over the lines of functions (n_function, n_line) at the
    same frequencies, 0 where one is zero throughout: 1 where they differ by a factor alone.

    Raises
    ------
    InputError
        Functions at different lines.

    References
    ----------
    Heylen, Lammens (1996), FRAC: a consistent way of comparing frequency response functions,
    Proc. Identification in Engineering Systems, Swansea.
    """
    if analysis.shape != test.shape:
        raise InputError(f"functions of {analysis.shape} and {test.shape} have different lines")
    top = np.abs(np.sum(np.conj(analysis) * test, axis=-1)) ** 2
    bottom = np.sum(np.abs(analysis) ** 2, axis=-1) * np.sum(np.abs(test) ** 2, axis=-1)
    return np.asarray(np.divide(top, bottom, out=np.zeros_like(top), where=bottom > 0.0))
