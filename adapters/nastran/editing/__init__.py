"""Surgery on the text of a deck: what is not asked to change stays byte for byte."""
