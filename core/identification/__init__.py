"""Modes from measured frequency responses."""
