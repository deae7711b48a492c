"""Damping and frequency responses in result.json."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace as Any

import numpy as np
import pytest
import scipy.sparse as sp

from trueup.adapters.universal import read_test
from trueup.core.discovery.findings import ModalDamping, ResponseGap
from trueup.core.discovery.screening.completed_model import SolvedModel
from trueup.core.results.evidence import damping_table, response_table
from trueup.core.results.plain import plain

DUCT = Path(__file__).resolve().parents[3].parent / "shared" / "data" / "cases" / "duct"


@pytest.mark.skipif(not DUCT.is_dir(), reason="../shared/data is absent")
def test_responses_keep_the_axes_of_their_own_file():
    import trueup

    alone = read_test([DUCT / "duct_frf.unv"]).frfs
    both = trueup.read_test([DUCT / "duct_test.unv", DUCT / "duct_frf.unv"])
    assert both.modes is not None
    assert both.frfs is not None
    np.testing.assert_array_equal(both.frfs.responses.axis, alone.responses.axis)
    np.testing.assert_array_equal(both.frfs.values, alone.values)


ALL = np.ones(3, bool)


def told(*args):
    return plain(damping_table(*args))


def side(D, pairs):
    correlation = Any(pairs=[Any(test=t, analysis=a) for t, a in pairs])
    solution = Any(vectors=np.eye(2), eigenvalues=np.array([1.0, 16.0]))
    return SolvedModel(Any(correlation=correlation), solution, D)


def test_a_dashpot_shows_in_the_ratio_of_the_mode_that_feels_it():
    found = Any(damping=ModalDamping((0.02, 0.02, 0.02), (0.01, 0.01, 0.01)))
    D = sp.csr_matrix(np.diag([0.0, 0.32]))
    measured = np.array([0.01, 0.05, np.nan])
    pairs = [(0, 0), (1, 1)]
    out = told(found, measured, ALL, side(None, pairs), side(D, pairs))
    assert [m["test"] for m in out["modes"]] == [1, 2]
    first, second = out["modes"]
    assert first["after"] == pytest.approx(0.01)
    assert second["before"] == pytest.approx(0.02)
    assert second["after"] == pytest.approx(0.01 + 0.32 / 8.0)
    assert out["typical_factor"]["after"] == pytest.approx(1.0)
    assert out["typical_factor"]["before"] == pytest.approx(np.sqrt(2.0 * 2.5))


def test_a_mode_without_a_partner_has_no_ratio_foretold():
    found = Any(damping=ModalDamping((0.02, 0.02), (0.01, 0.01)))
    D = sp.csr_matrix(np.diag([0.0, 0.32]))
    out = told(found, np.array([0.01, 0.05]), ALL[:2], side(D, [(0, 0)]), side(D, []))
    assert out["modes"][1]["before"] is None
    assert out["typical_factor"]["after"] is None


def test_without_dashpots_damping_says_nothing():
    found = Any(damping=ModalDamping((0.02,), (0.02,)))
    assert damping_table(found, np.array([0.01]), ALL[:1], side(None, []), side(None, [])) is None
    assert (
        damping_table(Any(damping=None), np.array([0.01]), ALL[:1], side(None, []), side(None, []))
        is None
    )


def test_responses_are_told_one_by_one():
    gap = ResponseGap(("1:X", "2:Z"), ("3:X",), 50, 7.5, (0.2, 0.4), (0.8, 0.9), (1.0, 0.8, 0.3))
    out = plain(response_table(gap))
    assert out["responses"][1] == {"sensor": "2:Z", "before": 0.4, "after": 0.9}
    assert out["mean_frac"] == {"before": pytest.approx(0.3), "after": pytest.approx(0.85)}
    assert out["log_misfit"] == {"before": 1.0, "parameters": 0.8, "after": 0.3}
