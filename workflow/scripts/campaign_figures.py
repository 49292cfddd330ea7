"""Rule campaign_figures: draw every figure across datasets."""

from pathlib import Path

from softkin.figures import CAMPAIGN_FIGURES
from softkin.figures.drawing import draw
from softkin.interface import CampaignResults
from softkin.job import job
from softkin.models import MODELS

with job(snakemake.log[0], "campaign figures"):
    results = CampaignResults(
        published_comparison=Path(snakemake.input.published_comparison),
        dataset_titles=snakemake.params.titles,
        model_titles={name: spec.title for name, spec in MODELS.items()},
    )
    draw(CAMPAIGN_FIGURES, results, Path(snakemake.output[0]))
