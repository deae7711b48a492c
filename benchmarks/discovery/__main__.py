"""Run as ``python -m benchmarks.discovery`` or ``python benchmarks/discovery``."""

import sys
from pathlib import Path

if not __package__:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))

from benchmarks.discovery.run import main

sys.exit(main())
