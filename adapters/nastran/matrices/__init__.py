"""Matrices of the user's own Nastran runs: OP4, DMIG punch, OP2; and models made of them."""
