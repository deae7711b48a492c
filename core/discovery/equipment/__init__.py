"""Equipment: where it stands, its body, and how a fit finds that."""
