"""Cards written every way Nastran reads, and ways to read them again."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import strategies as st

from trueup.adapters.nastran.cards import definitions
from trueup.adapters.nastran.deck.logical_lines import read_sections
from trueup.adapters.nastran.deck.raw_cards import cut, fields_of
from trueup.adapters.nastran.editing.find_cards import find_card
from trueup.adapters.nastran.fields.parameter_references import FieldRef
from trueup.adapters.nastran.text.deck_text import DeckText, read_deck_text

# Cards with at least two lines of fields: name, then data fields ("" blank).
CARDS = [
    ["PSHELL", "3", "1", "2.5", "1", "", "1", "", "1.5-3", "-1.25", "1.25", "1"],
    ["PBAR", "11", "1", "200.", "9000.", "9000.", "3000.", "", "", "10.", "10.", "-10.", "10."],
    ["MAT1", "1", "70000.", "", ".33", "2.7-9", "1.E-6", "20.", ".02", "", "", "", "5"],
    ["CONM2", "900", "1", "", "1.2345-3", "0.", "1.", "2.", "", "1.", "0.", "1.", "", "0.", "2.D0"],
    ["PELAS", "4", "1000.", "", "", "5", "2000.", ".01", "1."],
    ["MAT1", "2", "2.1+5", "", ".3", "7.85-9"],
    ["PROD", "7", "1", "100."],
]

FORMATS = ("small", "right", "large", "free", "free large", "tabs")
COMMENTS = [b"", b"", b"", b"  $ skin", b"$ f\xfcr Pr\xfcfung"]
BETWEEN = [b"$ a comment, with commas", b"", b"   ", b"$ PSHELL  3       1       9."]


def fields_of_line(words: list[str], form: str, head: str, tag: str) -> list[bytes]:
    """One line of eight fields in a format; two lines for the large ones."""
    words = (words + [""] * 8)[:8]
    if form in ("large", "free large"):
        star = f"{head}*" if head[:1].isalpha() else "*" + head[1:]
        halves = [(star, words[:4], ""), ("*", words[4:], tag)]
    else:
        halves = [(head, words, tag)]
    lines = []
    for name, part, end in halves:
        if form.startswith("free"):
            text = ",".join([name, *part, *([end] if end else [])])
        elif form == "tabs":
            cells = [w if len(w) == 8 else w + "\t" for w in (name, *part)]
            text = "".join(cells) + end
        else:
            width = 16 if form == "large" else 8
            cells = [w.rjust(width) if form == "right" else w.ljust(width) for w in part]
            text = name.ljust(8) + "".join(cells) + end
        lines.append(text.encode("latin-1"))
    return lines


@st.composite
def card_lines(draw: st.DrawFn, card: list[str]) -> list[bytes]:
    """The lines of one card: each continuation in its own format, comments between them."""
    name, data = card[0], card[1:]
    lines: list[bytes] = []
    tag = ""
    for start in range(0, len(data), 8):
        form = draw(st.sampled_from(FORMATS))
        more = start + 8 < len(data)
        next_tag = draw(st.sampled_from(["", "+", f"+{name[:3]}{start}"])) if more else ""
        head = name if start == 0 else tag or "+"
        words = fields_of_line(data[start : start + 8], form, head, next_tag)
        tag = next_tag
        comment = draw(st.sampled_from(COMMENTS))
        blanks = draw(st.sampled_from([b"", b"", b"   "]))
        stripped = [w.rstrip() if draw(st.booleans()) else w for w in words]
        if form.startswith("free") and not next_tag:
            stripped = [w.rstrip(b",") if b"," in w.rstrip(b",") else w for w in stripped]
        if not next_tag:
            stripped[-1] += blanks + comment
        for word in stripped:
            if start and draw(st.integers(0, 4)) == 0:
                lines.append(draw(st.sampled_from(BETWEEN)))
            lines.append(word)
    return lines


@st.composite
def decks(draw: st.DrawFn) -> tuple[bytes, list[list[str]]]:
    """A deck in one file and the cards it holds."""
    cards = draw(st.permutations(CARDS))
    newline = draw(st.sampled_from([b"\n", b"\r\n", b"\r"]))
    mixed = draw(st.booleans()) and newline == b"\n"
    lines = [b"$ units: mm, t, N, s", b"SOL 103", b"CEND", b"TITLE = PSHELL 3", b"BEGIN BULK"]
    for card in cards:
        lines += draw(card_lines(card))
    ended = draw(st.booleans())
    if ended:
        lines += [b"ENDDATA", b"PSHELL  3       text after the end, \xff\xfe"]
    ends = [b"\r\n" if mixed and draw(st.booleans()) else newline for _ in lines]
    if draw(st.booleans()):
        ends[-1] = b""
    return b"".join(a + b for a, b in zip(lines, ends, strict=True)), cards


def as_read(data: bytes) -> DeckText:
    """The deck as a file read back."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.bdf"
        path.write_bytes(data)
        return read_deck_text(path)


def by_our_reader(data: bytes) -> list[list[str | None]]:
    """Fields of all cards as the reader that assembles decks sees them."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "deck.bdf"
        path.write_bytes(data)
        sections = read_sections(path)
        return [fields_of(raw.lines) for raw in cut(sections.bulk, sections.files)]


def by_pynastran(deck: DeckText, name: str, number: int) -> list[str]:
    """Fields of one card as pyNastran cuts its lines."""
    pytest.importorskip("pyNastran")
    from pyNastran.bdf.bdf_interface.utils import to_fields

    lines = [
        line.data.decode("latin-1").split("$")[0] for line in find_card(deck, name, number).lines
    ]
    return [f.strip() for f in to_fields(lines, name)]


def references(card: list[str]) -> list[tuple[FieldRef, int]]:
    """All values of a card, with the place of each in the card's list of fields."""
    name, stride = card[0], definitions()[card[0]].several
    found = []
    for shift in range(0, len(card) - 1, stride or len(card)):
        for field, index in definitions()[name].reals.items():
            at = 1 + index + shift
            found.append((FieldRef(name, int(card[1 + shift]), field), at))
    return found


VALUES = st.one_of(
    st.sampled_from([1.0, 0.5, 70000.0, 2.7e-9, 123456.0, -1.5]),
    st.floats(1e-12, 1e12),
    st.floats(-1e12, -1e-12),
)
