"""What follows from the data: credible places, measurements that would decide."""
