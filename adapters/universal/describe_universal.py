"""What a universal file holds, in one screen."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from .datasets.known_datasets import DATASETS
from .read_universal import read_universal
from .universal_content import Dataset


def describe_universal(path: Path) -> dict[str, Any]:
    """Say what a universal file holds.

    Returns
    -------
    dict
        ``format``, ``contents`` (tables by what they are), ``datasets`` (number, name, how many,
        first line), ``skipped`` (what, line, why) and ``warnings``.

    Raises
    ------
    InputError
        A file that cannot be read.
    """
    content = read_universal(path)
    return {
        "format": "universal file",
        "contents": {k: v for kind in DATASETS for k, v in kind.tell(content).items()},
        "datasets": _datasets(content.datasets),
        "skipped": [{"what": s.what, "line": s.line, "why": s.why} for s in content.skipped],
        "warnings": list(content.warnings),
    }


def _datasets(datasets: Sequence[Dataset]) -> list[dict[str, Any]]:
    """One entry for each kind of dataset: how many there are and where the first stands."""
    counts = Counter(d.number for d in datasets)
    first = {d.number: d for d in reversed(datasets)}
    return [
        {"number": n, "what": first[n].what, "datasets": counts[n], "line": first[n].line}
        for n in sorted(counts)
    ]
