"""The diff names only what changed, and applying it gives the other text."""

import shutil
import subprocess
from pathlib import Path

import pytest
from hypothesis import given, strategies as st
from tests.work import calls_of

from trueup.adapters.nastran.editing.deck_diff import unified_diff
from trueup.adapters.nastran.text.deck_text import DeckText
from trueup.adapters.nastran.text.source_file import TextFile
from trueup.core.errors import InputError


def pair(before: bytes, after: bytes) -> tuple[DeckText, DeckText]:
    old = DeckText((TextFile(Path("/deck/deck.bdf"), before, before),), {})
    return old, old.with_file_data({0: after})


def apply(before: bytes, diff: str) -> bytes:
    """Apply a unified diff, hunk by hunk, checking every line it takes for granted."""
    lines = before.decode("latin-1").splitlines(keepends=True)
    out, at = [], 0
    patch = diff.split("\n")[2:-1]
    k = 0
    while k < len(patch):
        assert patch[k].startswith("@@")
        start, _, n = patch[k].split()[1][1:].partition(",")
        start = int(start) - (n != "0")
        out += lines[at:start]
        at = start
        k += 1
        while k < len(patch) and not patch[k].startswith("@@"):
            sign, text = patch[k][0], patch[k][1:] + "\n"
            if k + 1 < len(patch) and patch[k + 1].startswith("\\"):
                text = text[:-1]
            if sign in " -":
                assert lines[at] == text
                at += 1
            if sign in " +":
                out.append(text)
            k += 1 + (k + 1 < len(patch) and patch[k + 1].startswith("\\"))
    return "".join(out + lines[at:]).encode("latin-1")


LINES = st.lists(st.sampled_from([b"a", b"b", b"c\r", b"", b"d \xe9"]), max_size=25)


@given(LINES, LINES, st.booleans(), st.booleans())
def test_applying_the_diff_gives_the_other_text(old, new, end_old, end_new):
    before = b"\n".join(old) + b"\n" * (end_old or old[-1:] == [b"c\r"])
    after = b"\n".join(new) + b"\n" * (end_new or new[-1:] == [b"c\r"])
    a, b = pair(before, after)
    diff = unified_diff(a, b)
    assert bool(diff) == (before != after)
    if diff:
        assert apply(before, diff) == after


def test_the_form_is_that_of_diff_u():
    before = b"".join(b"line %d\n" % n for n in range(20))
    a, b = pair(before, before.replace(b"line 7\n", b"LINE 7\nnew\n").replace(b"line 19\n", b""))
    assert unified_diff(a, b, context=1).splitlines() == [
        "--- a/deck.bdf",
        "+++ b/deck.bdf",
        "@@ -7,3 +7,4 @@",
        " line 6",
        "-line 7",
        "+LINE 7",
        "+new",
        " line 8",
        "@@ -19,2 +20 @@",
        " line 18",
        "-line 19",
    ]


def test_changes_close_together_share_a_hunk():
    before = b"".join(b"line %d\n" % n for n in range(20))
    a, b = pair(before, before.replace(b"line 7\n", b"X\n").replace(b"line 13\n", b"Y\n"))
    assert unified_diff(a, b, context=3).count("@@ -") == 1
    assert unified_diff(a, b, context=2).count("@@ -") == 2


def test_other_decks_are_not_compared():
    old, _ = pair(b"a", b"b")
    other = DeckText((TextFile(Path("/other.bdf"), b"a", b"a"),), {})
    with pytest.raises(InputError, match="same deck"):
        unified_diff(old, other)


@pytest.mark.skipif(shutil.which("patch") is None, reason="the program patch is not installed")
def test_the_program_patch_takes_it(tmp_path):
    before = b"".join(b"line %d \xe9\r\n" % n for n in range(30)) + b"end"
    after = before.replace(b"line 7", b"seven").replace(b"end", b"END\nmore")
    a, b = pair(before, after)
    (tmp_path / "deck.bdf").write_bytes(before)
    diff = unified_diff(a, b).encode("latin-1")
    subprocess.run(["patch", "-p1", "--binary"], cwd=tmp_path, input=diff, check=True)
    assert (tmp_path / "deck.bdf").read_bytes() == after


def test_scattered_changes_in_a_mesh_cost_in_proportion_to_its_lines():
    line = b"CQUAD4  %-8d1       1       2       3       4\n"
    changed = line.replace(b"d1 ", b"d2 ")

    def calls(n):
        before = b"".join(line % k for k in range(n))
        after = b"".join((line if k % 1000 else changed) % k for k in range(n))
        a, b = pair(before, after)
        said = []
        count = calls_of(lambda: said.append(unified_diff(a, b, context=0)))
        assert said[0].count("\n+") == n // 1000 + 1
        return count

    assert calls(80_000) < 4.5 * calls(20_000)
