"""What ``convert`` carries from its sources to its destination, and what it cannot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ...core.data.frfs import Frfs
from ...core.data.geometry import Geometry
from ...core.data.measurement import Measurement
from ...core.data.modes import Modes
from ...core.errors import InputError, Place
from .read import DECK, FILE_KINDS, OP4, PUNCH, RESULTS, RUNS, STORE, UNIVERSAL, kind_of_file
from .sources import is_changed, read_deck

if TYPE_CHECKING:
    from ...adapters.store import StoreContent

KINDS = {kind.name: kind for kind in FILE_KINDS}


@dataclass
class Cargo:
    """The neutral content of all sources.

    Parameters
    ----------
    geometry : Geometry or None
    modes, frfs, matrices, functions : dict
        By name.
    from_deck : bool
        Whether the geometry is that of a deck, which goes on holding it.
    no_matrices : str
        Why a deck gives its geometry only.
    rest : list of str
        What the sources hold that no part of this can carry, in words.
    notes : list of str
        What was assumed or rounded.
    extras : dict
        Parts of a store that only a store can hold.
    extensions : dict
        What registered datasets of universal files hold, by the name of its type.
    """

    geometry: Geometry | None = None
    modes: dict[str, Modes] = field(default_factory=dict)
    frfs: dict[str, Frfs] = field(default_factory=dict)
    matrices: dict[str, Any] = field(default_factory=dict)
    functions: dict[str, Any] = field(default_factory=dict)
    from_deck: bool = False
    no_matrices: str = ""
    rest: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    extras: dict[str, Any] = field(default_factory=dict)
    extensions: dict[str, list[Any]] = field(default_factory=dict)

    def add(self, part: str, name: str, noun: object) -> None:
        """Add a noun, if there is one, under a name that is still free."""
        if noun is None:
            return
        named: dict[str, object] = getattr(self, part)
        free, number = name, 2
        while free in named:
            free, number = f"{name}_{number}", number + 1
        named[free] = noun


@dataclass(frozen=True)
class Boundary:
    """To what a deck is reduced: grids as text, number of component modes, their highest [Hz]."""

    grids: str
    modes: int = 20
    fmax: float | None = None


def load(
    sources: Sequence[Path],
    kind: str | None,
    subcase: int | None,
    boundary: Boundary | None = None,
) -> Cargo:
    """Read all sources.

    A deck beside results or matrices gives them geometry and axes; alone, it is assembled.

    Raises
    ------
    InputError
        A source that cannot be read; two decks; two geometries.
    """
    kinds = [(path, KINDS[kind] if kind else kind_of_file(path)) for path in sources]
    decks = [path for path, k in kinds if k == DECK]
    if len(decks) > 1:
        raise Place(decks[1]).error("give one deck only; it names its own INCLUDE files")
    cargo = Cargo()
    deck = _deck(decks[0], len(kinds) == 1, cargo, boundary) if decks else None
    universal = [path for path, k in kinds if k == UNIVERSAL]
    if universal:
        _universal(universal, cargo)
    for path, k in kinds:
        if k == RESULTS:
            _results(path, deck, subcase, cargo)
        elif k in (OP4, PUNCH):
            _matrices(path, deck, cargo)
        elif k == RUNS:
            from ...adapters.nastran import terms_of_runs

            for m, factor in terms_of_runs(path):
                cargo.add("matrices", m.name, m)
                cargo.notes.append(f"{m.name} is multiplied by {factor}")
        elif k == STORE:
            from ...adapters.store import read_store

            _stored(read_store(path), path, cargo)
    return cargo


def _matrices(path: Path, deck: Any, cargo: Cargo) -> None:
    """Add the matrices of an OP4 or a punch; where a list of dofs stands beside an OP4, modes."""
    from ...adapters.nastran import dof_list, read_matrices, read_op4_modes

    if dof_list(path) is not None:
        return cargo.add("modes", "analysis", read_op4_modes(path, deck))
    for m in read_matrices(path, deck):
        cargo.add("matrices", m.name, m)
    return None


def cargo_of(source: object, boundary: Boundary | None = None) -> Cargo:
    """Return the content of nouns: a deck, a test, modes, a geometry, what a store holds.

    Raises
    ------
    InputError
        Something else, or two geometries.
    """
    from ...adapters.nastran import Deck
    from ...adapters.store import StoreContent

    cargo, every = Cargo(), source if isinstance(source, list | tuple) else [source]
    for noun in every:
        held = getattr(noun, "content", noun)
        if isinstance(noun, Deck) or is_changed(noun):
            _deck(noun, len(every) == 1, cargo, boundary)
        elif isinstance(noun, Measurement):
            _set_geometry(cargo, noun.geometry, Path("test"))
            cargo.add("modes", "test", noun.modes)
            cargo.add("frfs", "test", noun.frfs)
        elif isinstance(noun, Modes):
            cargo.add("modes", "analysis", noun)
        elif isinstance(noun, Frfs):
            cargo.add("frfs", "test", noun)
        elif isinstance(noun, Geometry):
            _set_geometry(cargo, noun, Path("the sources"))
        elif isinstance(held, StoreContent):
            _stored(held, Path("the store"), cargo)
        else:
            raise InputError(
                f"{type(noun).__name__} cannot be converted; give files, a deck, a test, modes, "
                "frequency responses, a geometry or what a verb gave"
            )
    return cargo


def _set_geometry(cargo: Cargo, geometry: Geometry | None, path: Path) -> None:
    if geometry is None:
        return
    if cargo.geometry is not None:
        raise Place(path).fault("holds a second geometry: convert the sources one by one")
    cargo.geometry = geometry


def _deck(source: object, alone: bool, cargo: Cargo, boundary: Boundary | None) -> Any:
    from ...adapters.nastran import build_model, craig_bampton, deck_geometry, model_matrices

    deck = read_deck(source)
    cargo.notes += deck.warnings
    cargo.from_deck = True
    if alone and boundary:
        model = craig_bampton(deck, boundary.grids, boundary.modes, boundary.fmax)
        cargo.notes += [w for w in model.warnings if w not in cargo.notes]
        for m in model_matrices(model):
            named = replace(m, name=f"{m.name[0]}AA")
            cargo.add("matrices", named.name, named)
    elif alone:
        try:
            model = build_model(deck)
        except InputError as error:
            _set_geometry(cargo, deck_geometry(deck), deck.path)
            cargo.no_matrices = str(error)
            cargo.notes.append(f"grids and elements only are taken of the deck: {error}")
            return deck
        cargo.notes += [w for w in model.warnings if w not in cargo.notes]
        _set_geometry(cargo, model.geometry, deck.path)
        for m in model_matrices(model):
            cargo.add("matrices", m.name, m)
    else:
        _set_geometry(cargo, deck_geometry(deck), deck.path)
    return deck


def _universal(paths: list[Path], cargo: Cargo) -> None:
    from ...adapters.universal import read_universal

    content = read_universal(paths)
    _set_geometry(cargo, content.geometry, paths[0])
    cargo.add("modes", "test", content.modes)
    cargo.add("frfs", "test", content.frfs)
    for k, f in enumerate(content.functions, 1):
        cargo.functions[f"{f.kind.replace(' ', '_').replace('/', '_')}/{k:05d}"] = f
    for noun in content.extensions:
        cargo.extensions.setdefault(type(noun).__name__, []).append(noun)
    cargo.rest += [f"{s.what} of {Path(s.path or paths[0]).name} line {s.line}"
                   for s in content.skipped]  # fmt: skip
    cargo.notes += content.warnings


def _results(path: Path, deck: Any, subcase: int | None, cargo: Cargo) -> None:
    from ...adapters.nastran import describe_results, read_matrices, read_modes
    from ...adapters.nastran.results.read_modes import HDF5, kind_of_results

    told = describe_results(path)
    if told["contents"].get("matrices"):
        for m in read_matrices(path, deck):
            cargo.add("matrices", m.name, m)
    if told["contents"]["modes"] or not cargo.matrices:
        cargo.add("modes", "analysis", read_modes(path, deck, subcase))
        if deck is None and kind_of_results(path) != HDF5:
            cargo.notes.append(
                f"{path.name}: shapes are taken as along basic axes; name the deck as well where "
                "grids have displacement systems of their own"
            )
    others = [s["what"] for s in told["skipped"]]
    if others:
        more = f" and {len(others) - 6} more" if len(others) > 6 else ""
        cargo.notes.append(f"{path.name}: not read: {', '.join(others[:6])}{more}")


def _stored(content: StoreContent, path: Path, cargo: Cargo) -> None:
    from ...adapters.nastran import matrix_of
    from ...adapters.universal import Function

    _set_geometry(cargo, content.geometry, path)
    for name, modes in content.modes.items():
        cargo.add("modes", name, modes)
    for name, frfs in content.frfs.items():
        cargo.add("frfs", name, frfs)
    for name, said in content.functions.items():
        kept = {k: v for k, v in said.items() if k != "function"}
        cargo.add("functions", name, Function(kind=said["function"], **kept))
    used = set()
    for name, matrix in content.matrices.items():
        rows, columns = (content.dofs.get(f"{side}/{name}") for side in ("rows", "columns"))
        used |= {f"{side}/{name}" for side in ("rows", "columns")}
        own = content.matrix_names.get(name, name)
        cargo.add("matrices", name, matrix_of(own, matrix, rows, columns))
    dofs = {k: v for k, v in content.dofs.items() if k not in used}
    for key, value in (
        ("test_geometry", content.test_geometry), ("mac", content.mac), ("dofs", dofs),
        ("pairs", content.pairs), ("history", content.history),
    ):  # fmt: skip
        if value is None or (not isinstance(value, Geometry) and not len(value)):
            continue
        if key in cargo.extras:
            raise Place(path).fault(f"holds a second {key.replace('_', ' ')}: convert one store")
        cargo.extras[key] = value
