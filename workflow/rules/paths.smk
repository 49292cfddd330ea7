# Names of runs and paths of files: what the configuration spans, and what more than one stage needs.
from softkin.core.manifest import MANIFEST
from softkin.core.runs import OUTER, PAPER, PRESETS, SEARCHED, TUNED
from softkin.models.paper_groups import NETWORK, ONE_OF_EACH_KIND


include: "groups.smk"


# The datasets that know when their rows were recorded.
RECORDED = [name for name in config["datasets"] if is_recorded(config["sources"][name])]
# The datasets whose entry names the orientation of the tip.
ORIENTED = [
    name for name in config["datasets"] if "orientation" in config["sources"][name]
]
# Published datasets, and the models whose learning curves decide what the paper says of the data that a network needs.
LEARNING_MODELS = [name for name in ONE_OF_EACH_KIND if name in config["models"]]
LEARNING = [
    name
    for name in config["datasets"]
    if "urls" in config["sources"][name]
    and name not in RECORDED
    and NETWORK in narrowed(config, "models", name)
]
# The presets that some dataset has.
ALL_PRESETS = {preset for group in GROUPS if group.datasets for preset in group.presets}
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
    *(["published_columns.csv"] if TUNED in ALL_PRESETS else []),
    "left_out.csv",
    "claims.csv",
    *(["recorded.csv"] if RECORDED else []),
    *(["learning_curve.csv"] if LEARNING else []),
    *(["orientation.csv"] if ORIENTED else []),
    *(["selection.csv", "searched_runs.csv"] if searched(ALL_PRESETS) else []),
]


wildcard_constraints:
    dataset=DATASET,
    model="|".join(MODELS),
    ensemble="|".join(ENSEMBLES),
    preset="|".join(PRESETS),
    quantile_model="|".join(QUANTILE_MODELS),


def of_presets(name, presets):
    """One file of a model for each of these presets."""
    return [f"results/{{dataset}}/{{model}}/{preset}/{name}" for preset in presets]


def of_ensemble(name, presets):
    """One file of an ensemble for each of these presets that it has, those whose parameters come from a study."""
    return [
        f"results/{{dataset}}/{{ensemble}}/{preset}/{name}"
        for preset in searched(presets)
    ]


def of_quantile_presets(name, presets):
    """One file of a quantile regressor for each of these presets."""
    return [
        f"results/{{dataset}}/quantiles/{{quantile_model}}/{preset}/{name}"
        for preset in presets
    ]


# The models that CV+ and jackknife+-after-bootstrap refit.
CHEAP_MODELS = [name for name in config["models"] if MODELS[name].is_cheap]
# The models that a few gross errors cannot move.
ROBUST_MODELS = [name for name in config["models"] if MODELS[name].is_robust]
INTERVAL_MANIFEST = f"results/{{dataset}}/intervals/{MANIFEST}"


include: "of_dataset.smk"


def tuning(*keys):
    """What a study is told of the configured tuning: these keys, and the folds and rows of a trial."""
    return {key: config["tuning"][key] for key in (*keys, "n_folds", "max_rows")}


def of_every_dataset(patterns):
    """The files of the first dataset, then those of the second, ..."""
    return [
        path
        for dataset in config["datasets"]
        for path in expand(patterns, dataset=dataset)
    ]


def final_output():
    """The files that a complete campaign leaves."""
    return [
        REPORT,
        HEADLINE,
        *(f"results/tables/{name}" for name in PAPER_TABLES),
        "results/tables/figures",
        "results/tables/summary.json",
        *(f"results/tables/{name}" for name in TABLES),
        *expand(
            "results/{dataset}/{name}",
            dataset=config["datasets"],
            name=["data_card.md", "figures", "calibrated_model.joblib"],
        ),
        *expand("results/{dataset}/mlflow_runs.json", dataset=config["datasets"]),
    ]
