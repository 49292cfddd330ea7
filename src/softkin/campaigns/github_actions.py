"""The text of a workflow of GitHub Actions that starts a campaign every day."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Mapping

#: What a campaign leaves, and the next one goes on from.
KEPT = ("results", ".snakemake", "mlflow.db*", "mlartifacts")
#: @NAME@ is filled in. GitHub sends mail for a failed job alone, so that exit codes 3 and 4 fail it, too.
TEXT = """\
name: campaign
on:
  schedule:
    - cron: "@CRON@" # UTC
  workflow_dispatch:
permissions:
  contents: read
concurrency:
  group: softkin-campaign
  cancel-in-progress: false
jobs:
  campaign:
    runs-on: ubuntu-latest
    timeout-minutes: 350
    defaults:
      run:
        working-directory: @INSIDE@
    env:
@VARIABLES@
      # URLs of Apprise, one blank between two, as a secret of the repository; none: no notification.
      NOTIFY_URLS: ${{ secrets.NOTIFY_URLS }}
    steps:
      - uses: actions/checkout@v4
      - uses: actions/setup-python@v5
        with:
          python-version: "3.11"
      - name: Take up the results of the night before
        uses: actions/cache/restore@v4
        with:
          path: |
@KEPT@
          key: softkin-${{ github.run_id }}-${{ github.run_attempt }}
          restore-keys: softkin-
      - name: Install
        run: |
          make .venv/installed
          if [ -n "$NOTIFY_URLS" ]; then .venv/bin/pip install --quiet '@APPRISE@'; fi
      - name: Campaign
        id: campaign
        run: |
          rm -f results/verdict.*
          code=0
          @CAMPAIGN@ || code=$?
          echo "exit_code=$code" >> "$GITHUB_OUTPUT"
          if [ -f results/verdict.md ]; then cat results/verdict.md >> "$GITHUB_STEP_SUMMARY"; fi
      - name: Keep the results for the next night
        if: always()
        uses: actions/cache/save@v4
        with:
          path: |
@KEPT@
          key: softkin-${{ github.run_id }}-${{ github.run_attempt }}
      - name: Show the verdict
        if: always()
        uses: actions/upload-artifact@v4
        with:
          name: verdict
          path: |
@VERDICT@
      - name: A verdict that a person looks at fails this job
        run: |
          echo "the campaign ended with exit code $EXIT_CODE"
          exit "$EXIT_CODE"
        env:
          EXIT_CODE: ${{ steps.campaign.outputs.exit_code }}
"""


def github_workflow(
    time: str, cores: int, *, notify: str | None, variables: Mapping[str, str], apprise: str, inside: str = "."
) -> str:
    """The workflow; results are kept from night to night in GitHub's cache.

    Parameters:
        time: of the day, 'HH:MM', UTC.
        cores: jobs at a time.
        notify: command that gets the verdict on its standard input; None for none.
        variables: of the campaign's environment.
        apprise: what pip installs for URLs, such as 'apprise==2.3.0'.
        inside: the project's folder within the repository; its top by default.
    """
    hour, minute = map(int, time.split(":"))
    within = "" if inside == "." else f"{inside}/"
    told = f" --notify={shlex.quote(notify)}" if notify else ""
    filled = {
        "CRON": f"{minute} {hour} * * *",
        "INSIDE": json.dumps(_literally(inside), ensure_ascii=False),
        "VARIABLES": "\n".join(f"      {name}: {json.dumps(value)}" for name, value in variables.items()),
        "KEPT": "\n".join(f"            {_literally(within + name)}" for name in KEPT),
        "VERDICT": f"            {_literally(within)}results/verdict.*",
        "CAMPAIGN": _literally(f".venv/bin/python -m softkin.cli.campaign --cores {cores}{told}"),
        "APPRISE": apprise,
    }
    return re.sub("@([A-Z]+)@", lambda found: filled[found[1]], TEXT)


def _literally(text: str) -> str:
    """Text in which GitHub finds no expression."""
    return text.replace("${{", "${{ '${{' }}")
