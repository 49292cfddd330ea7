"""Remove old campaigns from the MLflow store, and what was superseded before the oldest one that is kept.

    python -m softkin.cli.prune --keep 50 --yes

Nothing else in softkin removes runs. Without --yes it only says what would go.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from softkin.cli.store_address import store_address
from softkin.core.errors import SoftkinError
from softkin.tracking.prune import remove, to_remove
from softkin.tracking.store import client_of


def main(arguments: Sequence[str] | None = None) -> int:
    """Say what goes, and remove it; return the exit code."""
    parser = argparse.ArgumentParser(prog="softkin.cli.prune", allow_abbrev=False, description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    parser.add_argument("--keep", type=int, required=True, help="how many of the last campaigns stay, at least 1")
    parser.add_argument("--yes", action="store_true", help="remove, and not only say what")
    asked = parser.parse_args(arguments)
    if asked.keep < 1:
        print("softkin: KEEP is a whole number from 1, such as make prune KEEP=50", file=sys.stderr)
        return 2
    try:
        client = client_of(store_address(Path()))
        removal = to_remove(client, asked.keep)
        for sentence in removal.sentences():
            print(f"{'removed' if asked.yes else 'would remove'}: {sentence}")
        if asked.yes:
            remove(client, removal)
    except SoftkinError as error:
        print(f"softkin: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
