"""Parameters as design variables of SOL 200: written from a study, read back, read by others."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.verbs.updating.test_measured_beside import TRUTH, E

import trueup
from trueup.core.errors import InputError

ASKED = ("stiffness = MAT1 1 E [0.5, 3]", "MAT1 1 RHO, CONM2 90 M", "PBAR 1 I1")
OWN = """\
DESVAR,7,BEND,2.,1.,8.
DVPREL1,1,PBAR,1,5
,7,3000.
DESVAR,8,YOUNG,1.,.5
DVMREL1,2,MAT1,1,E
,8,PVAL
"""


@pytest.fixture
def told(files: tuple[Path, Path]) -> trueup.MovableParameters:
    return trueup.parameters(*files, ASKED, deck_length_unit="mm", frequency_sigma=0.01)


def with_cards(deck: Path, cards: str) -> Path:
    deck.write_text(deck.read_text().replace("ENDDATA", cards + "ENDDATA"))
    return deck


def test_the_deck_comes_back_with_its_parameters(told: trueup.MovableParameters, tmp_path: Path):
    told.save(tmp_path / "run")
    again = trueup.parameters(tmp_path / "run" / "sol200" / "bar.bdf")
    cards = {c.name: c.cards for c in again.candidates}
    assert cards == {
        "STIFFNES": ("MAT1 1 E",), "MAT11RHO": ("MAT1 1 RHO", "CONM2 90 M"),
        "PBAR1I1": ("PBAR 1 I1",),
    }  # fmt: skip
    hz = trueup.solve(tmp_path / "run" / "sol200" / "bar.bdf", 6).modes
    assert list(hz) == list(trueup.solve(tmp_path / "bar.bdf", 6).modes)


def test_the_objective_is_that_of_the_update(
    told: trueup.MovableParameters, files: tuple[Path, Path]
):
    """Equation (2) at the deck and off it, by the text of the DEQATN as it stands."""
    assert told.sol200 is not None
    lines = [x[1:] for x in told.sol200.diff.splitlines() if x.startswith("+")]
    first = next(k for k, x in enumerate(lines) if x.startswith("DEQATN"))
    assert max(map(len, lines[first:])) <= 72
    text = lines[first][16:] + "".join(x[8:] for x in lines[first + 1 :])
    arguments, body = re.fullmatch(r"J\((.*?)\)=(.*)", text).groups()
    pairs = trueup.correlate(*files, deck_length_unit="mm").pairs
    aims = [x.split() for x in lines if x.startswith("DRESP1")]
    assert [int(a[4]) for a in aims] == [p.analysis for p in pairs]
    values = [1.0, 1.1, 0.9, *(p.analysis_hz for p in pairs)]
    names = arguments.split(",")
    due = sum((((p.analysis_hz / p.test_hz) ** 2 - 1.0) / 0.01) ** 2 for p in pairs)
    due += 0.01 * (0.1**2 + 0.1**2)
    assert eval(body, dict(zip(names, values, strict=True))) == pytest.approx(due, rel=1e-6)


def test_pynastran_reads_it(told: trueup.MovableParameters, tmp_path: Path):
    bdf = pytest.importorskip("pyNastran.bdf.bdf", reason="pyNastran is not for this Python")
    assert told.sol200 is not None
    model = bdf.BDF(debug=None)
    model.read_bdf(told.sol200.write(tmp_path / "out"))
    assert model.sol == 200
    assert [v.label for v in model.desvars.values()] == ["STIFFNES", "MAT11RHO", "PBAR1I1"]
    assert (len(model.dvmrels), len(model.dvcrels), len(model.dvprels)) == (2, 1, 1)
    assert model.desvars[1].xlb == 0.5
    assert model.dvmrels[1].coeffs == [E]
    assert model.modtrak.high_range == 6
    case = model.subcases[0]
    assert case.get_parameter("ANALYSIS")[0] == "MODES"
    assert case.get_parameter("DESOBJ")[0] == len(model.dresps)


def test_design_variables_are_the_parameters_of_an_update(files: tuple[Path, Path]):
    deck, test = files
    done = trueup.update(
        with_cards(deck, OWN), test, deck_length_unit="mm", residuals="frequencies",
        write_undetermined=True,
    )  # fmt: skip
    assert [(q.name, q.cards) for q in done.parameters] == [
        ("BEND", ("PBAR 1 I1",)), ("YOUNG", ("MAT1 1 E",)),
    ]  # fmt: skip
    assert done.study.parameters == ("BEND = PBAR 1 I1 [0.5, 4]", "YOUNG = MAT1 1 E [0.5, 5]")
    a, b = (q.factor for q in done.parameters)
    assert a * b == pytest.approx(TRUTH[0], rel=0.02)


@pytest.mark.parametrize(
    ("cards", "why"),
    [
        ("DESVAR,7,A,2.\nDVPREL1,1,PBAR,1,I1,,,6.\n,7,3000.\n", "is not proportional"),
        ("DESVAR,7,A,2.\nDVPREL1,1,PBAR,1,I1\n,7,1.,7,2.\n", "several design variables move"),
        ("DESVAR,7,A,2.\nDVPREL1,1,PBAR,1,I1\n,7,3100.\n", "its design variable says 6200"),
        ("DVPREL1,1,PBAR,1,I1\n,7,3100.\n", "there is no DESVAR 7"),
        ("DESVAR,7,A,2.\nDVPREL1,1,PBAR,2,I1\n,7,3000.\n", "PBAR 2"),
        ("DESVAR,7,A,two\nDVPREL1,1,PBAR,1,I1\n,7,3000.\n", "'TWO' is no real number"),
        ("DESVAR,7,A,2.\nDVPREL1,1,PFOO,1,3\n,7,3000.\n", "field 3 of PFOO 1"),
    ],
)
def test_what_is_no_parameter_is_said(files: tuple[Path, Path], cards: str, why: str):
    with pytest.raises(InputError, match="no parameter is named") as refused:
        trueup.update(with_cards(files[0], cards), files[1], deck_length_unit="mm")
    assert why in str(refused.value)
    assert "bar.bdf line" in str(refused.value)


def test_a_deck_with_design_variables_is_not_given_others(files: tuple[Path, Path]):
    told = trueup.parameters(
        with_cards(files[0], OWN), files[1], ["MAT1 1 RHO"], deck_length_unit="mm"
    )
    assert told.sol200 is None
    assert any("no deck for SOL 200 was made: bar.bdf has DESVAR" in w for w in told.warnings)
