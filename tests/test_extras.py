"""Optional packages: every extra that an error names exists."""

import tomllib
from pathlib import Path
from typing import Any, get_args

import pytest

from humanwalk.extras import Extra, install_command, missing_package

EXTRAS = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())["project"]["optional-dependencies"]


@pytest.mark.parametrize("extra", get_args(Extra))
def test_extra_exists_and_the_command_installs_it_from_the_checkout(extra: Any) -> None:
    assert EXTRAS[extra]
    assert install_command(extra).endswith(f"pip install -e '.[{extra}]'")


def test_error_is_one_line_with_package_and_command() -> None:
    message = str(missing_package("playwright", "video"))
    assert message.startswith("playwright: ")
    assert message.endswith(install_command("video"))
    assert message.isprintable()
