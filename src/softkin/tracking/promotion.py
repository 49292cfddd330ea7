"""Say which registered version of a robot's calibrated model is the champion: what `models:/...@champion` loads."""

from __future__ import annotations

from mlflow import MlflowClient

#: The version that was made last, and the one that a campaign has found no worse than the champion before it.
CANDIDATE, CHAMPION = "candidate", "champion"
#: Tag of a version: why it became the champion.
REASON = "promoted_because"
FIRST = "it is the first version"


def nominate(client: MlflowClient, name: str, version: str) -> None:
    """Make a version the candidate, and the champion where there is none.

    Parameters:
        client: of the store.
        name: of the registered model.
        version: its number.
    """
    aliases = aliases_of(client, name)
    if aliases.get(CANDIDATE) != version:
        client.set_registered_model_alias(name, CANDIDATE, version)
    if CHAMPION not in aliases:
        promote(client, name, version, FIRST)


def promote(client: MlflowClient, name: str, version: str, reason: str) -> None:
    """Make a version the champion; its tag says why."""
    client.set_model_version_tag(name, version, REASON, reason)
    client.set_registered_model_alias(name, CHAMPION, version)


def aliases_of(client: MlflowClient, name: str) -> dict[str, str]:
    """Alias -> version of a registered model."""
    return {alias: str(version) for alias, version in client.get_registered_model(name).aliases.items()}
