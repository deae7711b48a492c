"""One module a group of datasets: from its lines to what it says."""
