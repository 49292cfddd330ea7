"""What runs when published data cannot be reached."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
import yaml

from softkin.core.files import read_json
from softkin.core.samples import SUBSETS
from tests.workflow.conftest import NOWHERE, House, jobs_of

pytestmark = pytest.mark.timeout(600)


def test_a_stand_in_takes_the_place_of_unreachable_data_until_they_return(house: House, tmp_path: Path) -> None:
    """A stand-in has another name, a title that says so, and a warning before and after the run."""
    (tmp_path / "mirror").mkdir()
    override = yaml.safe_load((house.mirror / "override.yaml").read_text())
    override["sources"]["finger"]["urls"] = [NOWHERE]
    override["datasets"] = ["finger"]
    (tmp_path / "mirror" / "override.yaml").write_text(yaml.safe_dump(override))
    alone = House(house.root, tmp_path, tmp_path / "mirror")
    small = ["models=[lr]", "presets=[paper]", "interval_methods=[scp_mapie]", "regions=[]"]
    done = alone.forked("results/report.html", "--config", *small)
    output = done.stdout + done.stderr
    assert done.returncode == 0, output[-3000:]
    assert output.count("STAND-INS: finger cannot be reached") == 2
    description = read_json(tmp_path / "results" / "finger_standin" / "dataset.json")
    assert description["origin"] == "stand-in"
    assert "STAND-IN" in description["title"]
    assert description["rows"] == dict(zip(SUBSETS, (120, 88, 89, 120), strict=True))
    assert "STAND-IN" in (tmp_path / "results" / "report.html").read_text()
    assert "nothing was run that the paper has printed" in output
    assert planned(alone, *small) == set()
    assert planned(alone, *small, "when_unreachable=fail") == {"finger"}
    shutil.copy(house.mirror / "FINGER.json", tmp_path / "mirror")
    assert planned(alone, *small) == {"finger"}
    assert read_json(house.work / "results" / "finger" / "dataset.json")["origin"] == "published"


def planned(house: House, *configuration: str) -> set[str]:
    """The datasets that jobs of a run would be about."""
    status, output = house.looking("--dry-run", "results/report.html", "--config", *configuration)
    assert status == 0, output
    named = (re.search(r"dataset=(\w+)", wildcards) for _, wildcards in jobs_of(output))
    return {found[1] for found in named if found}
