"""Nastran decks and results."""
