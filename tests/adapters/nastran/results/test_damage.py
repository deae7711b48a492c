"""Damaged result files: one sentence or a reading, never a traceback, nothing printed."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from trueup.adapters.nastran import describe_results
from trueup.core.errors import InputError

ROOT = Path(__file__).resolve().parents[4]
DATA = ROOT.parent / "shared" / "data" / "nastran"

FILES = (
    "solid_shell_bar/static_solid_shell_bar_kelm.op2", "plate/plate_py.op2",
    "cantilever/full.h5", "svanberg_beam/modes.f06",
)  # fmt: skip


@pytest.mark.skipif(not DATA.is_dir(), reason=f"no shared data beside {ROOT.name}")
@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("way", ["cut", "bytes", "digits"])
def test_damage_is_told_in_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, way: str
) -> None:
    rng = random.Random(f"{name} {way}")
    whole = (DATA / name).read_bytes()
    path = tmp_path / f"damaged{Path(name).suffix}"
    for _ in range(5):
        data = bytearray(whole)
        if way == "cut":
            data = data[: rng.randrange(len(data))]
        else:
            for _ in range(rng.choice([1, 20, 200])):
                new = rng.randrange(256) if way == "bytes" else rng.choice(b"0123456789-+.E \n")
                data[rng.randrange(len(data))] = new
        path.write_bytes(bytes(data))
        try:
            describe_results(path)
        except InputError as error:
            told = str(error)
            assert str(path) in told
            assert "\n" not in told
    assert capsys.readouterr() == ("", "")
