# Results that were made with other params are made anew also where Snakemake has lost its records of them: those of the
# jobs have them, see src/softkin/cli/redo.py. Comes last, since it asks every rule for its params. No rule of its own.
from snakemake.iocontainers import InputFiles, OutputFiles, Wildcards

from softkin.cli.redo import redo_changed

# What a wildcard may be in this run: there may be results of others.
NAMES = {
    "dataset": config["datasets"],
    "model": config["models"],
    "ensemble": config["ensembles"],
    "quantile_model": config["quantile_models"],
}


def params_of(words):
    """The params of the job of these words, its rule and its wildcards; None where this run has no such job."""
    name, *names = words.split()
    if not workflow.is_rule(name):
        return None
    defined = workflow.get_rule(name)
    found = defined.log[0].match(f"{Path('results', 'logs', name, *names)}.log")
    if found is None or any(
        of not in NAMES[key] for key, of in found.groupdict().items()
    ):
        return None
    wildcards = Wildcards(fromdict=found.groupdict())
    params, _ = defined.expand_params(wildcards, InputFiles(), OutputFiles(), job=None)
    return dict(params.items())


if workflow.is_main_process:
    only_say = only_looks(sys.argv)
    for changed in redo_changed(OF_UNKNOWN_PARAMS, params_of, only_say=only_say):
        print(f"softkin: {changed}.", file=sys.stderr)
