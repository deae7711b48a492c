"""The command line."""


def main() -> None:
    """Run ``trueup`` and leave with its exit status."""
    import sys

    from .app import run

    sys.exit(run())
