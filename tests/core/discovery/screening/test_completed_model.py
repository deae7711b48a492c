"""A model completed by what was found: one that does not solve, what is written."""

from dataclasses import dataclass, field

import pytest

from trueup.core.discovery.findings import Discovery, MovedParameter
from trueup.core.discovery.screening.completed_model import upheld, written
from trueup.core.errors import CheckError


@dataclass(frozen=True)
class Said:
    verdict: str
    findings: tuple = ()
    would_decide: tuple = field(default=("a sensor",))
    parameters: tuple = ()
    proposal: bool = False

    completes = Discovery.completes
    adopted = Discovery.adopted


MASS = Said("effect", ("a mass",))


def test_a_completed_deck_that_does_not_solve_is_the_findings_fault():
    def complete(found):
        if found.verdict == "effect":
            raise CheckError("the model is a mechanism")
        return "the deck as it is"

    found, done = upheld(MASS, complete)
    assert done == "the deck as it is"
    assert found.verdict == "undecided"
    assert found.findings == MASS.findings
    assert "completed as found, the model is a mechanism" in found.would_decide[0]


def test_a_proposal_that_does_not_solve_is_none():
    def complete(found):
        if found.completes:
            raise CheckError("the model is a mechanism")
        return "the deck as it is"

    found, done = upheld(Said("undecided", ("two masses",), proposal=True), complete)
    assert (done, found.proposal) == ("the deck as it is", False)


def test_a_deck_that_never_solved_is_not():
    def complete(_):
        raise CheckError("the model is a mechanism")

    with pytest.raises(CheckError, match="mechanism"):
        upheld(Said("no_gap"), complete)


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
