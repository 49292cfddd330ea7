# The configuration, checked; the lists that it spans; the paths that more than one stage needs.
import os
import sys

from snakemake.exceptions import WorkflowError

import softkin
from softkin.configuration import check_configuration
from softkin.datasets import READERS, reader_files
from softkin.datasets.reaching import warning, with_stand_ins
from softkin.interface import OUTER, PAPER, PRESETS, SEARCHED, SoftkinError, TUNED
from softkin.intervals import INTERVAL_METHODS
from softkin.models import MODELS, source_files
from softkin.quantile_models import QUANTILE_MODELS
from softkin.regions import REGION_METHODS
from softkin.standins import STANDINS

# A job has one core. What asks for none by itself (OpenMP, BLAS) would take all, and two such jobs side by side wait for
# each other most of the time.
os.environ.update(OMP_NUM_THREADS="1")

try:
    check_configuration(
        config,
        Path(workflow.basedir) / "workflow" / "schemas" / "config.schema.yaml",
        {
            "models": MODELS,
            "formats": READERS,
            "interval_methods": INTERVAL_METHODS,
            "quantile_models": QUANTILE_MODELS,
            "regions": REGION_METHODS,
            "standins": STANDINS,
        },
    )
except SoftkinError as error:
    raise WorkflowError(str(error)) from None

STANDING_IN = []
if config["when_unreachable"] == "simulate":
    config["datasets"], config["sources"], STANDING_IN = with_stand_ins(
        config["datasets"],
        config["sources"],
        mirror=os.environ.get("SOFTKIN_DATA_MIRROR") or config.get("data_mirror"),
        retrieved={name: Path(f"results/{name}/raw") for name in config["datasets"]},
    )

PACKAGE = Path(softkin.__file__).parent
PUBLISHED = Path(workflow.basedir) / "config" / "published"
# For `--software-deployment-method conda`; unused otherwise.
SOFTWARE = "../envs/softkin.yaml"
HEADLINE = "results/tables/headline.txt"
REPORT = "results/report.html"
# To be pasted into a paper.
PAPER_TABLES = [
    f"{name}.{ending}"
    for name in ("paper_tables", "interval_tables")
    for ending in ("md", "tex")
]
TABLES = [
    "point_metrics.csv",
    "marker_errors.csv",
    "interval_metrics.csv",
    "interval_choice.csv",
    "conditional_coverage.csv",
    "alarm_rates.csv",
    "extrapolation_intervals.csv",
    "target_spaces.csv",
    "published_comparison.csv",
    "published_intervals.csv",
    *(["published_columns.csv"] if TUNED in config["presets"] else []),
    *(
        ["selection.csv", "searched_runs.csv"]
        if set(SEARCHED) & set(config["presets"])
        else []
    ),
]


# The presets that a study stands behind.
SEARCHED_PRESETS = [preset for preset in config["presets"] if preset in SEARCHED]


wildcard_constraints:
    dataset="|".join(config["sources"]),
    model="|".join(MODELS),
    preset="|".join(PRESETS),
    quantile_model="|".join(QUANTILE_MODELS),


def of_presets(name, presets=tuple(config["presets"])):
    """One file of a model for each of these presets."""
    return [f"results/{{dataset}}/{{model}}/{preset}/{name}" for preset in presets]


def of_searched(name):
    """One file of a model for each preset that a study stands behind."""
    return of_presets(name, SEARCHED_PRESETS)


def max_fit_rows(wildcards):
    """How many rows of train a model is fitted on at most; None for one that takes any number."""
    return config["max_fit_rows"].get(wildcards.model)


def source(wildcards):
    """The dataset's entry in config/datasets.yaml."""
    return config["sources"][wildcards.dataset]


def robot(wildcards):
    """What studies and fits must know of a robot: its base, and how the norm of a command is taken."""
    entry = source(wildcards)
    return {"base": entry.get("base"), "standardised_norm": "split" in entry}


def tracking_uri():
    """The store: MLFLOW_TRACKING_URI goes before the configuration."""
    return os.environ.get("MLFLOW_TRACKING_URI") or config["tracking_uri"]


