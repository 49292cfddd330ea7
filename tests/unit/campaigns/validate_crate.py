"""Validate an RO-Crate by roc-validator, on a machine that reaches w3id.org or not; run by its interpreter.

    python validate_crate.py results

Without w3id.org the words of RO-Crate are those that the package `rocrate` brings, which are of version 1.3. In 1.1 the
one word that is another there and that crates of softkin use is `ComputationalWorkflow`.
"""

import json
import sys
from pathlib import Path

import requests
import rocrate  # type: ignore[import-not-found]
from rocrate_validator import services  # type: ignore[import-not-found]
from rocrate_validator.models import Severity, ValidationSettings  # type: ignore[import-not-found]
from rocrate_validator.utils.http import HttpRequester  # type: ignore[import-not-found]

CONTEXT = "https://w3id.org/ro/crate/1.1/context"
PROFILE = "workflow-run-crate-0.5"


def words() -> bytes:
    """The JSON-LD context of RO-Crate 1.1."""
    brought = json.loads((Path(rocrate.__file__).parent / "data" / "ro-crate.jsonld").read_text(encoding="utf-8"))
    brought["@context"]["ComputationalWorkflow"] = "https://bioschemas.org/ComputationalWorkflow"
    return json.dumps(brought).encode()


def answer(_: object, url: str, *__: object, **___: object) -> requests.Response:
    """As HttpRequester.get: the words for their address, and nothing for any other."""
    if url != CONTEXT:
        raise requests.ConnectionError(url)
    response = requests.Response()
    response.status_code, response.url, response._content = 200, url, words()
    response.headers["Content-Type"] = "application/ld+json"
    return response


def main(crate: str) -> int:
    """Print what the profile requires and the crate has not; 0 where that is nothing."""
    try:
        requests.head(CONTEXT, timeout=10)
        print("the words of RO-Crate come from w3id.org")
    except requests.ConnectionError:
        HttpRequester.get = answer
        print("the words of RO-Crate come from the package rocrate")
    settings = ValidationSettings(
        rocrate_uri=crate, profile_identifier=PROFILE, requirement_severity=Severity.REQUIRED, no_cache=True
    )
    found = services.validate(settings)
    for issue in found.get_issues():
        print(issue.severity.name, issue.check.identifier, issue.message)
    return int(found.has_issues())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
