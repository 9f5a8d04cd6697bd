"""Studies whose rows are made up: their statistics are known."""

import json
from collections.abc import Callable
from typing import Any

import pyarrow as pa
import pytest

from humanwalk.study.design import Point
from humanwalk.study.results import Results
from humanwalk.study.row import Row, run_columns
from humanwalk.study.study import parse_study


@pytest.fixture
def make_results() -> Callable[..., Results]:
    """Makes the results of a study in YAML, its rows from its points."""

    def make(text: str, row_of: Callable[[Point], Row], name: str = "made up") -> Results:
        study = parse_study(text)
        rows: list[dict[str, Any]] = []
        for index, point in enumerate(study.points):
            values = {column: study.value_at(point, column) for column in study.columns}
            factors = {name: json.dumps(value) if isinstance(value, list) else value for name, value in values.items()}
            made = {"survived": True} | row_of(point)
            end = "completed" if made["survived"] else "fell"
            rows.append(dict.fromkeys(run_columns()) | {"row": index, "end": end} | factors | made)
        return Results(name, study, pa.Table.from_pylist(rows))

    return make
