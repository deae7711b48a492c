"""A survey of frequency responses: checked, cleaned, weighted."""
