"""What stands on the report of a study besides its results."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING

from ...core.errors import Place
from .study import Study

if TYPE_CHECKING:
    from ...adapters.report import Imprint

_PICTURES = {".png": "png", ".svg": "svg+xml", ".jpg": "jpeg", ".jpeg": "jpeg", ".webp": "webp"}


def imprint_of(study: Study) -> Imprint:
    """Return what stands on the report of a study besides its results.

    Raises
    ------
    InputError
        A logo that cannot be read or is no picture that a page can show.
    """
    from ...adapters.report import Imprint
    from ...core.files import reading

    logo = ""
    if study.logo is not None:
        kind = _PICTURES.get(study.logo.suffix.lower())
        if kind is None:
            known = ", ".join(_PICTURES)
            raise Place(study.logo).fault(f"is no picture that a page shows; give {known}")
        with reading(study.logo):
            held = base64.b64encode(study.logo.read_bytes()).decode()
        logo = f"data:image/{kind};base64,{held}"
    title, author, company, date = (
        text or "" for text in (study.title, study.author, study.company, study.date)
    )
    return Imprint(title, author, company, date, logo)
