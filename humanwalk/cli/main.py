"""The command line: its commands are registered by import, grouped by subject."""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from enum import Enum
from typing import Any

from typer import TyperException

from humanwalk.cli import (
    compare_commands,
    drive_commands,
    inspection_commands,
    run_commands,
    schema_commands,
    simulation_commands,
    study_commands,
    tuning_commands,
)
from humanwalk.cli.common import BAD_INPUT, MAX_MESSAGE, app, console
from humanwalk.cli.streams import discard, encode_all, open_missing, signals_as_exits
from humanwalk.quantity import ParameterError, printable

__all__ = [
    "app",
    "compare_commands",
    "drive_commands",
    "inspection_commands",
    "main",
    "run_command",
    "run_commands",
    "schema_commands",
    "simulation_commands",
    "study_commands",
    "tuning_commands",
]


def main() -> None:
    """Entry point of the program."""
    open_missing()
    encode_all(sys.stdout)
    with signals_as_exits():
        run_command()


def run_command() -> None:
    """Run the command in `sys.argv`; invalid input produces one line and exit code 2."""
    with _own_log():
        try:
            try:
                code = app(standalone_mode=False)
            finally:
                sys.stdout.flush()
        except (ParameterError, OSError, TyperException) as error:
            if message := _message(error):
                text = f"humanwalk: {printable(message, MAX_MESSAGE)}"
                console.print(text, style="red", highlight=False, soft_wrap=True)
            discard(sys.stdout)
            sys.exit(BAD_INPUT)
        # typer returns the exit code with which a command ended, or None.
        sys.exit(code)


def _message(error: Exception) -> str:
    """The message for invalid input; empty where typer has printed the help instead."""
    match error:
        case OSError():
            return _file_error(error)
        case TyperException():
            message, context = _option_error(error).rstrip("."), getattr(error, "ctx", None)
            return f"{message}; see {context.command_path} --help" if message and context else message
        case _:
            return str(error)


def _option_error(error: TyperException) -> str:
    """The message of typer. For a number or a choice it names the value and what is allowed, which typer leaves out."""
    message = error.format_message()
    of_pydantic: Any = error.__cause__
    if not hasattr(of_pydantic, "errors"):
        return message
    option: Any = getattr(error, "param", None)
    kind = option.type_descriptor.annotation
    if issubclass(kind, Enum):
        allowed = ", ".join(kind)
    else:
        ends = (("from", option.min), ("to", option.max))
        numbers = "whole numbers" if kind is int else "numbers"
        allowed = " ".join((numbers, *(f"{word} {end:g}" for word, end in ends if end is not None)))
    return f"{message.partition(': ')[0]}: {of_pydantic.errors()[0]['input']}; allowed: {allowed}"


def _file_error(error: OSError) -> str:
    """An error of a file that no function has turned into a ParameterError: standard output has no name."""
    name = "standard output" if error.filename is None else printable(error.filename)
    return f"{name}: {error.strerror or error}"


class _OneLine(logging.Formatter):
    def format(self, record: logging.LogRecord) -> str:
        """A message on one line; names of files and columns come from others."""
        return printable(super().format(record), MAX_MESSAGE)


@contextmanager
def _own_log() -> Iterator[None]:
    """Within the block, every message that this package logs is one line on stderr, and Drake logs errors only.

    Drake's notices (ports) are of no use here; its errors arrive as exceptions.
    """
    drake = logging.getLogger("drake")
    drake.addFilter(_is_error)
    log, handler = logging.getLogger("humanwalk"), logging.StreamHandler()
    handler.setFormatter(_OneLine("humanwalk: %(message)s"))
    log.addHandler(handler)
    # pydrake gives the root logger a handler of its own.
    log.propagate = False
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.propagate = True
        drake.removeFilter(_is_error)


def _is_error(record: logging.LogRecord) -> bool:
    return record.levelno >= logging.ERROR
