# The configuration, checked; the lists that it spans; the paths that more than one stage needs.
from snakemake.exceptions import WorkflowError

import softkin
from softkin.configuration import check_configuration
from softkin.datasets import READERS
from softkin.interface import PAPER, PRESETS, SoftkinError, TUNED
from softkin.models import MODELS, source_files

try:
    check_configuration(
        config,
        Path(workflow.basedir) / "workflow" / "schemas" / "config.schema.yaml",
        {"models": MODELS, "formats": READERS},
    )
except SoftkinError as error:
    raise WorkflowError(str(error)) from None

PACKAGE = Path(softkin.__file__).parent
PUBLISHED = Path(workflow.basedir) / "config" / "published"
RUN = "results/{dataset}/{model}/{preset}"
# For `--software-deployment-method conda`; unused otherwise.
SOFTWARE = "../envs/softkin.yaml"
HEADLINE = "results/tables/headline.txt"
TABLES = [
    "point_metrics.csv",
    "marker_errors.csv",
    "published_comparison.csv",
    *(["published_columns.csv", "selection.csv"] if TUNED in config["presets"] else []),
]


wildcard_constraints:
    dataset="|".join(config["sources"]),
    model="|".join(MODELS),
    preset="|".join(PRESETS),


def package(*modules):
    """Modules of softkin that decide a rule's result: Snakemake does not see imports, it sees inputs."""
    return [PACKAGE / module for module in modules]


def model_code(wildcards):
    """The files that define one model."""
    return source_files(wildcards.model)


def source(wildcards):
    """The dataset's entry in config/datasets.yaml."""
    return config["sources"][wildcards.dataset]


def every_run():
    """[model, preset] of each run that one dataset gets."""
    return [
        [model, preset] for model in config["models"] for preset in config["presets"]
    ]


def run_files(name, presets=tuple(PRESETS)):
    """One file of each run of a dataset, in the order of `every_run`."""
    return [
        f"results/{{dataset}}/{model}/{preset}/{name}"
        for model, preset in every_run()
        if preset in presets
    ]


def of_every_dataset(patterns):
    """The files of the first dataset, then those of the second, ...: the order of `every_dataset_and_model`."""
    return [
        path
        for dataset in config["datasets"]
        for path in expand(patterns, dataset=dataset)
    ]


def every_dataset_and_model():
    """[dataset, model] of each study."""
    return [
        [dataset, model] for dataset in config["datasets"] for model in config["models"]
    ]


def final_output():
    """All that a complete campaign leaves."""
    return [
        HEADLINE,
        "results/tables/paper_tables.md",
        "results/tables/paper_tables.tex",
        *(f"results/tables/{name}" for name in TABLES),
        *expand("results/{dataset}/mlflow_runs.json", dataset=config["datasets"]),
    ]
