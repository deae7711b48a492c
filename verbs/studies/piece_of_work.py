"""One piece of work in a process of its own: read from standard input, answered on its output."""

import os
import pickle
import signal
import sys

from .executors import answered


def main() -> None:
    """Do it; whatever it prints goes to standard error, and what it started ends with it."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    with os.fdopen(os.dup(1), "wb") as out:
        os.dup2(2, 1)
        work, item = (pickle.load(sys.stdin.buffer) for _ in range(2))
        out.write(pickle.dumps(answered(work, item)))


if __name__ == "__main__":
    main()
