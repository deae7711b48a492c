from __future__ import annotations

from pathlib import Path

import pytest

DATA = Path(__file__).parents[5] / "shared" / "data"


@pytest.fixture
def data() -> Path:
    if not DATA.is_dir():
        pytest.skip(f"the shared data is not at {DATA}")
    return DATA
