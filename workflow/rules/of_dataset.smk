# What one dataset gets of the configured models, presets and methods: all of them, what its entry narrows them to, and less
# in a run that makes tables of what is there after a job has failed.
import json
import os
from functools import cache, partial

from softkin.cli.partial_tables import PARTIAL

# Set in a run that makes tables of what is there after a job has failed: what a dataset does without, by key of the
# configuration, and the datasets that are complete, see src/softkin/cli/partial_tables.py.
IS_PARTIAL = PARTIAL in os.environ
LEFT_OUT, COMPLETE = (
    json.loads(os.environ.get(PARTIAL, "{}")).get(key, none)
    for key, none in (("left_out", {}), ("complete", []))
)


def configured(key, dataset):
    """The models, interval methods, ... of a dataset: those of this key that are its own and not left out."""
    names = narrowed(config, key, dataset)
    out = LEFT_OUT.get(dataset, {}).get(key, ())
    return [name for name in names if name not in out] if out else names


@cache
def runs_of(models, presets, ensembles=()):
    """[model, preset] of each run of these, ensembles by searched presets; one list for all jobs, which are thousands."""
    runs = [[model, preset] for model in models for preset in presets]
    return runs + [[name, preset] for name in ensembles for preset in searched(presets)]


def searched_presets(dataset):
    """The presets of a dataset whose parameters come from a study."""
    return searched(configured("presets", dataset))


def ensembles_of(dataset):
    """The ensembles of a dataset: of searched runs, where there are some."""
    return configured("ensembles", dataset) * bool(searched_presets(dataset))


def every_run(wildcards):
    """[model, preset] of each run of a dataset, ensembles last."""
    models = configured("models", wildcards.dataset)
    presets = configured("presets", wildcards.dataset)
    ensembles = ensembles_of(wildcards.dataset)
    return runs_of(tuple(models), tuple(presets), tuple(ensembles))


def pool_runs(wildcards):
    """[model, preset] of each run of a dataset whose parameters come from a study: they may be members of ensembles."""
    models = configured("models", wildcards.dataset)
    return runs_of(tuple(models), tuple(searched_presets(wildcards.dataset)))


def searched_of(dataset):
    """[model, preset] of each run of a dataset that is searched for on train, ensembles last."""
    models = configured("models", dataset) + ensembles_of(dataset)
    return runs_of(tuple(models), tuple(searched_presets(dataset)))


def searched_runs(wildcards):
    """Those of the dataset of a job."""
    return searched_of(wildcards.dataset)


def tuned_runs(wildcards):
    """[model, preset] of each tuned run of a dataset."""
    models = configured("models", wildcards.dataset) + ensembles_of(wildcards.dataset)
    presets = [
        name for name in configured("presets", wildcards.dataset) if name == TUNED
    ]
    return runs_of(tuple(models), tuple(presets))


def manifests_of(dataset):
    """The manifests of a dataset's models: they stand for all files of the models, see src/softkin/core/manifest.py."""
    models = configured("models", dataset) + ensembles_of(dataset)
    return [f"results/{dataset}/{model}/{MANIFEST}" for model in models]


def pool_manifests(wildcards):
    """The manifests of a dataset's models without ensembles."""
    models = configured("models", wildcards.dataset)
    return [f"results/{wildcards.dataset}/{model}/{MANIFEST}" for model in models]


def model_manifests(wildcards):
    """The manifests of a dataset's models."""
    return manifests_of(wildcards.dataset)


def orientation_model(wildcards):
    """The model of the tip's orientation, where a dataset has one."""
    return [f"results/{wildcards.dataset}/orientation.joblib"] * (
        wildcards.dataset in ORIENTED
    )


def orientation_scores(wildcards):
    """The scores of that model."""
    return [f"results/{wildcards.dataset}/orientation.csv"] * (
        wildcards.dataset in ORIENTED
    )


def compared_models(wildcards):
    """The models of a dataset that are fitted in either target space, so that the spaces can be compared."""
    models = configured("models", wildcards.dataset)
    return models * is_compared(group_of(wildcards.dataset))


def quantile_runs(wildcards):
    """[quantile regressor, preset] of each run of a dataset."""
    names = configured("quantile_models", wildcards.dataset)
    return runs_of(tuple(names), tuple(has_quantiles(group_of(wildcards.dataset))))


def quantile_manifests(wildcards):
    """The manifests of a dataset's quantile regressors."""
    dataset = wildcards.dataset
    names = [name for name, _ in quantile_runs(wildcards)]
    return [
        f"results/{dataset}/quantiles/{of}/{MANIFEST}" for of in dict.fromkeys(names)
    ]


def refit_file(wildcards, kind):
    """The file of a dataset that the rule `refit` makes of this kind, where a method needs it."""
    files = refit_files(group_of(wildcards.dataset))[kind]
    return expand(files, dataset=wildcards.dataset)


def study_parts(wildcards):
    """Of which rows of train the studies stored held-out errors, where a method of a dataset needs them."""
    methods = group_of(wildcards.dataset).interval_methods
    if not asks_for("needs_held_out", methods):
        return None
    names = ("n_folds", "max_rows", "max_markers")
    return {name: config["tuning"][name] for name in names}


# What a run that makes tables of what is there must not declare: it may have fewer intervals of a dataset, and the
# calibrated model of an earlier run stays.
def of_methods(group):
    """The files of a group's intervals."""
    return expand(
        "results/{{dataset}}/intervals/{method}.parquet",
        method=group.interval_methods * (not IS_PARTIAL),
    )


CALIBRATED_MODEL = ["results/{dataset}/calibrated_model.joblib"] * (not IS_PARTIAL)


def calibrated_model(wildcards):
    """The calibrated model of a dataset, where this run makes it or has nothing to do for it."""
    if IS_PARTIAL and wildcards.dataset not in COMPLETE:
        return []
    return [f"results/{wildcards.dataset}/calibrated_model.joblib"]


# All that the interval methods start from, of one dataset.
STORED_OUTPUTS = {
    "models": model_manifests,
    "quantile_models": quantile_manifests,
    "refits": partial(refit_file, kind="refits"),
    "shells": partial(refit_file, kind="shells"),
}


def methods_of(wildcards):
    """The interval methods of a dataset."""
    return configured("interval_methods", wildcards.dataset)


def regions_of(wildcards):
    """The joint regions of a dataset."""
    return configured("regions", wildcards.dataset)


def interval_params():
    """The params that all interval rules share."""
    return {
        "methods": methods_of,
        "runs": every_run,
        "quantile_runs": quantile_runs,
        "searched": searched_runs,
        "pool": pool_runs,
        "study_parts": study_parts,
        "confidence_levels": config["confidence_levels"],
        "seed": config["seed"],
    }
