"""Rule draw_campaign_figures: draw every figure across datasets."""

from pathlib import Path

from softkin.core.job import job
from softkin.models import MODELS
from softkin.models.ensembles import ENSEMBLES
from softkin.reporting.figures import CAMPAIGN_FIGURES
from softkin.reporting.figures.drawing import draw
from softkin.reporting.figures.spec import CampaignResults

with job(snakemake.log[0], "draw campaign figures", snakemake.output, snakemake.input, snakemake.params):
    results = CampaignResults(
        published_comparison=Path(snakemake.input.published_comparison),
        dataset_titles=snakemake.params.titles,
        learning_curve=next(map(Path, snakemake.input.learning_curve), None),
        model_titles={name: spec.title for name, spec in (MODELS | ENSEMBLES).items()},
    )
    draw(CAMPAIGN_FIGURES, results, Path(snakemake.output[0]))
