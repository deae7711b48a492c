"""The files of a deck as text: lines, INCLUDE statements, numbers as they are written."""
