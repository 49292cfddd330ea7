"""Tables across datasets: ours, and ours beside the published ones."""
