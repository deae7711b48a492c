"""Dashpots to ground, by damping ratios and complex shapes."""
