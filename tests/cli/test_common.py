"""Progress shows names from others without their control characters."""

import io

from rich.console import Console

from humanwalk.cli.common import print_warnings, simulated_progress

NAME = "x\x1b]0;title\x07[bold red]"


def test_a_name_in_a_progress_bar_is_escaped() -> None:
    shown = io.StringIO()
    console = Console(file=shown, force_terminal=True, width=120)
    with simulated_progress(console) as progress:
        progress.add_task(NAME, total=3.0)
    assert "x\\x1b]0;title\\x07[bold red]" in shown.getvalue()
    assert "\x1b]0" not in shown.getvalue()


def test_few_warnings_are_printed() -> None:
    shown = io.StringIO()
    print_warnings([f"the {k}th" for k in range(8)], Console(file=shown, width=80))
    assert shown.getvalue().splitlines() == [f"warning: the {k}th" for k in range(5)] + ["warning: and 3 more"]
