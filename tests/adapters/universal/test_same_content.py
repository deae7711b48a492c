"""Real files written in another way: the same content must come out, to the last bit."""

import re
from pathlib import Path

import numpy as np
import pytest

from trueup.adapters.universal import read_universal

ROOT = Path(__file__).resolve().parents[3]
DATA = ROOT.parent / "shared" / "data" / "uff"
CLOSING = rb"(\n *-1 *\r?\n)(?= *-1)"

WAYS = {
    "CR only": lambda d: d.replace(b"\r\n", b"\n").replace(b"\n", b"\r"),
    "CRLF": lambda d: d.replace(b"\r\n", b"\n").replace(b"\n", b"\r\n"),
    "LF": lambda d: d.replace(b"\r\n", b"\n"),
    "D exponents": lambda d: re.sub(rb"(\d)[eE]([-+]\d\d)", rb"\1D\2", d),
    "small d exponents": lambda d: re.sub(rb"(\d)[eE]([-+]\d\d)", rb"\1d\2", d),
    "letterless": lambda d: re.sub(rb"( -?\d\.\d+)[eE]([-+])(\d\d)(?=[ \n\r-])", rb"\1\g<2>0\3", d),
    "trailing blanks": lambda d: d.replace(b"\n", b"  \n"),
    "last -1 of a dataset glued": lambda d: re.sub(
        rb"\r?\n(    -1)[ ]*(?=\r?\n\s+-1|\r?\n?$)", rb"\1", d
    ),
    "no line end after the last -1": lambda d: d.rstrip(),
    "end-of-file mark of DOS": lambda d: d + b"\x1a",
    "blank lines between datasets": lambda d: re.sub(CLOSING, rb"\1\n\n", d),
    "a stray -1 between datasets": lambda d: re.sub(CLOSING, rb"\1    -1\n", d),
}
IN_BINARY_TOO = ("no line end after the last -1", "end-of-file mark of DOS")

FILES = [p for p in sorted(DATA.glob("*")) if p.suffix != ".mail"] if DATA.is_dir() else []


def arrays(content):
    """Everything that was read, as arrays by name."""
    found = {"counts": [len(content.functions), len(content.traces), len(content.systems)]}
    if content.geometry is not None:
        found["ids"], found["xyz"] = content.geometry.ids, content.geometry.xyz
    if content.modes is not None:
        m = content.modes
        found |= {"shapes": m.shapes, "hz": m.frequencies_hz, "damping": m.damping}
    if content.frfs is not None:
        found |= {"frfs": content.frfs.values, "lines": content.frfs.frequencies_hz}
    for k, f in enumerate(content.functions):
        found |= {f"x{k}": f.abscissa, f"y{k}": f.values}
    return found


@pytest.mark.skipif(not FILES, reason=f"no shared data beside {ROOT.name}")
@pytest.mark.parametrize("path", FILES, ids=[p.name for p in FILES])
def test_the_same_content_written_in_another_way(path, tmp_path):
    data = path.read_bytes()
    expected = arrays(read_universal(path))
    for name, way in WAYS.items():
        written = way(data)
        if written == data or (b"    58b" in data and name not in IN_BINARY_TOO):
            continue
        other = tmp_path / "other.unv"
        other.write_bytes(written)
        found = arrays(read_universal(other))
        assert found.keys() == expected.keys(), name
        for key, value in expected.items():
            np.testing.assert_array_equal(found[key], value, err_msg=f"{name}: {key}")
