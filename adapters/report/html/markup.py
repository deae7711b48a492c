"""The few lines that turn text into safe HTML and SVG."""

from html import escape


def esc(value: object) -> str:
    """Return the text of `value`, safe inside an element or a quoted attribute."""
    return escape(str(value), quote=True)


def tag(name: str, *children: str, **attributes: object) -> str:
    """Return an element; children are markup already, attribute values are escaped.

    A trailing underscore is dropped from attribute names (``class_``), inner ones become
    hyphens; attributes that are None or False are left out.
    """
    given = "".join(
        f' {k.rstrip("_").replace("_", "-")}="{esc("" if v is True else v)}"'
        for k, v in attributes.items()
        if v is not None and v is not False
    )
    inner = "".join(children)
    if not inner and name in _VOID:
        return f"<{name}{given}/>"
    return f"<{name}{given}>{inner}</{name}>"


def svg_text(x: float, y: float, label: object, **attributes: object) -> str:
    """Return an SVG text element."""
    return tag("text", esc(label), x=short(x), y=short(y), **attributes)


def centred(x: float, y: float, label: object, kind: str | None = None, **more: object) -> str:
    """Return an SVG text element whose middle is at `x`."""
    return svg_text(x, y, label, class_=kind, text_anchor="middle", **more)


def svg(kind: str, size: tuple[float, float], told: str, *children: str, **more: object) -> str:
    """Return a picture of some pixels; `told` is what it shows, for who does not see it."""
    width, height = size
    return tag("svg", *children, class_=kind, viewBox=f"0 0 {width} {height}", width=width,
               role="img", aria_label=told, **more)  # fmt: skip


def key(text: str, role: str | None = None, **of_mark: object) -> str:
    """Return an entry of a legend: a mark of some style, and what it stands for."""
    return tag("span", tag("i", class_=role, **of_mark), esc(text), class_="key")


def short(value: float) -> str:
    """Return a coordinate with one decimal at most."""
    text = f"{value:.1f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


_VOID = {"path", "rect", "circle", "line", "use", "polyline", "polygon", "br", "meta"}
