"""Which parameters to move: those that explain the misfit and that the test can determine."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from ..arrays import Floats, Ints
from .identifiability import all_below
from .updating_numbers import UPDATING


@dataclass(frozen=True)
class Choice:
    """Parameters in the order chosen; what share of the misfit each and those before explain."""

    chosen: tuple[int, ...]
    explained: tuple[float, ...]


def forward_selection(gradient: Floats, values: Floats, limit: float) -> Choice:
    """Choose parameters one by one, each the one that takes most from what is left.

    Lallement and Piranda (1990), *Localisation methods for parameter updating of finite element
    models in elastodynamics*, IMAC 8; Friswell, Mottershead and Ahmadian (1998), *Combining subset
    selection and parameter constraints in model updating*, J. Vib. Acoust. 120(4), 854. It ends
    where the best of the others takes no more than chance would, or where the test would not
    determine the parameters together.

    Parameters
    ----------
    gradient : (n_residual, n) float
        Derivatives of the residuals, each over its standard deviation, by the factors.
    values : (n_residual,) float
        The residuals.
    limit : float
        Standard error of a factor up to which it is determined.
    """
    left, misfit = gradient.copy(), values.copy()
    free, chosen, explained = list(range(gradient.shape[1])), list[int](), list[float]()
    whole = float(values @ values)
    chance = UPDATING.chance + 2.0 * np.log(max(len(free), 1))
    while free:
        size = np.linalg.norm(left[:, free], axis=0)
        own = np.divide(1.0, size, out=np.zeros_like(size), where=size > UPDATING.unidentifiable)
        gain = (own * (left[:, free].T @ misfit)) ** 2
        best = int(np.argmax(gain >= (1.0 - UPDATING.alike) * gain.max()))
        if gain[best] <= chance:
            break
        k = free.pop(best)
        if not all_below(gradient[:, [*chosen, k]], 1.0, np.full(len(chosen) + 1, limit)):
            continue
        q = left[:, k] / np.linalg.norm(left[:, k])
        left -= np.outer(q, q @ left)
        misfit -= q * (q @ misfit)
        chosen.append(k)
        explained.append(1.0 - float(misfit @ misfit) / whole)
    return Choice(tuple(chosen), tuple(explained))


def indistinct(correlation: Floats) -> Ints:
    """Return the number of the group of each parameter, (n,): those not told apart have one."""
    alike = sp.csr_matrix(np.abs(correlation) > UPDATING.indistinct)
    return np.asarray(connected_components(alike, directed=False)[1], np.int64)
