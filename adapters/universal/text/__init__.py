"""Numbers and lines as universal files print them, read and written by array arithmetic."""
