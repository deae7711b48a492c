"""Maps of the misfit peak where a plate was changed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck
from trueup.adapters.nastran.discovery.build_structure import build_structure
from trueup.core.correlation.comparison import compare, place_test
from trueup.core.correlation.criteria import Criteria
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes
from trueup.core.eigen.normal_modes import modes_of, solve
from trueup.core.errors import InputError
from trueup.core.localisation.error_localisation import disagreement

NX, NY = 12, 8
SIZE = np.array([0.9, 0.6])


def deck(folder: Path, name: str, soft=(), extra="") -> Path:
    """A free plate of aluminium; elements `soft` have a property of their own."""
    lines = ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,7.+10,,.33,2700.", "PSHELL,1,1,.003,1,,1",
             "PSHELL,2,1,.0022,1,,1", extra]  # fmt: skip
    for j in range(NY + 1):
        for i in range(NX + 1):
            x, y = SIZE * [i / NX, j / NY]
            lines.append(f"GRID,{1 + i + j * (NX + 1)},,{x:.6f},{y:.6f},0.")
    for j in range(NY):
        for i in range(NX):
            e, g = 1 + i + j * NX, 1 + i + j * (NX + 1)
            p = 2 if (i, j) in soft else 1
            lines.append(f"CQUAD4,{e},{p},{g},{g + 1},{g + NX + 2},{g + NX + 1}")
    path = folder / name
    path.write_text("\n".join([*lines, "ENDDATA", ""]))
    return path


def mapped(tmp_path: Path, rotate: str = "analysis", **changed):
    compared, found = surveyed(tmp_path, rotate, **changed)
    return compared.geometry.xyz[found.places], found


def surveyed(tmp_path: Path, rotate: str = "analysis", **changed):
    structure = build_structure(read_deck(deck(tmp_path, "model.bdf")), [])
    model = structure.model
    solution = solve(model, 30)
    truth = build_model(read_deck(deck(tmp_path, "truth.bdf", **changed)))
    real = modes_of(truth, solve(truth, 24))
    nodes = model.geometry.ids
    row = 6 * np.arange(len(nodes)) + 2
    rng = np.random.default_rng(1)
    shapes = real.shapes[row, 6:20]
    shapes = shapes + 0.01 * shapes.std(axis=0) * rng.standard_normal(shapes.shape)
    measurement = Measurement(
        Geometry(nodes, model.geometry.xyz, "m"),
        Modes(real.frequencies_hz[6:20], shapes, Dofs(nodes, np.full(len(nodes), 3))),
        None,
        "m",
    )
    modes = modes_of(model, solution)
    placed = place_test(model.geometry, modes, measurement, "m")
    compared = compare(model.geometry, modes, placed, Criteria(rotate=rotate), 6)
    found = disagreement(
        compared, structure.members, structure.displacement, solution.vectors, np.ones(0)
    )
    return compared, found


def test_a_mass_is_where_the_map_of_masses_peaks(tmp_path):
    at = 1 + 9 + 2 * (NX + 1)
    xyz, found = mapped(tmp_path, extra=f"CONM2,900,{at},,0.15")
    best = xyz[np.argmax(found.mass)]
    assert np.linalg.norm(best - [0.675, 0.15, 0.0]) < 0.1
    assert found.mass.max() > 2.0 * max(found.stiffness.max(), found.ground.max())


def test_a_soft_patch_is_where_the_map_of_stiffness_peaks(tmp_path):
    soft = {(i, j) for i in (2, 3, 4) for j in (4, 5, 6)}
    xyz, found = mapped(tmp_path, soft=soft)
    best = xyz[np.argmax(found.stiffness)]
    assert np.linalg.norm(best - [0.2625, 0.4125, 0.0]) < 0.12
    assert found.stiffness.max() > found.mass.max()


def test_a_spring_to_ground_is_where_the_map_of_springs_peaks(tmp_path):
    at = 1 + 3 + 6 * (NX + 1)
    xyz, found = mapped(tmp_path, extra=f"CELAS2,901,2.+3,{at},3")
    best = xyz[np.argmax(found.ground)]
    assert np.linalg.norm(best - [0.225, 0.45, 0.0]) < 0.12


def test_shares_are_shares(tmp_path):
    _, found = mapped(tmp_path, extra="CONM2,900,30,,0.1")
    for part in (found.mass, found.stiffness, found.ground):
        assert (part >= 0.0).all()
        assert (part <= 1.0 + 1e-9).all()
    assert np.isfinite(found.motion).all()


def test_a_turned_test_is_refused(tmp_path):
    with pytest.raises(InputError, match="need the analysis side rotated"):
        mapped(tmp_path, "test", extra="CONM2,900,30,,0.1")
