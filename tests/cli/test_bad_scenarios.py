"""Scenario files that are broken or hostile, through the command line: run or refused in one line, nothing else.

Never a traceback, never code that is executed, never a file outside the output folder, never 2 GB of memory.
"""

import io
import json
import os
import re
import resource
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from humanwalk.cli.main import run_command
from humanwalk.parameter_file import MAX_FILE_SIZE, fields_of
from humanwalk.scenario import Scenario, dump_scenario, load_scenario

LARGEST_MEMORY_KB = 2_000_000
LINES = dump_scenario(load_scenario("thesis")).splitlines()


def peak_memory() -> int:
    """Largest memory of this process so far [kB]; earlier tests of the process count, so only its growth is checked."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


NASTY = [
    ".nan", ".inf", "-1e308", "1e999", "9" * 400, "-0.0", "0", "-1", "''", "null", "~", "[]", "{}", "[[[]]]", "true",
    "2017-01-01", "!!binary aGk=", "!!set {a}", "!!timestamp x", "!!float x", "!!int 99999999999999999999999999",
    "!!python/object/apply:os.system ['touch pwned']",
    "!!python/object/new:subprocess.Popen [['touch', 'pwned']]",
    "!!python/name:os.system", "!!python/module:os", "!!python/tuple [1]",
    "&a [*a]", "&a {b: *a}", "*nowhere", "[" * 3000, "{a: " * 500, "../../../etc/passwd", "/dev/zero", "$(touch pwned)",
    "%s%s%n", "'\\0'", '"\\ud800"', "\x07", "é" * 300, "|\n  text", "1_000", "0x10", "1:30:00", "<<", "? a\n: b",
]  # fmt: skip
LAUGHS = "_a: &a [x, x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"_{b}: &{b} [{', '.join([f'*{a}'] * 10)}]\n" for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)


def walk(path: Any, folder: Any) -> Any:
    """Exit code and what was printed by walking 2 ms of a scenario file; what is raised but not caught fails."""
    saved, argv = sys.stderr, sys.argv
    sys.argv = ["humanwalk", "walk", str(path), "--no-replay", "--no-plots", "-o", str(folder), "--duration", "0.002"]
    sys.stderr = io.StringIO()
    code = 0
    try:
        run_command()
    except SystemExit as end:
        code = end.code or 0  # type: ignore[assignment]
    finally:
        printed, sys.stderr, sys.argv = sys.stderr.getvalue(), saved, argv
    return code, printed


@st.composite
def mutated(draw: Any) -> Any:
    """The thesis' scenario with one to three things done to it."""
    lines = list(LINES)
    for _ in range(draw(st.integers(1, 3))):
        i = draw(st.integers(0, len(lines) - 1)) if lines else 0
        action = draw(st.sampled_from(["value", "field", "delete", "double", "indent", "cut", "insert", "laugh"]))
        nasty = draw(st.sampled_from(NASTY))
        if not lines:
            break
        if action == "value":
            head, colon, _ = lines[i].rpartition(": ")
            lines[i] = f"{head}{colon}{nasty}"
        elif action == "field":
            parts = lines[i].split(", ")
            j = draw(st.integers(0, len(parts) - 1))
            head, colon, _ = parts[j].rpartition(": ")
            parts[j] = f"{head}{colon}{nasty}"
            lines[i] = ", ".join(parts)
        elif action == "delete":
            del lines[i]
        elif action == "double":
            lines.insert(i, lines[i])
        elif action == "indent":
            lines[i] = "  " + lines[i]
        elif action == "cut":
            lines[i] = lines[i][: draw(st.integers(0, len(lines[i])))]
        elif action == "insert":
            lines.insert(i, f"{draw(st.sampled_from(['duration', 'gait', 'x', '_x', '<<', '_tag']))}: {nasty}")
        else:
            lines = [*LAUGHS.splitlines(), *lines, f"{draw(st.sampled_from(['duration', 'start', 'gait']))}: *i"]
    return "\n".join(lines)


