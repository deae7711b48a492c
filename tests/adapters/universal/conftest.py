"""Text of small universal files, for the tests of this folder (fixture `uff`)."""

import sys
from pathlib import Path

import pytest

DATA = Path(__file__).parents[4] / "shared" / "data"


@pytest.fixture(scope="session")
def uff():
    """The functions below that print datasets."""
    return sys.modules[__name__]


@pytest.fixture
def write(tmp_path):
    """Write text or bytes to a file and return its path."""

    def written(content, name="test.unv"):
        path = tmp_path / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))
        return path

    return written


@pytest.fixture(scope="session")
def data():
    """The folder of real files; the test is skipped where it is absent."""
    if not DATA.is_dir():
        pytest.skip("no shared data beside the repository")
    return DATA


def dataset(number, *lines):
    """A dataset between its delimiters."""
    return "\n".join(["    -1", f"{number:6d}", *lines, "    -1", ""])


def units(factor=1.0, code=1):
    """Dataset 164."""
    return dataset(
        164,
        f"{code:10d}  SI: Meter (newton)         2",
        f"{factor:25.16E}{1:25.16E}{1:25.16E}",
        f"{273.15:25.16E}",
    )


def nodes_15(rows, definition=0, displacement=0):
    """Dataset 15 from rows of node, x, y, z."""
    return dataset(
        15,
        *(
            f"{n:10d}{definition:10d}{displacement:10d}{11:10d}{x:13.5E}{y:13.5E}{z:13.5E}"
            for n, x, y, z in rows
        ),
    )


def nodes_2411(rows, displacement=0):
    """Dataset 2411 from rows of node, x, y, z."""
    lines = []
    for n, x, y, z in rows:
        lines += [f"{n:10d}{1:10d}{displacement:10d}{11:10d}", f"{x:25.16E}{y:25.16E}{z:25.16E}"]
    return dataset(2411, *lines)


def systems_2420(*systems):
    """Dataset 2420 from (number, type, rows of the 4 x 3 matrix)."""
    lines = [f"{1:10d}", "part"]
    for number, kind, rows in systems:
        lines += [f"{number:10d}{kind:10d}{8:10d}", f"CS{number}"]
        lines += ["".join(f"{v:25.16E}" for v in row) for row in rows]
    return dataset(2420, *lines)


def shape_55(
    values,
    frequency=10.0,
    mass=1.0,
    viscous=0.01,
    hysteretic=0.0,
    kind=(1, 2, 2, 8, 2, 3),
    record_7=(2, 4, 1, 1),
    record_8=None,
):
    """Dataset 55 from {node: values}."""
    reals = record_8 or (frequency, mass, viscous, hysteretic)
    lines = ["NONE"] * 5
    lines += ["".join(f"{k:10d}" for k in kind), "".join(f"{k:10d}" for k in record_7)]
    lines += ["".join(f"{v:13.5E}" for v in reals)]
    for node, row in values.items():
        lines.append(f"{node:10d}")
        lines += ["".join(f"{v:13.5E}" for v in row[k : k + 6]) for k in range(0, len(row), 6)]
    return dataset(55, *lines)


def function_58(
    data,
    response=(1, 3),
    reference=(2, 3),
    function=4,
    ordinate_type=5,
    even=True,
    n_point=None,
    start=1.0,
    step=0.5,
    quantities=(18, 12, 13),
    units_=("Hz", "NONE", "NONE"),
    ids=("NONE",) * 5,
    names=("NONE", "NONE"),
    number="    58",
    rows=None,
):
    """Header and lines of a dataset 58; `data` are the reals in file order."""
    n_point = n_point or len(data) // (2 if ordinate_type in (5, 6) else 1)
    head = list(ids)
    head.append(
        f"{function:5d}{0:10d}{0:5d}{0:10d} {names[0]:10s}{response[0]:10d}{response[1]:4d} "
        f"{names[1]:10s}{reference[0]:10d}{reference[1]:4d}"
    )
    head.append(
        f"{ordinate_type:10d}{n_point:10d}{int(even):10d}{start:13.5E}{step:13.5E}{0:13.5E}"
    )
    for quantity, unit in zip((*quantities, 0), (*units_, "NONE"), strict=True):
        head.append(f"{quantity:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {unit:20s}")
    if rows is None:
        rows = ["".join(f"{v:13.5E}" for v in data[k : k + 6]) for k in range(0, len(data), 6)]
    return "\n".join(["    -1", number, *head, *rows, "    -1", ""])
