"""A plate that is bowed, which no effect of the list is: told as what it looks like."""

from __future__ import annotations

import re

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran import build_model, read_deck
from trueup.core.data.dofs import Dofs
from trueup.core.data.geometry import Geometry
from trueup.core.data.measurement import Measurement
from trueup.core.data.modes import Modes
from trueup.core.eigen import normal_modes

LONG, WIDE = 16, 8
SIDE = 25.0


def deck(path, height=0.0):
    """A clamped plate of 2 mm [mm, t, N, s], a half wave along its length as high as that."""
    across = WIDE + 1
    grids = [
        f"GRID,{1 + j + across * i},,{SIDE * i},{SIDE * j},"
        f"{height * np.sin(np.pi * i / LONG):.6f}{',,123456' * (i in (0, LONG))}"
        for i in range(LONG + 1)
        for j in range(across)
    ]
    shells = [
        f"CQUAD4,{1 + j + WIDE * i},1,{a},{a + across},{a + across + 1},{a + 1}"
        for i in range(LONG)
        for j in range(WIDE)
        for a in [1 + j + across * i]
    ]
    cards = ["PSHELL,1,1,2.,1,,1", "MAT1,1,70000.,,.3,2.7-9", "ENDDATA"]
    path.write_text("\n".join(["SOL 103", "CEND", "BEGIN BULK", *grids, *shells, *cards]) + "\n")
    return path


def measured(truth, flat) -> Measurement:
    """Return the lowest modes out of plane, with scatter, at the places of the flat one."""
    rng, model = np.random.default_rng(7), build_model(read_deck(truth))
    modes = normal_modes.modes_of(model, normal_modes.solve(model, n_modes=12))
    at = np.flatnonzero((model.dofs.component == 3) & (model.dofs.node % 3 == 1))
    shapes = modes.shapes[at] / np.abs(modes.shapes[at]).max(axis=0)
    shapes += 0.004 * rng.standard_normal(shapes.shape)
    hz = modes.frequencies_hz * (1.0 + 5e-4 * rng.standard_normal(len(modes)))
    drawn = build_model(read_deck(flat)).geometry
    geometry = Geometry(drawn.ids, drawn.xyz)
    dofs = Dofs(model.dofs.node[at], model.dofs.component[at])
    return Measurement(geometry, Modes(hz, shapes, dofs), length_unit="mm")


@pytest.mark.slow
@pytest.mark.parametrize("height", [2.5, 0.0])
def test_a_bow_is_told_with_its_height_and_none_where_none_is(tmp_path, height):
    flat = deck(tmp_path / "flat.bdf")
    test = measured(deck(tmp_path / "bowed.bdf", height), flat)
    found = trueup.discover(flat, test, deck_length_unit="mm")
    assert found.verdict != "effect"
    told = re.findall(r"bowed along x by ([0-9.]+) deck units", " ".join(found.would_decide))
    assert [float(h) for h in told] == pytest.approx([height] * (height > 0.0), rel=0.2)
