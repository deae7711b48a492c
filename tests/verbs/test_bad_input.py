"""What is no input of a verb is refused in one sentence of the family, never a bare exception."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trueup
from trueup.core.data.parameter import Parameter
from trueup.verbs.studies.study import Study

DUCT = Path(__file__).parents[2] / "fixtures" / "duct"
DECK, TEST = DUCT / "duct.bdf", DUCT / "duct_test.unv"
NO_PATHS = [None, 3, np.zeros(2), {}, object(), b"duct.bdf", "a\x00b"]
verb: Any = trueup


@pytest.fixture(scope="module")
def found() -> trueup.Correlated:
    return trueup.correlate(DECK, TEST, deck_length_unit="mm")


@pytest.fixture(scope="module")
def solved() -> trueup.Solved:
    return trueup.solve(DECK, 3)


@pytest.mark.parametrize(
    "given", NO_PATHS, ids=lambda o: "object" if type(o) is object else repr(o)
)
@pytest.mark.parametrize(
    "name", ["read", "open_run", "report", "read_deck", "read_test", "solve", "inspect", "identify"]
)
def test_what_is_no_path_is_refused(name: str, given: object) -> None:
    with pytest.raises(trueup.InputError, match=r"is given as|no file of a test|give a deck|pyuff"):
        getattr(verb, name)(given)


@pytest.mark.parametrize(
    ("noun", "given", "wrong"),
    [
        ("Dofs", (1, 2), r"node of Dofs has shape \(\), expected \(n,\)"),
        ("Dofs", ([1], [7]), "component of Dofs must be 1 to 3"),
        ("Dofs", ([1], [1], [1, 2]), r"axis of Dofs has shape \(2,\), expected \(1, 3\)"),
        ("Geometry", ("a", "b"), "ids of Geometry must be an array of numbers"),
        ("Geometry", ([1], [[0, 0, 0]], None, 3), "elements of Geometry is given as int"),
        ("Geometry", ([1], [[0, 0, 0]], None, {"tria": "a"}), "elements of Geometry must be"),
        ("Modes", (1, 2, 3), "dofs of Modes is given as int; it must be Dofs"),
        ("Modes", ([1.0], [["a"]], trueup.Dofs([1], [1])), "mode shapes of modes must be an array"),
        ("Frfs", (1, 2, 3, 4), "responses of Frfs is given as int"),
        ("Measurement", (1,), "geometry of Measurement is given as int"),
        ("Measurement", (trueup.Geometry([1], [[0, 0, 0]]), 1), "Modes of Measurement is given"),
        ("Model", (1, 2, 3, 4, 5), "geometry of Model is given as int"),
    ],
)
def test_what_makes_no_noun_is_refused(noun: str, given: tuple[Any, ...], wrong: str) -> None:
    with pytest.raises(trueup.InputError, match=wrong):
        getattr(verb, noun)(*given)


@pytest.mark.parametrize("bounds", [(3.0, 1.0), (0.0, 1.0), (1.0, 1.0), (float("nan"), 2.0)])
def test_bounds_with_nothing_between_are_refused(bounds: tuple[float, float]) -> None:
    with pytest.raises(trueup.InputError, match="PSHELL 1 T: bounds"):
        Parameter("PSHELL 1 T", ("PSHELL 1 T",), (1.0,), *bounds)


@pytest.mark.parametrize("name", ["solve", "update", "discover"])
def test_a_progress_that_cannot_be_told_is_refused(name: str) -> None:
    given = (DECK,) if name == "solve" else (DECK, TEST)
    with pytest.raises(trueup.InputError, match="progress is 3; give a function"):
        getattr(verb, name)(*given, progress=3)


@pytest.mark.parametrize("name", ["read", "open_run", "report"])
def test_a_list_of_nothing_is_refused(name: str) -> None:
    with pytest.raises(trueup.InputError):
        getattr(verb, name)([])


@pytest.mark.parametrize(
    "call",
    [
        lambda: verb.solve(DECK, numbr=3),
        lambda: verb.identify(TEST, numbr=3),
        lambda: verb.inspect(DECK, numbr=3),
        lambda: verb.convert(DECK, "a.h5", numbr=3),
    ],
)
def test_a_keyword_that_is_none_is_named(call: Callable[[], object]) -> None:
    with pytest.raises(trueup.InputError, match=r"\w+: unknown key 'numbr'; (did|known)"):
        call()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"mac_min": "a"}, "Study: 'mac_min' has a value of the wrong type: 'a'"),
        ({"mac_min": 10**400}, "'mac_min' must be a finite number"),
        ({"regularisation": float("nan")}, "'regularisation' must be a finite number"),
        ({"frequency_tolerance": float("inf")}, "'frequency_tolerance' must be a finite number"),
    ],
)
def test_a_study_holds_values_of_its_types(given: dict[str, Any], said: str) -> None:
    with pytest.raises(trueup.InputError, match=said):
        trueup.Study(**given)
    assert trueup.Study(deck="a.bdf", mac_min=1).deck == Path("a.bdf")  # type: ignore[arg-type]


def test_a_format_is_named_by_a_word(tmp_path: Path) -> None:
    with pytest.raises(trueup.InputError, match="'to' has a value of the wrong type: 3"):
        verb.convert(DECK, tmp_path / "a.h5", to=3)


@pytest.mark.parametrize("folder", [None, 3, "a\x00b"])
def test_a_result_is_saved_to_a_path(found: trueup.Correlated, folder: Any) -> None:
    for write in (found.save, found.pairs.to_csv, found.mac.to_csv):
        with pytest.raises(trueup.InputError, match="is given as"):
            write(folder)


def test_what_cannot_be_written_is_said(found: trueup.Correlated, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(trueup.InputError, match=r"x cannot be written: \w+"):
        found.save(tmp_path / "file" / "x")
    with pytest.raises(trueup.InputError, match="cannot write"):
        found.pairs.to_csv(tmp_path)


def test_the_library_asks_in_its_own_words(solved: trueup.Solved, tmp_path: Path) -> None:
    solved.save(tmp_path / "run")
    with pytest.raises(trueup.InputError, match="exists; give force=True to replace it"):
        solved.save(tmp_path / "run")
    again = trueup.open_run(solved.save(tmp_path / "run", force=True))
    assert isinstance(again, trueup.Solved)
    assert again.to_dict() == solved.to_dict()
    assert np.array_equal(again.shapes.shapes, solved.shapes.shapes)
    done = trueup.convert(DECK, tmp_path / "k.op4")
    assert done._repr_html_() is None
    with pytest.raises(trueup.InputError, match="exists; give force=True"):
        trueup.convert(DECK, tmp_path / "k.op4")


def test_rotate_none_rotates_nothing(found: trueup.Correlated) -> None:
    plain = trueup.correlate(DECK, TEST, deck_length_unit="mm", rotate=None)
    assert (found.criteria.rotate, plain.criteria.rotate) == ("analysis", "none")


def test_shapes_of_one_mode(found: trueup.Correlated) -> None:
    pytest.importorskip("matplotlib")
    one = found.pairs[0].test
    assert len(found.plot.shapes(one).axes) == 1
    with pytest.raises(trueup.InputError, match="test mode 99 has no partner"):
        found.plot.shapes(99)
    for odd in ("first", 1.5, [None, 1]):
        with pytest.raises(trueup.InputError, match="give mode numbers"):
            found.plot.misfit(odd)


def test_several_files_are_a_test() -> None:
    test = trueup.read([TEST])
    assert isinstance(test, trueup.ModalTest)
    assert isinstance(test, trueup.Measurement)
    assert trueup.read_test(test) is test


def test_what_is_long_is_shown_in_part(found: trueup.Correlated) -> None:
    page = found.mac._repr_html_()
    assert page.count("<tr>") == 13
    assert f"24 test modes and {len(found.mac.analysis)} analysis modes" in page
    assert len(page) < 6000
    assert repr(Study()) == "Study()"
    assert repr(Study(mac_min=0.8)) == "Study(mac_min=0.8)"
