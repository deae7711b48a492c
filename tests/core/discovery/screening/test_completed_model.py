"""A model completed by what was found: one that does not solve, what is written."""

from dataclasses import dataclass, field

import pytest

from trueup.core.discovery.findings import Discovery, MovedParameter
from trueup.core.discovery.screening.completed_model import borne_out, upheld, written
from trueup.core.errors import CheckError


@dataclass(frozen=True)
class Said:
    verdict: str
    findings: tuple = ()
    would_decide: tuple = field(default=("a sensor",))
    parameters: tuple = ()
    proposal: bool = False
    posterior: float = 0.9

    completes = Discovery.completes
    adopted = Discovery.adopted


@dataclass(frozen=True)
class Named:
    kind: str
    confidence: float = 0.9


@dataclass(frozen=True)
class Paired:
    test: int
    deviation_percent: float


@dataclass(frozen=True)
class Pairs:
    pairs: tuple


MASS = Said("effect", (Named("point_mass"), Named("sensor_swap")))
BEFORE = Pairs((Paired(0, -4.0), Paired(1, 2.0)))


def test_a_completed_deck_that_does_not_solve_is_the_findings_fault():
    def complete(found):
        if found.verdict == "effect":
            raise CheckError("the model is a mechanism")
        return "the deck as it is"

    found, done = upheld(MASS, complete)
    assert done == "the deck as it is"
    assert found.verdict == "undecided"
    assert [f.kind for f in found.findings] == ["point_mass", "sensor_swap"]
    assert [f.confidence for f in found.findings] == [0.4, 0.9]
    assert found.posterior == 0.4
    assert "completed as found, the model is a mechanism" in found.would_decide[0]


def test_a_proposal_that_does_not_solve_is_none():
    def complete(found):
        if found.completes:
            raise CheckError("the model is a mechanism")
        return "the deck as it is"

    found, done = upheld(Said("undecided", (Named("point_mass"),), proposal=True), complete)
    assert (done, found.proposal) == ("the deck as it is", False)


def test_a_deck_that_never_solved_is_not():
    def complete(_):
        raise CheckError("the model is a mechanism")

    with pytest.raises(CheckError, match="mechanism"):
        upheld(Said("no_gap"), complete)


@pytest.mark.parametrize(
    "after",
    [
        pytest.param((Paired(0, 3.5), Paired(1, -2.0)), id="frequencies stay as far off"),
        pytest.param((Paired(1, -0.1),), id="a mode no longer pairs"),
    ],
)
def test_a_claim_whose_deck_is_no_nearer_to_the_test_is_a_proposal(after):
    found = borne_out(MASS, BEFORE, Pairs(after), 4)
    assert (found.verdict, found.proposal, found.posterior) == ("undecided", True, 0.4)
    assert "hardly less off" in found.would_decide[0]


@pytest.mark.parametrize(
    "after",
    [
        pytest.param((Paired(0, 1.0), Paired(1, -1.0)), id="frequencies come nearer"),
        pytest.param((Paired(0, 4.0), Paired(1, 2.0), Paired(2, 9.0)), id="another mode pairs"),
    ],
)
def test_a_claim_whose_deck_is_nearer_stays(after):
    assert borne_out(MASS, BEFORE, Pairs(after), 4) is MASS


def test_a_dashpot_shows_in_the_damping():
    dashpot = Said("effect", (Named("local_damper"),))
    assert borne_out(dashpot, BEFORE, BEFORE, 4) is dashpot


@pytest.mark.parametrize(
    ("verdict", "proposal"),
    [("no_gap", False), ("test_fault", False), ("parameters_only", True)],
)
def test_nothing_is_said_to_be_missing_where_hardly_a_mode_pairs(verdict, proposal):
    """A node 50 m off, a test whose directions were exchanged: 0 of 10 pair, and no gap it was."""
    said = Said(verdict)
    assert borne_out(said, BEFORE, BEFORE, 4) is said
    found = borne_out(said, BEFORE, BEFORE, 5)
    assert (found.verdict, found.proposal, found.posterior) == ("undecided", proposal, 0.4)
    assert "than 2 of 5" in found.would_decide[0]


CLEAR = MovedParameter(0, 1.5, 0.1, True, 1.4)
VAGUE = MovedParameter(1, 1.3, 0.4, False, 1.3)
TINY = MovedParameter(2, 1.001, 0.0001, True, 1.001)


@pytest.mark.parametrize(
    ("adopt", "factors"),
    [("significant", [1.5, 1.0, 1.0]), ("all", [1.4, 1.3, 1.0]), ("none", [1.0, 1.0, 1.0])],
)
def test_what_is_written_of_the_known_parameters(adopt, factors):
    said = Said("parameters_only", parameters=(CLEAR, VAGUE, TINY))
    assert [m.written for m in written(said, adopt).parameters] == factors
    proposed = Said("undecided", parameters=(CLEAR, VAGUE, TINY), proposal=True)
    assert [m.written for m in written(proposed, adopt).parameters] == factors
    undecided = Said("undecided", parameters=(CLEAR, VAGUE, TINY))
    assert [m.written for m in written(undecided, adopt).parameters] == [1.0] * 3
