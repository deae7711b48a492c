"""Standard errors of a fit, and what the fitted model is wrong by."""
