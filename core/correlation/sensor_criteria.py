"""How well paired shapes agree at each sensor."""

import numpy as np

from ..arrays import Floats


def comac(analysis: Floats, test: Floats) -> Floats:
    """Coordinate modal assurance criterion of each sensor, (n_sensor,).

    (sum |a t|)^2 / (sum a^2 sum t^2) over paired shapes (n_sensor, n_pair), those of the analysis
    scaled to the test's, NaN where a sensor does not move. Each test shape is brought to unit
    length first, so that every pair counts alike. Signs do not count: a sensor that is
    reversed has 1 (see `ecomac`).

    References
    ----------
    Lieven, Ewins (1988), Spatial correlation of mode shapes, the coordinate modal assurance
    criterion (COMAC), IMAC VI.
    """
    length = np.linalg.norm(test, axis=0)
    length = np.where(length > 0, length, 1.0)
    a, t = analysis / length, test / length
    top = np.sum(np.abs(a * t), axis=1) ** 2
    bottom = np.sum(a**2, axis=1) * np.sum(t**2, axis=1)
    return np.asarray(np.divide(top, bottom, out=np.full(len(a), np.nan), where=bottom > 0))


def ecomac(analysis: Floats, test: Floats) -> Floats:
    """Enhanced coordinate modal assurance criterion of each sensor, (n_sensor,): 0 agrees.

    sum |a - t| / (2 n_pair) over paired shapes (n_sensor, n_pair), the test shapes at a largest
    reading of 1 and the analysis shapes scaled to them by least squares, so that gain and
    polarity of a sensor count. NaN without pairs.

    References
    ----------
    Hunt (1992), Application of an enhanced coordinate modal assurance criterion, IMAC X.
    """
    if not test.shape[1]:
        return np.full(len(test), np.nan)
    peak = np.abs(test).max(axis=0, initial=0.0)
    t = test / np.where(peak > 0.0, peak, 1.0)
    power = np.sum(analysis**2, axis=0)
    scale = np.sum(analysis * t, axis=0) / np.where(power > 0.0, power, 1.0)
    return np.asarray(np.mean(np.abs(analysis * scale - t), axis=1) / 2.0)
