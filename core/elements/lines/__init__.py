"""Bars, rods and beams."""
