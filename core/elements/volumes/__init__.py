"""Bricks, wedges, tetrahedra, pyramids and what they share."""
