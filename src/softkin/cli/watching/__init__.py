"""What a person sees while the workflow runs: one quiet screen on a terminal, plain lines anywhere else."""
