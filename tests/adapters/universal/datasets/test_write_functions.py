"""Functions of any kind written to 58 and 58b: read back equal, by trueup and by pyuff."""

from pathlib import Path

import numpy as np
import pytest
import pyuff

from trueup.adapters.universal import Function, read_universal, write_universal
from trueup.core.errors import InputError

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data" / "uff"
FILES = [p for p in sorted(DATA.glob("*")) if p.suffix != ".mail"] if DATA.is_dir() else []
N = 37
RNG = np.random.default_rng(4)


def function(even, is_complex, kind="coherence"):
    x = 5.0 + 0.125 * np.arange(N) if even else np.cumsum(RNG.integers(1, 9, N) / 8.0)
    values = RNG.normal(size=N) + (1j * RNG.normal(size=N) if is_complex else 0.0)
    return Function(
        kind, x, values, (17, -3), (4, 0), "acceleration", "force", "frequency", "Hz", "m/s^2",
        ("name", "second", "3", "NONE", "NONE"),
    )  # fmt: skip


@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize("is_complex", [True, False])
@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("single", [True, False])
def test_every_ordinate_type_comes_back(tmp_path, even, is_complex, binary, single):
    f = function(even, is_complex)
    path = tmp_path / "f.unv"
    write_universal(path, functions=[f, f], binary=binary, single=single)
    content = read_universal(path)
    assert content.skipped == ()
    digits = 1e-7 if single and binary else 1e-5 if single else 0.0 if binary else 1e-12
    for again in content.functions:
        np.testing.assert_allclose(again.values, f.values, rtol=digits)
        np.testing.assert_allclose(again.abscissa, f.abscissa, rtol=1e-9)
        for name in ("kind", "response", "reference", "quantity", "per", "over", "abscissa_unit",
                     "ordinate_unit", "ids"):  # fmt: skip
            assert getattr(again, name) == getattr(f, name), name
    if even or not binary:  # pyuff reads a single abscissa of 58b as double
        first = next(s for s in pyuff.UFF(str(path)).read_sets() if s["type"] == 58)
        np.testing.assert_allclose(first["data"][:N], f.values, rtol=max(digits, 1e-12))
        np.testing.assert_allclose(first["x"][:N], f.abscissa, rtol=1e-9)


@pytest.mark.skipif(not FILES, reason=f"no shared data beside {ROOT.name}")
@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("path", FILES, ids=[p.name for p in FILES])
def test_real_functions_come_back(tmp_path, path, binary):
    functions = read_universal(path).functions
    if not functions:
        pytest.skip("the file has no such functions")
    other = tmp_path / "other.unv"
    write_universal(other, functions=functions, binary=binary)
    again = read_universal(other).functions
    assert len(again) == len(functions)
    for a, b in zip(again, functions, strict=True):
        even = np.ptp(np.diff(b.abscissa)) < 1e-6 * abs(b.abscissa).max()
        np.testing.assert_allclose(a.values, b.values, rtol=0 if binary else 1e-12)
        np.testing.assert_allclose(a.abscissa, b.abscissa, rtol=1e-6 if binary and not even
                                   else 1e-8, atol=1e-9)  # fmt: skip
        assert (a.kind, a.response, a.reference) == (b.kind, b.response, b.reference)


def test_values_that_are_not_finite_are_refused(tmp_path):
    f = function(True, False)
    values = np.array(f.values)
    values[3] = np.nan
    bad = Function(f.kind, f.abscissa, values, f.response, f.reference)
    with pytest.raises(InputError, match=r"coherence of node 17.*not finite"):
        write_universal(tmp_path / "f.unv", functions=[bad])
    assert not (tmp_path / "f.unv").exists()
