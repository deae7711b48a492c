"""A plant written as a unit: description, data, sources and binaries in one archive."""

from __future__ import annotations

import hashlib
import struct
import zipfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from ...core.errors import InputError
from ...core.files import replacing
from ...core.statespace.modal_plant import ModalPlant
from .build_kernel import HEADERS, KERNEL, PLATFORMS, SOURCES, binaries
from .model_description import build_description, identifier, model_description
from .plant_variables import nominals

_MAGIC = 0x31746E616C70
_EPOCH = (1980, 1, 1, 0, 0, 0)
VERSIONS = (2, 3)


def write_unit(
    path: Path, plant: ModalPlant, version: int = 2, platforms: Sequence[str] = ()
) -> tuple[str, ...]:
    """Write a unit for model exchange and co-simulation.

    The same plant, kernel and compiler give the same bytes.

    Parameters
    ----------
    path : Path
        Its stem names the model.
    plant : ModalPlant
    version : {2, 3}
        FMI 2.0 or 3.0.
    platforms : sequence of str
        What to compile for, by the folders of FMI 2.0, or "all"; default: whatever a
        compiler at hand makes.

    Returns
    -------
    tuple of str
        Platforms that the unit has a binary for; none where there is no compiler: then it is a
        source unit.

    Raises
    ------
    InputError
        Another version, a platform that is not known, or a file that cannot be written.
    """
    if version not in VERSIONS:
        raise InputError(f"fmi={version!r} is no version of FMI that can be written; give 2 or 3")
    name = path.stem
    token = _token(plant)
    compiled = binaries(platforms)
    files: dict[str, bytes] = {
        "modelDescription.xml": model_description(plant, version, name, token, SOURCES).encode(),
        "resources/plant.bin": _data(plant, token),
    }
    for source in (*SOURCES, *HEADERS):
        files[f"sources/{source}"] = (KERNEL / source).read_bytes()
    if version == VERSIONS[-1]:
        files["sources/buildDescription.xml"] = build_description(name, SOURCES).encode()
    for of, content in compiled.items():
        folder, _, suffix, _ = PLATFORMS[of]
        place = of if version == VERSIONS[0] else folder
        files[f"binaries/{place}/{identifier(name)}{suffix}"] = content
    with replacing(path) as fresh, zipfile.ZipFile(fresh, "w", zipfile.ZIP_DEFLATED) as archive:
        for where, content in files.items():
            archive.writestr(zipfile.ZipInfo(where, _EPOCH), content, zipfile.ZIP_DEFLATED)
    return tuple(compiled)


def _data(plant: ModalPlant, token: str) -> bytes:
    """Return what the kernel reads; see `load` in ``kernel/plant.c``."""
    sizes = len(plant), len(plant.inputs), len(plant.outputs)
    head = struct.pack("<4q64s", _MAGIC, *sizes, token.encode())
    parts = (
        plant.frequencies_hz,
        plant.damping,
        nominals(plant),
        plant.drive.T,
        plant.quantity,
        plant.sense.T,
    )
    return head + b"".join(np.ascontiguousarray(a, dtype="<f8").tobytes() for a in parts)


def _token(plant: ModalPlant) -> str:
    """Return a token in the form of a GUID, made of what the plant is."""
    said = "\n".join(c.name for c in (*plant.inputs, *plant.outputs))
    digest = hashlib.sha256(said.encode() + _data(plant, "")).hexdigest()
    return "{" + "-".join(digest[a:b] for a, b in _GROUPS) + "}"


_GROUPS = ((0, 8), (8, 12), (12, 16), (16, 20), (20, 32))
