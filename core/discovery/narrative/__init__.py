"""Findings and the sentences that tell them."""
