"""`trueup.correlate`: files or objects in, the tables of result.json out, typed."""

from __future__ import annotations

import json
import shutil
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trueup
from trueup.adapters.store import write_store
from trueup.adapters.universal import read_universal

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"
FILES = (DUCT / "duct.bdf", DUCT / "duct_test.unv")


@pytest.fixture(scope="module")
def found() -> trueup.Correlated:
    return trueup.correlate(*FILES, deck_length_unit="mm")


def test_objects_give_what_files_give(found: trueup.Correlated) -> None:
    deck, test = trueup.read_deck(str(FILES[0])), trueup.read_test([FILES[1]])
    same = trueup.correlate(deck, test, deck_length_unit="mm")
    assert same.to_dict() == found.to_dict()
    assert same.study.test == (FILES[1],)


def test_a_run_of_objects_says_what_it_can_be_run_again_with(tmp_path: Path) -> None:
    test = replace(trueup.read_test(FILES[1]), files=())
    modes = trueup.solve(FILES[0], 12)
    found = trueup.correlate(FILES[0], test, deck_length_unit="mm", modes=modes)
    assert len(found.analysis_hz) == len(modes.shapes)
    assert "\ntest =" not in (found.save(tmp_path / "run") / "study.toml").read_text()


def test_a_run_is_run_again_wherever_it_is_moved_with_its_inputs(
    found: trueup.Correlated, tmp_path: Path
) -> None:
    shutil.copytree(FILES[0].parent, tmp_path / "here")
    inputs = [tmp_path / "here" / f.name for f in FILES]
    trueup.correlate(*inputs, deck_length_unit="mm").save(tmp_path / "here/runs/first")
    (tmp_path / "here").rename(tmp_path / "there")
    again = trueup.correlate(study=tmp_path / "there/runs/first/study.toml")
    assert again.pairs == found.pairs
    assert again.study.deck == tmp_path.resolve() / "there" / FILES[0].name


def test_modes_of_the_model_may_stand_in_a_store(tmp_path: Path) -> None:
    solved = trueup.solve(FILES[0], 12)
    write_store(tmp_path / "modes.h5", geometry=solved.geometry, modes={"found": solved.shapes})
    of_file, of_object = (
        trueup.correlate(*FILES, deck_length_unit="mm", modes=m)
        for m in (tmp_path / "modes.h5", solved)
    )
    assert of_file.pairs == of_object.pairs
    strange = replace(
        solved.shapes, dofs=replace(solved.shapes.dofs, node=solved.shapes.dofs.node + 9)
    )
    write_store(tmp_path / "others.h5", geometry=None, modes={"analysis": strange})
    with pytest.raises(trueup.InputError, match=r"others\.h5: grid \d+ is not in the deck"):
        trueup.correlate(*FILES, deck_length_unit="mm", modes=tmp_path / "others.h5")
    write_store(tmp_path / "two.h5", geometry=None, modes={"a": solved.shapes, "b": strange})
    with pytest.raises(trueup.InputError, match=r"no modes of an analysis \(its modes: a, b\)"):
        trueup.correlate(*FILES, deck_length_unit="mm", modes=tmp_path / "two.h5")


def test_what_is_known_of_damping_stands_beside_the_pairs(found: trueup.Correlated) -> None:
    test = trueup.read_test(FILES[1])
    assert test.modes is not None
    turned = test.modes.shapes * np.exp(0.3j)  # of one phase all over, so a normal mode
    turned[:, 1] += 1j * np.roll(test.modes.shapes[:, 1], 1)
    modes = replace(test.modes, shapes=turned, damping=np.linspace(0.01, 0.02, len(test.modes)))
    solved = trueup.solve(FILES[0], 30).shapes
    solved = replace(solved, damping=np.full(len(solved), 0.005))
    known = trueup.correlate(
        FILES[0], replace(test, modes=modes), modes=solved, deck_length_unit="mm"
    )
    assert known.test_damping == pytest.approx(modes.damping)
    assert known.test_mpc[0] == pytest.approx(1.0)
    assert known.test_mpc[1] < 0.9
    for pair in known.pairs:
        assert pair.test_damping == modes.damping[pair.test - 1]
        assert pair.test_mpc == known.test_mpc[pair.test - 1]
        assert pair.analysis_damping == 0.005
    assert found.pairs[0].analysis_damping is None
    assert found.pairs[0].test_mpc is None  # of real shapes nothing can be said


