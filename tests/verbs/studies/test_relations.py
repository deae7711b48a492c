"""Ratios and sums of parameters that are known, beside a test that leaves them open."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.verbs.updating.test_measured_beside import TRUTH, E, files

import trueup
from trueup.core.data.parameter import Parameter
from trueup.core.errors import InputError
from trueup.core.updating.residuals import RESIDUALS, Beside, Seen, Slopes
from trueup.verbs.studies.relations import read_relation

__all__ = ["files"]
RELATIONS = next(r for r in RESIDUALS if r.name == "relations")
PARAMETERS = (
    Parameter("PSHELL 3 12I/T**3", ("PSHELL 3 12I/T**3",), (2.0,)),
    Parameter("front", ("PBAR 1 I1", "PBAR 2 I1"), (4.0, 4.0)),
    Parameter("rear", ("PBAR 3 I1",), (8.0,)),
    Parameter("mixed", ("PBAR 4 I1", "PBAR 5 I1"), (1.0, 2.0)),
)


def seen(p: np.ndarray, *texts: str) -> Seen:
    none = np.zeros((0, 0))
    known = tuple(read_relation(t, PARAMETERS) for t in texts)
    return Seen(None, p, (), np.zeros(0), none, none, Beside(relations=known))  # type: ignore[arg-type]


def test_sums_and_ratios_of_values_and_their_derivatives() -> None:
    texts = ("front + rear - PSHELL 3 12I/T**3 = 9 ± 0.5", "rear / front = 2.5 +- 0.1",
             "front / front + rear = 0.3 ± 1")  # fmt: skip
    p, step = np.array([1.1, 1.2, 0.9, 1.0]), 1e-6
    values = RELATIONS.value(seen(p, *texts))[:, 0]
    front, rear, shell = 4.8, 7.2, 2.2
    known = [(front + rear - shell - 9.0) / 0.5, (rear / front - 2.5) / 0.1]
    np.testing.assert_allclose(values, [*known, front / (front + rear) - 0.3])
    slopes = Slopes((0, 1, 2), np.zeros((0, 3)), None)
    found = RELATIONS.derivative(seen(p, *texts), slopes)
    for k, e in enumerate(np.eye(4)[:3] * step):
        ahead, behind = (RELATIONS.value(seen(q, *texts)) for q in (p + e, p - e))
        np.testing.assert_allclose(found[:, :, k], (ahead - behind) / (2 * step), rtol=1e-6)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("front / rear", "cannot be understood"),
        ("front = 3 ± x", "cannot be understood"),
        ("front / rear = 3 ± 0", "above 0"),
        ("front / rear / front = 3 ± 1", "more than two"),
        ("frnt / rear = 3 ± 1", "names 'frnt', which is no parameter; did you mean 'front'"),
        ("front / rear = nan ± 1", "no finite number"),
        ("front / rear = 3 ± inf", "no finite number"),
        ("mixed + rear = 3 ± 1", "mixed moves several values"),
    ],
)
def test_what_is_wrong_with_a_relation_is_said(text: str, says: str) -> None:
    with pytest.raises(InputError, match=says):
        read_relation(text, PARAMETERS)


def test_a_known_value_sets_the_scale_that_frequencies_leave_open(
    files: tuple[Path, Path],
) -> None:
    """Modulus and density together: the test tells their ratio, the relation one of them."""
    names = ["stiff = MAT1 1 E", "dense = MAT1 1 RHO"]
    asked = {"deck_length_unit": "mm", "regularisation": 0.0}
    done = trueup.update(
        *files, names, residuals="frequencies, relations",
        relations=f"stiff = {TRUTH[0] * E!r} ± 5", **asked,
    )  # fmt: skip
    np.testing.assert_allclose([p.factor for p in done.parameters], TRUTH, rtol=1e-3)
    assert done.study.relations == (f"stiff = {TRUTH[0] * E!r} ± 5",)


def test_relations_are_asked_for(files: tuple[Path, Path]) -> None:
    with pytest.raises(InputError, match="give relations"):
        trueup.update(*files, "MAT1 1 E", residuals="relations", deck_length_unit="mm")


@pytest.mark.parametrize(
    ("given", "residual"),
    [
        ({"relations": "MAT1 1 E = 7e4 ± 5"}, "relations"),
        ({"measured_mass": 1.0}, "mass"),
        ({"measured_centre_of_gravity": (0.0, 0.0, 0.0)}, "centre_of_gravity"),
        ({"load_cases": [{"loads": ["13:+Z=50"], "readings": ["13:+Z=1"]}]}, "deflections"),
    ],
)
def test_what_no_residual_reads_is_refused(
    files: tuple[Path, Path], given: dict[str, object], residual: str
) -> None:
    with pytest.raises(InputError, match=f"does not name '{residual}'"):
        trueup.update(*files, "MAT1 1 E", deck_length_unit="mm", **given)
