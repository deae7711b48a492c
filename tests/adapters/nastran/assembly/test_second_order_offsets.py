"""Offsets of second-order shells against rigid arms."""

import pytest
from tests.adapters.nastran.assembly.test_cards import _max_change


@pytest.mark.parametrize(
    ("shape", "nodes", "edges"),
    [
        ("CQUAD8", "1,2,3,4", ((1, 2), (2, 3), (3, 4), (4, 1))),
        ("CTRIA6", "1,2,3", ((1, 2), (2, 3), (3, 1))),
    ],
)
def test_offset_of_a_second_order_shell_is_a_rigid_arm(model, shape, nodes, edges):
    xyz = {1: (0.0, 0.0), 2: (2.0, 0.0), 3: (2.0, 1.0), 4: (0.0, 1.0)}
    corners = list(range(1, len(edges) + 1))
    for k, (i, j) in enumerate(edges):
        xyz[11 + k] = tuple((a + b) / 2 for a, b in zip(xyz[i], xyz[j], strict=True))
    used = [*corners, *(11 + k for k in range(len(edges)))]
    middles = ",".join(str(11 + k) for k in range(len(edges)))
    z = 0.25
    prop = "PSHELL,1,1,.2,1,,1\nMAT1,1,7.,,.3,1.\nPARAM,AUTOSPC,NO\n"
    first = ",".join(f"{nodes},{middles}".split(",")[:6])
    second = f"{nodes},{middles}".split(",")[6:]
    fields = [*second, *[""] * (2 - len(second))] if shape == "CQUAD8" else []
    lines = {
        "CQUAD8": f"CQUAD8,1,1,{first}\n,{','.join(fields)},,,,,,{{z}}\n",
        "CTRIA6": f"CTRIA6,1,1,{first}\n,,{{z}}\n",
    }
    flat = "".join(f"GRID,{n},,{xyz[n][0]},{xyz[n][1]},0.\n" for n in used)
    offset = model(flat + lines[shape].format(z=z) + prop)
    arms = "".join(f"GRID,{100 + n},,{xyz[n][0]},{xyz[n][1]},{z}\n" for n in used)
    rigid = "".join(f"RBE2,{200 + n},{n},123456,{100 + n}\n" for n in used)
    moved = lines[shape].format(z="")
    for n in sorted(used, reverse=True):
        moved = moved.replace(f",{n},", f",{100 + n},").replace(f",{n}\n", f",{100 + n}\n")
    moved = f"{shape},1,1," + moved.split(",", 3)[3]
    apart = model(flat + arms + rigid + moved + prop)
    assert _max_change(offset, apart) < 1e-12
