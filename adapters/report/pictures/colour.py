"""Colours by lightness: a perceptually uniform ramp and the colours of the series."""

import math

STEPS = 20  # a ramp class every 5 % of MAC


def oklch(lightness: float, chroma: float, hue: float) -> str:
    """Return the hex sRGB of an OKLCH colour, chroma reduced until it can be shown.

    References
    ----------
    Ottosson (2020), the Oklab colour space: equal steps of lightness look equal.
    """
    while True:
        rgb = _srgb(lightness, chroma, hue)
        if chroma <= 0.0 or all(-1e-4 <= c <= 1.0001 for c in rgb):
            return "#" + "".join(f"{round(255 * min(max(c, 0.0), 1.0)):02x}" for c in rgb)
        chroma = max(chroma - 0.004, 0.0)


def ramp(*, dark: bool) -> list[str]:
    """Return `STEPS` colours from the paper's own (nothing) to full ink (everything).

    Lightness is linear in the step, so equal differences of the value look equal, in grey print
    and to colour-blind eyes too; on a dark page the direction turns round.
    """
    colours = []
    for k in range(STEPS):
        x = k / (STEPS - 1)
        lightness = 0.255 + 0.665 * x if dark else 0.975 - 0.665 * x
        chroma = 0.006 + 0.125 * math.sin(math.pi * x) ** 1.1 + 0.035 * x
        hue = 268.0 - 53.0 * x if dark else 215.0 + 53.0 * x
        colours.append(oklch(lightness, chroma, hue))
    return colours


def series(count: int, *, dark: bool) -> list[str]:
    """Return colours of unordered series: alike in weight, neighbours far apart in hue."""
    hues = (255.0, 45.0, 160.0, 350.0, 90.0, 205.0, 305.0, 25.0)
    low, high = (0.72, 0.80) if dark else (0.52, 0.62)
    return [oklch(high if k % 2 else low, 0.14, hues[k % len(hues)]) for k in range(count)]


def variables(*, dark: bool) -> str:
    """Return the CSS properties of the ramp (``--c0`` ...) and of the series (``--s0`` ...)."""
    named = [f"--c{k}:{c}" for k, c in enumerate(ramp(dark=dark))]
    named += [f"--s{k}:{c}" for k, c in enumerate(series(8, dark=dark))]
    return ";".join(named)


def _srgb(lightness: float, chroma: float, hue: float) -> tuple[float, float, float]:
    a = chroma * math.cos(math.radians(hue))
    b = chroma * math.sin(math.radians(hue))
    long = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3
    medium = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3
    short = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3
    return (
        _gamma(4.0767416621 * long - 3.3077115913 * medium + 0.2309699292 * short),
        _gamma(-1.2684380046 * long + 2.6097574011 * medium - 0.3413193965 * short),
        _gamma(-0.0041960863 * long - 0.7034186147 * medium + 1.7076147010 * short),
    )


def _gamma(c: float) -> float:
    return 12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055
