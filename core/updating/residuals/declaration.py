"""What a residual declares, and what it is given of the model and the test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ...arrays import Floats, Ints, Numbers
from ...correlation.criteria import Criteria
from ...correlation.mode_pairing import Pair
from ...data.parametric_model import Model
from ...errors import InputError
from ...reduction.damped_poles import Damped


@dataclass(frozen=True, eq=False)
class LoadCase:
    """Displacements under a static load, deck units.

    Parameters
    ----------
    load : (n_free,) float
        Forces and moments.
    rows : (n_reading, n_free) sparse
        What was read of the displacements.
    values : (n_reading,) float
        The readings.
    """

    load: Floats
    rows: sp.csr_matrix
    values: Floats


@dataclass(frozen=True, eq=False)
class Relation:
    """A sum of factors p, ``above @ p``, or a ratio of two, that is known.

    Parameters
    ----------
    above, below : (n_parameter,) float
        What each factor counts; `below` all zero where it is no ratio.
    value, sigma : float
        What it is, and the standard deviation of that.
    """

    above: Floats
    below: Floats
    value: float
    sigma: float


@dataclass(frozen=True, eq=False)
class Beside:
    """What was measured beside modes, deck units.

    Parameters
    ----------
    mass : float, optional
        Of the whole structure, fixed points included.
    centre_of_gravity : (3,) float, optional
        Basic frame; NaN a coordinate that is not known.
    load_cases : tuple of LoadCase
    relations : tuple of Relation
        Of the parameters.
    """

    mass: float | None = None
    centre_of_gravity: Floats | None = None
    load_cases: tuple[LoadCase, ...] = ()
    relations: tuple[Relation, ...] = ()


@dataclass(frozen=True, eq=False)
class Responses:
    """Measured frequency responses laid onto a model.

    Parameters
    ----------
    frequencies_hz : (n_line,) float
    values : (n_out, n_in, n_line) complex
        Receptance, mobility or accelerance per force; NaN what was not measured.
    order : int
        How often displacement is differentiated by time to give them.
    observed, driven : (n_out, n_free), (n_in, n_free) sparse
        What sensors and forces read of the model.
    points : tuple of (int, int)
        Positions of sensors and forces that are one degree of freedom: driving points.
    """

    frequencies_hz: Floats
    values: Numbers
    order: int
    observed: sp.csr_matrix
    driven: sp.csr_matrix
    points: tuple[tuple[int, int], ...] = ()


@dataclass(frozen=True, eq=False)
class Target:
    """The test at its sensors: what the update aims at.

    Parameters
    ----------
    frequencies_hz : (n_test,) float
    shapes : (n_sensor, n_test) float or complex
    sensors : (n_sensor, n_free) sparse
        Sensor displacements from the free degrees of freedom of the model.
    modes : tuple of int, optional
        Test modes that the update may use; default all.
    frequency_std, shape_std : (n_test,) float, optional
        Standard errors of the test's frequencies, relative, and lengths of those of its shapes,
        over the shapes'; they add to the standard deviations of the weights.
    damping, damping_std : (n_test,) float, optional
        Ratios of the test, NaN where unknown, and their standard errors.
    beside : Beside
    responses : Responses, optional
    """

    frequencies_hz: Floats
    shapes: Numbers
    sensors: sp.csr_matrix
    modes: tuple[int, ...] | None = None
    frequency_std: Floats | None = None
    shape_std: Floats | None = None
    beside: Beside = Beside()
    damping: Floats | None = None
    damping_std: Floats | None = None
    responses: Responses | None = None

    @property
    def forces(self) -> sp.csr_matrix | None:
        """What the forces of the responses are, (n_in, n_free)."""
        return None if self.responses is None else self.responses.driven


@dataclass(frozen=True, eq=False)
class DampedPairs:
    """A model with its damping, and what of it the pairs are.

    Parameters
    ----------
    model : Damped
    turned : (n_mode, n_pair) float
        Coefficients of the analysis' modes that the pairs are of.
    measured : (n_pair,) float, optional
        Damping ratios of the test, NaN where unknown.
    responses : Responses, optional
        Those of the test.
    """

    model: Damped
    turned: Floats
    measured: Floats | None = None
    responses: Responses | None = None

    def take(self, at: Ints) -> DampedPairs:
        """Return the same of some of the pairs."""
        known = None if self.measured is None else self.measured[at]
        return replace(self, turned=self.turned[:, at], measured=known)


@dataclass(frozen=True, eq=False)
class Seen:
    """A model at one parameter point beside the test: one column a pair.

    Parameters
    ----------
    model : Model
    factors : (n_parameter,) float
    pairs : tuple of Pair
    eigenvalues : (n_pair,) float
        Of the analysis modes, after rotation their Rayleigh quotients, (rad/s)².
    analysis, test : (n_sensor, n_pair) float
        Shapes at the sensors as they are paired: the analysis' mass-normalised, the test's of
        any scaling.
    beside : Beside
        What else was measured.
    damped : DampedPairs, optional
        The same with damping.
    """

    model: Model
    factors: Floats
    pairs: tuple[Pair, ...]
    eigenvalues: Floats
    analysis: Floats
    test: Floats
    beside: Beside = Beside()
    damped: DampedPairs | None = None

    @property
    def test_eigenvalues(self) -> Floats:
        """Of the test modes, (n_pair,), (rad/s)²."""
        return np.array([(2.0 * np.pi * q.test_hz) ** 2 for q in self.pairs])

    def take(self, columns: Sequence[int] | Ints) -> Seen:
        """Return the same of some of the pairs, in this order."""
        at = np.asarray(columns, np.int64)
        return replace(
            self,
            pairs=tuple(self.pairs[k] for k in at),
            eigenvalues=self.eigenvalues[at],
            analysis=self.analysis[:, at],
            test=self.test[:, at],
            damped=None if self.damped is None else self.damped.take(at),
        )


@dataclass(frozen=True, eq=False)
class Slopes:
    """Derivatives of what is seen by the parameters that move.

    Parameters
    ----------
    parameters : tuple of int
        Their positions in ``Model.parameters``.
    eigenvalues : (n_pair, n_active) float
    analysis : (n_sensor, n_pair, n_active) float or None
        None unless a residual in use asks for it (`Residual.needs_shapes`).
    """

    parameters: tuple[int, ...]
    eigenvalues: Floats
    analysis: Floats | None


@dataclass(frozen=True, eq=False)
class Linearisation:
    """Weighted residuals W^½Δz, (n,), and their derivatives W^½∂(z_a)/∂p, (n, n_active)."""

    values: Floats
    gradient: Floats


@dataclass(frozen=True)
class Residual:
    """One kind of difference Δz in the objective of equation (2).

    Parameters
    ----------
    name : str
        What users say: ``residuals = "frequencies"``.
    weight : str
        Key of the study that holds the standard deviation σ, for example ``frequency_sigma``.
    sigma : float
        Default of that standard deviation.
    value : callable
        Δz of a `Seen`: (n_row, k), each row in units of one σ; rows are pairs, or stand for the
        whole model where `error` is not given.
    derivative : callable
        Of the value by the active parameters: `Seen` and `Slopes` to (n_row, k, n_active).
    needs_shapes : bool
        Whether the derivative looks at ``Slopes.analysis``, which costs a solve a mode.
    size : callable, optional
        Squared length of each row of the value, (n_row,), where it is known for less.
    readings : callable, optional
        How many of the rows are of something that was measured; default all.
    unpaired : callable
        The squared length that is due for a test mode without a partner.
    error : callable
        Standard errors of the test itself in units of the value, (n_test,), or None; they add to σ.
        Where this is given rows are pairs, and the weights of test modes count.
    tells_pairs : bool
        Whether modes are paired by this very residual: a step that loses a pair has then made it
        worse.
    believes_sigmas : bool
        Whether the standard deviations are those of a posterior with it: else the scatter of all
        residuals is that which is left.
    stated : bool
        Whether its own standard deviation is known apart from the modes (scales, a ± by hand): that
        modes fit better than theirs makes it no smaller.
    damped : bool
        Whether the damping of the model counts.
    hears : bool
        Whether it looks at frequency responses.
    """

    name: str
    weight: str
    sigma: float
    value: Callable[[Seen], Floats]
    derivative: Callable[[Seen, Slopes], Floats]
    needs_shapes: bool = False
    size: Callable[[Seen], Floats] | None = None
    readings: Callable[[Seen], int] | None = None
    unpaired: Callable[[Criteria], float] = lambda _: 0.0
    error: Callable[[Target], Floats | None] | None = None
    tells_pairs: bool = False
    believes_sigmas: bool = False
    stated: bool = False
    damped: bool = False
    hears: bool = False

    def squared(self, seen: Seen) -> Floats:
        """Squared length of each row of the value, (n_row,)."""
        return np.sum(self._value(seen) ** 2, axis=1) if self.size is None else self.size(seen)

    def data(self, seen: Seen) -> int:
        """Count what was measured."""
        return len(self.squared(seen)) if self.readings is None else self.readings(seen)

    def _value(self, seen: Seen) -> Floats:
        values = self.value(seen)
        if values.ndim != 2:
            raise InputError(f"residual '{self.name}': its value is no table (n_row, k)")
        return values

    def linearised(self, seen: Seen, slopes: Slopes, sigma: Floats | float) -> Linearisation:
        """Weigh value and derivative by 1/σ, one σ in all or one a row."""
        values, gradient = self._value(seen), self.derivative(seen, slopes)
        if gradient.shape[:-1] != values.shape:
            raise InputError(f"residual '{self.name}': its derivative is not (n_row, k, n_active)")
        rows = np.broadcast_to(np.asarray(sigma, np.float64), len(values))
        values, gradient = values / rows[:, None], gradient / rows[:, None, None]
        return Linearisation(values.ravel(), gradient.reshape(values.size, gradient.shape[-1]))
