"""OP2 files as bytes, with words of 32 or 64 bit in either byte order."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

TITLES = " " * 128  # title; subtitle and label are as long


@dataclass
class Writer:
    """Puts the records of an OP2 file together (`word` 4 or 8 bytes, `order` < or >)."""

    word: int = 4
    order: str = "<"
    names_in_full: bool = False
    """Whether names fill words of 64 bit (MSC) or only half of each (NX)."""
    out: bytearray = field(default_factory=bytearray)

    def record(self, data: bytes) -> None:
        mark = struct.pack(self.order + "i", len(data))
        self.out += mark + data + mark

    def marker(self, value: int) -> None:
        self.record(self.int(value))

    def int(self, value: int) -> bytes:
        return struct.pack(self.order + ("i" if self.word == 4 else "q"), value)

    def real(self, value: float) -> bytes:
        return struct.pack(self.order + ("f" if self.word == 4 else "d"), value)

    def text(self, text: str, words: int) -> bytes:
        """Four characters a word; words of 64 bit end in four blanks."""
        raw = text.ljust(4 * words).encode("latin-1")
        pad = b" " * (self.word - 4)
        return b"".join(raw[k : k + 4] + pad for k in range(0, 4 * words, 4))

    def label(self, version: str = "XXXXXXXX") -> None:
        for data in (
            b"".join(map(self.int, (1, 2, 26))),
            self.text("NASTRAN FORT TAPE ID CODE - ", 7),
            self.text(version, 2),
        ):
            self.marker(len(data) // self.word)
            self.record(data)
        self.marker(-1)
        self.marker(0)

    def block(self, name: str, trailer: tuple[int, ...], records: list[list[bytes]]) -> None:
        """A table: each record is one part or several."""
        self._start(name, trailer)
        number = -3
        for parts in records:
            for value in (number, 1, 0):
                self.marker(value)
            for data in parts:
                self.marker(len(data) // self.word)
                self.record(data)
            number -= 1
        for value in (number, 1, 0, 0):
            self.marker(value)

    def matrix(self, name: str, trailer: tuple[int, ...], columns: list[list]) -> None:
        """A matrix: each column a list of (row from 1, bytes of values)."""
        self._start(name, trailer)
        number = -3
        for strings in columns:
            for value in (number, 1, 1):
                self.marker(value)
            for row, data in strings:
                self.marker(len(data) // self.word)
                self.record(self.int(row) + data)
            number -= 1
        for value in (number, 1, 0, 0):
            self.marker(value)

    def _start(self, name: str, trailer: tuple[int, ...]) -> None:
        self.marker(2)
        self.record(self._name(name))
        self.marker(-1)
        self.marker(7)
        self.record(b"".join(map(self.int, trailer)))
        for value in (-2, 1, 0, 2):
            self.marker(value)
        self.record(self._name(name))

    def _name(self, name: str) -> bytes:
        if self.names_in_full:
            return name.ljust(2 * self.word).encode("latin-1")
        return self.text(name, 2)

    def vector_header(
        self, number: int, value: complex, *, subcase: int = 1, width: int = 8, form: int = 1,
        analysis: int = 2, subtitle: str = "", cycles: float = 0.0,
    ) -> bytes:  # fmt: skip
        """The 146 words before an eigenvector."""
        second = value.imag if analysis == 9 else cycles
        words = [self.int(0)] * 50
        for at, word in (
            (0, 10 * analysis + 2), (1, 7), (3, subcase), (4, number), (8, form), (9, width),
        ):  # fmt: skip
            words[at] = self.int(word)
        words[5], words[6] = self.real(complex(value).real), self.real(second)
        titles = self.text("", 32) + self.text(subtitle, 32) + self.text("", 32)
        return b"".join(words) + titles

    def vector(self, points, kinds, values) -> bytes:
        """Rows of point, kind (1 grid, 2 scalar) and real values."""
        return b"".join(
            self.int(10 * p + 2) + self.int(k) + b"".join(map(self.real, row))
            for p, k, row in zip(points, kinds, values, strict=True)
        )

    def lama(self, eigenvalues, masses, cycles) -> None:
        head = [self.int(0)] * 50
        head[0], head[1], head[9] = self.int(21), self.int(6), self.int(7)
        rows = b"".join(
            self.int(k) + self.int(k)
            + b"".join(map(self.real, (v, v**0.5, c, m, v * m)))
            for k, (v, m, c) in enumerate(zip(eigenvalues, masses, cycles, strict=True), 1)
        )  # fmt: skip
        titles = self.text("", 96)
        self.block("LAMA", (101, len(masses), 0, 0, 0, 0, 0), [[b"".join(head) + titles], [rows]])

    def done(self) -> bytes:
        self.marker(0)
        return bytes(self.out)
