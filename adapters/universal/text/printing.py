"""Numbers and lines as universal files print them."""

DELIMITER = b"    -1\n"


def dataset(number: int, *parts: bytes) -> bytes:
    """Frame the lines of a dataset."""
    return b"".join([DELIMITER, b"%6d\n" % number, *parts, DELIMITER])


def text_line(said: str) -> bytes:
    """Return a text line: printable, at most 80 columns, NONE where there is nothing to say."""
    kept = " ".join("".join(c if c.isprintable() else " " for c in said).split())[:80]
    return (kept or "NONE").encode("latin-1", "replace") + b"\n"


def name_field(said: str, width: int) -> bytes:
    """Return a name padded to its columns."""
    return text_line(said)[:-1][:width].ljust(width)


def tight(value: float) -> bytes:
    """Return a number in 13 columns, a blank first, with all the digits that 12 columns hold.

    A field of format E13.5 may hold any number with a decimal point; this keeps ten digits
    where E13.5 itself would keep six.
    """
    for digits in range(17, 0, -1):
        mantissa, letter, power = f"{float(value):.{digits}g}".partition("e")
        printed = (mantissa if "." in mantissa else mantissa + ".") + letter.upper() + power
        if len(printed) <= 12:
            break
    return b"%13s" % printed.encode()
