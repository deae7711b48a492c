"""What the verbs answer, as typed tables: one class a table, one field a key of result.json."""
