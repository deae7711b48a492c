"""Bring a test onto a model and correlate the two."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from ..arrays import Floats, Numbers
from ..data.frfs import Frfs
from ..data.geometry import Geometry
from ..data.length_units import to_length_unit
from ..data.measurement import Measurement
from ..data.modes import Modes
from ..errors import InputError
from ..noun import Noun
from ..registration.alignment import Alignment, align
from ..registration.length_units import reconcile_units
from ..registration.nodes_by_hand import aligned_by, put_on_grids
from ..registration.registration_numbers import ALIGN
from ..sensors.sensor_map import Observation, observe
from .correlation_numbers import CORRELATION
from .criteria import Criteria
from .mode_errors import ModeErrors, mode_errors, told
from .mode_pairing import Correlation, correlate
from .odd_modes import said_of_odd


@dataclass(frozen=True, eq=False)
class Placed(Noun):
    """A test laid onto a model.

    Parameters
    ----------
    alignment : Alignment
        From test to analysis coordinates.
    observation : Observation
        Sensors that lie on the model.
    test : Modes
        At those sensors, in their order, deck length unit.
    test_geometry : Geometry
        In the analysis frame and the deck length unit.
    warnings : tuple of str
    errors : ModeErrors, optional
        Standard errors of `test` where it was identified here; they weigh.
    length_factor : float
        Deck length units in one of the test's own; `test` and `test_geometry` have it already.
    mpc : (n_test,) float, optional
        Modal phase collinearity of test modes that were identified here.
    weights : (n_test,) float, optional
        What the user says that each test mode counts beside the others; all the same without.
    damping_std : (n_test,) float, optional
        Standard errors of damping ratios that were identified here.
    frfs : Frfs, optional
        Frequency responses of the test, in its own frame and units.
    """

    alignment: Alignment
    observation: Observation
    test: Modes
    test_geometry: Geometry
    warnings: tuple[str, ...] = ()
    errors: ModeErrors | None = None
    length_factor: float = 1.0
    mpc: Floats | None = None
    weights: Floats | None = None
    damping_std: Floats | None = None
    frfs: Frfs | None = None

    def take(self, rows: Numbers) -> Placed:
        """Return the test at some of its sensors (indices or mask)."""
        seen, errors = self.observation.take(rows), self.errors
        test = replace(self.test, shapes=self.test.shapes[rows], dofs=seen.sensors)
        if errors is not None:
            errors = replace(errors, shape=errors.shape[rows])
        return replace(self, observation=seen, test=test, errors=errors)

    def of_modes(self, modes: Numbers) -> Placed:
        """Return some of the test modes (indices or mask)."""
        errors = self.errors
        if errors is not None:
            errors = ModeErrors(errors.frequency[modes], errors.shape[:, modes])
        weights, damping_std = (
            None if v is None else v[modes] for v in (self.weights, self.damping_std)
        )
        taken = self.test.take(modes)
        return replace(self, test=taken, errors=errors, weights=weights, damping_std=damping_std)

    def weighted(self, rows: Numbers | sp.spmatrix) -> Numbers | sp.csr_matrix:
        """Multiply rows of sensors with the square roots of their weights."""
        if self.errors is None:
            return rows
        factor = sp.diags(np.sqrt(self.errors.sensors))
        return sp.csr_matrix(factor @ rows) if sp.issparse(rows) else np.asarray(factor @ rows)


@dataclass(frozen=True, eq=False)
class Comparison(Noun):
    """A model and a test, correlated.

    Parameters
    ----------
    geometry : Geometry
        Of the analysis.
    analysis : Modes
        Mass-normalised where their generalized mass is known, on all analysis dofs.
    placed : Placed
    correlation : Correlation
    warnings : tuple of str
    """

    geometry: Geometry
    analysis: Modes
    placed: Placed
    correlation: Correlation
    warnings: tuple[str, ...] = ()

    @property
    def test(self) -> Modes:
        """Test modes at the sensors that lie on the model."""
        return self.placed.test

    @property
    def alignment(self) -> Alignment:
        """From test to analysis coordinates."""
        return self.placed.alignment

    @property
    def observation(self) -> Observation:
        """Sensors that lie on the model."""
        return self.placed.observation


def place_test(
    geometry: Geometry,
    analysis: Modes,
    measurement: Measurement,
    deck_length_unit: str | None = None,
    motion: Numbers | sp.spmatrix | None = None,
    seed: int = 0,
    node_map: Mapping[int, int] | None = None,
) -> Placed:
    """Convert a test to deck units, align it and find its sensors on the model.

    Parameters
    ----------
    geometry, analysis : Geometry, Modes
        Of the analysis; the modes decide where the geometry is too symmetric to.
    measurement : Measurement
        With modes.
    deck_length_unit : {"m", "mm", "in", "ft"}, optional
        What the user says; stronger than what the deck says.
    motion : optional
        See `observation.grids_of`.
    seed : int
        Of the alignment's random starts.
    node_map : mapping of int to int, optional
        Test nodes to the grids that they are at, whatever their positions; three that are not on
        a line align the test.

    Raises
    ------
    InputError
        Units that cannot both be right, a test that does not lie on the model, no test modes.
    """
    if measurement.modes is None or not len(measurement.modes):
        raise InputError("the test holds no modes")
    odd = said_of_odd(measurement.modes)
    measured = measurement.geometry
    if measured.size == 0.0 and len(measured.ids) > 1:
        raise InputError(
            f"all {len(measured.ids)} nodes of the test lie at one position: its geometry was "
            "not exported; export it again (dataset 15 or 2411)"
        )
    declared = replace(measured, length_unit=measured.length_unit or measurement.length_unit)
    units = reconcile_units(geometry, declared, deck_length_unit)
    unit = units.deck
    own = replace(geometry, length_unit=unit)
    if unit and units.test:
        moved, test = to_length_unit(declared, measurement.modes, units.test, unit)
    else:
        moved, test = declared, measurement.modes
    if test is None:
        raise InputError("the test holds no modes")
    if not np.any(test.shapes):
        raise InputError("the test's mode shapes are zero at every sensor; give measured ones")
    by_hand = aligned_by(own, moved, node_map) if node_map else None
    alignment = by_hand or align(own, moved, analysis, test, seed=seed)
    if node_map:
        moved = put_on_grids(own, moved, node_map, alignment)
    seen = observe(own, analysis.dofs, moved, test.dofs, alignment, motion=motion)
    if moved.size < ALIGN.possible[0] * own.size and seen.within.mean() < CORRELATION.on_model:
        raise InputError(
            f"the test is {own.size / moved.size:.3g} times smaller than the model and only "
            f"{seen.within.mean():.0%} of its sensors lie on it in the best position: the length "
            "units of the two cannot both be right; state the deck's with deck_length_unit, the "
            "test's in dataset 164"
        )
    rows = np.flatnonzero(seen.within)
    kept = seen.take(rows)
    at_sensors = replace(test, shapes=test.shapes[rows], dofs=kept.sensors)
    in_frame = replace(moved, xyz=alignment.apply(moved.xyz))
    # An undecided alignment warns of its ambiguity itself.
    ambiguity = (alignment.ambiguity,) if alignment.ambiguity and alignment.decided else ()
    warnings = (*measurement.warnings, *odd, *units.warnings, *alignment.warnings, *ambiguity)
    errors = _errors(measurement, rows)
    weighed = (told(errors, kept.sensors.labels),) if errors else ()
    said = (*warnings, *seen.warnings, *weighed)
    return Placed(
        alignment,
        kept,
        at_sensors,
        in_frame,
        said,
        errors,
        units.factor,
        measurement.mpc,
        damping_std=measurement.damping_std,
        frfs=measurement.frfs,
    )


def _errors(measurement: Measurement, rows: Numbers) -> ModeErrors | None:
    modes, f_std, std = measurement.modes, measurement.frequency_std, measurement.shape_std
    if modes is None or f_std is None or std is None:
        return None
    return mode_errors(modes.frequencies_hz, modes.shapes[rows], f_std, std[rows])


def compare(
    geometry: Geometry,
    analysis: Modes,
    placed: Placed,
    criteria: Criteria | None = None,
    rigid_body_modes: int = 0,
) -> Comparison:
    """Correlate analysis modes, the first so many of them rigid-body modes, with a placed test."""
    criteria = criteria or Criteria()
    criteria.require(placed.test.frequencies_hz, len(analysis), rigid_body_modes)
    normalised = mass_normalised(analysis)
    found = correlate(
        analysis.frequencies_hz,
        np.asarray(placed.weighted(placed.observation.matrix @ normalised.shapes)),
        placed.test.frequencies_hz,
        np.asarray(placed.weighted(placed.test.shapes)),
        criteria,
        rigid_body_modes,
    )
    return Comparison(geometry, normalised, placed, found, placed.warnings)


def mass_normalised(modes: Modes) -> Modes:
    """Return modes scaled to unit generalized mass; unknown masses are left as they are."""
    mass = modes.generalized_mass
    known = np.isfinite(mass) & (mass > 0.0)
    scale = np.where(known, 1.0 / np.sqrt(np.where(known, mass, 1.0)), 1.0)
    unit = np.where(known, 1.0, mass)
    return replace(modes, shapes=modes.shapes * scale, generalized_mass=unit)
