"""Where model and test disagree: by mode, by sensor, and spread over the structure."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from ..arrays import Floats, Ints, Numbers, frozen, require_shape
from ..correlation.mac import realised
from ..correlation.mode_pairing import Correlation
from ..correlation.sensor_criteria import comac
from ..errors import InputError
from ..noun import Noun
from .localisation_numbers import MAPS
from .shape_noise import Noise


@dataclass(frozen=True, eq=False)
class PairedShapes:
    """Shapes of the pairs side by side at the sensors, close modes turned onto each other.

    Parameters
    ----------
    analysis : (n_sensor, n_pair) float
        Each scaled to its test shape by least squares (the modal scale factor).
    test : (n_sensor, n_pair) float
        In the test's own scale; a principal-phase real part where it was complex.
    mixing : (n_test, n_pair) float
        Test shapes that each column of `test` is made of: one, or a cluster turned.
    """

    analysis: Floats
    test: Floats
    mixing: Floats


@dataclass(frozen=True, eq=False)
class Misfit(Noun):
    """Disagreement of paired shapes in standard deviations of the measurement.

    Parameters
    ----------
    normalised : (n_sensor, n_pair) float
        (test - analysis) / sigma; about N(0, 1) where nothing but noise differs.
    by_mode : (n_pair,) float
        Root mean square over the sensors: 1 is noise alone.
    by_sensor : (n_sensor,) float
        Root mean square over the pairs: 1 is noise alone.
    comac : (n_sensor,) float
        Coordinate modal assurance criterion, 1 where all pairs agree at a sensor.
    frequency : (n_pair,) float
        Deviation over its standard deviation.
    """

    normalised: Floats
    by_mode: Floats
    by_sensor: Floats
    comac: Floats
    frequency: Floats


def paired_shapes(
    found: Correlation, analysis_shapes: Floats, test_shapes: Numbers
) -> PairedShapes:
    """Put the shapes of each pair side by side, the way the correlation turned them.

    As `correlate` had them: `analysis_shapes` (n_sensor, n_analysis), `test_shapes`
    (n_sensor, n_test) real or complex.
    """
    test = realised(test_shapes)
    a, t = [p.analysis for p in found.pairs], [p.test for p in found.pairs]
    mixing = np.eye(test.shape[1])[:, t]
    if found.criteria.rotate == "test":
        length = np.linalg.norm(test, axis=0)
        scale = np.divide(1.0, length, out=np.zeros_like(length), where=length > 0)
        mixing = scale[:, None] * found.transformation[:, t]
    elif found.criteria.rotate == "analysis":
        analysis_shapes = analysis_shapes @ found.transformation
    chosen, turned = analysis_shapes[:, a], test @ mixing
    power, onto = np.sum(chosen**2, axis=0), np.sum(chosen * turned, axis=0)
    scale = np.divide(onto, power, out=np.zeros_like(power), where=power > 0)
    return PairedShapes(frozen(chosen * scale), frozen(turned), frozen(mixing))


def misfit(
    found: Correlation,
    shapes: PairedShapes,
    noise: Noise,
    frequency_sigma: float | Floats = MAPS.frequency,
) -> Misfit:
    """Measure where paired shapes and frequencies disagree, in units of the noise.

    Sensors that the noise of the test shapes calls outliers do not count for `by_mode`; the maps
    by sensor cover all. `frequency_sigma` (or one a pair) is the standard deviation of a relative
    frequency difference: of the measurement, and of what the mesh cannot tell.

    Raises
    ------
    InputError
        There are no pairs.
    """
    if not found.pairs:
        raise InputError("no pair of modes to compare; lower the MAC limit")
    require_shape(noise.sigma, (shapes.mixing.shape[0],), "the noise of the test shapes")
    counted = ~noise.outlier
    sigma = np.sqrt((shapes.mixing**2).T @ noise.sigma**2)
    z = (shapes.test - shapes.analysis) / sigma
    # The scale of each shape was fitted: one degree of freedom a pair.
    inside = np.count_nonzero(counted)
    share = max(inside - 1, 1)
    deviation = np.array([p.deviation_percent for p in found.pairs]) / 100.0
    return Misfit(
        frozen(z),
        frozen(np.sqrt(np.sum(z[counted] ** 2, axis=0) / share)),
        frozen(np.sqrt(np.mean(z**2, axis=1) * inside / share)),
        frozen(comac(shapes.analysis, shapes.test)),
        frozen(deviation / frequency_sigma),
    )


def spread(values: Floats, sensor_xyz: Floats, grid_xyz: Floats) -> Floats:
    """Spread what sensors say over the grids of a model, for a map.

    Averages over the nearest sensors with Gaussian weights of their distance (Nadaraya, 1964;
    Watson, 1964), as wide as the median distance of a sensor position to its third nearest
    other. A map is a picture of where to look; it locates nothing.

    Of values (n_sensor,), NaN where a sensor says nothing, come values (n_grid,), NaN where no
    sensor with a value is near; `sensor_xyz` and `grid_xyz` are in the same frame and unit.

    Raises
    ------
    InputError
        There is no sensor.
    """
    if not len(sensor_xyz):
        raise InputError("no sensor to draw a map from")
    width = _width(sensor_xyz)
    k = min(MAPS.neighbours, len(sensor_xyz))
    distance, near = cKDTree(sensor_xyz).query(grid_xyz, k=np.arange(1, k + 1))
    # Relative to the nearest sensor, so that far grids follow it instead of falling to 0 / 0.
    weight = np.exp(-0.5 * (distance**2 - distance[:, :1] ** 2) / width**2)
    picked = np.asarray(values)[near]
    known = np.isfinite(picked)
    total = np.sum(weight, axis=1, where=known)
    summed = np.sum(weight * np.where(known, picked, 0.0), axis=1)
    return np.asarray(np.divide(summed, total, out=np.full_like(summed, np.nan), where=total > 0))


def _width(sensor_xyz: Floats) -> float:
    places = np.unique(sensor_xyz, axis=0)
    if len(places) < 2:
        return 1.0
    neighbours: Ints = np.array([min(MAPS.width, len(places))])
    return float(np.median(cKDTree(places).query(places, k=neighbours)[0]))
