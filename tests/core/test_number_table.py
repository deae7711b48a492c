"""Numbers that were tuned stand in tables, with unit, meaning and source."""

from __future__ import annotations

import ast
from dataclasses import fields
from pathlib import Path

import pytest
from benchmarks.discovery.sensitivity import ROOT, markdown, scaled, tables

FORMULAS: dict[str, set[float]] = {
    "": {0, 1, 2, 3, 6, 0.5, 12.0, 100.0, 1e-300},
    "misalignment.py": {4, 7, 11, 1.5, 8.0},
    "discretisation_error.py": {4, 9, 36.0},
    "element_patches.py": {4},
    "joint_flexibility.py": {4, 5},
    "structure_points.py": {4, 5},
    "support_flexibility.py": {4, 5, 7},
    "sentences.py": {360.0},
    "mechanisms.py": {4},
    "pencil.py": {10.0},
    "rigid_body_modes.py": {7},
    "shift_invert_solver.py": {1000},
    "pose_families.py": {30},
    "poses.py": {4, 5},
    "surface_registration.py": {31},
    "facet_interpolation.py": {4},
    "outer_surface.py": {4, 21, 0.7548776662466927, 0.5698402909980532},
    "moments.py": {4, 5},
    "pole_stabilisation.py": {4},
    "significance.py": {4, 70.0},
    "survey_data.py": {4, 70.0},
    "footprints.py": {5.0},
    "link_spring.py": {0.7548776662466927, 0.5698402909980532},
    "quality.py": {4.0},
    "result.py": {4},
    "mode_indicator.py": {4, 20.0},
    "check_survey.py": {1000.0},
    "coherence.py": {10.0},
    "time_records.py": {1e3},
    "participation.py": {20.0},
    "peaks_without_mode.py": {20.0},
    "function_faults.py": {4},
}
"""What may stand outside the tables: counts of directions and degrees of freedom, halves, squares,
the variance of a uniform law (1/12), per cent; and in some modules the stencil of second
differences and the volume of all rotations (8π²), the mass matrix of linear shells (1/36), the
corners of one, the components that turn (4 to 6), degrees, axes of an array, fourth powers and
differences (of variance 70), quarters, decibels, milliseconds; seeds, the six rigid motions and the
one of scalar points, bits of a key, the golden angle, the powers of the additive recurrence that
fills a square evenly (Roberts 2018) and of its root in thirty rounds. What is divided by is
1e-300 at least."""
ROOMS = (
    "correlation",
    "discovery",
    "eigen",
    "identification",
    "localisation",
    "reduction",
    "registration",
    "sensors",
    "updating",
)
MODULES = sorted(
    p
    for room in ROOMS
    for p in (ROOT / "core" / room).rglob("*.py")
    if not p.name.endswith("_numbers.py")
)


def literals(code: str) -> set[tuple[int, float]]:
    """Lines and values of the numbers in some code but those of a table."""
    nodes = list(ast.walk(ast.parse(code)))
    calls = (n for n in nodes if isinstance(n, ast.Call) and isinstance(n.func, ast.Name))
    tuned = {id(n) for c in calls if c.func.id == "number" for n in ast.walk(c)}
    return {
        (n.lineno, n.value)
        for n in nodes
        if isinstance(n, ast.Constant) and type(n.value) in {int, float} and id(n) not in tuned
    }


@pytest.mark.parametrize("path", MODULES, ids=lambda p: f"{p.parent.name}/{p.name}")
def test_no_tuned_number_stands_outside_the_tables(path: Path) -> None:
    code = path.read_text(encoding="utf-8")
    allowed = FORMULAS[""] | FORMULAS.get(path.name, set())
    assert not [found for found in literals(code) if found[1] not in allowed]
    assigned = [n for n in ast.parse(code).body if isinstance(n, ast.Assign | ast.AnnAssign)]
    assert not [n.lineno for n in assigned if isinstance(n.value, ast.Constant)
                and isinstance(n.value.value, int | float)]  # fmt: skip


def test_the_checker_sees_numbers_wherever_they_stand() -> None:
    code = "a = -0.3\ndef f(x, n=7):\n    return x[:5] > 1e-3 * max(x)\n"
    assert literals(code) == {(1, 0.3), (2, 7), (3, 5), (3, 1e-3)}
    assert not literals('a: float = number(0.3, "-", "a share")')


def test_every_number_has_unit_meaning_and_source() -> None:
    assert {
        "dampers",
        "discovery",
        "effects",
        "likelihood",
        "narrative",
        "search",
    } <= set(tables())
    for room, table in tables().items():
        for f in fields(table):
            assert all(f.metadata[k] for k in ("unit", "meaning", "source")), f"{room}.{f.name}"
            assert f.metadata["source"].format("") is not None


def test_the_document_holds_the_tables() -> None:
    assert (ROOT / "docs" / "numbers.md").read_text(encoding="utf-8") == markdown()


def test_every_number_of_a_table_is_used() -> None:
    code = "".join(p.read_text(encoding="utf-8") for p in (ROOT / "core").rglob("*.py"))
    for room, table in tables().items():
        for f in fields(table):
            assert f"{room.upper()}.{f.name}" in code, f.name


def test_a_number_times_a_factor_is_another_number() -> None:
    assert scaled(0.3, 2.0) == 0.6
    assert scaled(2, 1.1) == 3
    assert scaled((4, 0.5), 0.5) == (2, 0.25)
    assert scaled(2, 1.0) == 2
