"""The command line."""


def main() -> None:
    """Run ``trueup`` and leave with its exit status.

    OpenBLAS uses one thread unless the user says otherwise: on the many small matrices of a search
    its threads wait for each other, on busy cores ten times as long as the work takes.
    """
    import os
    import sys

    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

    from .app import run

    sys.exit(run())
