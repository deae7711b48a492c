"""Text where only ASCII goes: in decks, and on terminals of few characters."""

import unicodedata

_SPELLED = {
    "−": "-", "–": "-", "—": "-", "±": "+/-", "→": "->", "←": "<-", "°": " deg", "×": "x",
    "·": ".", "…": "...", "²": "^2", "³": "^3", "√": "sqrt ", "≈": "~", "≤": "<=", "≥": ">=",
    "Δ": "delta ", "θ": "theta", "λ": "lambda", "φ": "phi", "ζ": "zeta", "σ": "sigma",
    "ρ": "rho", "ν": "nu", "ω": "omega", "π": "pi", "ε": "eps", "∞": "inf",
    "‘": "'", "’": "'", "“": '"', "”": '"',
}  # fmt: skip


def in_ascii(text: str) -> str:
    """Return text in ASCII: signs spelled, accents left off, a question mark for what is left.

    >>> in_ascii("θ = 30°, x1.2 ± 0.1")
    'theta = 30 deg, x1.2 +/- 0.1'
    """
    spelled = "".join(_SPELLED.get(c, c) for c in text)
    marks = "".join(
        c for c in unicodedata.normalize("NFKD", spelled) if not unicodedata.combining(c)
    )
    return marks.encode("ascii", "replace").decode("ascii")
