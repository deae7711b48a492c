"""Parameters moved to the test by sensitivities."""
