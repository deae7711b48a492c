"""Correlation and update as sections of the report; None where the run says nothing."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from ...core.arrays import Floats
from ...core.geometry import Geometry
from . import charts, heatmap, placing, reading, tables
from .deckdiff import deck_diff
from .formats import fixed, general, hz
from .html_table import html_table
from .markup import esc, tag
from .reading import Result
from .scene import scene
from .section import Section


def pairs(result: Result) -> Section | None:
    """Return the paper's table of pairs and the deviations and MAC by mode."""
    table = tables.pairs(result)
    if table is None:
        return None
    body = html_table(table)
    after, before = reading.final(result), reading.initial(result)
    states = {"before": before, "after": after} if before else {"": after}
    modes = reading.test_modes(*states.values())
    known = reading.mode_hz(before, "test") | reading.mode_hz(after, "test")
    labels = [(str(n), _tick_hz(known.get(n))) for n in modes]
    for key, title, scale, unit in (
        ("deviation_percent", "Frequency deviation of each test mode", 1.0, "%"),
        ("mac", "MAC of each test mode with its partner", 100.0, "%"),
    ):
        values = {s: _by_mode(c, key, modes, scale) for s, c in states.items()}
        mac_min = reading.number(reading.part(after, "criteria").get("mac_min"))
        body += charts.bars(
            title,
            labels,
            values,
            unit=unit,
            limits=(0.0, 100.0) if key == "mac" else None,
            mark=100.0 * mac_min if key == "mac" and mac_min else None,
            height=240 if key == "deviation_percent" else 200,
        )
    return Section("Pairs", "pairs", body)


def _tick_hz(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:.1f}" if 100.0 <= value < 10000.0 else hz(value)


def _by_mode(correlation: Result, key: str, modes: list[int], scale: float) -> list[float | None]:
    partners = reading.pair_by_test(correlation)
    found = [reading.number(partners.get(n, {}).get(key)) for n in modes]
    return [None if v is None else scale * v for v in found]


def matrices(result: Result) -> Section | None:
    """Return the MAC as measured, after rotation, after updating."""
    after, before = reading.final(result), reading.initial(result)
    changed = "updating" if reading.verb(result) != "discover" else "completing the model"
    wanted = (
        [
            (before, "mac", "As measured"),
            (before, "mac_rotated", "After rotation of close modes"),
            (after, "mac_rotated", f"After {changed}"),
        ]
        if before
        else [
            (after, "mac", "As measured"),
            (after, "mac_rotated", "After rotation of close modes"),
        ]
    )
    if before and reading.mac_matrix(after, "mac_rotated") is None:
        wanted[2] = (after, "mac", f"After {changed}")
    shown = [(c, k, t, m) for c, k, t in wanted if (m := reading.mac_matrix(c, k)) is not None]
    if not shown:
        return None
    narrow = max(len(m.analysis) for *_, m in shown) <= 13
    figures = []
    for correlation, key, title, matrix in shown:
        turned = key == "mac_rotated" or reading.mac_matrix(correlation, "mac_rotated") is None
        figures.append(
            heatmap.heatmap(
                matrix,
                title,
                test_hz=reading.mode_hz(correlation, "test"),
                analysis_hz=reading.mode_hz(correlation, "analysis"),
                pairs=_ringed(correlation) if turned else [],
                clusters=_framed(correlation),
                width=500 if narrow else 1050,
            )
        )
    keys = tag("span", tag("i", class_="ring"), "pair", class_="key") + tag(
        "span", tag("i", class_="frame"), "cluster of close modes", class_="key"
    )
    top = tag("div", heatmap.legend(), tag("span", keys, class_="note"), class_="row")
    return Section("MAC matrices", "mac", top + tag("div", *figures, class_="row"))


def _ringed(correlation: Result) -> list[tuple[int, int]]:
    found = [
        (reading.mode_number(p, "test"), reading.mode_number(p, "analysis"))
        for p in reading.records(correlation, "pairs")
    ]
    return [(t, a) for t, a in found if t is not None and a is not None]


def _framed(correlation: Result) -> list[tuple[list[int], list[int]]]:
    return [
        (reading.identifiers(c.get("test")), reading.identifiers(c.get("analysis")))
        for c in reading.records(correlation, "clusters")
    ]  # fmt: skip


def unpaired(result: Result) -> Section | None:
    """Return the modes of both sides without a partner."""
    table = tables.unpaired(result)
    if table is None:
        return None
    sides = [tables.only(table, side) for side in ("test", "analysis")]
    shown = tag("div", *[html_table(t) for t in sides if t.rows], class_="row")
    note = tag("p", esc(table.note), class_="note") if table.note else ""
    return Section(table.title, "unpaired", shown + note)


def parameters(result: Result) -> Section | None:
    """Return what was moved and how the update went."""
    table = tables.parameters(result)
    body = html_table(table) if table else ""
    steps = reading.records(result, "history")
    at, breaks = _iterations(steps)
    named = [str(p.get("name", k + 1)) for k, p in enumerate(reading.records(result, "parameters"))]
    objective = [reading.number(h.get("objective")) for h in steps]
    known = [v for v in objective if v is not None]
    steep = bool(known) and min(known) > 0.0 and max(known) > 15.0 * min(known)
    deviations = _series([h.get("deviations_percent") for h in steps], [])
    body += tag(
        "div",
        charts.lines(
            "Factors on the deck's values", at, _series([h.get("factors") for h in steps], named),
            reference=1.0, breaks=breaks,
        ),
        charts.lines(
            "Objective", at, _by_stage(objective, at, breaks), log=steep, breaks=breaks,
        ),
        charts.lines(
            "Frequency deviation of each pair", at,
            [charts.Series(_pair_name(result, s.name), s.values) for s in deviations],
            unit="%", reference=0.0, ordered=True, width=1056, height=330,
            breaks=breaks,
        ),
        class_="row",
    )  # fmt: skip
    rows = tables.history(result)
    if rows:
        body += tag("details", tag("summary", "Iterations as a table"), html_table(rows))
    if not (table or rows):
        return None
    return Section("Parameters and progress", "parameters", body)


