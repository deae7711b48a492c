"""Datasets 58 and 58b: every ordinate type, spacing, byte order and floating-point format."""

import numpy as np
import pytest

from trueup.adapters.universal import read_universal
from trueup.adapters.universal.text.legacy_floats import IBM, VAX, decode
from trueup.core.errors import InputError

N = 7
X = np.array([1.0, 1.5, 2.5, 4.0, 6.0, 7.25, 9.5])
Y = np.array([1.5, -2.25, 3.0, 0.5, -0.125, 8.0, 1.0])
Z = Y + 1j * np.arange(N)


def interleaved(ordinate_type, even):
    columns = [Y] if ordinate_type in (2, 4) else [Z.real, Z.imag]
    return np.column_stack(columns if even else [X, *columns])


def only(path):
    """Abscissa and ordinates of the one function of a file."""
    content = read_universal(path)
    assert content.skipped == ()
    if content.frfs is None:
        return content.functions[0].abscissa, content.functions[0].values
    return content.frfs.frequencies_hz, content.frfs.values[0, 0]


def check(path, ordinate_type, even):
    x, y = only(path)
    np.testing.assert_array_equal(x, 1.0 + 0.5 * np.arange(N) if even else X)
    np.testing.assert_array_equal(y, Z if ordinate_type in (5, 6) else Y)


@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize("ordinate_type", [2, 4, 5, 6])
def test_ascii(uff, write, ordinate_type, even):
    table = interleaved(ordinate_type, even)
    double = ordinate_type in (4, 6)
    per_line = {
        (2, 0): 6,
        (2, 1): 6,
        (4, 1): 4,
        (4, 0): 4,
        (5, 0): 6,
        (5, 1): 6,
        (6, 1): 4,
        (6, 0): 3,
    }
    n = per_line[ordinate_type, int(even)]
    fields = [
        f"{v:20.12E}" if double and (even or column) else f"{v:13.5E}"
        for row in table
        for column, v in enumerate(row)
    ]
    rows = ["".join(fields[k : k + n]) for k in range(0, len(fields), n)]
    text = uff.function_58(None, ordinate_type=ordinate_type, even=even, n_point=N, rows=rows)
    check(write(text), ordinate_type, even)


def binary(uff, block, ordinate_type, even, order=1, form=2, n_byte=None, tail=b""):
    size = len(block) if n_byte is None else n_byte
    number = f"    58b{order:6d}{form:6d}{11:12d}{size:12d}{0:6d}{0:6d}{0:12d}{0:12d}"
    text = uff.function_58(
        None, ordinate_type=ordinate_type, even=even, n_point=N, rows=[], number=number
    )
    head, _, _ = text.rpartition("    -1")
    return head.encode() + block + tail + b"    -1\n"


@pytest.mark.parametrize("tail", [b"", b"\n", b"\r\n"])
@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("even", [True, False])
@pytest.mark.parametrize("ordinate_type", [2, 4, 5, 6])
def test_binary(uff, write, ordinate_type, even, order, tail):
    """By the book an uneven abscissa is single precision also where the ordinates are double."""
    table = interleaved(ordinate_type, even)
    number = f"{'<' if order == 1 else '>'}f{8 if ordinate_type in (4, 6) else 4}"
    layout = [("x", number[0] + "f4")] if not even else []
    layout += [(f"y{k}", number) for k in range(table.shape[1] - (not even))]
    block = np.array([tuple(row) for row in table], layout).tobytes()
    check(write(binary(uff, block, ordinate_type, even, order, tail=tail)), ordinate_type, even)


@pytest.mark.parametrize("ordinate_type", [4, 6])
def test_binary_with_a_double_abscissa(uff, write, ordinate_type):
    block = interleaved(ordinate_type, False).astype("<f8").tobytes()
    check(write(binary(uff, block, ordinate_type, False)), ordinate_type, False)


@pytest.mark.parametrize("n_byte", [0, 17, 8 * N])
def test_binary_with_a_wrong_size_in_its_header(uff, write, n_byte):
    """Some programs announce half the bytes of complex data."""
    block = interleaved(6, True).astype("<f8").tobytes()
    check(write(binary(uff, block, 6, True, n_byte=n_byte)), 6, True)


def test_binary_block_padded_to_its_announced_size(uff, write):
    block = interleaved(6, True).astype("<f8").tobytes()
    padded = block + bytes(512 - len(block))
    check(write(binary(uff, padded, 6, True)), 6, True)


@pytest.mark.parametrize("change", [slice(None, -3), slice(None, -8)])
def test_binary_block_of_the_wrong_size_is_listed_not_read_as_garbage(uff, write, change):
    block = interleaved(6, True).astype("<f8").tobytes()[change]
    content = read_universal(write(binary(uff, block, 6, True) + uff.units().encode()))
    assert content.frfs is None
    assert content.functions == ()
    assert content.skipped[0].line == 2
    assert "its 7 points take 112 bytes" in content.skipped[0].why
    assert content.length_unit == "m"


def test_binary_cut_off(uff, write):
    block = interleaved(6, True).astype("<f8").tobytes()
    with pytest.raises(InputError, match="line 2: the file ends inside dataset 58"):
        read_universal(write(binary(uff, block, 6, True)[:-30]))


