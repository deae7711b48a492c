"""How the numbers of dataset 58 are laid out, by ordinate data type and spacing."""

REALS = {2: 1, 4: 1, 5: 2, 6: 2}
"""Reals that make one ordinate: 2, 4 real and 5, 6 complex; 4 and 6 double precision."""

HEADER_LINES = 11


def form(line: bytes) -> tuple[int, ...]:
    """Ordinate data type, number of points and spacing from the seventh line; else nothing."""
    parts = [line[0:10], line[10:20], line[20:30]]
    for words in (parts, line.split()):
        try:
            return int(words[0]), int(words[1]), int(words[2])
        except (ValueError, IndexError):
            continue
    return ()


def columns(ordinate_type: int, even: bool) -> tuple[int, ...]:
    """Widths of the fields on a full line of the ASCII form."""
    if ordinate_type in (2, 5):
        return (13,) * 6
    if even:
        return (20,) * 4
    return (13, 20, 13, 20) if ordinate_type == 4 else (13, 20, 20)


def records(ordinate_type: int, even: bool) -> list[tuple[int, ...]]:
    """Bytes of the numbers of one point of the binary form, the book's layout first.

    By the book an uneven abscissa is single; some programs write it double with the ordinates.
    """
    if ordinate_type not in REALS:
        return []
    ordinates = (8 if ordinate_type in (4, 6) else 4,) * REALS[ordinate_type]
    if even:
        return [ordinates]
    return list(dict.fromkeys([(4, *ordinates), (ordinates[0], *ordinates)]))
