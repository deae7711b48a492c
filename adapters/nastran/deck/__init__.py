"""The bulk data: logical lines, continuations, fields, cards by name and number."""
