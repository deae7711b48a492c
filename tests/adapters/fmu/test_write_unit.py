"""What stands in the archive, with and without a compiler."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.io import loadmat
from tests.adapters.fmu.plants import HZ, VERSIONS, plant

from trueup.adapters.fmu import build_kernel, write_state_space, write_unit
from trueup.core.errors import InputError


@pytest.mark.parametrize("version", VERSIONS)
def test_the_same_plant_gives_the_same_bytes(
    tmp_path: Path, version: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Also in another process and compiled again."""
    first = tmp_path / "plant.fmu"
    monkeypatch.setattr(build_kernel, "_cache", lambda: tmp_path / "kept")
    made = write_unit(first, plant(), version, ["linux64"])
    assert len(list((tmp_path / "kept").iterdir())) == len(made)
    code = (
        "import sys; from pathlib import Path; from tests.adapters.fmu.plants import plant\n"
        "from trueup.adapters.fmu import build_kernel, write_unit\n"
        "build_kernel._cache = lambda: Path('fresh').absolute()\n"
        f"write_unit(Path('plant.fmu'), plant(), {version}, ['linux64'])"
    )
    (tmp_path / "again").mkdir()
    environment = {**os.environ, "PYTHONHASHSEED": "7", "PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path / "again", env=environment, check=True
    )
    assert (tmp_path / "again" / "plant.fmu").read_bytes() == first.read_bytes()


@pytest.mark.parametrize("version", VERSIONS)
def test_without_a_compiler_the_unit_holds_its_sources(
    tmp_path: Path, version: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(build_kernel, "_compilers", lambda name: [])
    assert write_unit(tmp_path / "plant.fmu", plant(), version) == ()
    with zipfile.ZipFile(tmp_path / "plant.fmu") as archive:
        names = archive.namelist()
    assert {"sources/plant.c", "sources/plant.h", "sources/fmi2.c", "sources/fmi3.c"} < set(names)
    assert ("sources/buildDescription.xml" in names) == (version == VERSIONS[1])
    assert not any(n.startswith("binaries/") for n in names)


def test_every_platform_that_a_compiler_makes_has_its_binary(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A compiler of a cross-compiler's name stands on the path; what it made is kept."""
    monkeypatch.setattr(build_kernel, "_cache", lambda: tmp_path / "kept")
    monkeypatch.setattr(build_kernel, "find_spec", lambda name: None)
    compiler = tmp_path / "x86_64-w64-mingw32-gcc"
    compiler.write_text('#!/bin/sh\nwhile [ "$1" != -o ]; do shift; done\necho MZ > "$2"\n')
    compiler.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    assert "win64" in write_unit(tmp_path / "plant.fmu", plant(), 3)
    age = compiler.stat().st_mtime_ns
    compiler.write_text("#!/bin/sh\nexit 1\n")
    os.utime(compiler, ns=(age, age))
    assert "win64" in write_unit(tmp_path / "plant.fmu", plant(), 3)
    os.utime(compiler, ns=(age + 1, age + 1))
    assert "win64" not in write_unit(tmp_path / "other.fmu", plant(), 3)
    with zipfile.ZipFile(tmp_path / "plant.fmu") as archive:
        assert archive.read("binaries/x86_64-windows/plant.dll") == b"MZ\n"


@pytest.mark.parametrize("version", VERSIONS)
def test_the_description_says_units_starts_and_dependencies(tmp_path: Path, version: int) -> None:
    write_unit(tmp_path / "a plant.fmu", plant(), version)
    with zipfile.ZipFile(tmp_path / "a plant.fmu") as archive:
        root = ElementTree.fromstring(archive.read("modelDescription.xml"))
    identifiers = {e.get("modelIdentifier") for e in root if "modelIdentifier" in e.attrib}
    assert identifiers == {"a_plant"}
    experiment = root.find("DefaultExperiment")
    assert experiment is not None
    assert float(experiment.attrib["stepSize"]) == pytest.approx(0.05 / HZ.max())
    every = root.find("ModelVariables")
    assert every is not None
    said = {}
    for place, v in enumerate(every):
        inside = v[0] if version == VERSIONS[0] else v
        said[v.get("name")] = {**inside.attrib, **v.attrib}
        assert v.get("valueReference") == str(place)
    assert said["g1.force.Z"]["unit"] == "N"
    assert said["g2.moment.RX"]["unit"] == "N.m"
    assert said["g2.angularVelocity.RX"]["unit"] == "rad/s"
    assert said["mode[2].frequency"]["variability"] == "tunable"
    assert float(said["mode[2].frequency"]["start"]) == HZ[1]
    assert all(float(said[f"mode[{k}].q"]["nominal"]) > 0.0 for k in range(1, 7))
    shift = 1 if version == VERSIONS[0] else 0
    outputs = root.find("ModelStructure/Outputs") if shift else root.find("ModelStructure")
    assert outputs is not None
    by = [set(map(int, (e.get("dependencies") or "").split())) for e in list(outputs)[:5]]
    inputs = {shift, 1 + shift, 2 + shift}
    assert [bool(b & inputs) for b in by] == [False, False, True, False, True]


def test_another_version_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="fmi=1 is no version"):
        write_unit(tmp_path / "plant.fmu", plant(), 1)
    assert not list(tmp_path.iterdir())


def test_sources_name_only_the_c_library() -> None:
    text = "".join((build_kernel.KERNEL / s).read_text("utf-8") for s in build_kernel.SOURCES)
    assert set(re.findall(r"#include <(.*)>", text)) <= {
        "math.h", "stdbool.h", "stdint.h", "stdio.h", "stdlib.h", "string.h",
    }  # fmt: skip


def test_arrays_hold_the_state_space_with_names_and_units(tmp_path: Path) -> None:
    for name in ("plant.npz", "plant.mat"):
        write_state_space(tmp_path / name, plant())
    arrays = np.load(tmp_path / "plant.npz", allow_pickle=False)
    matlab = loadmat(tmp_path / "plant.mat")
    for key, matrix in zip("ABCD", plant().matrices(), strict=True):
        assert np.array_equal(arrays[key], matrix)
        assert np.array_equal(matlab[key], matrix)
    assert arrays["output_units"].tolist() == ["m", "rad/s", "m/s2", "m", "m/s2"]
    assert [str(n[0]) for n in matlab["input_names"].ravel()][2] == "push"


def test_python_control_takes_the_arrays(tmp_path: Path) -> None:
    control = pytest.importorskip("control", reason="python-control is not installed")
    write_state_space(tmp_path / "plant.npz", plant())
    p = np.load(tmp_path / "plant.npz", allow_pickle=False)
    names = {k: [n.replace(".", "_") for n in p[f"{k[:-1]}_names"].tolist()]
             for k in ("inputs", "outputs", "states")}  # fmt: skip
    system = control.ss(p["A"], p["B"], p["C"], p["D"], **names)
    assert system.input_labels == ["g1_force_Z", "g2_moment_RX", "push"]
    exact = plant().responses(np.array([9.0]))[:, :, 0]
    assert system(2j * np.pi * 9.0) == pytest.approx(exact, rel=1e-9)


def test_platforms_that_are_not_known_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the platform 'amiga' is not known; give all, or some of"):
        write_unit(tmp_path / "plant.fmu", plant(), 2, ["amiga"])
    assert not list(tmp_path.iterdir())
