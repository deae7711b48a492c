"""What all tests share: Hypothesis without deadlines, and the code of the documents."""

import os
import re
from pathlib import Path

import pytest
from hypothesis import settings

# Workers share the cores: threads of linear algebra would only wait for each other.
if "PYTEST_XDIST_WORKER" in os.environ:
    os.environ.setdefault("OMP_NUM_THREADS", "1")

# How long an example takes says more of the machine's load.
settings.register_profile("trueup", deadline=None)
settings.load_profile("trueup")

DOCS = Path(__file__).parents[1] / "docs"


@pytest.fixture
def documented():
    """Run the Python of a section of a document; the names that it leaves."""

    def run(heading, document="extending.md"):
        text = (DOCS / document).read_text(encoding="utf-8")
        section = text.split(f"\n## {heading}\n")[1].split("\n## ")[0]
        names = {"__name__": "documented"}
        for code in re.findall(r"```python\n(.*?)```", section, re.DOTALL):
            exec(compile(code, f"{document}: {heading}", "exec"), names)
        return names

    return run
