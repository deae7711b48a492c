"""Datasets 151 (header) and 2400 (model header): where a file comes from."""

from collections.abc import Iterator
from datetime import datetime
from typing import Any

from ..container import Section
from ..open_file import Source
from ..text.number_fields import text
from ..text.printing import dataset, text_line
from ..universal_content import Header, UniversalContent
from .dataset_kind import DatasetKind, Gathered, Outgoing


def _read(source: Source, section: Section, into: Gathered) -> int:
    lines = [text(line) for line in source.lines(section)] + [""] * 7
    program = " ".join(lines[5].split())
    into.add(Header(lines[0], lines[1], program, " ".join(lines[3].split()[:2])))
    return 1


def _read_model_header(source: Source, section: Section, into: Gathered) -> int:
    """Read dataset 2400: entity name and part number of the model."""
    lines = [text(line) for line in source.lines(section)] + [""] * 6
    into.add(Header(lines[1], lines[2], "", " ".join(lines[4].split()[:2])))
    return 1


def _tell(content: UniversalContent) -> dict[str, Any]:
    if not content.headers:
        return {}
    h = content.headers[0]
    said = {"name": h.name, "description": h.description, "program": h.program}
    return {"header": {k: v for k, v in said.items() if v and v != "NONE"}}


def _write(out: Outgoing) -> Iterator[bytes]:
    now = datetime.now().strftime("%d-%b-%y %H:%M:%S")
    saved = f"{now[:9]:10}{now[10:]:10}".encode()
    yield dataset(
        151,
        text_line(out.name),
        text_line(out.description),
        text_line("trueup"),
        saved + b"%10d%10d%10d\n" % (0, 0, 0),
        saved + b"\n",
        text_line("trueup"),
        saved + b"\n",
    )


HEADER = DatasetKind(151, "header", _read, _tell, _write)
MODEL_HEADER = DatasetKind(2400, "model header", _read_model_header)