def test_a_file_that_lost_only_its_last_delimiter_is_read_and_told(uff, write):
    text = uff.function_58([1.0, 2.0, 3.0, 4.0])
    content = read_universal(write(text.removesuffix("    -1\n")))
    np.testing.assert_array_equal(content.frfs.values, [[[1 + 2j, 3 + 4j]]])
    assert "without the -1" in content.warnings[0]


@pytest.mark.parametrize("keep", [30, 400, 900, 1100])
def test_ascii_cut_off(uff, write, keep):
    text = uff.function_58(np.arange(60.0))
    with pytest.raises(InputError, match=r"cut off|ends inside"):
        read_universal(write(text[:keep]))


@pytest.mark.parametrize("cut", [2, 3, 6, 12])
def test_a_last_number_cut_short_is_not_believed(uff, write, cut):
    text = uff.function_58([1.0, 2.0, 3.0, 4.5678]).removesuffix("\n    -1\n")
    with pytest.raises(InputError, match="ends inside dataset 58"):
        read_universal(write(text[:-cut]))


def test_vax_floats():
    """F floating 1.0, -2.5, 0.1 and D floating 1.0 of the VAX Architecture Reference Manual."""
    f = [[0x80, 0x40, 0, 0], [0x20, 0xC1, 0, 0], [0xCC, 0x3E, 0xCD, 0xCC], [0, 0, 0, 0]]
    np.testing.assert_allclose(
        decode(np.array(f, np.uint8), False, VAX), [1.0, -2.5, 0.1, 0.0], rtol=1e-7
    )
    d = [[0x80, 0x40, 0, 0, 0, 0, 0, 0], [0xCC, 0x3E, 0xCC, 0xCC, 0xCC, 0xCC, 0xCD, 0xCC]]
    np.testing.assert_allclose(decode(np.array(d, np.uint8), False, VAX), [1.0, 0.1], rtol=1e-15)


def test_ibm_floats():
    """-118.625 is C276A000, 1.0 is 41100000 (IBM System/370 Principles of Operation)."""
    single = [[0xC2, 0x76, 0xA0, 0x00], [0x41, 0x10, 0, 0], [0, 0, 0, 0]]
    raw = np.array(single, np.uint8)
    np.testing.assert_array_equal(decode(raw, True, IBM), [-118.625, 1.0, 0.0])
    np.testing.assert_array_equal(decode(raw[:, ::-1], False, IBM), [-118.625, 1.0, 0.0])
    double = np.array([[0xC2, 0x76, 0xA0, 0, 0, 0, 0, 0]], np.uint8)
    np.testing.assert_array_equal(decode(double, True, IBM), [-118.625])


@pytest.mark.parametrize(("order", "form"), [(3, 2), (1, 4)])
def test_an_unknown_number_format_is_listed(uff, write, order, form):
    block = interleaved(6, True).astype("<f8").tobytes()
    content = read_universal(write(binary(uff, block, 6, True, order, form)))
    assert "is not known" in content.skipped[0].why


@pytest.mark.parametrize(
    ("change", "why"),
    [
        ({"n_point": 9}, "announces 18 numbers and holds 12"),
        ({"n_point": 2}, "announces 4 numbers and holds 12"),
        ({"n_point": 10**9}, "announces 2000000000 numbers in"),
        ({"n_point": -4}, "announces -4 points"),
        ({"ordinate_type": 3}, "ordinate data type 3"),
    ],
)
def test_wrong_counts_are_listed_with_their_line(uff, write, change, why):
    content = read_universal(write(uff.units() + uff.function_58(np.arange(12.0), **change)))
    assert content.frfs is None
    assert content.skipped[0].line == 8
    assert why in content.skipped[0].why


def test_zeros_that_pad_the_last_line_are_no_points(uff, write):
    content = read_universal(write(uff.function_58([1, 2, 3, 4, 0, 0], n_point=2)))
    np.testing.assert_array_equal(content.frfs.values, [[[1 + 2j, 3 + 4j]]])


def test_stars_and_nan_are_listed_not_zero(uff, write):
    good = "".join(f"{v:13.5E}" for v in (1, 2, 3, 4))
    text = uff.function_58(None, (5, 1), n_point=2, rows=[good])
    text += uff.function_58(None, (7, 1), n_point=2, rows=[good[:39] + " ************"])
    text += uff.function_58(None, (9, 1), n_point=2, rows=[good[:39] + "          NaN"])
    content = read_universal(write(text))
    assert content.frfs.responses.labels == ["5:X"]
    lines = text.split("\n")
    assert [s.why for s in content.skipped] == [
        "'************' is not a number",
        "1 of its 2 values are not finite numbers",
    ]
    assert "****" in lines[content.skipped[0].line - 1]
    assert lines[content.skipped[1].line - 1] == "    58"


def test_latin1_and_utf8_headers(uff, write):
    text = uff.function_58([1, 2, 3, 4], units_=("Hz", "m/s²", "N"))
    for encoding in ("latin-1", "utf-8"):
        assert read_universal(write(text.encode(encoding))).frfs is not None