def test_its_tables_are_typed(found: trueup.Correlated) -> None:
    first = found.pairs[0]
    assert (first.test, first.mac > 0.7) == (1, True)
    assert found.mac.values.shape == (len(found.test_hz), len(found.analysis_hz))
    assert found.summary.pairs == len(found.pairs)
    assert found.alignment.sensors[0].direction
    assert found.alignment.scale == pytest.approx(1000.0)


def test_what_is_saved_is_opened_again(found: trueup.Correlated, tmp_path: Path) -> None:
    folder = found.save(tmp_path / "run")
    again = trueup.read(folder)
    assert isinstance(again, trueup.Correlated)
    assert again.to_dict() == found.to_dict() == json.loads((folder / "result.json").read_text())
    shapes = found.content.modes["analysis"].shapes
    assert np.array_equal(again.content.modes["analysis"].shapes, shapes)
    assert again.study.deck_length_unit == "mm"
    again.save(tmp_path / "again")
    names = {str(p.relative_to(folder)) for p in folder.rglob("*.*")}
    assert {"tables/pairs.csv", "tables/mac.csv", "tables/alignment_sensors.csv"} < names
    for name in names - {"result.h5", "study.toml"}:
        assert (folder / name).read_bytes() == (tmp_path / "again" / name).read_bytes(), name


def test_a_run_folder_is_not_replaced_unless_asked(
    found: trueup.Correlated, tmp_path: Path
) -> None:
    found.save(tmp_path / "run")
    with pytest.raises(trueup.InputError, match="exists"):
        found.save(tmp_path / "run")
    found.save(tmp_path / "run", force=True)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"mac_mim": 0.7}, "correlate: unknown key 'mac_mim'; did you mean 'mac_min'"),
        ({"residuals": "both"}, "correlate: unknown key 'residuals'"),
        ({"mac_min": "high"}, "'mac_min' has a value of the wrong type: 'high'"),
        ({"mac_min": 1.5}, "mac_min is 1.5; give a value above 0"),
        ({"rotate": "both"}, "rotate is 'both'"),
        ({"deck_length_unit": "cm"}, "deck_length_unit is 'cm'"),
        ({"study": 3}, "study is 3"),
        ({"parameters": ["PBAR 11 I1"]}, "parameters has no effect"),
        ({"modes": 3}, "modes is given as int"),
    ],
)
def test_options_that_are_none_are_named(given: dict[str, Any], said: str) -> None:
    with pytest.raises(trueup.InputError, match=said):
        trueup.correlate(*FILES, **given)


@pytest.mark.parametrize(
    ("deck", "test", "said"),
    [
        (3, FILES[1], "a deck is given as int"),
        (None, FILES[1], "give a deck and a test"),
        (FILES[0], None, "give a deck and a test"),
        (FILES[0], 3.0, "a test is given as float"),
        (FILES[0], [], "no file of a test is given"),
        (FILES[0], [FILES[1], None], "a test is given as NoneType"),
        (FILES[0], "nowhere.unv", "nowhere.unv does not exist"),
        ("nowhere.bdf", FILES[1], "nowhere.bdf"),
        (FILES[1], FILES[1], "duct_test.unv"),
    ],
)
def test_sources_that_are_none_are_named(deck: Any, test: Any, said: str) -> None:
    with pytest.raises(trueup.InputError, match=said):
        trueup.correlate(deck, test)


