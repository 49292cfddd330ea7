# Names of runs and paths of files: what the configuration spans, and what more than one stage needs.
from softkin.core.manifest import MANIFEST
from softkin.core.runs import OUTER, PAPER, PRESETS, SEARCHED, TUNED
from softkin.models.paper_groups import NETWORK, ONE_OF_EACH_KIND

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
    if "urls" in config["sources"][name] and name not in RECORDED
] * (NETWORK in LEARNING_MODELS)
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
    "left_out.csv",
    "claims.csv",
    *(["recorded.csv"] if RECORDED else []),
    *(["learning_curve.csv"] if LEARNING else []),
    *(["orientation.csv"] if ORIENTED else []),
    *(
        ["selection.csv", "searched_runs.csv"]
        if set(SEARCHED) & set(config["presets"])
        else []
    ),
]


# The presets whose parameters come from a study.
SEARCHED_PRESETS = [preset for preset in config["presets"] if preset in SEARCHED]


# Each file is held against these, and there are hundreds of a dataset: a list of a thousand names would be read each time.
wildcard_constraints:
    dataset="(?!(?:tables|logs|benchmarks|studies|studies_before_refit|manifest|schedules|peers)/)[a-z][a-z0-9_]*",
    model="|".join(MODELS),
    ensemble="|".join(ENSEMBLES),
    preset="|".join(PRESETS),
    quantile_model="|".join(QUANTILE_MODELS),


def of_presets(name, presets=tuple(config["presets"])):
    """One file of a model for each of these presets."""
    return [f"results/{{dataset}}/{{model}}/{preset}/{name}" for preset in presets]


def of_searched(name):
    """One file of a model for each preset whose parameters come from a study."""
    return of_presets(name, SEARCHED_PRESETS)


def of_ensemble(name):
    """One file of an ensemble for each preset that it has, those whose parameters come from a study."""
    return [
        f"results/{{dataset}}/{{ensemble}}/{preset}/{name}"
        for preset in SEARCHED_PRESETS
    ]


def asks_for(trait):
    """Whether the calibration data of a configured interval method have this trait."""
    methods = [INTERVAL_METHODS[name] for name in config["interval_methods"]]
    return any(getattr(method.calibrated_on, trait) for method in methods)


# The models that are fitted in either target space, so that the spaces can be compared.
COMPARED = config["models"] * (
    OUTER in config["presets"] and len(config["target_spaces"]) > 1
)
# The models that CV+ and jackknife+-after-bootstrap refit.
CHEAP_MODELS = [name for name in config["models"] if MODELS[name].is_cheap]
# The models that a few gross errors cannot move.
ROBUST_MODELS = [name for name in config["models"] if MODELS[name].is_robust]
# The presets and runs of quantile regressors, where a configured method needs them.
QUANTILE_PRESETS = [
    preset for preset in config["presets"] if preset in (PAPER, TUNED)
] * asks_for("needs_quantiles")
# The refits that a configured method needs; none of the others are made.
REFITS = ["results/{dataset}/refits.npz"] * asks_for("needs_refits")
# Of which rows of train the studies stored held-out errors, where a configured method needs them.
STUDY_PARTS = (
    {key: config["tuning"][key] for key in ("n_folds", "max_rows", "max_markers")}
    if asks_for("needs_held_out")
    else None
)
SHELLS = ["results/{dataset}/shells.npz"] * asks_for("needs_shells")
OTHER_SPACES = ["results/{dataset}/other_spaces.parquet"] * bool(COMPARED)
INTERVAL_MANIFEST = f"results/{{dataset}}/intervals/{MANIFEST}"


include: "of_dataset.smk"


def of_quantile_presets(name, presets=(PAPER, TUNED)):
    """One file of a quantile regressor for each of these presets that it gets."""
    return [
        f"results/{{dataset}}/quantiles/{{quantile_model}}/{preset}/{name}"
        for preset in QUANTILE_PRESETS
        if preset in presets
    ]


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
