"""One format each: files in, neutral nouns out, and back."""
