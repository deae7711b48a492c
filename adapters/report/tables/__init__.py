"""What a run says: read, put in tables and sentences."""
