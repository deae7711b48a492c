"""The command line."""


def main() -> None:
    """Run ``trueup``."""
    from .app import app

    app()
