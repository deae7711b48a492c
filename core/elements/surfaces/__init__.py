"""Shells, panels, and sections of bodies of revolution."""
