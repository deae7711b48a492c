"""The verb `compare`."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ..core.correlation.common_places import correlate_models
from ..core.correlation.criteria import Criteria
from ..core.data.geometry import Geometry
from ..core.data.modes import Modes
from ..core.errors import InputError, naming
from ..core.results.comparison import CompareTables, MatchRow, SourceRow, ValueRow
from ..core.results.correlation import Compared, RunTables, gap
from ..core.results.plain import Table
from .analysis import rigid_count
from .files.sources import Source, read_deck
from .runs.folder import Folder
from .studies.options import Say, checked_call, unheard
from .studies.study import Study

if TYPE_CHECKING:
    from ..adapters.nastran import Deck


@dataclass(frozen=True, eq=False, kw_only=True)
class SideBySide(CompareTables, Folder):
    """What `compare` found: the tables of result.json as fields."""


@dataclass(frozen=True, eq=False)
class _Model:
    """A deck, or modes of a file, by name."""

    name: str
    geometry: Geometry
    modes: Modes
    deck: Deck | None = None
    rigid: int | None = None
    mass: float | None = None
    kilograms: float | None = None


@checked_call
def compare(
    sources: Sequence[Source],
    number: int | None = None,
    fmax: float | None = None,
    *,
    mac_min: float = 0.7,
    frequency_tolerance: float = 0.3,
    cluster_width: float = 0.02,
    progress: Say = unheard,
) -> SideBySide:
    """Put runs, or decks and files of modes, side by side.

    Runs stand beside their test. Of decks and modes the first is the reference: the others' modes
    pair with its modes by the MAC in the places that both have a grid in (some thousands of them),
    close modes turned onto each other as in `correlate`.

    Parameters
    ----------
    sources : sequence of paths
        Run folders of correlate, update and discover; or decks, and files of modes with positions.
    number, fmax : optional
        Modes of a deck to find; default: what it asks for, or ten.
    mac_min, frequency_tolerance, cluster_width : float
        As for `correlate`.
    progress : callable
        Told what is done, a few words at a time.

    Returns
    -------
    SideBySide

    Raises
    ------
    InputError
        Fewer than two; runs beside others; runs of different tests; what cannot be read; no
        places in common.
    """
    paths = [Path(os.fspath(s)) for s in sources if isinstance(s, str | os.PathLike)]
    if len(paths) != len(sources) or len(paths) < 2:
        raise InputError("compare takes two paths or more: of runs, or of decks and modes")
    names = _names(paths)
    runs = [p.is_dir() for p in paths]
    if all(runs):
        return _of_runs(paths, names)
    if any(runs):
        raise InputError("a run folder compares with run folders; give its deck instead")
    criteria = Study(
        mac_min=mac_min, frequency_tolerance=frequency_tolerance, cluster_width=cluster_width
    ).criteria
    models = []
    for path, name in zip(paths, names, strict=True):
        progress(f"reading {name}")
        models.append(_model(path, name, number, fmax))
    progress("comparing")
    return _of_models(models, criteria)


def _names(paths: Sequence[Path]) -> list[str]:
    """Return short names, each its own: the last part of the path, or as much as tells apart."""
    for depth in range(1, max(len(p.parts) for p in paths) + 1):
        names = ["/".join(p.parts[-depth:]) for p in paths]
        if len(set(names)) == len(names):
            return names
    raise InputError("one of them is given twice")


def _of_runs(paths: Sequence[Path], names: Sequence[str]) -> SideBySide:
    from .runs.open_run import read_result
    from .runs.report import answer_of

    answers: list[RunTables] = []
    for path in paths:
        with naming(path):
            answers.append(answer_of(read_result(path)))
    first = answers[0].final.test_hz
    for answer, name in zip(answers, names, strict=True):
        hz = answer.final.test_hz
        if len(hz) != len(first) or any(abs(hz - first) > 1e-6 * first):
            raise InputError(f"{name} is of another test than {names[0]}: its modes are others")
    rows: list[SourceRow] = []
    modes: list[MatchRow] = []
    values: list[ValueRow] = []
    for answer, name in zip(answers, names, strict=True):
        found, far = answer.final, answer.final.summary
        rows.append(SourceRow(
            name, answer.verb, len(found.analysis_hz), None, None, far.pairs,
            far.mean_abs_deviation_percent, far.worst_deviation_percent, far.mean_mac,
        ))  # fmt: skip
        modes += _by_test(found, name)
        values += [
            ValueRow(f"{q.name}: {card}", name, float(v))
            for q in getattr(answer, "parameters", ())
            for card, v in zip(q.cards, q.updated, strict=True)
            if v is not None
        ]
    warnings = dict.fromkeys(w for a in answers for w in a.all_warnings)
    return SideBySide(
        reference=", ".join(answers[0].sources[1]) or "the test",
        sources=Table(rows),
        modes=Table(sorted(modes, key=lambda m: m.mode), MatchRow),
        values=Table(sorted(values, key=lambda v: v.name), ValueRow),
        warnings=tuple(warnings),
    )


def _by_test(found: Compared, name: str) -> Iterator[MatchRow]:
    partners = {p.test: p for p in found.pairs}
    for t in found.test_modes:
        hz, p = float(found.test_hz[t - 1]), partners.get(t)
        if p is None:
            yield MatchRow(t, hz, name, None, None, None, None)
        else:
            yield MatchRow(t, hz, name, p.analysis, p.analysis_hz, p.deviation_percent, p.mac)


def _model(path: Path, name: str, number: int | None, fmax: float | None) -> _Model:
    from .files.modes_as_test import holds_modes, modes_on_grids
    from .files.read import DECK, kind_of_file
    from .files.sources import read_test
    from .solve import solve

    if kind_of_file(path) is DECK:
        deck = read_deck(path)
        found = solve(deck, number, fmax)
        told = found.rigid_body_modes, found.mass, found.kilograms
        return _Model(name, found.geometry, found.shapes, deck, *told)
    test = modes_on_grids([path]) if holds_modes([path]) else read_test(path)
    if test.modes is None:
        raise InputError(f"{path} holds no modes; identify finds them in responses", file=path)
    return _Model(name, test.geometry, test.modes)


def _of_models(models: Sequence[_Model], criteria: Criteria) -> SideBySide:
    first = models[0]
    rows, modes = [_row(first)], list[MatchRow]()
    for other in models[1:]:
        with naming(other.name):
            found = correlate_models(
                (first.geometry, first.modes), (other.geometry, other.modes), criteria
            )
        far = gap(found)
        rows.append(_row(other, far.pairs, far.mean_abs_deviation_percent,
                         far.worst_deviation_percent, far.mean_mac))  # fmt: skip
        for p in found.pairs:
            own = p.analysis + 1, p.analysis_hz, p.deviation_percent, p.mac
            modes.append(MatchRow(p.test + 1, p.test_hz, other.name, *own))
        modes += [
            MatchRow(
                t + 1, float(first.modes.frequencies_hz[t]), other.name, None, None, None, None
            )
            for t in found.unpaired_test
            if t >= rigid_count(first.modes)
        ]
    return SideBySide(
        reference=first.name,
        sources=Table(rows),
        modes=Table(sorted(modes, key=lambda m: m.mode), MatchRow),
        values=Table(_values(models), ValueRow),
    )


def _row(
    m: _Model, pairs: int | None = None, mean: float | None = None, worst: float | None = None,
    mac: float | None = None,
) -> SourceRow:  # fmt: skip
    what = "deck" if m.deck is not None else "modes"
    far = pairs, mean, worst, mac
    return SourceRow(m.name, what, len(m.modes), m.rigid, m.mass, *far, m.kilograms)


def _values(models: Sequence[_Model]) -> Iterator[ValueRow]:
    """Yield the values of cards that differ between the decks."""
    from ..adapters.nastran.assembly.candidate_parameters import properties_of

    told: dict[str, dict[str, float]] = {}
    decks = [m for m in models if m.deck is not None]
    for m in decks:
        assert m.deck is not None
        for row in properties_of(m.deck):
            for name, value in row.values.items():
                told.setdefault(f"{row.card} {row.id} {name}", {})[m.name] = value
    for name, by in told.items():
        if len(decks) > 1 and (len(by) < len(decks) or len(set(by.values())) > 1):
            yield from (ValueRow(name, source, value) for source, value in by.items())
