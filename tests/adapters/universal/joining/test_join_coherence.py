"""Coherence in the file of the functions or beside it reaches what identification names."""

import numpy as np
import pytest

from trueup.adapters.universal import read_universal, write_universal
from trueup.adapters.universal.joining.join_coherence import coherence_of
from trueup.adapters.universal.universal_content import Function
from trueup.core.data.dofs import Dofs
from trueup.core.data.frfs import Frfs
from trueup.core.identification.survey.modal_synthesis import modal_response, poles_from
from trueup.verbs.identify import identify

LINES = np.arange(10.0, 60.0, 0.1)


@pytest.fixture(scope="module")
def frfs():
    shapes = np.random.default_rng(0).standard_normal((6, 3))
    poles = poles_from(np.array([20.0, 32.0, 47.0]), np.full(3, 0.01))
    values = modal_response(LINES, poles, shapes, shapes[[0, 5]] / (2j * poles.imag))
    rng = np.random.default_rng(1)
    values = values + 1e-3 * np.abs(values).std() * rng.standard_normal(values.shape)
    dofs = Dofs(np.arange(1, 7), np.full(6, 3))
    return Frfs(LINES, dofs, dofs.take(np.array([0, 5])), values)


def coherence(response, reference, level, lines=LINES, kind="coherence"):
    return Function(
        kind, lines, np.full(len(lines), level), response, reference, over="frequency",
        abscissa_unit="Hz", codes=(6 if kind == "coherence" else 26, 18, 0, 0),
    )  # fmt: skip


def all_but_one_high(low):
    return [coherence((o, 3), (i, 3), low if (o, i) == (4, 6) else 0.98)
            for o in range(1, 7) for i in (1, 6)]  # fmt: skip


@pytest.mark.parametrize("binary", [False, True])
@pytest.mark.parametrize("apart", [False, True])
def test_low_coherence_is_named_from_one_file_or_two(frfs, tmp_path, binary, apart):
    first, second = tmp_path / "frf.unv", tmp_path / "coherence.unv"
    functions = all_but_one_high(0.4)
    if apart:
        write_universal(first, frfs=frfs, binary=binary)
        write_universal(second, functions=functions, binary=binary)
    else:
        write_universal(first, frfs=frfs, functions=functions, binary=binary)
    found = identify([first, second] if apart else first)
    (fault,) = found.faults
    assert (fault.kind, fault.functions) == ("low_coherence", ("4:Z/6:Z",))
    assert fault.sentence in found.warnings
    assert found.to_dict()["faults"][0]["functions"] == ["4:Z/6:Z"]


def test_high_coherence_is_no_fault(frfs, tmp_path):
    write_universal(tmp_path / "frf.unv", frfs=frfs, functions=all_but_one_high(0.95))
    assert identify(tmp_path / "frf.unv").faults == ()


def test_other_lines_signs_multiple_coherence_and_strays(frfs, tmp_path):
    functions = [
        coherence((2, -3), (1, 3), 0.5, np.arange(20.0, 50.0, 0.25)),
        coherence((3, 3), (0, 0), 0.6, kind="multiple coherence"),
        coherence((99, 3), (1, 3), 0.7),
    ]
    write_universal(tmp_path / "frf.unv", frfs=frfs, functions=functions)
    found, said = coherence_of(read_universal([tmp_path / "frf.unv"]))
    inside = (found.frequencies_hz >= 20.0) & (found.frequencies_hz <= 49.75)
    assert np.allclose(found.values[1, 0, inside], 0.5)
    assert np.isnan(found.values[1, 0, ~inside]).all()
    assert np.allclose(found.values[2], 0.6)
    assert np.isfinite(found.values).any(axis=2).sum() == 3
    assert said == ("1 of 3 coherence functions belong to no frequency response",)
