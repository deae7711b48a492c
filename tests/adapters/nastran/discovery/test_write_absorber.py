"""An absorber in a deck: read back and solved it splits a frequency as den Hartog says."""

from dataclasses import replace

import numpy as np
import pytest

from trueup.adapters.nastran import build_model, read_deck, read_deck_text, write_deck
from trueup.adapters.nastran.discovery.write_effect import adopt
from trueup.core.discovery.findings import Finding, Where
from trueup.core.eigen import normal_modes

K, M = 4.0e4, 0.01
F0 = np.sqrt(K / M) / (2.0 * np.pi)

ONE_MASS = """CEND
BEGIN BULK
CORD2R,7,,0.,0.,0.,0.,1.,0.
,1.,0.,0.
GRID,1,,10.,20.,30.,{cd},{held}
CELAS2,1,4.0E4,1,{component}
CONM2,2,1,,0.01
ENDDATA
"""

PLATE = """CEND
BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,40.,0.,0.
GRID,3,,40.,30.,0.
GRID,4,,0.,30.,0.
CQUAD4,1,1,1,2,3,4
PSHELL,1,1,2.,1
MAT1,1,70000.,,0.3,2.7-6
CONM2,11,1,,0.0025
CONM2,12,2,,0.0025
CONM2,13,3,,0.0025
CONM2,14,4,,0.0025
ENDDATA
"""


def finding(grids, component, mass, hz):
    return Finding(
        "model",
        "tuned_absorber",
        Where(grids=tuple(grids), xyz=(0.0, 0.0, 0.0), region="near grid 1"),
        {"mass": mass, "frequency_hz": hz, "components": [component]},
        (0.9 * mass, 1.1 * mass),
        (),
        0.9,
        "About 0.001 of mass on a spring is missing.",
    )


def completed(folder, text, what):
    (folder / "deck.bdf").write_text(text)
    read = read_deck_text(folder / "deck.bdf")
    done = adopt(read, read_deck(folder / "deck.bdf"), what)
    top = write_deck(done.deck, folder / "out")
    model = build_model(read_deck(top))
    return done, model, normal_modes.solve(model, n_modes=min(8, model.n_free))


def hz(solution):
    return np.sqrt(np.maximum(solution.eigenvalues, 0.0)) / (2.0 * np.pi)


@pytest.mark.parametrize(("cd", "held", "component"), [(0, "12456", 3), (7, "23456", 1)])
@pytest.mark.parametrize("mu", [0.05, 0.3])
def test_one_frequency_becomes_den_hartogs_two(tmp_path, cd, held, component, mu):
    """Tuned to its host, masses in the ratio μ: (ω/ω₀)² = 1 + μ/2 ± √(μ + μ²/4).

    The second deck measures its grid in a frame whose first axis is the basic third one.
    """
    text = ONE_MASS.format(cd=cd, held=held, component=component)
    if cd:
        text = text.replace("0.,1.,0.\n,1.,0.,0.", "1.,0.,0.\n,0.,0.,1.")
    done, model, solution = completed(tmp_path, text, finding([1], 3, mu * M, F0))
    assert model.n_free == 2
    split = 1.0 + 0.5 * mu + np.sqrt(mu + 0.25 * mu**2) * np.array([-1.0, 1.0])
    np.testing.assert_allclose(hz(solution), F0 * np.sqrt(split), rtol=1e-6)
    assert any(c.startswith("CELAS2") for c in done.cards)


def test_a_mass_on_a_mount_is_an_absorber_in_every_direction(tmp_path):
    mass = {"mass": 0.1 * M, "mount_hz": F0}
    what = replace(finding([1], 3, 0.1 * M, F0), kind="point_mass", magnitude=mass)
    text = ONE_MASS.format(cd=0, held="12456", component=3)
    _, _, solution = completed(tmp_path, text, what)
    split = 1.05 + np.sqrt(0.1025) * np.array([-1.0, 1.0])
    np.testing.assert_allclose(hz(solution), F0 * np.sort([*np.sqrt(split), 1.0, 1.0]), rtol=1e-6)


@pytest.mark.parametrize("grids", [[1], [1, 2], [1, 2, 3, 4]])
def test_between_grids_it_hangs_on_their_mean_and_leaves_a_free_structure_free(tmp_path, grids):
    """A free rigid body and an absorber at its middle: ω² = ω_a² (1 + m/M); six rigid modes."""
    m = 0.002
    _, _, solution = completed(tmp_path, PLATE, finding(grids, 3, m, 5.0))
    assert solution.rigid_body_modes == 6
    elastic = hz(solution)[6]
    if len(grids) == 4:
        assert elastic == pytest.approx(5.0 * np.sqrt(1.0 + m / (0.01 + 2.7e-6 * 2400.0)), rel=1e-3)
    else:
        assert elastic > 5.0 * np.sqrt(1.0 + m / (0.01 + 2.7e-6 * 2400.0))


def test_the_cards_are_those_of_an_engineer_with_a_comment(tmp_path):
    done, _, _ = completed(
        tmp_path, ONE_MASS.format(cd=0, held="12456", component=3), finding([1], 3, 1e-3, F0)
    )
    text = done.deck.files[0].data.decode()
    assert "$ trueup discover: tuned absorber" in text
    assert [c.split()[0].rstrip("*") for c in done.cards] == ["SPOINT", "CELAS2", "CMASS2"]
    assert all(card in text for card in done.cards)
