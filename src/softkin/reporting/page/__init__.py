"""One self-contained page, results/report.html, that tells a complete run to whoever has not seen the project."""
