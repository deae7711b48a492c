"""A neutral model made of a deck."""
