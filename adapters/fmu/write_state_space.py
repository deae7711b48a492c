"""A plant as arrays with names and units: NumPy's ``.npz`` and MATLAB's ``.mat``."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...core.errors import Place
from ...core.files import replacing
from ...core.statespace.channels import Channel
from ...core.statespace.modal_plant import ModalPlant


def write_state_space(path: Path, plant: ModalPlant) -> None:
    """Write A, B, C, D (those of ``control.ss``), names and units of all, modes and shapes.

    Raises
    ------
    InputError
        A suffix that is neither .npz nor .mat, or a file that cannot be written.
    """
    if path.suffix.lower() not in (".npz", ".mat"):
        raise Place(path).fault("is neither .npz nor .mat")
    A, B, C, D = plant.matrices()
    held = {
        **{"A": A, "B": B, "C": C, "D": D},
        "input_names": np.array([c.name for c in plant.inputs]),
        "output_names": np.array([c.name for c in plant.outputs]),
        "state_names": np.array(plant.state_names),
        "input_units": _units(plant.inputs, plant.si),
        "output_units": _units(plant.outputs, plant.si),
        "frequencies_hz": plant.frequencies_hz,
        "damping": plant.damping,
        "drive": plant.drive,
        "sense": plant.sense,
        "residual_modes": np.array(plant.residual_modes),
        "band_hz": np.array(np.nan if plant.band_hz is None else plant.band_hz),
        "error": np.array(np.nan if plant.error is None else plant.error),
    }
    with replacing(path) as fresh, fresh.open("wb") as stream:
        if path.suffix.lower() == ".npz":
            np.savez_compressed(stream, allow_pickle=False, **held)
        else:
            from scipy.io import savemat

            cells = {k: v.astype(object) if v.dtype.kind == "U" else v for k, v in held.items()}
            savemat(stream, cells, oned_as="column")


def _units(channels: tuple[Channel, ...], si: bool) -> np.ndarray[tuple[int], np.dtype[np.str_]]:
    return np.array([c.unit if si else "deck" for c in channels], dtype=np.str_)
