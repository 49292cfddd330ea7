# Results that were made with other params are made anew also where Snakemake has lost its records of them: those of the
# jobs have them, see src/softkin/cli/redo.py. Comes last, since it asks every rule for its params. No rule of its own.
from snakemake.iocontainers import InputFiles, OutputFiles, Wildcards

from softkin.cli.redo import redo_changed

# The keys of the configuration that say what a wildcard may be: there may be results of others.
KEYS = {
    "model": "models",
    "ensemble": "ensembles",
    "quantile_model": "quantile_models",
}


def is_of_this_run(wildcards):
    """Whether this run has jobs of this dataset, and of this model."""
    dataset = wildcards.get("dataset")
    return dataset in (None, *config["datasets"]) and all(
        name in configured(KEYS[key], dataset)
        for key, name in wildcards.items()
        if key != "dataset"
    )


def params_of(words):
    """The params of the job of these words, its rule and its wildcards; None where this run has no such job."""
    name, *names = words.split()
    rule_name = name_of(name, group_of(names[0])) if name in GROUPED else name
    if not workflow.is_rule(rule_name):
        return None
    defined = workflow.get_rule(rule_name)
    found = defined.log[0].match(f"{Path('results', 'logs', name, *names)}.log")
    if found is None or not is_of_this_run(found.groupdict()):
        return None
    wildcards = Wildcards(fromdict=found.groupdict())
    params, _ = defined.expand_params(wildcards, InputFiles(), OutputFiles(), job=None)
    return dict(params.items())


if workflow.is_main_process:
    only_say = only_looks(sys.argv)
    for changed in redo_changed(OF_UNKNOWN_PARAMS, params_of, only_say=only_say):
        print(f"softkin: {changed}.", file=sys.stderr)
