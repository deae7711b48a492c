"""INCLUDE statements: what they name, over which lines, and which file that is."""

import os
import re
from pathlib import Path

from ....core.errors import Place

_QUOTED = re.compile(r"""(['"])(?P<path>.*?)\1""", re.DOTALL)
_LOGICAL = re.compile(r"(?P<symbol>[A-Za-z_]\w+):(?P<rest>.*)", re.DOTALL)
_WINDOWS_VARIABLE = re.compile(r"%(\w+)%")
_MOST_LINES = 50


def parse_include(lines: list[str], where: Place, more: int = 0) -> tuple[str, int]:
    """Return the path that an INCLUDE names as it is written, and how many lines it takes.

    Parameters
    ----------
    lines : list of str
        The line that starts with INCLUDE and those after it.
    where : Place
        File and line, for messages.
    more : int
        Lines over which a name without quotes goes on.

    Raises
    ------
    InputError
        A quote that is never closed, or no name.
    """
    body = lines[0].strip()[len("INCLUDE") :].strip().lstrip(",= \t")
    used = 1
    if body[:1] in ("'", '"') and body:
        while not _QUOTED.match(body):
            if used >= len(lines) or used > _MOST_LINES:
                raise where.error("the quote after INCLUDE is never closed")
            body += lines[used].strip()
            used += 1
        match = _QUOTED.match(body)
        name = match["path"].strip() if match else ""
    else:
        name = body.split("$", 1)[0].strip()
        for line in lines[1 : 1 + more]:
            name += line.split("$", 1)[0].strip()
            used += 1
    if not name:
        raise where.error("INCLUDE names no file")
    return name, used


def is_anchored(name: str) -> bool:
    """Whether an INCLUDE names its file by an absolute path or a symbol, not a relative one."""
    return os.path.isabs(_expand(name, Place())) if not _LOGICAL.fullmatch(name) else True


def locate_include(name: str, parent: Path, top: Path, where: Place) -> Path:
    """Find the file an INCLUDE names: beside the including file, else beside the top deck.

    Environment variables are put in for ``SYMBOL:``, ``$NAME`` and ``%NAME%``; backslashes
    separate folders; a name that differs by case only is taken where there is just one.

    Raises
    ------
    InputError
        No such file: where it was looked for.
    """
    relative = Path(_expand(name, where))
    places = [Path(os.path.normpath(folder / relative)) for folder in (parent.parent, top.parent)]
    for place in places:
        if place.is_file():
            return place
        same = _ignoring_case(place)
        if same is not None:
            return same
    looked = " and ".join(str(p) for p in dict.fromkeys(places))
    raise where.error(f"the INCLUDE file {name!r} does not exist (looked for {looked})")


def _expand(name: str, where: Place) -> str:
    written = name
    match = _LOGICAL.fullmatch(name)
    if match:
        folder = os.environ.get(match["symbol"])
        if folder is None:
            raise where.error(
                f"INCLUDE {written!r} uses the symbol {match['symbol']!r}, which is not "
                "set: set the environment variable of that name to its folder"
            )
        name = f"{folder}/{match['rest']}"
    name = _WINDOWS_VARIABLE.sub(lambda m: os.environ.get(m[1], m[0]), name)
    return os.path.expandvars(name).replace("\\", "/")


def _ignoring_case(path: Path) -> Path | None:
    if not path.parent.is_dir():
        return None
    same = [p for p in path.parent.iterdir() if p.name.lower() == path.name.lower()]
    return same[0] if len(same) == 1 and same[0].is_file() else None
