"""What the package promises as a whole: rooms, links, the public face, the wheel."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
import tomllib
import venv
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

import trueup

ROOT = Path(__file__).parents[1]
FACE = ROOT / "src" / "trueup"
ROOMS = ("adapters", "cli", "core", "verbs")
FOLDERS = (*ROOMS, "fixtures")
MAY_IMPORT = {
    "core": {"core"},
    "adapters": {"core", "adapters"},
    "verbs": {"core", "adapters", "verbs"},
    "cli": {"core", "adapters", "verbs", "cli", ""},
}
IN_CORE = {"numpy", "scipy", *sys.stdlib_module_names}
USED_INSIDE_FUNCTIONS = {"pyNastran", "pyuff", "h5py"}


def modules(room: str) -> list[Path]:
    return sorted(p for p in (ROOT / room).rglob("*.py") if "__pycache__" not in p.parts)


def imported(path: Path, top: Path) -> Iterator[tuple[str, ast.stmt]]:
    """Absolute dotted name of every import of a module, wherever it stands."""
    package = ["trueup", *path.relative_to(top).parts[:-1]]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((alias.name, node) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            module = [*base, *(node.module.split(".") if node.module else [])]
            if module in (["trueup"], *(["trueup", room] for room in ROOMS)):
                yield from ((".".join([*module, alias.name]), node) for alias in node.names)
            else:
                yield ".".join(module), node


def room_of(name: str) -> str | None:
    """Room of an import of this package ('' for its face), None for others."""
    parts = name.split(".")
    if parts[0] != "trueup":
        return None
    return parts[1] if len(parts) > 1 and parts[1] in FOLDERS else ""


@pytest.mark.parametrize("room", ROOMS)
def test_imports_run_one_way(room: str) -> None:
    assert modules(room)
    for path in modules(room):
        for name, node in imported(path, ROOT):
            target = room_of(name)
            assert target is None or target in MAY_IMPORT[room], (
                f"{path.relative_to(ROOT)}:{node.lineno} imports {name}"
            )


def own_room(path: Path) -> str:
    """Room of a module: its folder, or itself where it stands beside rooms."""
    beside = any(p.is_dir() and (p / "__init__.py").is_file() for p in path.parent.iterdir())
    return str((path if beside else path.parent).relative_to(ROOT))


def test_imports_between_rooms_make_no_circle() -> None:
    above: dict[str, set[str]] = {}
    for path in (p for room in ROOMS for p in modules(room) if p.name != "__init__.py"):
        for name, _ in imported(path, ROOT):
            if room_of(name) not in ROOMS:
                continue
            target = ROOT.joinpath(*name.split(".")[1:]).with_suffix(".py")
            target = target if target.is_file() else target.with_suffix("") / "__init__.py"
            room = str(target.parent.relative_to(ROOT)) if target.name == "__init__.py" else ""
            room = room or own_room(target)
            if room != own_room(path) and not own_room(path).startswith(f"{room}/"):
                above.setdefault(own_room(path), set()).add(room)
    assert len(above) > 40
    tuple(TopologicalSorter(above).static_order())


def test_core_imports_numpy_scipy_and_the_standard_library_only() -> None:
    for path in modules("core"):
        for name, node in imported(path, ROOT):
            if room_of(name) is None:
                assert name.split(".")[0] in IN_CORE, (
                    f"{path.relative_to(ROOT)}:{node.lineno} imports {name}"
                )


def test_adapters_do_not_import_each_other() -> None:
    for path in modules("adapters"):
        own = path.relative_to(ROOT / "adapters").parts[0].removesuffix(".py")
        for name, node in imported(path, ROOT):
            if name.startswith("trueup.adapters."):
                assert name.split(".")[2] == own, (
                    f"{path.relative_to(ROOT)}:{node.lineno} imports {name}"
                )


def test_inside_the_package_imports_are_relative() -> None:
    for room in ROOMS:
        for path in modules(room):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
                if isinstance(node, ast.ImportFrom) and not node.level:
                    names = [node.module or ""]
                assert not any(n.split(".")[0] == "trueup" for n in names), path


def test_third_party_readers_are_imported_where_they_are_used() -> None:
    for room in ROOMS:
        for path in modules(room):
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
                if isinstance(node, ast.ImportFrom) and not node.level:
                    names = [node.module or ""]
                found = {n.split(".")[0] for n in names} & USED_INSIDE_FUNCTIONS
                assert not found, f"{path.relative_to(ROOT)}:{node.lineno} imports {found}"


def test_the_import_checker_sees_every_form(tmp_path: Path) -> None:
    path = tmp_path / "core" / "deep" / "x.py"
    path.parent.mkdir(parents=True)
    path.write_text(
        "import scipy.sparse as sp, typer\nfrom ... import adapters\nfrom ..dofs import Dofs\n"
        "def f():\n    from ...cli.study import Study\n    from . import y\n"
    )
    assert [name for name, _ in imported(path, tmp_path)] == [
        "scipy.sparse", "typer", "trueup.adapters", "trueup.core.dofs", "trueup.cli.study",
        "trueup.core.deep",
    ]  # fmt: skip
    assert [room_of(n) for n in ("scipy.x", "trueup", "trueup.adapters.store", "trueup.Dofs")] == [
        None, "", "adapters", "",
    ]  # fmt: skip


def test_links_mapping_and_folders_agree() -> None:
    hatch = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]
    wheel = hatch["build"]["targets"]["wheel"]
    links = {p.name for p in FACE.iterdir() if p.is_symlink()}
    assert links == set(FOLDERS)
    for folder in FOLDERS:
        assert os.readlink(FACE / folder) == f"../../{folder}"
        assert (ROOT / folder / "__init__.py").is_file()
        assert wheel["sources"][folder] == f"trueup/{folder}"
    assert set(wheel["only-include"]) == {"src/trueup", *FOLDERS}
    assert set(wheel["sources"]) == {"src/trueup", *FOLDERS}
    assert set(hatch["build"]["exclude"]) == {f"/src/trueup/{folder}" for folder in FOLDERS}


def test_every_folder_with_code_is_a_package() -> None:
    for room in ROOMS:
        for path in modules(room):
            assert (path.parent / "__init__.py").is_file(), path


def test_the_public_face_holds_what_it_lists() -> None:
    assert trueup.__all__ == sorted(trueup.__all__)
    tree = ast.parse((FACE / "__init__.py").read_text(encoding="utf-8"))
    checked = next(n for n in tree.body if isinstance(n, ast.If))
    seen = {a.name: n.module for n in checked.body if isinstance(n, ast.ImportFrom)
            for a in n.names}  # fmt: skip
    assert set(seen) == set(trueup.__all__)
    for name, module in seen.items():
        value = getattr(trueup, name)
        assert value.__doc__, name
        assert value.__module__.startswith("trueup."), name
        assert value is getattr(sys.modules[f"trueup.{module}"], name)
    assert set(trueup.__all__) <= set(dir(trueup))
    with pytest.raises(AttributeError, match="no attribute 'nonsense'"):
        trueup.nonsense  # noqa: B018


def python(*words: str, **more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, check=False,
        env={**os.environ, **more}, timeout=120,
    )  # fmt: skip


def test_importing_the_face_imports_neither_numpy_nor_a_reader() -> None:
    said = python(
        "-c",
        "import sys, trueup; print(trueup.__version__, {'numpy', 'scipy', 'typer', 'pyNastran'} "
        "& set(sys.modules))",
    )
    assert said.stdout == f"{trueup.__version__} set()\n", said.stderr


def test_the_help_does_not_import_the_readers() -> None:
    said = python(
        "-c",
        "import sys\nsys.argv = ['trueup', '--help']\nfrom trueup.cli.app import run\n"
        "status = run()\nprint(status, {'pyNastran', 'pyuff', 'h5py', 'scipy'} & set(sys.modules))",
    )
    assert said.stdout.endswith("0 set()\n"), said.stdout + said.stderr


def test_the_module_runs() -> None:
    said = python("-m", "trueup", "--version")
    assert (said.returncode, said.stdout) == (0, f"trueup {trueup.__version__}\n")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == trueup.__version__
    assert project["scripts"] == {"trueup": "trueup.cli:main"}


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_shell_completes_verbs(shell: str) -> None:
    asked = {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}
    said = python("-m", "trueup", "--show-completion", shell, **asked)
    assert said.returncode == 0
    assert "TRUEUP_COMPLETE" in said.stdout


def test_verbs_are_offered_for_completion() -> None:
    said = python(
        "-c", "import sys; sys.argv[0] = 'trueup'\nfrom trueup.cli.app import run; sys.exit(run())",
        _TRUEUP_COMPLETE="complete_bash", COMP_WORDS="trueup co", COMP_CWORD="1",
    )  # fmt: skip
    assert said.stdout.split() == ["convert", "correlate", "compare"], said.stderr


def test_no_file_names_the_machine_it_was_written_on() -> None:
    tracked = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if tracked.returncode:
        pytest.skip("not a git checkout")
    home = re.compile(rb"/(?:home|Users|root)/\w+")
    for name in filter(None, tracked.stdout.split("\0")):
        path = ROOT / name
        if path.is_file() and path.suffix not in {".op2", ".unv"}:
            assert not home.search(path.read_bytes()), name


@pytest.mark.slow
def test_the_wheel_works_on_its_own(tmp_path: Path) -> None:
    """Built, installed where the checkout is not seen, run on the deck that ships with it."""
    built = python("-m", "pip", "wheel", "--no-deps", "--quiet", "-w", str(tmp_path), str(ROOT))
    if built.returncode and "hatchling" in built.stderr:
        pytest.skip(f"hatchling cannot be had here: {built.stderr.splitlines()[-1]}")
    assert built.returncode == 0, built.stderr
    (wheel,) = tmp_path.glob("trueup-*.whl")
    place = tmp_path / "venv"
    venv.create(place, with_pip=False, symlinks=True)
    own = place / ("Scripts" if os.name == "nt" else "bin") / "python"
    site = subprocess.run(
        [own, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"],
        capture_output=True, text=True, check=True,
    ).stdout.strip()  # fmt: skip
    done = python(
        "-m", "pip", "install", "--no-deps", "--quiet", "--target", str(tmp_path / "lib"),
        str(wheel),
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    # The libraries that trueup needs come from the interpreter that runs the tests.
    borrowed = [p for p in sys.path if p.endswith("site-packages")]
    Path(site, "borrowed.pth").write_text("\n".join([str(tmp_path / "lib"), *borrowed]) + "\n")
    alone = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    script = (
        "import trueup, json\nfrom importlib.resources import files\n"
        "print(trueup.__file__)\n"
        "deck = trueup.read_deck(files('trueup.fixtures') / 'duct' / 'duct.bdf')\n"
        "from trueup.adapters.nastran import build_model\nprint(build_model(deck).n_free)\n"
    )
    ran = subprocess.run(
        [own, "-c", script], cwd=tmp_path, env=alone, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    where, free = ran.stdout.splitlines()
    assert Path(where).is_relative_to(tmp_path)
    assert int(free) > 1000
    said = subprocess.run(
        [own, "-m", "trueup", "--version"],
        cwd=tmp_path,
        env=alone,
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout == f"trueup {trueup.__version__}\n"
    names = subprocess.run(
        [own, "-m", "zipfile", "-l", str(wheel)], capture_output=True, text=True, check=True
    ).stdout
    assert "trueup/py.typed" in names
    assert "trueup/adapters/report/page.css" in names
    for source in ("plant.h", "plant.c", "fmi2.c", "fmi3.c"):
        assert f"trueup/adapters/fmu/kernel/{source}" in names
    assert "licenses/LICENSE" in names
