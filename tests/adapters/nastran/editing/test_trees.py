"""Decks of several files, INCLUDE in all its forms: changed on disk, and only what must change.

Each deck is generated: its cards in any format (see written_decks.py), spread over nested files
with their own line ends and encodings, text before CEND, after ENDDATA and between the cards.
"""

import os
import tempfile
from pathlib import Path

from hypothesis import HealthCheck, given, settings, strategies as st
from tests.adapters.nastran.editing import written_decks

from trueup.adapters.nastran import read_deck_text, split_property, write_deck, write_in_place
from trueup.adapters.nastran.deck.logical_lines import read_sections
from trueup.adapters.nastran.deck.raw_cards import cut, fields_of
from trueup.adapters.nastran.editing.add_cards import add_cards
from trueup.adapters.nastran.editing.deck_diff import unified_diff
from trueup.adapters.nastran.editing.find_cards import find_card, free_id
from trueup.adapters.nastran.editing.set_values import read_value, set_values
from trueup.adapters.nastran.editing.write_deck import names_in_tree
from trueup.adapters.nastran.fields.parameter_references import FieldRef
from trueup.adapters.nastran.text.real_numbers import writable

CARDS = [
    *written_decks.CARDS,
    ["CQUAD4", "31", "3", "1", "2", "3", "4", "", "", "", "", "2.5"],
    ["CTRIA3", "32", "3", "1", "2", "3"],
    ["CBAR", "33", "11", "1", "2", "0.", "0.", "1."],
    ["GRID", "1", "", "0.", "0.", "0."],
]
NAMES = ["mesh.bdf", "sub/Props Wing.dat", "sub/deep/mat.inc", "other/bars.blk"]
SYMBOL = "TRUEUP_TEST_TREE"


def statement(form, target, folder):
    """An INCLUDE of a file (path below the root) from a file of some folder."""
    relative = os.path.relpath(target, folder or ".").replace(os.sep, "/")
    cut_at = max(relative.rfind("/") + 1, 1)
    return {
        "quoted": [f"INCLUDE '{relative}'"],
        "double quoted": [f'include "{relative}" $ see there'],
        "split": [f"INCLUDE '{relative[:cut_at]}", f"   {relative[cut_at:]}'"],
        "backslash": ["INCLUDE '" + relative.replace("/", "\\") + "'"],
        "symbol": [f"INCLUDE '{SYMBOL}:{target}'"],
        "bare": [f"INCLUDE {relative}"] if " " not in relative else [f"INCLUDE '{relative}'"],
    }[form]


FORMS = ("quoted", "double quoted", "split", "backslash", "symbol", "bare")