@settings(max_examples=200, suppress_health_check=[HealthCheck.too_slow, HealthCheck.function_scoped_fixture])
@given(mutated())
def test_mutated_scenario_is_run_or_refused_in_one_line(tmp_path_factory: pytest.TempPathFactory, text: str) -> None:
    place = tmp_path_factory.mktemp("place")
    path, folder = place / "bad.yaml", place / "out"
    path.write_bytes(text.encode("utf-8", "surrogatepass"))
    before = os.getcwd()
    os.chdir(place)
    try:
        memory = peak_memory()
        code, printed = walk(path, folder)
    finally:
        os.chdir(before)
    assert "Traceback" not in printed
    if code == 2:
        assert printed.startswith("humanwalk: ")
        assert len(printed.splitlines()) == 1, printed
        assert len(printed) < 2000
        assert {entry.name for entry in place.iterdir()} == {"bad.yaml"}
    else:
        assert code in (0, 1)
        assert {entry.name for entry in place.iterdir()} == {"bad.yaml", "out"}
        assert {entry.name for entry in folder.iterdir()} == {"scenario.yaml", "signals.parquet", "summary.json"}
    assert peak_memory() - memory < LARGEST_MEMORY_KB


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"\x00" * 1000,
        b"\xff\xfe" + "duration: 1".encode("utf-16-le"),
        b"[" * MAX_FILE_SIZE,
        b"a: " * 30_000,
        b"{" * 50_000,
        b"- " * 50_000,
        b"#" * (MAX_FILE_SIZE + 1),
        (LAUGHS + "duration: *i").encode(),
        (LAUGHS + "start: {joint_angles: *i}").encode(),
        (LAUGHS + "gait: {*i : 1}").encode(),
        b"gait: &g {path: *g}",
        b"gait: &g {ramp: {speed: 1}, path: *g}",
        b"duration: !!python/object/apply:os.system ['touch pwned']",
        b"? !!python/object/apply:os.system ['touch pwned']\n: 1",
        b"--- 1\n--- 2",
        b"a: &a {b: *a}\na: *a",
        b"&a [*a, *a]",
        b"? {a: 1}\n: 1\n? {a: 1}\n: 2",
    ],
    ids=lambda text: f"{text[:24]!r}...{len(text)}",
)
def test_hostile_file_is_run_or_refused_in_one_line(tmp_path: Any, monkeypatch: pytest.MonkeyPatch, text: Any) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.yaml").write_bytes(text)
    memory = peak_memory()
    code, printed = walk("bad.yaml", "out")
    assert "Traceback" not in printed
    assert not (tmp_path / "pwned").exists()
    if code == 2:
        assert len(printed.splitlines()) == 1
        assert [entry.name for entry in tmp_path.iterdir()] == ["bad.yaml"]
    else:
        assert code == 0
    assert peak_memory() - memory < LARGEST_MEMORY_KB


def test_no_field_of_a_scenario_says_where_to_write() -> None:
    """The only texts without a list of choices are a description, and files that are read."""

    def texts(kind: Any) -> Any:
        return {name for name, field in fields_of(kind) if field.type in (str, "str")}

    recordings = ("controller.recorded", "controller.balanced.style.recorded")
    files = {f"{name}.{file}" for name in recordings for file in ("angles", "mapping")}
    assert texts(Scenario) == {"description", "subject.measured"} | files


@pytest.mark.parametrize("name", ["...yaml", "..yaml", "a b;c.yaml", "~.yaml", "-o.yaml"])
def test_name_of_a_scenario_does_not_lead_out_of_runs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    (tmp_path / "in").mkdir()
    monkeypatch.chdir(tmp_path / "in")
    (tmp_path / "in" / name).write_text("duration: 0.002\n")
    monkeypatch.setattr(sys, "argv", ["humanwalk", "walk", "--no-replay", "--no-plots", "--", f"./{name}"])
    with pytest.raises(SystemExit) as end:
        run_command()
    assert not end.value.code
    assert {entry.name for entry in tmp_path.iterdir()} == {"in"}
    assert {entry.name for entry in (tmp_path / "in").iterdir()} == {name, "runs"}
    (run,) = (tmp_path / "in" / "runs").iterdir()
    assert {entry.name for entry in run.iterdir()} == {"scenario.yaml", "signals.parquet", "summary.json"}


@pytest.mark.parametrize(
    "file", ["/etc/passwd", "/dev/zero", "/dev/zero.csv", "../x.mot", "\0.mot", "a" * 5000 + ".mot"]
)
def test_recording_that_is_none_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, file: str) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.yaml").write_text(f"follow: {{file: {json.dumps(file)}}}")
    code, printed = walk("bad.yaml", "out")
    assert code == 2
    assert len(printed.splitlines()) == 1, printed
    assert "root:" not in printed


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("walkk",), "No such command 'walkk'. Did you mean 'walk'?; see humanwalk --help"),
        (("walk", "--nosuch"), "No such option: --nosuch; see humanwalk walk --help"),
        (("walk", "--duration", "abc"), "'--duration': .*; see humanwalk walk --help"),
        (("walk", "--mass", "70kg"), "'--mass': 70kg; allowed: numbers; see humanwalk walk --help$"),
        (("walk", "--checkpoint", "-1"), "'--checkpoint': -1; allowed: numbers from 0; see "),
        (("bench", "--repeats", "1.5"), "'--repeats': 1.5; allowed: whole numbers from 1; see "),
        (
            ("study", "terrain", "-o", "a", "--workers", "0"),
            "'--workers': 0; allowed: whole numbers from 1 to 1000",
        ),
        (("schema", "scnario"), "'kind': scnario; allowed: scenario, study, tuning; see humanwalk schema --help$"),
        (("drive", "--port", "80000"), "'--port': .*65535; see humanwalk drive --help"),
        (("study", "run", "terrain"), "Missing option '--output' / '-o'; see humanwalk study run --help"),
    ],
)
def test_an_unknown_command_or_option_is_one_line(humanwalk: Any, arguments: tuple[str, ...], message: str) -> None:
    code, output, errors = humanwalk(*arguments)
    assert (code, output) == (2, "")
    (line,) = errors.splitlines()
    assert re.search(message.replace("?", r"\?"), line)


@pytest.mark.parametrize("command", [(), ("study",)])
def test_without_arguments_the_help_is_all_that_is_shown(command: tuple[str, ...]) -> None:
    ended = subprocess.run([sys.executable, "-m", "humanwalk", *command], capture_output=True, text=True, check=False)
    assert ended.returncode == 2
    assert "Usage" in ended.stdout
    assert ended.stderr == ""
