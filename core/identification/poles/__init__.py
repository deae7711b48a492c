"""Poles and participation: estimated, refined, selected."""