@st.composite
def trees(draw):
    """Files of a deck as bytes by path, and which file each card stands in."""
    cards = draw(st.permutations(CARDS))
    names = ["run/deck.bdf", *NAMES[: draw(st.integers(1, len(NAMES)))]]
    homes = [draw(st.sampled_from(names)) for _ in cards]
    parents = {n: draw(st.sampled_from(names[: names.index(n)])) for n in names[1:]}
    children = {n: [c for c, p in parents.items() if p == n] for n in names}
    files, where = {}, {}
    for name in names:
        pieces = []
        for card, home in zip(cards, homes, strict=True):
            if home == name:
                where[card[0], int(card[1])] = name
                pieces.append(draw(written_decks.card_lines(card)))
                pieces.append([draw(st.sampled_from(written_decks.BETWEEN))])
        for child in children[name]:
            form = draw(st.sampled_from(FORMS))
            lines = statement(form, child, os.path.dirname(name))
            pieces.insert(2 * draw(st.integers(0, len(pieces) // 2)), [x.encode() for x in lines])
        lines = [x for piece in pieces for x in piece]
        if name == names[0]:
            lines = [b"SOL 103", b"CEND", b"TITLE = PSHELL 3", b"BEGIN BULK", *lines]
            if draw(st.booleans()):
                lines += [b"ENDDATA", b"INCLUDE 'nowhere.bdf'", b"PBAR    11      \xff"]
        newline = draw(st.sampled_from([b"\n", b"\r\n"]))
        ended = draw(st.booleans()) or name != names[0]
        files[name] = newline.join(lines) + (newline if ended else b"")
    return files, where


class Tree:
    """The files of a deck in a folder of their own while a test runs."""

    def __init__(self, files):
        self.files = files

    def __enter__(self):
        self._folder = tempfile.TemporaryDirectory()
        self.root = Path(self._folder.name).resolve() / "in"
        for name, data in self.files.items():
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        self._before = os.environ.get(SYMBOL)
        os.environ[SYMBOL] = str(self.root)
        return self

    def __exit__(self, *_):
        os.environ.pop(SYMBOL)
        self._folder.cleanup()

    @property
    def top(self):
        return self.root / "run" / "deck.bdf"

    def now(self):
        return {
            p.relative_to(self.root).as_posix(): p.read_bytes()
            for p in self.root.rglob("*")
            if p.is_file()
        }


def all_cards(path):
    sections = read_sections(path)
    return [fields_of(raw.lines) for raw in cut(sections.bulk, sections.files)]


several = settings(deadline=None, max_examples=40, suppress_health_check=[HealthCheck.too_slow])


@several
@given(trees())
def test_nothing_asked_nothing_changed(tree):
    files, _ = tree
    with Tree(files) as t:
        deck = read_deck_text(t.top)
        assert sorted(f.path for f in deck.files) == sorted(t.root / n for n in files)
        assert len(all_cards(t.top)) == len(CARDS)
        written = write_deck(deck, t.root.parent / "out")
        out = t.root.parent / "out"
        copies = {p.relative_to(out).as_posix() for p in out.rglob("*") if p.is_file()}
        names = dict(zip(names_in_tree(deck), deck.files, strict=True))
        assert copies
        for copy in copies:
            assert (out / copy).read_bytes() == names[copy].original
        assert all_cards(written) == all_cards(t.top)
        assert written.name == "deck.bdf"
        assert write_in_place(deck) == ()
        assert t.now() == files


@several
@given(trees(), st.data())
def test_one_value_changed_in_place_touches_its_card_alone(tree, data):
    files, where = tree
    card = data.draw(st.sampled_from(written_decks.CARDS))
    ref, _ = data.draw(st.sampled_from(written_decks.references(card)))
    value = data.draw(written_decks.VALUES)
    with Tree(files) as t:
        deck = read_deck_text(t.top)
        place = find_card(deck, ref.card, ref.id)
        edited = set_values(deck, {ref: value})
        took_away = list(removed_rows(deck, edited))
        assert {file for file, _ in took_away} <= {place.file}
        assert {row for _, row in took_away} <= set(place.rows)
        write_in_place(edited)
        after = t.now()
        home = where[card[0], int(card[1])]
        assert {n for n in files if files[n] != after[n]} <= {home}
        assert set(after) - set(files) <= {f"{home}.bak"}
        assert after.get(f"{home}.bak", files[home]) == files[home]
        assert read_value(read_deck_text(t.top), ref) == writable(value)
        assert len(all_cards(t.top)) == len(CARDS)


def removed_rows(before, after):
    """File and line of the lines that a diff takes away."""
    files = {f"--- a/{name}": k for k, name in enumerate(names_in_tree(before))}
    file, row = -1, 0
    for line in unified_diff(before, after, context=0).split("\n"):
        if line in files:
            file = files[line]
        elif line.startswith("@@"):
            row = int(line.split()[1][1:].partition(",")[0]) - 1
        elif line.startswith("-") and not line.startswith("--- a/"):
            yield file, row
            row += 1


@several
@given(trees(), st.data())
def test_new_cards_stand_in_one_block_beside_their_neighbour(tree, data):
    files, where = tree
    near = data.draw(st.sampled_from(sorted(where)))
    with Tree(files) as t:
        deck = read_deck_text(t.top)
        kinds = {"property": free_id(deck, "property"), "material": free_id(deck, "material"),
                 "element": free_id(deck, "element")}  # fmt: skip
        for name, number in (("PSHELL", "property"), ("MAT1", "material"), ("CONM2", "element")):
            held = {n for segment in deck.segments for _, n in deck.rows_in(segment, name)}
            assert kinds[number] not in held
        mine = [
            ["MAT1", kinds["material"], 7.1e4, None, 0.33],
            ["PSHELL", kinds["property"], kinds["material"], 0.1 + 0.2],
        ]
        edited = add_cards(deck, mine, "a patch that the model lacks", near)
        changed = [k for k, f in enumerate(edited.files) if f.edited]
        home = deck.files.index(next(f for f in deck.files if f.path == t.root / where[near]))
        assert changed == [home]
        old, new = deck.files[home].data, edited.files[home].data
        start = next(k for k in range(len(old) + 1) if new[: k + 1] != old[: k + 1])
        assert new[:start] == old[:start]
        assert new.endswith(old[start:]) or not old[start:]
        assert b"$ a patch that the model lacks" in new
        write_in_place(edited)
        again = all_cards(t.top)
        assert len(again) == len(CARDS) + 2
        reread = read_deck_text(t.top)
        assert read_value(reread, FieldRef("PSHELL", kinds["property"], "T")) == writable(0.1 + 0.2)


@several
@given(trees(), st.sampled_from([[31], [32], [31, 32]]))
def test_a_property_split_moves_the_named_elements_alone(tree, elements):
    files, _ = tree
    with Tree(files) as t:
        deck = read_deck_text(t.top)
        before = {(c[0], c[1]): c for c in all_cards(t.top)}
        done = split_property(deck, "PSHELL", 3, elements, "a soft patch")
        write_in_place(done.deck)
        after = {(c[0], c[1]): c for c in all_cards(t.top)}
        assert len(after) == len(before) + 2  # its property and its material
        for key, card in before.items():
            expected = list(card)
            if key in (("CQUAD4", "31"), ("CTRIA3", "32")) and int(key[1]) in elements:
                expected[2] = str(done.property)
            assert [w or "" for w in after[key]] == [w or "" for w in expected]
        copy, original = after["PSHELL", str(done.property)], before["PSHELL", "3"]
        materials = {str(old): str(new) for old, new in done.materials.items()}
        fields = zip(copy[2:], original[2:], strict=True)
        for k, (new, old) in enumerate(fields, 2):
            assert (new or "") == (materials.get(old, old) if k in (2, 4, 6, 11) else (old or ""))
