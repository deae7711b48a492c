"""A deck written again: the same tree and bytes, whole or not at all."""

import os
from pathlib import Path

import pytest

from trueup.adapters.nastran.editing import write_deck as writing
from trueup.adapters.nastran.editing.set_values import read_value, set_values
from trueup.adapters.nastran.editing.write_deck import write_deck, write_in_place
from trueup.adapters.nastran.fields.parameter_references import FieldRef
from trueup.adapters.nastran.text.deck_text import DeckText, read_deck_text
from trueup.core.errors import InputError

AREA = FieldRef("PROD", 1, "A")


def tree(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode("latin-1"))
    return folder / next(iter(files))


def contents(folder: Path) -> dict[str, str]:
    return {
        p.relative_to(folder).as_posix(): p.read_bytes().decode("latin-1")
        for p in folder.rglob("*")
        if p.is_file()
    }


def moved(top: Path) -> DeckText:
    return set_values(read_deck_text(top), {AREA: 2.0})


def test_nothing_changed_is_written_byte_for_byte(tmp_path):
    files = {
        "deck.bdf": "CEND\r\nBEGIN BULK\r\nINCLUDE 'sub/a.bdf'  \r\nENDDATA\r\n\x1a trailing \xe9",
        "sub/a.bdf": "PROD\t1\t1\t1.0   \rGRID,1",
    }
    top = write_deck(read_deck_text(tree(tmp_path / "in", files)), tmp_path / "out")
    assert top == tmp_path / "out" / "deck.bdf"
    assert contents(tmp_path / "out") == files


def test_files_above_the_top_deck_keep_their_place(tmp_path):
    files = {"run/one/deck.bdf": "INCLUDE '../../parts/a.bdf'\n", "parts/a.bdf": "PROD,1,1,1.\n"}
    source = tree(tmp_path / "in", files)
    top = write_deck(moved(source), tmp_path / "out")
    assert top == tmp_path / "out/run/one/deck.bdf"
    assert contents(tmp_path / "out") == {**files, "parts/a.bdf": "PROD,1,1,2.\n"}
    assert contents(tmp_path / "in") == files
    assert read_value(read_deck_text(top), AREA) == 2.0


def test_a_file_named_absolutely_stays_where_it_is_while_nothing_in_it_changes(tmp_path):
    far = tree(tmp_path / "far", {"mesh.bdf": "GRID,1\n"})
    files = {"deck.bdf": f"INCLUDE '{far}'\nPROD,1,1,1.\n"}
    write_deck(moved(tree(tmp_path / "in", files)), tmp_path / "out")
    assert contents(tmp_path / "out") == {"deck.bdf": f"INCLUDE '{far}'\nPROD,1,1,2.\n"}


def test_a_file_named_absolutely_is_copied_when_it_changes(tmp_path):
    far = tree(
        tmp_path / "far",
        {"a.bdf": "$ a\nINCLUDE 'p/b.bdf'\nINCLUDE 'c.bdf'\n", "p/b.bdf": "PROD,1,1,1.\n",
         "c.bdf": "GRID,1\n"},
    )  # fmt: skip
    files = {"deck.bdf": f"INCLUDE '{far}'\nGRID,2\n"}
    top = write_deck(moved(tree(tmp_path / "in", files)), tmp_path / "out")
    written = read_deck_text(top)
    assert read_value(written, AREA) == 2.0
    assert [f.path for f in written.files] == [
        top,
        tmp_path / "out/included/a.bdf",
        tmp_path / "out/included/b.bdf",
        tmp_path / "far/c.bdf",
    ]
    assert contents(tmp_path / "far")["p/b.bdf"] == "PROD,1,1,1.\n"


def test_a_file_named_absolutely_inside_the_tree_gets_its_own_place(tmp_path):
    folder = tmp_path / "in"
    files = {"deck.bdf": f"INCLUDE '{folder}/sub/a.bdf'\nGRID,2\n", "sub/a.bdf": "PROD,1,1,1.\n"}
    top = write_deck(moved(tree(folder, files)), tmp_path / "out")
    assert contents(tmp_path / "out") == {
        "deck.bdf": "INCLUDE 'sub/a.bdf'\nGRID,2\n",
        "sub/a.bdf": "PROD,1,1,2.\n",
    }
    assert read_value(read_deck_text(top), AREA) == 2.0


