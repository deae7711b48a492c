"""Correlate Nastran models with modal tests, update them, and find what they lack."""

__version__ = "0.1.0"
