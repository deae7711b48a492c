"""How an update goes: one deck or several, embedded solver or the user's, kept as it goes."""