def test_long_paths_are_broken_over_lines(tmp_path):
    deep = "/".join(f"folder_{n:02d}" for n in range(12))
    files = {
        "deck.bdf": f"INCLUDE '{tmp_path}/in/{deep}/a.bdf'\n",
        f"{deep}/a.bdf": "PROD,1,1,1.\n",
    }
    top = write_deck(moved(tree(tmp_path / "in", files)), tmp_path / "out")
    assert max(len(line) for line in top.read_text().splitlines()) <= 72
    assert read_value(read_deck_text(top), AREA) == 2.0


def test_a_folder_with_files_is_not_written_over(tmp_path):
    top = tree(tmp_path / "in", {"deck.bdf": "PROD,1,1,1.\n"})
    tree(tmp_path / "out", {"mine.txt": "x"})
    with pytest.raises(InputError, match="exists already"):
        write_deck(read_deck_text(top), tmp_path / "out")
    assert contents(tmp_path / "out") == {"mine.txt": "x"}


def test_an_empty_folder_may_be_there(tmp_path):
    (tmp_path / "out").mkdir()
    write_deck(read_deck_text(tree(tmp_path, {"deck.bdf": "PROD,1,1,1.\n"})), tmp_path / "out")
    assert contents(tmp_path / "out") == {"deck.bdf": "PROD,1,1,1.\n"}


def test_a_failure_leaves_nothing_behind(tmp_path, monkeypatch):
    deck = read_deck_text(tree(tmp_path / "in", {"deck.bdf": "PROD,1,1,1.\n"}))
    monkeypatch.setattr(Path, "write_bytes", lambda *_: (_ for _ in ()).throw(OSError(28, "full")))
    with pytest.raises(InputError, match=r"cannot write the deck to .*: full"):
        write_deck(deck, tmp_path / "out")
    assert [p.name for p in tmp_path.iterdir()] == ["in"]


def test_in_place_changes_only_what_differs_and_keeps_a_backup(tmp_path):
    files = {"deck.bdf": "INCLUDE 'a.bdf'\nGRID,2\n", "a.bdf": "PROD,1,1,1.\n"}
    top = tree(tmp_path, files)
    (tmp_path / "a.bdf").chmod(0o640)
    backups = write_in_place(moved(top))
    assert backups == (tmp_path / "a.bdf.bak",)
    after = contents(tmp_path)
    assert after == {**files, "a.bdf": "PROD,1,1,2.\n", "a.bdf.bak": "PROD,1,1,1.\n"}
    assert (tmp_path / "a.bdf").stat().st_mode & 0o777 == 0o640


def test_in_place_never_overwrites_a_backup(tmp_path):
    top = tree(tmp_path, {"deck.bdf": "PROD,1,1,1.\n", "deck.bdf.bak": "older"})
    assert write_in_place(moved(top)) == (tmp_path / "deck.bdf.bak2",)
    assert (tmp_path / "deck.bdf.bak").read_text() == "older"


def test_in_place_follows_a_link(tmp_path):
    top = tree(tmp_path / "real", {"deck.bdf": "PROD,1,1,1.\n"})
    link = tmp_path / "deck.bdf"
    link.symlink_to(top)
    write_in_place(moved(link))
    assert link.is_symlink()
    assert top.read_text() == "PROD,1,1,2.\n"


def test_in_place_refuses_a_file_that_changed_meanwhile(tmp_path):
    top = tree(tmp_path, {"deck.bdf": "PROD,1,1,1.\n"})
    deck = moved(top)
    top.write_text("PROD,1,1,5.\n")
    with pytest.raises(InputError, match="changed on disk"):
        write_in_place(deck)
    assert contents(tmp_path) == {"deck.bdf": "PROD,1,1,5.\n"}


def test_in_place_writes_nothing_when_nothing_changed(tmp_path):
    top = tree(tmp_path, {"deck.bdf": "PROD,1,1,1.\n"})
    assert write_in_place(read_deck_text(top)) == ()
    assert contents(tmp_path) == {"deck.bdf": "PROD,1,1,1.\n"}


def test_in_place_restores_all_files_when_one_cannot_be_replaced(tmp_path, monkeypatch):
    files = {"deck.bdf": "INCLUDE 'a.bdf'\nPROD,2,1,1.\n", "a.bdf": "PROD,1,1,1.\n"}
    deck = set_values(moved(tree(tmp_path, files)), {FieldRef("PROD", 2, "A"): 3.0})
    real_replace = os.replace

    def fail_on_second(source, target):
        if Path(target).name == "a.bdf":
            raise OSError(5, "broken")
        real_replace(source, target)

    monkeypatch.setattr(writing.os, "replace", fail_on_second)
    with pytest.raises(InputError, match="in place: broken"):
        write_in_place(deck)
    assert contents(tmp_path) == files
