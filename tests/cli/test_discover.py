"""Discovery from the command line on cases whose hidden truth is known."""

import json
from pathlib import Path

import pytest

CASES = Path(__file__).resolve().parents[2].parent / "shared" / "data" / "cases"

pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason="../shared/data is absent")


def discovered(case, stem, tmp_path, *more):
    from trueup.cli.app import app

    folder, out = CASES / case, tmp_path / "run"
    app(
        [
            "discover",
            str(folder / f"{stem}.bdf"),
            str(folder / f"{stem}_test.unv"),
            "--deck-length-unit",
            "mm",
            "--out",
            str(out),
            "--quiet",
            *more,
        ],
        standalone_mode=False,
    )
    return json.loads((out / "result.json").read_text()), out


def test_a_soft_joint_is_found_named_sized_and_put_into_the_deck(tmp_path):
    result, out = discovered("tower_joint", "tower", tmp_path)
    assert result["verdict"] == "effect"
    (finding,) = result["findings"]
    assert finding["kind"] == "joint_flexibility"
    assert finding["where"]["xyz"] == [400.0, 0.0, 1000.0]
    assert 2e5 < finding["magnitude"]["stiffness"] < 8e5
    low, high = finding["interval"]
    assert low < 4e5 < high
    gap = result["gap"]
    assert gap["after"]["pairs"] >= gap["before"]["pairs"]
    assert gap["after"]["mean_abs_deviation_percent"] < 0.3
    assert gap["held_out"]["after"]["mean_abs_deviation_percent"] < 0.3
    changes = (out / "changes.diff").read_text()
    assert "+CBUSH" in changes
    assert "+RBE2" in changes
    written = {line for file in (out / "deck").iterdir() for line in file.read_text().splitlines()}
    names = [c.split()[0].rstrip("*") for c in finding["cards"]]
    assert sorted(names) == ["CBAR", "CBUSH", "GRID", "PBUSH", "RBE2"]
    assert written >= {line for card in finding["cards"] for line in card.split("\n")}
    assert (out / "report.html").is_file()


@pytest.mark.parametrize("unit", ["ft", "in", "m"])
def test_a_deck_unit_by_which_the_sizes_cannot_agree_is_refused(unit, tmp_path, call):
    folder, out = CASES / "tower_joint", tmp_path / "run"
    files = (folder / "tower.bdf", folder / "tower_test.unv")
    answer = call("discover", *files, "--deck-length-unit", unit, "--out", out, "--quiet")
    assert answer.status == 1
    assert "tower_test.unv" in answer.sentence
    assert "say so with --deck-length-unit mm" in answer.sentence
    assert not list(tmp_path.iterdir())


def test_parameters_alone_are_enough_where_nothing_is_missing(tmp_path):
    from trueup.adapters.nastran import parse_parameter, read_deck
    from trueup.adapters.nastran.assembly.variation import value_of

    result, out = discovered("tower_frame", "tower", tmp_path)
    assert result["verdict"] == "parameters_only"
    assert result["findings"] == []
    completed = read_deck(out / result["deck"])
    for p in result["parameters"]:
        card, number, fields = p["name"].split()
        specs = [parse_parameter(f"{card} {number} {f}") for f in fields.split("+")]
        stands = [value_of(completed, f) for spec in specs for f in spec.fields]
        assert stands == pytest.approx(p["updated"], rel=1e-5)
    gap = result["gap"]
    assert (
        gap["held_out"]["after"]["mean_abs_deviation_percent"]
        < gap["held_out"]["before"]["mean_abs_deviation_percent"]
    )


@pytest.mark.slow
def test_a_test_of_stated_scatter_is_believed_that_much_less(tmp_path):
    """Frequencies good to 5 % and shapes to 60 % show neither a modulus 5 % off nor its absence."""
    study = tmp_path / "study.toml"
    study.write_text("frequency_scatter = 0.05\nshape_scatter = 0.6\n")
    result, _ = discovered("tower_frame", "tower", tmp_path, "--study", str(study))
    assert result["verdict"] == "undecided"
    assert not [p for p in result["parameters"] if p["significant"]]


@pytest.mark.slow
def test_sensors_wired_backwards_and_swapped_are_named_and_nothing_else(tmp_path):
    result, _ = discovered("wheel_faults", "wheel", tmp_path)
    assert result["verdict"] == "test_fault"
    named = {(f["kind"], f["where"]["sensors"][0]) for f in result["findings"]}
    assert named == {("sensor_polarity", 109), ("sensor_swap", 119)}


@pytest.mark.slow
def test_a_hidden_mass_is_found_within_a_mesh_step_and_a_tenth(tmp_path):
    result, _ = discovered("wheel_mass", "wheel", tmp_path)
    (finding,) = result["findings"]
    assert finding["kind"] == "point_mass"
    x, y, z = finding["where"]["xyz"]
    assert abs(x - 172.5) + abs(y - 338.6) + abs(z) < 40.0
    assert finding["magnitude"]["mass"] == pytest.approx(8e-4, rel=0.15)


@pytest.mark.slow
def test_a_spring_to_ground_that_no_rigid_model_has_is_found(tmp_path):
    result, _ = discovered("panel_spring", "panel", tmp_path)
    (finding,) = result["findings"]
    assert finding["kind"] == "ground_spring"
    assert finding["where"]["xyz"] == [750.0, 450.0, 0.0]
    assert finding["magnitude"]["components"] == [3]
    assert finding["magnitude"]["stiffness"] == pytest.approx(15.0, rel=0.1)


@pytest.mark.slow
@pytest.mark.parametrize(("adopt", "moves"), [("significant", False), ("all", True)])
def test_only_what_the_test_determines_is_written_unless_asked(adopt, moves, tmp_path):
    result, out = discovered("panel_spring", "panel", tmp_path, "--adopt", adopt)
    vague = [p for p in result["parameters"] if not p["significant"]]
    assert vague
    assert any(p["updated"] != p["initial"] for p in vague) == moves
    lines = (out / "changes.diff").read_text().splitlines()
    changed = {line for line in lines if line.startswith("-") and not line.startswith("---")}
    moved = [p for p in result["parameters"] if p["updated"] != p["initial"]]
    assert len(changed) == len({c.rsplit(" ", 1)[0] for p in moved for c in p["cards"]})


def test_a_word_that_adopt_does_not_know_is_refused(tmp_path, call):
    folder = CASES / "tower_joint"
    said = call("discover", folder / "tower.bdf", folder / "tower_test.unv", "--adopt", "some")
    assert said.status == 2
    assert "adopt is 'some'; give one of significant, all, none" in said.err
