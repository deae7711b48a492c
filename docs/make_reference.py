"""Write ``reference.md`` from the docstrings of the library's public face.

    python docs/make_reference.py [--check]

With ``--check`` nothing is written; the exit status is 1 where the file is not current.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import trueup

PAGE = Path(__file__).with_name("reference.md")
INTRODUCTION = """# Reference of the library

Made from the docstrings by `python docs/make_reference.py`. The verbs take files or objects and
answer as the command line does; what they build on stays open in `trueup.core` and
`trueup.adapters`.
"""


def page() -> str:
    """Return the text of the page."""
    names = [n for n in trueup.__all__ if not n.startswith("_")]
    verbs = [n for n in names if inspect.isfunction(getattr(trueup, n))]
    nouns = [n for n in names if inspect.isclass(getattr(trueup, n))]
    parts = [INTRODUCTION]
    for title, group in (("Verbs", verbs), ("Nouns", nouns)):
        parts.append(f"## {title}\n")
        parts += [entry(n, getattr(trueup, n)) for n in sorted(group, key=str.lower)]
    return "\n".join(parts)


def entry(name: str, thing: object) -> str:
    """Return one heading with signature, docstring, and the public members of a class."""
    lines = [f"### {name}\n", "```text", f"{name}{signature(thing)}", "```\n", *body(thing)]
    if inspect.isclass(thing) and not issubclass(thing, Exception):
        lines += [f"- {member}" for member in members(thing)]
    return "\n".join(lines).rstrip() + "\n"


def signature(thing: object) -> str:
    """Return the signature without the addresses of its defaults."""
    try:
        text = str(inspect.signature(thing))  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return ""
    text = re.sub(
        r"<factory>|<[^<>]* at 0x[0-9a-f]+>|<function <lambda> at 0x[0-9a-f]+>", "...", text
    )
    return text.replace("'", "")


def body(thing: object) -> Iterator[str]:
    """Return the docstring, numpydoc's underlined headings in bold."""
    lines = (inspect.getdoc(thing) or "").splitlines()
    for k, line in enumerate(lines):
        if line and set(line) == {"-"}:
            continue
        underlined = k + 1 < len(lines) and lines[k + 1] and set(lines[k + 1]) == {"-"}
        if underlined:
            yield f"**{line}**\n"
        elif line and not line.startswith(" ") and re.fullmatch(r"[\w, ]+ : .*", line):
            yield f"- `{line}`"
        else:
            yield line
    yield ""


def members(cls: type) -> Iterator[str]:
    """Return a line for each public method and property."""
    for name, member in sorted(vars(cls).items()):
        if name.startswith("_") or not (inspect.isfunction(member) or isinstance(member, property)):
            continue
        said = (inspect.getdoc(member) or "").split("\n\n")[0].replace("\n", " ")
        call = "()" if inspect.isfunction(member) else ""
        yield f"`{name}{call}`: {said}"


def main(words: list[str]) -> int:
    """Write the page, or say whether it is current."""
    text = page()
    if words == ["--check"]:
        return int(not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != text)
    if words:
        sys.exit(__doc__)
    PAGE.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
