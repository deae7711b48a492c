from pathlib import Path

import numpy as np
import pytest
import scipy.linalg

from trueup.adapters.nastran import build_model, parse_parameter, read_deck

DATA = Path(__file__).parents[5] / "shared" / "data"


@pytest.fixture(scope="session")
def data():
    """Return the folder of decks with results of MSC and NX Nastran."""
    if not DATA.is_dir():
        pytest.skip("no shared data beside the repository")
    return DATA


@pytest.fixture
def deck(tmp_path):
    """Return a function that writes bulk data as a deck and reads it."""

    def write(bulk, case="", name="deck.bdf"):
        path = tmp_path / name
        path.write_text(f"SOL 103\nCEND\n{case}\nBEGIN BULK\n{bulk}\nENDDATA\n")
        return read_deck(path)

    return write


@pytest.fixture
def model(deck):
    """Return a function that builds the model of a deck given by its bulk data."""

    def build(bulk, parameters=(), case=""):
        return build_model(deck(bulk, case), [parse_parameter(p) for p in parameters])

    return build


@pytest.fixture(scope="session")
def frequencies():
    """Return a function that gives all frequencies [Hz] of a model, dense."""

    def solve(model, p=None):
        K, M = model.K(p).toarray(), model.M(p).toarray()
        shift = 1e-9 * np.trace(K) / np.trace(M)
        inverse = scipy.linalg.eigh(M, K + shift * M, eigvals_only=True)[::-1]
        inverse = inverse[inverse > 1e-14 * inverse[0]]
        return np.sqrt(np.abs(1.0 / inverse - shift)) / (2.0 * np.pi)

    return solve