def test_a_folder_that_is_no_run_is_refused(tmp_path: Path) -> None:
    with pytest.raises(trueup.InputError, match="not a run folder"):
        trueup.open_run(tmp_path)
    (tmp_path / "result.json").write_text('{"schema": "trueup/correlate/1"}')
    with pytest.raises(trueup.InputError, match=r"no result\.h5"):
        trueup.open_run(tmp_path)


def test_a_result_that_lacks_a_key_is_refused(found: trueup.Correlated, tmp_path: Path) -> None:
    path = found.save(tmp_path / "run") / "result.json"
    values = json.loads(path.read_text())
    values["pairs"][3].pop("mac")
    path.write_text(json.dumps(values))
    with pytest.raises(trueup.InputError, match=r"result\.json: 'pairs\[3\]\.mac' is missing"):
        trueup.open_run(tmp_path / "run")


def test_the_mac_goes_to_pandas(found: trueup.Correlated) -> None:
    pytest.importorskip("pandas")
    assert found.mac.to_pandas().shape == (24, len(found.mac.analysis) + 1)


ODD = """CSEAM,990001,9901,1,2,1.,0.,0.
RSSCON,990003,GRID,1,2
CQUAD4,990004,99999,1,2,74,73
CNEWELEM,990005,1,2
"""


@pytest.fixture
def odd(tmp_path: Path) -> Path:
    """The duct with cards whose matrices nobody knows."""
    shutil.copytree(DUCT, tmp_path / "odd")
    deck = tmp_path / "odd/duct.bdf"
    deck.write_text(deck.read_text().replace("ENDDATA", ODD + "ENDDATA"))
    return deck


def test_own_modes_need_grids_and_elements_only(found: trueup.Correlated, odd: Path) -> None:
    solved = trueup.solve(FILES[0], len(found.analysis_hz))
    own = trueup.correlate(FILES[0], FILES[1], deck_length_unit="mm", modes=solved)
    same = trueup.correlate(odd, FILES[1], deck_length_unit="mm", modes=solved)
    assert [(p.test, p.analysis) for p in same.pairs] == [(p.test, p.analysis) for p in own.pairs]
    np.testing.assert_allclose([p.mac for p in same.pairs], [p.mac for p in own.pairs], rtol=1e-3)
    said = [w for w in same.warnings if "grids and elements only" in w]
    assert len(said) == 1
    assert "duct.bdf line" in said[0]
    assert "CSEAM 990001" in said[0]
    with pytest.raises(trueup.InputError, match="CSEAM 990001"):
        trueup.correlate(odd, FILES[1], deck_length_unit="mm")


def test_what_is_not_assembled_stands_in_no_ones_way(odd: Path, tmp_path: Path) -> None:
    told = trueup.inspect(odd).files[0]
    assert any("CSEAM" in row.what for row in told.skipped)
    trueup.convert(odd, tmp_path / "odd.unv")
    trueup.convert(FILES[0], tmp_path / "duct.unv", lossy=True)
    ours, theirs = (read_universal([tmp_path / f"{n}.unv"]).geometry for n in ("odd", "duct"))
    assert ours is not None
    assert theirs is not None
    np.testing.assert_array_equal(ours.xyz, theirs.xyz)
    drawn, known = (sum(len(v) for v in g.elements.values()) for g in (ours, theirs))
    assert drawn == known + 1  # the quadrilateral without a property
    with pytest.raises(trueup.InputError, match=r"nothing that OP4 can hold.*CSEAM 990001"):
        trueup.convert(odd, tmp_path / "odd.op4")
    changed = trueup.read_deck(odd)
    assert changed.text.files[0].data == odd.read_bytes()


