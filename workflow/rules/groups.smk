# Datasets whose jobs make the same files, see src/softkin/core/narrowing.py: a rule of Snakemake names the same outputs for
# all of its jobs, so a rule whose outputs presets or interval methods decide is made once for each group. No rule of its
# own.
from softkin.core.narrowing import groups, name_of, narrowed
from softkin.data.entries import OWN_FOLDERS

GROUPS = groups(config)
# The rules that are made for each group.
GROUPED = ["fit_model", "fit_quantiles", "fit_ensemble", "refit", "calibrate"]
# The resources that a profile sets for a rule hold for the rule of each group.
RESOURCES = workflow.resource_settings.overwrite_resources
for group in GROUPS:
    for name in GROUPED:
        if name in RESOURCES:
            RESOURCES[name_of(name, group)] = RESOURCES[name]


# What the dataset of a path may be. Each file is held against these, and there are hundreds of a dataset: a list of a
# thousand names would be read each time.
DATASET = f"(?!(?:{'|'.join(OWN_FOLDERS)})/)[a-z][a-z0-9_]*"


def datasets_of(group):
    """What the wildcard `dataset` may be in a rule of a group."""
    if group.name:
        return "|".join(group.datasets)
    others = "|".join(name for other in GROUPS if other.name for name in other.datasets)
    return f"(?!(?:{others})(?:[/.]|$)){DATASET}" if others else DATASET


def group_of(dataset):
    """The group of a dataset."""
    return next(
        (group for group in GROUPS if group.name and dataset in group.datasets),
        GROUPS[0],
    )


# Rule of a group -> what it is called in logs, messages and timings.
STAGES = {name_of(name, group): name for name in GROUPED for group in GROUPS}


def stage_of(rule_name):
    """What a rule is called in logs, messages and timings."""
    return STAGES.get(rule_name, rule_name)


def searched(presets):
    """Those of some presets whose parameters come from a study."""
    return [preset for preset in presets if preset in SEARCHED]


def asks_for(trait, methods):
    """Whether the calibration data of one of these interval methods have this trait."""
    return any(getattr(INTERVAL_METHODS[name].calibrated_on, trait) for name in methods)


def has_quantiles(group):
    """The presets that quantile regressors have in a group: none where no method of it needs them."""
    presets = [preset for preset in group.presets if preset in (PAPER, TUNED)]
    return presets * asks_for("needs_quantiles", group.interval_methods)


def is_compared(group):
    """Whether the models of a group are fitted in either target space, so that the spaces can be compared."""
    return OUTER in group.presets and len(config["target_spaces"]) > 1


def refit_files(group):
    """What the rule `refit` makes of a dataset of a group; none of what no method needs."""
    return {
        "refits": ["results/{dataset}/refits.npz"]
        * asks_for("needs_refits", group.interval_methods),
        "shells": ["results/{dataset}/shells.npz"]
        * asks_for("needs_shells", group.interval_methods),
        "spaces": ["results/{dataset}/other_spaces.parquet"] * is_compared(group),
    }
