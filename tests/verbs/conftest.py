"""What several tests of updating work on."""

from pathlib import Path

import pytest
from tests.verbs.updating.test_measured_beside import TRUTH, E, cantilever

import trueup


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """A cantilever and the test of a stiffer one."""
    deck, truth, test = (tmp_path / n for n in ("bar.bdf", "truth.bdf", "test.unv"))
    deck.write_text(cantilever())
    truth.write_text(cantilever(TRUTH[0] * E))
    trueup.solve(truth, 6).save(tmp_path / "solved")
    trueup.convert([tmp_path / "solved" / "result.h5"], test)
    return deck, test
