"""Links into MLflow's UI that open runs, each with its saved view."""

from __future__ import annotations

from mlflow import MlflowClient

from softkin.tracking import champion, nights, saved_view
from softkin.tracking.store import client_of, experiment_of

#: The experiments across datasets, in the order of the links: name -> (title, key of the saved view).
ACROSS = {
    nights.EXPERIMENT: ("campaigns", saved_view.CAMPAIGNS_KEY),
    champion.EXPERIMENT: ("calibrated models", saved_view.CHAMPIONS_KEY),
}


def links(tracking_uri: str) -> dict[str, str]:
    """Title -> path and fragment of a link, from the server's address on.

    `workflowType` makes the UI open runs; without it a page for language models comes first.

    Parameters:
        tracking_uri: where the store is.

    Raises:
        StoreError: the store is gone.
    """
    experiments = {one.name: one.experiment_id for one in client_of(tracking_uri).search_experiments()}
    found = {}
    for name, (title, key) in ACROSS.items():
        if name in experiments:
            found[title] = _link(experiments.pop(name), key)
    if nights.HISTORY in experiments:
        found["nights as curves"] = (
            f"/#/experiments/{experiments.pop(nights.HISTORY)}/runs?workflowType=machine_learning"
        )
    experiments.pop("Default", None)
    return found | {name: _link(number, saved_view.KEY) for name, number in sorted(experiments.items())}


def link_to(client: MlflowClient, dataset: str) -> str:
    """The link to the runs of a dataset, from the server's address on."""
    return _link(experiment_of(client, dataset), saved_view.KEY)


def _link(experiment: str, view: str) -> str:
    return f"/#/experiments/{experiment}/runs?workflowType=machine_learning&viewStateShareKey={view}"
