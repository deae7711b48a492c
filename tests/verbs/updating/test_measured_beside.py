"""What was measured beside modes: a cantilever that was weighed, balanced and loaded."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trueup
from trueup.adapters.nastran import build_model, parse_parameter
from trueup.adapters.nastran.assembly.grid_point_weight import weight
from trueup.core.updating.residuals import RESIDUALS, Beside, Seen

LENGTH, AREA, INERTIA, E, RHO = 1000.0, 200.0, 6000.0, 70000.0, 2.7e-9
TRUTH = 1.2, 1.1
"""Of the modulus and the density of what was tested."""
TIP = 50.0 * LENGTH**3 / (3.0 * TRUTH[0] * E * INERTIA)


def cantilever(e: float = E, rho: float = RHO) -> str:
    n = 12
    xyz = np.linspace(0.0, LENGTH, n + 1)
    rows = [f"GRID,{k + 1},,{x:.4f},0.,0.,{7 * (k == n)}" for k, x in enumerate(xyz)]
    rows += ["CORD2R,7,,0.,0.,0.,0.,1.,0.", ",0.,0.,1."]  # turns the tip alone: loads are basic
    rows += [f"CBAR,{k + 1},1,{k + 1},{k + 2},0.,0.,1." for k in range(n)]
    rows += [f"PBAR,1,1,{AREA},{INERTIA},9000.,12000.", f"MAT1,1,{e:.1f},,0.3,{rho:.4e}"]
    rows += ["CONM2,90,1,,2.-4", "SPC1,1,123456,1", "EIGRL,1,,,6"]
    return "SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\n" + "\n".join(rows) + "\nENDDATA\n"


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    deck, truth, test = (tmp_path / n for n in ("bar.bdf", "truth.bdf", "test.unv"))
    deck.write_text(cantilever())
    truth.write_text(cantilever(TRUTH[0] * E, TRUTH[1] * RHO))
    trueup.solve(truth, 6).save(tmp_path / "solved")
    trueup.convert([tmp_path / "solved" / "result.h5"], test)
    return deck, test


def test_mass_and_balance_are_those_of_the_whole_deck(files: tuple[Path, Path]) -> None:
    """The mass on the clamped grid counts, which no mode sees."""
    deck = trueup.read_deck(files[0])
    model = build_model(deck, [parse_parameter("MAT1 1 RHO")])
    told = weight(deck)
    mass = RHO * AREA * LENGTH
    assert told.mass == pytest.approx(mass + 2e-4, rel=1e-12)
    none = np.zeros((0, 0))
    beside = Beside(1.0, np.zeros(3))
    seen = Seen(model, np.array([1.5]), (), np.zeros(0), none, none, beside)
    values = {r.name: r.value(seen) for r in RESIDUALS if r.name in ("mass", "centre_of_gravity")}
    heavy = 1.5 * mass + 2e-4
    assert values["mass"][0, 0] + 1.0 == pytest.approx(heavy, rel=1e-12)
    centre = values["centre_of_gravity"][:, 0] * model.geometry.size
    np.testing.assert_allclose(centre, [1.5 * mass * LENGTH / 2.0 / heavy, 0.0, 0.0], atol=1e-9)


@pytest.mark.parametrize(
    "more",
    [
        {"residuals": "frequencies, mass", "measured_mass": TRUTH[1] * RHO * AREA * LENGTH + 2e-4},
        {
            "residuals": "frequencies, deflections",
            "load_cases": [{"loads": ["13:+Z=50"], "readings": [f"13:+Z={TIP}"]}],
        },
    ],
    ids=["weighed", "loaded"],
)
def test_what_was_measured_beside_modes_sets_the_scale(
    files: tuple[Path, Path], more: dict[str, object], tmp_path: Path
) -> None:
    asked = [*files, ["MAT1 1 E", "MAT1 1 RHO"]]
    common = {"deck_length_unit": "mm", "regularisation": 0.0}
    alone = trueup.update(*asked, residuals="frequencies", **common)
    assert abs(np.array([p.factor for p in alone.parameters]) - TRUTH).max() > 0.05
    done = trueup.update(*asked, **more, **common)
    np.testing.assert_allclose([p.factor for p in done.parameters], TRUTH, rtol=1e-3)
    again = trueup.open_run(done.save(tmp_path / "run"))
    assert replace(again.study, source=None).load_cases == done.study.load_cases


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"load_cases": [{"loads": ["13:+Z=50"]}]}, "says no readings"),
        ({"load_cases": [{"loads": ["13:+Y"], "readings": ["1:+Y=1"]}]}, "cannot be read"),
        (
            {
                "residuals": "deflections",
                "load_cases": [{"loads": ["99:+Y=1"], "readings": ["13:+Y=1"]}],
            },
            "the deck has no grid 99",
        ),
        ({"measured_mass": -1.0}, "must be above 0"),
        ({"measured_centre_of_gravity": [1.0]}, "three numbers"),
        ({"residuals": "mass"}, "give measured_mass"),
        ({"residuals": "centre_of_gravity"}, "give measured_centre_of_gravity"),
        ({"residuals": "deflections"}, "under which load: give load_cases"),
    ],
)
def test_what_cannot_be_is_said(
    files: tuple[Path, Path], given: dict[str, object], said: str
) -> None:
    with pytest.raises(trueup.InputError, match=said):
        trueup.update(*files, ["MAT1 1 E"], deck_length_unit="mm", **given)


def test_a_prior_intervals_and_other_starts_are_told(
    files: tuple[Path, Path], tmp_path: Path
) -> None:
    """The ratio is known, the common scale is the prior's: both factors go together."""
    asked = (*files, ["MAT1 1 E", "MAT1 1 RHO"])
    done = trueup.update(
        *asked, residuals="frequencies, prior", prior_sigma=0.05, frequency_sigma=1e-4,
        regularisation=0.0, deck_length_unit="mm", intervals=True, starts=2,
    )  # fmt: skip
    e, rho = done.parameters
    assert e.factor / rho.factor == pytest.approx(TRUTH[0] / TRUTH[1], rel=1e-3)
    assert done.posterior is not None
    assert done.posterior.values[0, 1] == pytest.approx(1.0, abs=1e-4)
    for p in done.parameters:
        assert p.interval is not None
        low, high = p.interval
        assert (high - low) / 2.0 == pytest.approx(np.sqrt(3.84) * p.standard_error, rel=0.02)
    assert [s.same for s in done.starts] == [True, True]
    again = trueup.open_run(done.save(tmp_path / "run"))
    assert again.to_dict() == done.to_dict()
    assert " … " in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
