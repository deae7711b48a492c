"""The verb `identify`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..adapters.store import StoreContent
from ..adapters.universal import UniversalContent
from ..adapters.universal.universal_content import Skipped
from ..core.data.frfs import Frfs
from ..core.data.measurement import Measurement
from ..core.errors import InputError, Place
from ..core.results.modes import (
    band_rows,
    driving_rows,
    fault_rows,
    function_rows,
    mode_rows,
    place_rows,
    reciprocity_rows,
    rejected_rows,
)
from .files.made_of import made_of_files
from .files.sources import Source, existing, files_of
from .runs.identified import Identified
from .studies.imprint import imprint_of
from .studies.options import Files, Say, checked_call, study_of, unheard
from .studies.study import Study
from .studies.values import converted

if TYPE_CHECKING:
    from ..adapters.universal import Function

_MOST_NAMED = 20


@checked_call
def identify(
    frf: Source | None = None,
    fmin: float | None = None,
    fmax: float | None = None,
    max_order: int | None = None,
    *,
    exponential_window: float | str | None = None,
    take: float | Sequence[float] = (),
    refuse: float | Sequence[float] = (),
    bands: str | Sequence[str | tuple[float, float]] = (),
    modes: int | None = None,
    study: Study | Files | None = None,
    progress: Say = unheard,
) -> Identified:
    """Find modes in measured frequency responses, close pairs included.

    Parameters
    ----------
    frf : path, sequence of paths, Measurement or Frfs
        Responses of motion to force at any number of references; coherence functions among the
        files tell which of them, and which resonances, were measured poorly, time records which
        were cut off or hit twice. Default: the ``test``
        of the study.
    fmin, fmax : float, optional
        Use lines from here, up to here, Hz.
    max_order : int, optional
        Highest model order in a band.
    take, refuse : sequence of float
        Frequencies of rejected roots that are modes, and of modes that are none, Hz.
    exponential_window : float or str, optional
        Of the records: its time constant [s], or its value at their end ("1%"). The damping that
        it added is taken out.
    bands : sequence of (low, high) or str, optional
        Parts of the range to use, Hz, such as ``["15:60", (80.0, 180.0)]``; what lies outside
        takes no part.
    modes : int, optional
        As many modes as there are: the best founded, rejected roots among them where need be.
    study : Study or path, optional
        What stands here under other arguments may stand there (`modes` as ``identify_modes``);
        arguments win.
    progress : callable
        Told what is done, a few words at a time.

    Returns
    -------
    Identified

    Raises
    ------
    InputError
        A file that is missing or holds no frequency response; an empty range of frequencies; no
        root where one is taken or refused, fewer roots than modes asked for.
    """
    from ..adapters.report.stabilisation_page import stabilisation_page
    from ..adapters.universal.joining.join_coherence import coherence_of
    from ..adapters.universal.joining.time_records import time_records_of
    from ..core.identification.identify import identify as find
    from ..core.identification.survey.time_records import faults_of_records

    given = {"fmin": fmin, "fmax": fmax, "max_order": max_order, "take": take, "refuse": refuse,
             "exponential_window": exponential_window, "bands": bands}  # fmt: skip
    asked = study_of(
        "identify", study, {k: v for k, v in given.items() if v not in (None, ())}, given
    )
    number = converted("modes", modes, int | None, Place(shown="identify"))
    if frf is None and not asked.test:
        raise InputError("identify: no file of a test is given; give one, or a study that names it")
    progress("reading")
    imprint = imprint_of(asked)
    files = asked.test if frf is None else _files(frf)
    read = read_responses(files) if files else _content(frf)
    assert read.frfs is not None
    coherence, of_coherence = coherence_of(read)
    progress("identifying")
    found = find(
        read.frfs,
        geometry=read.geometry,
        coherence=coherence,
        **asked.identification | ({} if number is None else {"modes": number}),
    )
    asked = replace(asked, test=files, identify_modes=number or asked.identify_modes)
    of_records = faults_of_records(time_records_of(read))
    found = replace(found, faults=(*found.faults, *of_records))
    of_coherence = (*of_coherence, *(f.sentence for f in of_records))
    warnings = (*read.warnings, *_lost(read.skipped), *of_coherence, *found.warnings)
    name, hz = ", ".join(p.name for p in files), found.cmif.frequencies_hz
    answer = Identified(
        **made_of_files(files),
        frf=tuple(map(str, files)),
        modes=mode_rows(found),
        rejected=rejected_rows(found),
        references=place_rows(found.references),
        responses=place_rows(found.modes.dofs),
        bands=band_rows(found),
        quantity=found.quantity,
        lines=len(hz),
        range_hz=(float(hz[0]), float(hz[-1])),
        faults=fault_rows(found),
        driving_points=driving_rows(found),
        reciprocity=reciprocity_rows(found),
        warnings=warnings,
        functions=function_rows(found),
        content=StoreContent(
            geometry=read.geometry,
            modes={"test": found.real_modes, "test_complex": found.modes},
            matrices={"shape_std": found.shape_std},
        ),
        units=read.units,
        page="",
        study=asked if files else None,
        skipped=read.skipped,
    )
    page = stabilisation_page(found, name, warnings, read.geometry, answer, imprint)
    return replace(answer, page=page)


def _files(frf: Source) -> tuple[Path, ...]:
    return () if isinstance(frf, Frfs | Measurement) else tuple(files_of(frf))


def _content(source: Source) -> UniversalContent:
    if isinstance(source, Frfs):
        return UniversalContent(frfs=source)
    assert isinstance(source, Measurement)
    if source.frfs is None:
        raise InputError("the test holds no frequency responses to identify modes from")
    return UniversalContent(geometry=source.geometry, frfs=source.frfs, warnings=source.warnings)


def read_responses(paths: Sequence[Path]) -> UniversalContent:
    """Read files that together hold frequency responses.

    Raises
    ------
    InputError
        A file that is missing; no frequency response among what the files hold.
    """
    from ..adapters.universal import read_universal

    content = read_universal(existing(paths))
    if content.frfs is None:
        names = " and ".join(content.files)
        said = [_kind(f) for f in content.functions]
        held = [f"{said.count(kind)} × {kind}" for kind in dict.fromkeys(said)]
        held += ["mode shapes"] if content.modes is not None else []
        held += [f"{s.what} (line {s.line}: {s.why})" for s in content.skipped[:1]]
        what = f"; it holds {', '.join(held)}" if held else ""
        raise InputError(
            f"{names}: no frequency response of motion to a force (dataset 58 or 58b){what}; "
            "give the file that holds them",
            file=paths[0],
        )
    return content


def _kind(function: Function) -> str:
    """Say what a function is; of one called a frequency response, why it cannot be used."""
    if function.kind != "frequency response":
        return function.kind
    real = "" if np.iscomplexobj(function.values) else "real "
    return f"{real}frequency response of {function.quantity} per {function.per}"


def _lost(skipped: Sequence[Skipped]) -> list[str]:
    """Name the responses that could not be used, the first few one by one."""
    lost = [str(s) for s in skipped if s.harm == "lost"]
    more = len(lost) - _MOST_NAMED
    told = f"{more} further functions were not read; trueup inspect lists them"
    return [*lost[:_MOST_NAMED], *([told] if more > 0 else [])]
