"""Fixtures of the tests of the command line."""

import logging
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from humanwalk.cli.main import run_command


@pytest.fixture
def humanwalk(monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path) -> Iterator[Any]:
    """Runs the command line in an empty folder; gives exit code, output and errors."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    level = logging.getLogger("drake").level

    def run(*arguments: object) -> Any:
        monkeypatch.setattr(sys, "argv", ["humanwalk", *map(str, arguments)])
        code = 0
        try:
            run_command()
        except SystemExit as end:
            code = end.code or 0  # type: ignore[assignment]
        captured = capfd.readouterr()
        return code, captured.out, captured.err

    yield run
    logging.getLogger("drake").setLevel(level)
