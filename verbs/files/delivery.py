"""Destinations of ``convert``: what each can hold, and its writing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...core.arrays import Bools
from ...core.data.modes import Modes
from ...core.errors import InputError
from .exchange import Cargo


@dataclass(frozen=True)
class Target:
    """A format that can be written: its name, the parts it holds, its writer."""

    name: str
    holds: frozenset[str]
    write: Callable[[Path, Cargo], None]


def target_of(path: Path, name: str | None) -> Target:
    """Return the format that `name` names or the suffix tells.

    Raises
    ------
    InputError
        A suffix or a name that is not known.
    """
    key = (name or path.suffix).lower().lstrip(".")
    if key not in TARGETS:
        what = f"to={name!r}" if name else f"{path}: suffix '{path.suffix}'"
        raise InputError(f"{what} is no format that can be written; known are {', '.join(TARGETS)}")
    return TARGETS[key]


def losses(cargo: Cargo, target: Target) -> list[str]:
    """Say in words what of the cargo the target cannot hold."""
    lost = list(cargo.rest)
    for part, said in _PARTS.items():
        held = getattr(cargo, part)
        if not held or part in target.holds:
            continue
        if part == "geometry" and cargo.from_deck:
            continue
        names = "" if part == "geometry" else f" {', '.join(list(held)[:6])}"
        lost.append(said + names)
    if "extras" not in target.holds:
        lost += [k.replace("_", " ") for k in cargo.extras]
    if target.name == "universal file":
        for part in ("modes", "frfs"):
            lost += [f"{_PARTS[part]} {name}" for name in list(getattr(cargo, part))[1:]]
        for modes in list(cargo.modes.values())[:1]:
            count = int(_scalar(modes).sum())
            lost += [f"{count} scalar points of the modes"] if count else []
    if target is _PUNCH:
        lost += [f"matrix {k}, of which no dof map is known" for k in _without_map(cargo)]
    return lost


def is_empty(cargo: Cargo, target: Target) -> bool:
    """Whether nothing of the cargo can go into the target."""
    if target is _PUNCH:
        return len(_without_map(cargo)) == len(cargo.matrices)
    return not any(getattr(cargo, part) for part in _PARTS if part in target.holds)


def _without_map(cargo: Cargo) -> list[str]:
    return [name for name, m in cargo.matrices.items() if m.rows is None]


_PARTS = {
    "geometry": "the geometry",
    "modes": "the modes",
    "frfs": "the frequency responses",
    "matrices": "the matrices",
    "functions": "the functions",
    "extensions": "the registered datasets",
}


def _scalar(modes: Modes) -> Bools:
    """Rows of scalar points: alone on their node, where other nodes have six."""
    node, counts = np.unique(modes.dofs.node, return_counts=True)
    if not (counts == 6).any():
        return np.zeros(len(modes.dofs), bool)
    return np.isin(modes.dofs.node, node[counts == 1])


def _universal(path: Path, cargo: Cargo, binary: bool = False) -> None:
    from ...adapters.universal import write_universal

    modes = next(iter(cargo.modes.values()), None)
    if modes is not None:
        keep = np.flatnonzero(~_scalar(modes))
        modes = replace(modes, shapes=modes.shapes[keep], dofs=modes.dofs.take(keep))
    write_universal(
        path,
        geometry=cargo.geometry,
        modes=modes,
        frfs=next(iter(cargo.frfs.values()), None),
        functions=tuple(cargo.functions.values()),
        extensions=[noun for nouns in cargo.extensions.values() for noun in nouns],
        binary=binary,
    )
    if modes is not None:
        cargo.notes.append("dataset 55 holds six digits of each shape")


def _store(path: Path, cargo: Cargo) -> None:
    from ...adapters.store import write_store

    extras = dict(cargo.extras)
    dofs = dict(extras.pop("dofs", {}))
    for name, m in cargo.matrices.items():
        for side, kind in (("rows", m.rows), ("columns", m.columns)):
            if kind is not None:
                dofs[f"{side}/{name}"] = kind.dofs
    write_store(
        path,
        geometry=cargo.geometry,
        modes=cargo.modes,
        frfs=cargo.frfs,
        dofs=dofs,
        matrices={name: m.matrix.tocsr() for name, m in cargo.matrices.items()},
        matrix_names={name: m.name for name, m in cargo.matrices.items() if m.name != name},
        functions={name: _record(f) for name, f in cargo.functions.items()},
        **extras,
    )


def _record(function: Any) -> dict[str, Any]:
    kept = {k: v for k, v in asdict(function).items() if k not in ("kind", "line", "path")}
    return {"function": function.kind, **kept}


def _op4(path: Path, cargo: Cargo, formatted: bool = False) -> None:
    from ...adapters.nastran import write_op4

    write_op4(path, list(cargo.matrices.values()), formatted)


def _punch(path: Path, cargo: Cargo) -> None:
    from ...adapters.nastran import write_dmig

    write_dmig(path, [m for m in cargo.matrices.values() if m.rows is not None])
    cargo.notes.append("DMIG fields hold eleven to fourteen digits of each number")


_SHAPES = frozenset({"geometry", "modes", "frfs", "functions"})
_MATRICES = frozenset({"matrices"})
_UFF = _SHAPES | {"extensions"}
_UNIVERSAL = Target("universal file", _UFF, _universal)
_BINARY = Target("universal file", _UFF, lambda p, c: _universal(p, c, binary=True))
_STORE = Target("store of trueup", _SHAPES | _MATRICES | {"extras"}, _store)
_PUNCH = Target("DMIG punch", _MATRICES, _punch)

TARGETS: dict[str, Target] = {
    "unv": _UNIVERSAL,
    "uff": _UNIVERSAL,
    "uff-binary": _BINARY,
    "h5": _STORE,
    "op4": Target("OP4", _MATRICES, _op4),
    "op4-text": Target("formatted OP4", _MATRICES, lambda p, c: _op4(p, c, formatted=True)),
    "pch": _PUNCH,
    "dmig": _PUNCH,
}
"""Formats that can be written, by suffix or by what `name` says."""
