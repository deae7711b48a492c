"""The bases on which hypotheses are evaluated, and what they lack."""