def own_file(wildcards):
    """The file of one's own that an entry without `urls` names: retrieved again when it changes."""
    entry = source(wildcards)
    return [] if "urls" in entry or "robot" in entry else [entry["file"]]


def warn_of_stand_ins():
    """In colour, where there is a terminal to show it: nobody may take a simulated robot for the real thing."""
    if STANDING_IN:
        text = warning(STANDING_IN)
        is_terminal = sys.stderr.isatty()
        print(
            f"\033[1;33m{text}\033[0m" if is_terminal else text,
            file=sys.stderr,
            flush=True,
        )


def every_run(models=tuple(config["models"])):
    """[model, preset] of each run that one dataset gets."""
    return [[model, preset] for model in models for preset in config["presets"]]


def searched_runs():
    """[model, preset] of each run that a study stands behind."""
    return [run for run in every_run() if run[1] in SEARCHED]


def run_files(name, presets=tuple(PRESETS), models=tuple(config["models"])):
    """One file of each run of a dataset, in the order of `every_run`."""
    return [
        f"results/{{dataset}}/{model}/{preset}/{name}"
        for model, preset in every_run(models)
        if preset in presets
    ]


# The models that are fitted in either target space, to tell what a space is worth.
COMPARED = config["models"] * (
    OUTER in config["presets"] and len(config["target_spaces"]) > 1
)
# The models that CV+ and jackknife+-after-bootstrap refit, if any of these methods is asked for.
CHEAP_MODELS = [name for name in config["models"] if MODELS[name].is_cheap]
QUANTILE_RUNS = [
    [name, preset]
    for name in config["quantile_models"]
    for preset in config["presets"]
    if preset in (PAPER, TUNED)
]


def asks_for(*kinds):
    """Whether a configured interval method starts from one of these kinds of stored outputs."""
    return any(
        INTERVAL_METHODS[name].on in kinds for name in config["interval_methods"]
    )


def stored_outputs(wildcards):
    """Everything that the interval methods start from, of one dataset."""
    quantiles = "results/{{dataset}}/quantiles/{0}/{1}/quantiles.parquet"
    patterns = {
        "predictions": run_files("predictions.parquet"),
        "quantiles": [
            quantiles.format(*run) for run in QUANTILE_RUNS if asks_for("quantiles")
        ],
        "refits": ["results/{dataset}/refits.npz"] * asks_for("folds", "resamples"),
        "shells": ["results/{dataset}/shells.npz"] * asks_for("shells"),
    }
    return {
        name: expand(paths, dataset=wildcards.dataset)
        for name, paths in patterns.items()
    }


def interval_params():
    """What the interval rules are told."""
    return {
        "methods": config["interval_methods"],
        "runs": every_run(),
        "quantile_runs": QUANTILE_RUNS if asks_for("quantiles") else [],
        "confidence_levels": config["confidence_levels"],
        "seed": config["seed"],
    }


def quantile_parameters(wildcards):
    """For the tuned preset, what its study found."""
    path = "results/{dataset}/quantiles/{quantile_model}/tuned/parameters.json"
    return expand(path, **wildcards) if wildcards.preset == TUNED else []


def of_every_dataset(patterns):
    """The files of the first dataset, then those of the second, ...: the order of `every_study`."""
    return [
        path
        for dataset in config["datasets"]
        for path in expand(patterns, dataset=dataset)
    ]


def every_study():
    """[dataset, model, preset] of each study."""
    return [
        [dataset, *run] for dataset in config["datasets"] for run in searched_runs()
    ]


def final_output():
    """All that a complete campaign leaves."""
    return [
        REPORT,
        HEADLINE,
        *(f"results/tables/{name}" for name in PAPER_TABLES),
        "results/tables/figures",
        *(f"results/tables/{name}" for name in TABLES),
        *expand(
            "results/{dataset}/{name}",
            dataset=config["datasets"],
            name=["data_card.md", "figures", "calibrated_model.joblib"],
        ),
        *expand("results/{dataset}/mlflow_runs.json", dataset=config["datasets"]),
    ]
