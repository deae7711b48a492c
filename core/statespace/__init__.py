"""Modal state spaces: forces in, motions out, of the modes that matter and the rest as statics."""
