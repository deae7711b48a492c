"""Where the test geometry stands in the frame of the model, and in which length unit."""
