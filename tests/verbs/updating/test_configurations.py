"""A wing with and without a store: one set of parameters meets both tests."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

import trueup
from trueup.cli.app import app

E, RHO, STORE = 70000.0, 2.7e-9, 4e-4
TRUTH = 0.9 * E, 1.15 * RHO, 1.3 * STORE
SKIN = ("stiffness = MAT1 1 E", "density = MAT1 1 RHO")


def write(folder: Path, e: float, rho: float, store: float | None) -> Path:
    """A clamped, swept wing; the store hangs at its leading edge. Both share the wing's file."""
    folder.mkdir(exist_ok=True)
    grids = [(i, j) for i in range(10) for j in range(4)]
    rows = ["$ the wing"]
    rows += [
        f"GRID,{1 + 4 * i + j},,{80.0 * i:.1f},{30.0 * i + 60.0 * j:.1f},{4.0 * j * (3 - j):.1f}"
        for i, j in grids
    ]
    rows += [
        f"CQUAD4,{1 + 3 * i + j},1,{1 + 4 * i + j},{5 + 4 * i + j},{6 + 4 * i + j},{2 + 4 * i + j}"
        for i in range(9)
        for j in range(3)
    ]
    rows += ["PSHELL,1,1,3.0,1,,1", "SPC1,1,123456,1,THRU,4", "EIGRL,1,,,8"]
    rows += [f"MAT1,1,{e:.1f},,0.33,{rho:.4e}"]
    (folder / "wing.inc").write_text("\n".join(rows) + "\n")
    name = "clean" if store is None else "with_store"
    more = "" if store is None else f"$ the store\nCONM2,900,25,,{store:.5e}\n"
    deck = folder / f"{name}.bdf"
    deck.write_text(
        f"SOL 103\nCEND\nSPC = 1\nMETHOD = 1\nBEGIN BULK\nINCLUDE 'wing.inc'\n{more}ENDDATA\n"
    )
    return deck


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Both decks with their tests, whose shapes and frequencies are those of the truth."""
    folder = tmp_path_factory.mktemp("wing")
    for store in (None, STORE):
        deck = write(folder, E, RHO, store)
        truth = write(folder / "truth", *TRUTH[:2], store and TRUTH[2])
        trueup.solve(truth, 8).save(folder / f"solved_{deck.stem}")
        solved = folder / f"solved_{deck.stem}" / "result.h5"
        trueup.convert([solved], folder / f"{deck.stem}.unv")
    return folder


def configurations(folder: Path) -> list[dict[str, object]]:
    return [
        {"deck": folder / f"{name}.bdf", "test": folder / f"{name}.unv"}
        for name in ("clean", "with_store")
    ]


@pytest.fixture(scope="module")
def done(files: Path) -> trueup.UpdatedTogether:
    states = configurations(files)
    states[1]["measured_mass"] = trueup.solve(files / "truth" / "with_store.bdf", 1).mass
    found = trueup.update(
        parameters=[*SKIN, "store = CONM2 900 M"],
        configurations=states,
        residuals="frequencies, mass",
        frequency_sigma=0.001,
        deck_length_unit="mm",
    )
    assert isinstance(found, trueup.UpdatedTogether)
    return found


def test_two_states_tell_what_one_leaves_open(files: Path, done: trueup.UpdatedTogether) -> None:
    """The clean wing knows E/RHO alone; one of both that was weighed tells all."""
    alone = trueup.update(
        files / "clean.bdf", files / "clean.unv", SKIN, residuals="frequencies",
        deck_length_unit="mm",
    )  # fmt: skip
    assert any("stay as in the deck" in w for w in alone.warnings)
    known = trueup.update(
        parameters=SKIN,
        configurations=configurations(files),
        residuals="frequencies",
        deck_length_unit="mm",
    )
    assert not any("as in the deck" in w for w in known.warnings)
    found = {p.name: p.factor for p in done.parameters}
    assert found == pytest.approx({"stiffness": 0.9, "density": 1.15, "store": 1.3}, rel=5e-3)


def test_what_two_states_know_in_common_alone_is_put_back(files: Path) -> None:
    """Of E, RHO and the store two ratios are known, none by itself."""
    found = trueup.update(
        parameters=[*SKIN, "store = CONM2 900 M"],
        configurations=configurations(files),
        residuals="frequencies",
        deck_length_unit="mm",
    )
    assert {p.factor for p in found.parameters} == {1.0}
    assert {p.standard_error for p in found.parameters} == {None}
    (said,) = (w for w in found.warnings if "known together" in w)
    assert said.count("±") == 2
    assert not any(r.deck.diff for r in found.results.values())


def test_pairs_are_told_of_each_configuration(done: trueup.UpdatedTogether) -> None:
    assert [c.name for c in done.configurations] == ["clean", "with_store"]
    for c in done.configurations:
        own = [p for p in done.pairs if p.configuration == c.name]
        assert len(own) == c.test_modes == c.pairs == 8
        off = [abs(p.deviation_percent) for p in own if p.deviation_percent is not None]
        assert np.mean(off) == pytest.approx(c.mean_abs_deviation_percent)
        assert max(off) < 0.05 < 5.0 < c.mean_abs_deviation_percent_before
    assert "in 2 configurations, 16 of 16 test modes pair" in repr(done)


def test_standard_errors_are_those_of_both_tests(done: trueup.UpdatedTogether) -> None:
    """What each configuration's own result says of a shared parameter is the same."""
    for p in done.parameters:
        own = [q for r in done.results.values() for q in r.parameters if q.name == p.name]
        assert len(own) == (1 if p.name == "store" else 2)
        assert {(q.factor, q.standard_error, q.at_bound) for q in own} == {
            (p.factor, p.standard_error, p.at_bound)
        }


