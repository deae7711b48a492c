"""Optimisation by Nastran itself (SOL 200): parameters as design variables, and back."""