def _series(steps: list[object], names: list[str]) -> list[charts.Series]:
    by_step = [tables.by_name(s) for s in steps]
    keys = list(dict.fromkeys(k for s in by_step for k in s))
    return [
        charts.Series(
            names[j] if j < len(names) and k.isdigit() else k, tuple(s.get(k) for s in by_step)
        )
        for j, k in enumerate(keys)
    ]


def _pair_name(result: Result, name: str) -> str:
    """Name a line of deviations, which come by test mode or by pair, with its frequency."""
    final = reading.final(result)
    known, every = reading.mode_hz(final, "test"), reading.test_modes(final)
    paired = sorted(reading.pair_by_test(final))
    histories = [h.get("deviations_percent") for h in reading.records(result, "history")]
    if not name.isdigit():
        return name
    width = max((len(reading.numbers(h)) for h in histories), default=0)
    if any(isinstance(h, dict) for h in histories):
        mode = int(name)
    elif width in (len(every), len(paired)):
        mode = (every if width == len(every) else paired)[int(name) - 1]
    else:
        return f"pair {name}"
    return f"{mode} · {hz(known[mode])} Hz" if mode in known else f"test {mode}"


def _by_stage(
    objective: list[float | None], at: list[float], breaks: list[tuple[float, str]]
) -> list[charts.Series]:
    """Cut the objective where a stage begins: each stage minimises another one."""
    starts = [at[0] if at else 0.0, *[x for x, _ in breaks], float("inf")]
    names = ["first stage" if breaks else "objective", *[name for _, name in breaks]]
    return [
        charts.Series(
            name, tuple(v if a <= x < b else None for v, x in zip(objective, at, strict=True))
        )
        for name, (a, b) in zip(names, pairwise(starts), strict=True)
    ]


def _iterations(steps: list[Result]) -> tuple[list[float], list[tuple[float, str]]]:
    """Return the x of each step, and where a new stage begins.

    Iterations that start again with every stage are counted through.
    """
    told = [reading.number(h.get("iteration")) for h in steps]
    x = [float(k) if v is None else v for k, v in enumerate(told)]
    if any(b <= a for a, b in pairwise(x)):
        x = [float(k) for k in range(len(steps))]
    stages = [reading.number(h.get("stage")) for h in steps]
    breaks = [
        (x[k], f"stage {general(stages[k])}")
        for k in range(1, len(x))
        if stages[k] is not None and stages[k] != stages[k - 1]
    ]
    return x, breaks


def alignment(
    result: Result, geometry: Geometry | None, sensors_xyz: Floats | None
) -> Section | None:
    """Return where the test sits on the model."""
    found = reading.part(reading.final(result), "alignment") or reading.part(result, "alignment")
    if not found:
        return None
    unit = f" {geometry.length_unit}" if geometry is not None and geometry.length_unit else ""
    sensors = reading.records(found, "sensors")
    facts = []
    nodes = {str(s.get("node")) for s in sensors}
    if sensors:
        facts.append(("sensors", f"{len(sensors)} at {len(nodes)} nodes"))
        distances = [d for s in sensors if (d := reading.number(s.get("distance"))) is not None]
        if distances:
            facts.append(("farthest from the model", f"{general(max(distances), 3)}{unit}"))
    if reading.number(found.get("rms")) is not None:
        facts.append(("rms distance", f"{general(found['rms'], 3)}{unit}"))
    if reading.number(found.get("scale")) is not None:
        facts.append(("scale, test to deck", general(found["scale"], 6)))
    move = reading.numbers(found.get("translation"))
    if len(move) == 3:
        facts.append(("translation", f"{', '.join(general(_tidy(v), 4) for v in move)}{unit}"))
    turn = _turn(found.get("rotation"))
    if turn is not None:
        facts.append(("rotation", f"{fixed(turn, 2)}°"))
    strip = "".join(tag("div", tag("dt", esc(k)), tag("dd", esc(v))) for k, v in facts)
    body = tag("dl", strip, class_="facts") if strip else ""
    if geometry is not None and not reading.records(result, "findings"):
        marks = placing.sensors(sensors, geometry, sensors_xyz)
        picture = scene(geometry, "Sensors on the model", marks=marks) if marks else ""
        body = tag("div", picture, body, class_="row")
    return Section("Alignment and sensors", "alignment", body)


def _tidy(value: float | None) -> float | None:
    return None if value is None else 0.0 if abs(value) < 1e-9 else value


def _turn(rotation: object) -> float | None:
    """Angle of a rotation matrix, degrees."""
    rows = [reading.numbers(r) for r in rotation] if isinstance(rotation, (list, tuple)) else []
    if len(rows) != 3 or any(len(r) != 3 or None in r for r in rows):
        return None
    trace = float(np.trace(np.array(rows, dtype=float)))
    return float(np.degrees(np.arccos(np.clip((trace - 1.0) / 2.0, -1.0, 1.0))))


def deck(diff: str | None) -> Section | None:
    """Return what changed in the deck."""
    if not diff or not diff.strip():
        return None
    return Section("Changes to the deck", "deck", deck_diff(diff))