def test_each_deck_is_written_with_its_changed_cards_alone(
    files: Path, done: trueup.UpdatedTogether, tmp_path: Path
) -> None:
    folder = done.save(tmp_path / "run")
    diffs = {name: (folder / name / "changes.diff").read_text() for name in done.results}
    cards = {"clean": ["MAT1"], "with_store": ["MAT1", "CONM2"]}
    for name, diff in diffs.items():
        gone = [x[1:] for x in diff.splitlines() if x[:1] == "-" and x[:3] != "---"]
        assert sorted(x.split(",")[0] for x in gone) == sorted(cards[name])
        deck = folder / name / "deck"
        for file in ("wing.inc", f"{name}.bdf"):
            was, now = ((at / file).read_text().splitlines() for at in (files, deck))
            assert {*was} - {*now} <= {*gone}
        after = trueup.correlate(deck / f"{name}.bdf", files / f"{name}.unv", deck_length_unit="mm")
        assert after.summary.worst_deviation_percent < 0.05
    assert (folder / "clean/deck/wing.inc").read_text() == (
        folder / "with_store/deck/wing.inc"
    ).read_text()
    told = json.loads((folder / "result.json").read_text())
    assert told["schema"] == "trueup/update-configurations/1"
    assert [c["folder"] for c in told["configurations"]] == ["clean", "with_store"]
    assert (folder / "tables" / "pairs.csv").read_text().count("\n") == 17
    again = trueup.open_run(folder)
    assert again.to_dict() == done.to_dict() == told
    assert again.results["clean"].deck.diff == diffs["clean"]
    page = (folder / "report.html").read_text()
    assert 'href="with_store/report.html"' in page
    trueup.report(folder)
    assert (folder / "report.html").read_text() == page


STUDY = """
parameters = ["stiffness = MAT1 1 E", "store = CONM2 900 M"]
residuals = "frequencies"
deck_length_unit = "mm"

[[configurations]]
name = "as built"
deck = "clean.bdf"
test = ["clean.unv"]

[[configurations]]
deck = "with_store.bdf"
test = ["with_store.unv"]
exclude_test = [8]
parameters = ["density = MAT1 1 RHO"]
"""


def test_a_study_names_decks_and_tests(files: Path, tmp_path: Path) -> None:
    study = files / "study.toml"
    study.write_text(STUDY)
    out = tmp_path / "run"
    said = CliRunner().invoke(app, ["update", "--study", str(study), "--out", str(out)])
    assert said.exit_code == 0, said.output
    assert "Pairs of as built" in said.output
    assert "15 of 15 test modes pair" in " ".join(said.output.split())
    again = tmp_path / "again"
    more = CliRunner().invoke(
        app, ["update", "--study", str(out / "study.toml"), "--out", str(again), "-q"]
    )
    assert more.exit_code == 0, more.output
    one, two = (json.loads((f / "result.json").read_text()) for f in (out, again))
    assert one["parameters"] == two["parameters"]
    assert len(one["parameters"]) == 3
    alone = trueup.open_run(out / "with_store")
    assert [p.name for p in alone.parameters] == ["stiffness", "store", "density"]


def in_place(files: Path, folder: Path, study: str) -> tuple[Path, Result]:
    """Ask for both decks to be changed where they stand; the folder they are in."""
    here = folder / "in_place"
    shutil.copytree(files, here)
    (here / "study.toml").write_text("write_undetermined = true\nmax_iterations = 3\n" + study)
    words = ["update", "--study", str(here / "study.toml"), "--out", str(folder / "run"), "-ip"]
    return here, CliRunner().invoke(app, words)


def test_decks_are_changed_in_place_a_file_that_they_share_once(
    files: Path, tmp_path: Path
) -> None:
    whole = STUDY.replace("parameters = [", 'parameters = ["density = MAT1 1 RHO", ', 1)
    here, said = in_place(
        files, tmp_path, whole.replace('parameters = ["density = MAT1 1 RHO"]', "")
    )
    assert said.exit_code == 0, said.output
    now = {p.name: p.read_bytes() for p in here.iterdir() if p.suffix in (".inc", ".bdf", ".bak")}
    was = {name: (files / name).read_bytes() for name in now if (files / name).exists()}
    changed = {name for name in now if now[name] != was.get(name)}
    assert changed == {"wing.inc", "wing.inc.bak", "with_store.bdf", "with_store.bdf.bak"}
    assert now["wing.inc.bak"] == was["wing.inc"]
    assert now["wing.inc"] == (tmp_path / "run/as built/deck/wing.inc").read_bytes()
    for name, own in (("as built", ["wing.inc"]), ("with_store", ["with_store.bdf", "wing.inc"])):
        told = json.loads((tmp_path / "run" / name / "result.json").read_text())["in_place"]
        assert [Path(f).name for f in told["files"]] == own
        assert [Path(f).name for f in told["backups"]] == [f"{f}.bak" for f in own]
    assert said.output.replace("\n", "").count("changed in place") == 2


