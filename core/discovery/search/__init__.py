"""The search over combinations of effects."""
