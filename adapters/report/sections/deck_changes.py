"""What changed in the deck: its unified diff, changed fields picked out."""

from difflib import SequenceMatcher

from ....core.results.correlation import RunTables
from ..html.markup import esc, tag
from .section import Section

_MOST_LINES = 600


def deck_diff(diff: str) -> str:
    """Return a unified diff as coloured lines; what changed within a line stands out.

    Long diffs are cut with a line that says how much is left out.
    """
    lines = diff.splitlines()
    shown, rest = lines[:_MOST_LINES], len(lines) - _MOST_LINES
    out: list[str] = []
    k = 0
    while k < len(shown):
        removed = _run(shown, k, "-")
        added = _run(shown, k + len(removed), "+")
        if removed or added:
            out += _change(removed, added)
            k += len(removed) + len(added)
        else:
            out.append(tag("span", esc(shown[k]) or " ", class_=_role(shown[k])))
            k += 1
    if rest > 0:
        out.append(tag("span", f"… {rest} more lines in changes.diff", class_="more"))
    return tag("pre", "\n".join(out), class_="diff", tabindex="0")


def _role(line: str) -> str | None:
    if line.startswith(("--- ", "+++ ")):
        return "file"
    return "at" if line.startswith("@@") else None


def _run(lines: list[str], start: int, sign: str) -> list[str]:
    end = start
    while end < len(lines) and lines[end].startswith(sign) and not _role(lines[end]):
        end += 1
    return lines[start:end]


def _change(removed: list[str], added: list[str]) -> list[str]:
    """Mark lines; where as many went as came, line by line what differs."""
    if len(removed) != len(added):
        old, new = [esc(s) for s in removed], [esc(s) for s in added]
    else:
        marked = [_differing(a, b) for a, b in zip(removed, added, strict=True)]
        old, new = [m[0] for m in marked], [m[1] for m in marked]
    return [tag("del", s) for s in old] + [tag("ins", s) for s in new]


def _differing(old: str, new: str) -> tuple[str, str]:
    a, b = old[1:], new[1:]
    left, right = esc(old[0]), esc(new[0])
    for kind, i, j, m, n in _fields(a, b):
        if kind == "equal":
            left, right = left + esc(a[i:j]), right + esc(b[m:n])
        else:
            left += tag("b", esc(a[i:j])) if j > i else ""
            right += tag("b", esc(b[m:n])) if n > m else ""
    return left, right


def _fields(a: str, b: str) -> list[tuple[str, int, int, int, int]]:
    """Differences by fields of eight columns where the card keeps them, else by characters."""
    if len(a.rstrip()) <= 80 and len(b.rstrip()) <= 80 and not {"\t", ","} & set(a + b):
        out: list[tuple[str, int, int, int, int]] = []
        width = max(len(a), len(b))
        for k in range(0, width, 8):
            i, j, m, n = min(k, len(a)), min(k + 8, len(a)), min(k, len(b)), min(k + 8, len(b))
            out.append(("equal" if a[i:j] == b[m:n] else "replace", i, j, m, n))
        return out
    return list(SequenceMatcher(None, a, b, autojunk=False).get_opcodes())


DECK_CHANGES = Section(
    "Changes to the deck", "deck", RunTables,
    render=lambda run: deck_diff(run.diff) if run.diff.strip() else "",
)  # fmt: skip
