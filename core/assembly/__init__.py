"""From element matrices to the free degrees of freedom: parameters, constraints, condensation."""
