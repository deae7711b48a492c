"""Results of the user's own Nastran runs."""
