"""What a verb gives back, the run folder that holds it, its report and pictures."""
