"""The report of a run: one self-contained page, results/report.html, for readers who do not know the project."""
