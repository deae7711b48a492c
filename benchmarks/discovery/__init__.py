"""Cases with hidden truth by an independent solver, and what `discover` makes of them."""
