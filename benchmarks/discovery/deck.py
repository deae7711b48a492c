"""The deck that is given to the search: NAME.bdf with its mesh and properties included."""

from __future__ import annotations

from pathlib import Path

from .mesh import Mesh, Structure


def field(x: float) -> str:
    """Return a real number in at most eight columns, with a decimal point."""
    if x == 0.0:
        return "0."
    best = ""
    for digits in range(7, 0, -1):
        mantissa, _, exponent = f"{x:.{digits - 1}e}".partition("e")
        forms = [f"{mantissa.rstrip('0')}{int(exponent):+d}"]
        if 1e-4 <= abs(x) < 1e7:
            plain = f"{x:.{max(0, digits - 1 - int(exponent))}f}"
            forms.append(plain.rstrip("0") if "." in plain else plain + ".")
        if "." not in mantissa:
            forms[0] = f"{mantissa}.{int(exponent):+d}"
        short = [f for f in forms if len(f) <= 8]
        if short:
            best = min(short, key=len)
            break
    return best


def _card(name: str, *values: int | float | str | None) -> str:
    text = ["" if v is None else field(v) if isinstance(v, float) else str(v) for v in values]
    rows = [text[k : k + 8] for k in range(0, len(text), 8)]
    lines = []
    for k, row in enumerate(rows):
        head = name if k == 0 else ""
        lines.append((f"{head:<8}" + "".join(f"{f:<8}" for f in row)).rstrip())
    return "\n".join(lines) + "\n"


def write_deck(folder: Path, s: Structure, m: Mesh) -> Path:
    """Write NAME.bdf, mesh.bdf and properties.bdf; grids are numbered from 1 in mesh order.

    The bars of the truth have G = E/2, so their torsion constant is given for the deck's G.
    """
    grids = ["$ mesh, exported by the pre-processor\n"]
    grids += [_card("GRID", i + 1, None, *map(float, p)) for i, p in enumerate(m.xyz)]
    e = 0
    for quad, group in zip(m.quads, m.quad_group, strict=True):
        e += 1
        grids.append(_card("CQUAD4", e, int(group), *(int(i) + 1 for i in quad)))
    for bar, group, plane in zip(m.bars, m.bar_group, m.plane, strict=True):
        e += 1
        grids.append(_card("CBAR", e, int(group), *(int(i) + 1 for i in bar), *map(float, plane)))
    grids += [_card("SPC1", 1, 123456, int(i) + 1) for i in m.clamped]
    mat = s.material
    lines = ["$ properties: checked against the drawing, please keep this order\n"]
    if s.shells:
        lines.append(_card("MAT1", 1, mat.young, None, mat.poisson, mat.density))
    lines += [_card("PSHELL", g, 1, t, 1, None, 1) for g, t in s.shells.items()]
    for g, bar in s.bars.items():
        lines.append(_card("MAT1", g + 100, mat.young, None, mat.poisson, mat.density))
        lines.append(
            _card("PBAR", g, g + 100, bar.area, bar.i1, bar.i2, bar.torsion * (1.0 + mat.poisson))
        )
    constraint = "  SPC = 1\n" if m.clamped.size else ""
    top = (
        f"$ {s.title}\n$ units: mm, t, N, s\nSOL 103\nCEND\nTITLE = {s.title}\nECHO = NONE\n"
        f"SUBCASE 1\n{constraint}  METHOD = 10\n  DISPLACEMENT(PLOT) = ALL\nBEGIN BULK\n"
        "PARAM,POST,-1\n$ normal modes\nEIGRL,10,,,40,,,,MASS\n"
        "INCLUDE 'mesh.bdf'\nINCLUDE 'properties.bdf'\nENDDATA\n"
    )
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "mesh.bdf").write_text("".join(grids))
    (folder / "properties.bdf").write_text("".join(lines))
    deck = folder / f"{s.name}.bdf"
    deck.write_text(top)
    return deck