def test_a_shared_file_that_would_be_two_is_not_changed_in_place(
    files: Path, tmp_path: Path
) -> None:
    """The density is one configuration's own parameter, its card in the file that both include."""
    named = '"stiffness = MAT1 1 E", "store = CONM2 900 M"'
    here, said = in_place(files, tmp_path, STUDY.replace(named, '"skin = PSHELL 1 T"'))
    assert said.exit_code == 1, said.output
    assert "would be another file in each" in str(said.exception)
    assert all((here / p.name).read_bytes() == p.read_bytes() for p in files.glob("*.[bi]*"))
    assert not (tmp_path / "run").exists()
    assert not [*here.glob("*.bak")]


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"deck": "clean.bdf"}, "each of the configurations has its deck and test"),
        ({"parameters": ["MAT1 7 E"]}, "none of the cards that the parameters name"),
        ({"parameters": [*SKIN, "x = MAT1 7 E"]}, "none of the decks has a card"),
        ({"parameters": ()}, "no parameter is named"),
        ({"residuals": "mass"}, "the residual 'mass' needs what the structure weighs: give meas"),
    ],
)
def test_what_cannot_be_is_one_sentence(files: Path, change: dict, sentence: str) -> None:
    asked = {"parameters": SKIN, "configurations": configurations(files)} | change
    with pytest.raises(trueup.InputError, match=sentence):
        trueup.update(**asked, deck_length_unit="mm")


@pytest.mark.parametrize(
    ("first", "second", "sentence"),
    [
        ({}, {"test": ()}, "'with_store' names no test"),
        ({"name": "a/b"}, {}, "cannot be that of its folder"),
        ({"name": "with_store"}, {}, "two configurations have one name"),
        ({"name": "With_Store"}, {}, "differ by case only"),
        ({"parameters": ["s = MAT1 1 RHO"]}, {"parameters": ["s = MAT1 1 NU"]}, "one property"),
        ({"nodes": 3}, {}, "unknown key 'nodes'"),
    ],
)
def test_configurations_are_told_apart(
    files: Path, first: dict, second: dict, sentence: str
) -> None:
    one, two = configurations(files)
    two["name"] = "with_store"
    with pytest.raises(trueup.InputError, match=sentence):
        trueup.update(parameters=SKIN, configurations=[one | first, two | second])


def test_a_property_of_two_values_is_refused(files: Path, tmp_path: Path) -> None:
    other = write(tmp_path / "other", 1.01 * E, RHO, STORE)
    one, two = configurations(files)
    with pytest.raises(trueup.InputError, match="'stiffness': MAT1 1 E is 70000 in configuration"):
        trueup.update(
            parameters=SKIN, configurations=[one, two | {"deck": other}], deck_length_unit="mm"
        )


def test_other_verbs_look_at_one_deck(files: Path) -> None:
    study = trueup.Study(parameters=SKIN, configurations=configurations(files))
    for verb in (trueup.correlate, trueup.discover, trueup.parameters):
        with pytest.raises(trueup.InputError, match="one configuration"):
            verb(study=study)


def test_a_relation_counts_once_whatever_the_number_of_configurations(files: Path) -> None:
    """Two configurations of one test say no more of a relation than the relation itself."""
    clean = configurations(files)[0]
    asked = {"parameters": SKIN, "deck_length_unit": "mm", "max_iterations": 1}
    known = {"relations": "stiffness / density = 3e13 ± 1e12"}

    def due(states: list[dict[str, object]], **more: object) -> float:
        done = trueup.update(configurations=states, **asked, **more)
        return float(done.history[0].objective)

    for states in ([clean], [clean, clean | {"name": "again"}]):
        alone = due(states, residuals="frequencies")
        both = due(states, residuals="frequencies, relations", **known)
        assert both - alone == pytest.approx(((E / RHO - 3e13) / 1e12) ** 2)


def test_a_relation_may_be_of_what_one_deck_has(files: Path) -> None:
    asked = {
        "parameters": [*SKIN, "store = CONM2 900 M"],
        "configurations": configurations(files),
        "residuals": "frequencies, relations",
        "frequency_sigma": 0.001,
        "deck_length_unit": "mm",
        "regularisation": 0.0,
    }
    done = trueup.update(relations=f"store = {TRUTH[2]!r} ± {TRUTH[2] / 1000!r}", **asked)
    assert [p.standard_error is None for p in done.parameters] == [False] * 3
    values = [p.updated[0] for p in done.parameters]
    np.testing.assert_allclose(values, TRUTH, rtol=5e-3)
    with pytest.raises(trueup.InputError, match="which is no parameter"):
        trueup.update(relations="shop = 1 ± 1", **asked)
