"""Cards of solids."""
