"""What is asked: a study, its tables and names, who does its pieces of work."""
