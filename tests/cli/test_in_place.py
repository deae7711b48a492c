"""``--in-place``: the user's own deck changed, with a backup, and nothing else touched."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from trueup.adapters.nastran import read_deck_text

Call = Callable[..., Any]


@pytest.fixture
def nested(inputs: Path) -> Path:
    """The duct with its front flange in a file of CRLF lines and Latin-1, included by another."""
    lines = (inputs / "properties.bdf").read_text().splitlines()
    at = next(k for k, s in enumerate(lines) if s.startswith("PBAR    11"))
    card = [lines[at]]
    while lines[at + len(card)][:1] in (" ", "+", "*"):
        card.append(lines[at + len(card)])
    (inputs / "rings").mkdir()
    text = "\r\n".join(["$ Flansch außen  ", *card, "$ Ende"]) + "\r\n"
    (inputs / "rings" / "front.blk").write_bytes(text.encode("latin-1"))
    lines[at : at + len(card)] = ["INCLUDE 'rings/", "   front.blk'"]
    (inputs / "properties.bdf").write_text("\n".join(lines) + "\n")
    return inputs


def files_of(folder: Path) -> dict[str, bytes]:
    return {
        p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()
    }


@pytest.mark.slow
@pytest.mark.parametrize("option", ["-ip", "--in-place"])
def test_update_in_place(call: Call, nested: Path, tmp_path: Path, option: str) -> None:
    before = files_of(nested)
    run = tmp_path / "run"
    said = call(
        "update", nested / "duct.bdf", nested / "duct_test.unv", "-p", "PBAR 11 I2",
        "--residuals", "frequencies", "--max-iterations", "1", "--out", run, option,
    )  # fmt: skip
    assert said.status == 0, said.err
    after = files_of(nested)
    changed = {name for name in after if before.get(name) != after[name]}
    assert changed == {"rings/front.blk", "rings/front.blk.bak"}
    assert after["rings/front.blk.bak"] == before["rings/front.blk"]
    assert after["rings/front.blk"] == (run / "deck" / "rings" / "front.blk").read_bytes()
    old, new = (t["rings/front.blk"].split(b"\r\n") for t in (before, after))
    assert (old[0], old[-2:]) == (new[0], new[-2:])
    assert b"\n" not in after["rings/front.blk"].replace(b"\r\n", b"")
    result = json.loads((run / "result.json").read_text())
    assert [Path(p).name for p in result["in_place"]["files"]] == ["front.blk"]
    assert [Path(p).name for p in result["in_place"]["backups"]] == ["front.blk.bak"]
    assert "changed in place" in said.out
    value = result["parameters"][0]["updated"][0]
    deck = read_deck_text(nested / "duct.bdf")
    from trueup.adapters.nastran import FieldRef, read_value

    assert read_value(deck, FieldRef("PBAR", 11, "I2")) == value
    diff = (run / "changes.diff").read_bytes()
    assert b"--- a/rings/front.blk" in diff
    assert b"-PBAR    11" in diff
    assert diff.count(b"\r\n") >= 4  # the lines of the file as they are


def test_a_run_that_is_refused_leaves_the_deck_alone(
    call: Call, nested: Path, tmp_path: Path
) -> None:
    before = files_of(nested)
    said = call(
        "update", nested / "duct.bdf", nested / "duct_test.unv", "-p", "PBAR 77 I1", "-ip",
        "--out", tmp_path / "run",
    )  # fmt: skip
    assert said.status == 1
    assert files_of(nested) == before
    assert not (tmp_path / "run").exists()


def test_correlate_changes_no_deck(call: Call, nested: Path) -> None:
    said = call("correlate", nested / "duct.bdf", nested / "duct_test.unv", "--in-place")
    assert said.status == 2