def test_orthogonality_is_told_where_it_is_asked_for(
    found: trueup.Correlated, tmp_path: Path
) -> None:
    assert found.orthogonality is None
    assert "orthogonality" not in found.to_dict()
    told = trueup.correlate(*FILES, deck_length_unit="mm", reduction="serep")
    assert told.orthogonality is not None
    cross, own = told.orthogonality.cross, told.orthogonality.own
    assert cross.shape == own.shape == (len(told.pairs), len(told.pairs))
    for n, (row, pair) in enumerate(zip(told.orthogonality.pairs, told.pairs, strict=True)):
        assert (row.test, row.analysis) == (pair.test, pair.analysis)
        assert row.cross == cross[n, n] > 0.9
        assert row.beside == max(np.delete(cross[n], n).max(), np.delete(cross[:, n], n).max())
        assert row.own == np.delete(own[n], n).max()
    asked = told.orthogonality.requirements
    assert [r.name for r in asked] == ["NASA-STD-5002", "SMC-S-004"]
    assert all(r.met == (not r.unmet) for r in asked)
    again = trueup.open_run(told.save(tmp_path / "run"))
    assert again.to_dict() == told.to_dict()
    expanded = again.content.modes["test expanded"]
    assert len(expanded) == len(told.pairs)
    assert "Cross-orthogonality" in (tmp_path / "run" / "report.html").read_text()


def test_orthogonality_needs_the_models_own_modes() -> None:
    modes = trueup.solve(FILES[0], 12)
    with pytest.raises(trueup.InputError, match="reduction= needs"):
        trueup.correlate(*FILES, deck_length_unit="mm", modes=modes, reduction="irs")
    with pytest.raises(trueup.InputError, match="one of serep, guyan, irs"):
        trueup.correlate(*FILES, reduction="static")


def test_modes_of_a_duct_are_named_by_their_waves(found: trueup.Correlated) -> None:
    """Nine sensors a ring, at random: the duct is off round, so its modes lie where they must."""
    axis = found.axis_of_revolution
    assert axis is not None
    np.testing.assert_allclose(axis.direction, [0.0, 0.0, 1.0], atol=1e-12)
    first, second = (p for p in found.pairs if p.test in (1, 2))
    assert first.test_harmonic == second.test_harmonic == first.analysis_harmonic == 2
    apart = first.test_orientation_deg - second.test_orientation_deg
    assert abs(apart) == pytest.approx(45.0, abs=1.0)
    for p in (first, second):
        assert p.analysis_orientation_deg == pytest.approx(p.test_orientation_deg, abs=1.0)
    assert first.waves.startswith("n = 2, 6")
    cluster = next(c for c in found.clusters if 1 in c.test)
    assert cluster.harmonic == 2


def test_shapes_without_motion_are_refused() -> None:
    deck, test = trueup.read_deck(str(FILES[0])), trueup.read_test([FILES[1]])
    assert test.modes is not None
    still = replace(test, modes=replace(test.modes, shapes=0.0 * test.modes.shapes))
    with pytest.raises(trueup.InputError, match="zero at every sensor"):
        trueup.correlate(deck, still, deck_length_unit="mm")


@pytest.mark.parametrize(
    ("deck", "modes"),
    [
        ("mast/pn_mwe_s-solution_1.dat", "mast/pn_mwe_s-solution_1.op2"),  # grids in one place
        ("beam_pairs/beam_modes.dat", "beam_pairs/beam_modes_m1.op2"),  # a grid of no element
        ("solid_shell_bar/mode_solid_shell_bar.bdf", "solid_shell_bar/mode_solid_shell_bar.op2"),
    ],
)
def test_modes_of_another_solver_of_the_same_deck_are_the_same(deck: str, modes: str) -> None:
    recorded = Path(__file__).parents[3] / "shared" / "data" / "nastran"
    if not recorded.is_dir():
        pytest.skip("recorded runs are not beside the checkout")
    found = trueup.correlate(recorded / deck, [recorded / modes, recorded / deck])
    assert not found.unpaired_test
    assert min(p.mac for p in found.pairs) > 0.998
