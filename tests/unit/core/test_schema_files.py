from __future__ import annotations

from pathlib import Path

from softkin.core.schema_files import read_schema
from tests.conftest import HOUSE

FOLDER = HOUSE / "workflow" / "schemas"


def test_files_beside_a_schema_stand_where_it_refers_to_them(tmp_path: Path) -> None:
    (tmp_path / "all.yaml").write_text(
        "type: object\nproperties: {arm: {$ref: arm.yaml}, all: {allOf: [{$ref: arm.yaml}]}}"
    )
    (tmp_path / "arm.yaml").write_text("$schema: x\ntitle: an arm\ntype: object\nproperties: {tip: {$ref: tip.yaml}}")
    (tmp_path / "tip.yaml").write_text("type: number")
    arm = {"type": "object", "properties": {"tip": {"type": "number"}}}
    assert read_schema(tmp_path / "all.yaml") == {"type": "object", "properties": {"arm": arm, "all": {"allOf": [arm]}}}


def test_every_schema_is_read_by_that_of_the_configuration_and_short() -> None:
    read = read_schema(FOLDER / "config.schema.yaml")["properties"]["sources"]["additionalProperties"]
    assert "position_unit" in read["properties"]
    assert max(len(path.read_text().splitlines()) for path in FOLDER.glob("*.yaml")) <= 250
