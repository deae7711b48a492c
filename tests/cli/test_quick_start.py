"""What inspect and solve of a small deck leave unimported: it would take longer than their work."""

import subprocess
import sys

import pytest

DECK = "GRID,1,,,,,,123456\nGRID,2,,1.\nCROD,1,1,1,2\nPROD,1,1,1.\nMAT1,1,1.,,.3,1.\n"
HEAVY = "h5py scipy.signal scipy.stats scipy.optimize scipy.spatial pyNastran trueup.core.discovery"


@pytest.mark.parametrize(("verb", "heavy"), [("inspect", HEAVY), ("solve", HEAVY)])
def test_a_verb_imports_no_more_than_it_needs(tmp_path, verb, heavy):
    (tmp_path / "rod.bdf").write_text(DECK)
    told = f"import sys, trueup\ntrueup.{verb}('rod.bdf')\nprint(*sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", told], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert not set(heavy.split()) & set(done.stdout.split())
