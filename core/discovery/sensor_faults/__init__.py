"""Sensors checked against each other and against the model."""
