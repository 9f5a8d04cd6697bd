"""What is left of a run when the machine, the disk, the person or the controller gives up; see docs/reliability.md."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
import pytest
from pydrake.systems.framework import Context

from humanwalk.cli.walk import write_or_rescue
from humanwalk.control.pd_control import PdLaw
from humanwalk.measures.signals import TIME
from humanwalk.quantity import ParameterError
from humanwalk.run.folder import RUNS, SCENARIO, SIGNALS, SUMMARY, Run, claimed, new_run_folder, require_room
from humanwalk.run.simulate import simulate
from humanwalk.scenario import load_scenario
from humanwalk.systems import inverse_kinematics_solver, whole_body_controller

THREE = {SCENARIO, SIGNALS, SUMMARY}
WALK = "from humanwalk.cli.main import main; main()"
HEAR = "import signal; signal.signal(signal.SIGHUP, signal.SIG_DFL); "
"""For tests that are started by nohup, whose children ignore SIGHUP."""


def test_output_takes_every_character_in_every_locale(tmp_path: Path) -> None:
    (tmp_path / "uni.yaml").write_text("description: Höhe → 10 cm\n", encoding="utf-8")
    arguments = [sys.executable, "-c", WALK, "scenarios", "--show", "uni.yaml"]
    ascii_only = os.environ | {"PYTHONIOENCODING": "ascii"}
    shown = subprocess.run(arguments, cwd=tmp_path, env=ascii_only, capture_output=True, check=True)
    assert "Höhe → 10 cm" in shown.stdout.decode()


def start(folder: Path, *more: str, before: str = "", **environment: Any) -> subprocess.Popen[str]:
    """The command line in a process of its own, walking into `folder`/run."""
    return subprocess.Popen(
        [sys.executable, "-c", HEAR + before + WALK, "walk", "--no-replay", "--no-plots", "-o", "run", *more],
        cwd=folder,
        env=os.environ | environment,
        stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        text=True,
    )


def wait_for(path: Path, process: subprocess.Popen[str], limit: float = 120.0) -> None:
    end = time.monotonic() + limit
    while not path.exists():
        assert process.poll() is None, process.stderr.read()
        assert time.monotonic() < end
        time.sleep(0.02)


def names(folder: Path) -> set[str] | set[Any]:
    """Files that are seen; one that is being written is hidden."""
    return {entry.name for entry in folder.iterdir() if not entry.name.startswith(".")}


# Killed, stopped, twice.


def test_killed_run_leaves_its_last_checkpoint(tmp_path: Path) -> None:
    process = start(tmp_path, "--duration", "600", "--checkpoint", "0.5")
    try:
        wait_for(tmp_path / "run" / SUMMARY, process)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == -signal.SIGKILL
    run = Run.open(tmp_path / "run")
    assert run.summary["end"] == "unfinished"
    assert run.scenario.duration == 600
    assert run.signals.num_rows > 1
    assert all(np.isfinite(run[name]).all() for name in run.signals.column_names)
    # What it left is not overwritten.
    with pytest.raises(ParameterError, match="holds files already"):
        new_run_folder(tmp_path / "run", RUNS / "thesis")


def test_run_killed_before_its_first_checkpoint_leaves_no_false_run(tmp_path: Path) -> None:
    process = start(tmp_path, "--duration", "600")
    try:
        wait_for(tmp_path / "run", process)
    finally:
        process.kill()
        process.communicate()
    assert names(tmp_path / "run") == set()
    with pytest.raises(ParameterError, match="no run"):
        Run.open(tmp_path / "run")
    # The claim went with the process.
    folder, _ = new_run_folder(tmp_path / "run", RUNS / "thesis")
    with claimed(folder):
        pass


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_stopped_run_keeps_everything_until_then(tmp_path: Path, number: Any) -> None:
    process = start(tmp_path, "--duration", "600", "--checkpoint", "0.2")
    try:
        wait_for(tmp_path / "run" / SUMMARY, process)
        process.send_signal(number)
        _, errors = process.communicate(timeout=120)
    finally:
        process.kill()
        process.communicate()
    assert process.returncode == 130, errors
    assert "Traceback" not in errors
    run = Run.open(tmp_path / "run")
    assert run.summary["end"] == "interrupted"
    assert names(run.path) == THREE


def test_nobody_who_listens_any_more_does_not_cost_the_run(tmp_path: Path) -> None:
    """As with `humanwalk walk 2>&1 | head -1`."""
    process = subprocess.Popen(
        [sys.executable, "-c", WALK, "walk", "--duration", "0.1", "--no-replay", "--no-plots", "-o", "run"],
        cwd=tmp_path,
        stderr=subprocess.PIPE,
    )
    assert process.stderr.readline() == b"thesis: walking 0.1 s\n"
    process.stderr.close()
    assert process.wait(timeout=60) == 0
    assert Run.open(tmp_path / "run").summary["end"] == "completed"


def humanwalk(folder: Path, redirected: Any, *arguments: Any) -> Any:
    """Exit code and messages of the command line in a shell that redirects its streams."""
    command = f'"$0" -c "$1" {" ".join(arguments)} {redirected}'
    done = subprocess.run(["sh", "-c", command, sys.executable, WALK], cwd=folder, capture_output=True, text=True)
    return done.returncode, done.stderr


QUICK = ("walk", "--duration", "0.1", "--no-replay", "--no-plots", "-o", "run")


@pytest.mark.parametrize("redirected", ["2>/dev/full", "2>&-", ">&- 2>&-", "<&- >/dev/full"])
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full on this system")
def test_messages_that_cannot_be_written_do_not_cost_the_run(tmp_path: Path, redirected: Any) -> None:
    code, errors = humanwalk(tmp_path, redirected, *QUICK)
    assert code == 0, errors
    assert Run.open(tmp_path / "run").summary["end"] == "completed"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full on this system")
def test_results_that_cannot_be_written_are_one_line(tmp_path: Path) -> None:
    code, errors = humanwalk(tmp_path, ">/dev/full", "scenarios")
    assert code == 2
    assert errors.splitlines() == ["humanwalk: standard output: No space left on device"]


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
@pytest.mark.parametrize("seed", range(3))
def test_run_that_is_ended_at_a_random_time_leaves_whole_files_or_none(tmp_path: Path, number: Any, seed: int) -> None:
    process = start(tmp_path, "--duration", "0.5", "--checkpoint", "0.05")
    try:
        wait_for(tmp_path / "run", process)
        time.sleep(float(np.random.default_rng(seed).uniform(0.0, 2.0)))
        process.send_signal(number)
        _, errors = process.communicate(timeout=120)
    finally:
        process.kill()
        process.communicate()
    assert "Traceback" not in errors
    if not (tmp_path / "run").exists():
        return
    if SUMMARY in names(tmp_path / "run"):
        assert Run.open(tmp_path / "run").signals.num_rows > 0
    else:
        assert names(tmp_path / "run") <= {SCENARIO, SIGNALS}
    if number != signal.SIGKILL:
        assert not [entry for entry in (tmp_path / "run").iterdir() if entry.name.startswith(".")]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signal_during_an_import_waits_for_its_end(tmp_path: Path, number: Any) -> None:
    """An exception would abort a compiled extension that is being loaded."""
    (tmp_path / "slow.py").write_text(
        f"import os\nos.kill(os.getpid(), {int(number)})\nprint('imported', flush=True)\n"
    )
    code = f"""{HEAR}
from humanwalk.cli.streams import signals_as_exits
with signals_as_exits():
    import slow, time
    time.sleep(60)
"""
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, timeout=50)
    assert done.stdout == "imported\n"
    assert done.returncode in (128 + number, -number)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signal_in_a_destructor_waits_for_its_end(number: Any) -> None:
    """Python would drop the exception, and print a traceback."""
    code = f"""{HEAR}
import os, time
from humanwalk.cli.streams import signals_as_exits
class Ending:
    def __del__(self):
        os.kill(os.getpid(), {int(number)})
with signals_as_exits():
    Ending()
    print("goes on", flush=True)
    time.sleep(60)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=50)
    assert done.stdout == "goes on\n"
    assert "ignored" not in done.stderr
    assert done.returncode in (128 + number, -number)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signal_that_python_drops_is_sent_again(number: Any) -> None:
    code = f"""{HEAR}
import os, time, weakref
from humanwalk.cli import streams
streams.DROPPED_PERIOD = 0.1
class Thing:
    pass
with streams.signals_as_exits():
    thing = Thing()
    reference = weakref.ref(thing, lambda _: os.kill(os.getpid(), {int(number)}))
    del thing
    print("goes on", flush=True)
    time.sleep(60)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=50)
    assert done.stdout == "goes on\n"
    assert done.returncode in (128 + number, -number)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signal_after_the_end_prints_nothing(number: Any) -> None:
    """Python prints the traceback of an exception that is raised while it shuts down."""
    code = f"""{HEAR}
import atexit, os
from humanwalk.cli.streams import signals_as_exits
with signals_as_exits():
    atexit.register(lambda: os.kill(os.getpid(), {int(number)}))
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=50)
    assert done.stderr == ""
    assert done.returncode == -number


def test_of_two_runs_into_one_folder_one_is_refused(tmp_path: Path) -> None:
    first = start(tmp_path, "--duration", "600", "--checkpoint", "0.2")
    try:
        wait_for(tmp_path / "run", first)
        refused = None
        while refused is None and first.poll() is None:
            try:
                folder, _ = new_run_folder(tmp_path / "run", RUNS / "thesis")
                with claimed(folder):
                    time.sleep(0.01)
            except ParameterError as error:
                refused = str(error)
        if refused is None:
            refused = first.communicate()[1]
            assert first.returncode == 2
            assert (tmp_path / "run").is_dir()
    finally:
        first.kill()
        first.communicate()
    assert "another run writes into it" in refused or "holds files already" in refused


def test_claim_is_exclusive_and_ends(tmp_path: Path) -> None:
    with claimed(tmp_path), pytest.raises(ParameterError, match="another run writes into it"), claimed(tmp_path):
        pass
    with claimed(tmp_path):
        pass


def test_folder_that_was_filled_before_the_claim_is_refused(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("x")
    with pytest.raises(ParameterError, match="another run writes into it"), claimed(tmp_path):
        pass


# Disks.


def test_full_disk_is_found_before_the_simulation(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.disk_usage", lambda path: type("Usage", (), {"free": 10_000_000})())
    with pytest.raises(ParameterError, match="10 MB are free"):
        require_room(tmp_path, load_scenario("thesis"))


def test_longer_run_needs_more_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.disk_usage", lambda path: type("Usage", (), {"free": 100_000_000})())
    require_room(tmp_path, load_scenario("thesis"))
    with pytest.raises(ParameterError, match="make room"):
        require_room(tmp_path, load_scenario("thesis", {"duration": "700"}))


@pytest.mark.parametrize("duration", ["2500", "3000", "3600"])
def test_the_sampling_period_that_a_long_run_is_offered_fits(duration: str, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"set it to 0\.01\d+ s or more") as error:
        require_room(tmp_path, load_scenario("walk", {"duration": duration}))
    offered = str(error.value).partition("set it to ")[2].split()[0]
    require_room(tmp_path, load_scenario("walk", {"duration": duration, "recording.signal_period": offered}))


LIMIT = (
    "import resource, signal, sys;"
    "signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
    "resource.setrlimit(resource.RLIMIT_FSIZE, ({0}, {0}));"
)


@pytest.mark.parametrize(("limit", "left"), [(60_000, {SCENARIO}), (100, None)])
def test_disk_that_fills_up_at_the_end_is_one_line_and_no_half_file(
    tmp_path: Path, limit: int, left: set[str] | None
) -> None:
    """A file-size limit stands for the full disk; the folder for temporary files is as full."""
    process = start(tmp_path, "--duration", "0.3", before=LIMIT.format(limit), TMPDIR=str(tmp_path))
    _, errors = process.communicate(timeout=120)
    assert process.returncode == 2, errors
    *before, line = filter(None, errors.splitlines())
    assert before in ([], ["thesis: walking 0.3 s"])
    assert line.startswith("humanwalk: ")
    assert "File too large" in line or "room" in line
    if left is None:
        assert not (tmp_path / "run").exists()
    else:
        assert {entry.name for entry in (tmp_path / "run").iterdir()} == left
    assert not [entry for entry in tmp_path.iterdir() if entry.name.startswith("humanwalk-")]


def test_run_that_cannot_be_written_to_its_folder_is_rescued(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    outcome = simulate(load_scenario("thesis", {"duration": "0.02"}))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(ParameterError, match="the run is saved in") as raised:
        write_or_rescue(tmp_path / "gone", outcome, "thesis")
    (rescue,) = tmp_path.iterdir()
    assert str(rescue) in str(raised.value)
    assert Run.open(rescue).signals.equals(outcome.signals)


def test_full_disk_without_a_folder_for_temporary_files_is_one_line(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    outcome = simulate(load_scenario("thesis", {"duration": "0.02"}))

    def none(**options: Any) -> None:
        raise FileNotFoundError(2, "No usable temporary directory found")

    monkeypatch.setattr("tempfile.mkdtemp", none)
    with pytest.raises(ParameterError, match="No such file or directory"):
        write_or_rescue(tmp_path / "gone", outcome, "thesis")


@pytest.mark.parametrize("name", ["x" * 300, "\udcff", "a\0b"], ids=["too long", "not UTF-8", "NUL"])
@pytest.mark.parametrize("wanted", [True, False])
def test_name_that_files_cannot_have_is_refused_before_the_simulation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, wanted: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ParameterError) as raised:
        new_run_folder(tmp_path / name if wanted else None, RUNS / name)
    assert str(raised.value).isprintable()


def test_folder_that_may_not_be_written_is_refused_before_the_simulation(tmp_path: Path) -> None:
    """Of root, who may write anywhere else, the kernel's own folder is tried."""
    folder = tmp_path / "mine"
    folder.mkdir(mode=0o555)
    if os.geteuid() == 0:
        folder = "/proc/humanwalk"  # type: ignore[assignment]
    with pytest.raises(ParameterError) as raised:
        new_run_folder(type(tmp_path)(folder) / "run", RUNS / "thesis")
    assert len(str(raised.value).splitlines()) == 1
    assert "that you may write to" in str(raised.value)


# Controllers and solvers.


def broken_from(monkeypatch: pytest.MonkeyPatch, begin: float, breaks: Callable[..., Any]) -> None:
    """Let the inverse kinematics break from a time [s] on."""
    solve = inverse_kinematics_solver.InverseKinematicsSolver._solve

    def broken(self: Any, warm: Any, context: Context, discrete: Any) -> Any:
        status = solve(self, warm, context, discrete)
        return breaks(self, context, discrete) if context.get_time() >= begin - 1e-9 else status

    monkeypatch.setattr(inverse_kinematics_solver.InverseKinematicsSolver, "_solve", broken)


def not_a_number(self: Any, context: Context, discrete: Any) -> None:
    discrete.set_value(0, np.full(discrete.value(0).size, np.nan))


def throw(self: Any, context: Context, discrete: Any) -> None:
    raise RuntimeError("the solver gave up\nsecond line")


def ended(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, begin: float, breaks: Callable[..., Any], law: PdLaw = "implicit"
) -> Any:
    broken_from(monkeypatch, begin, breaks)
    period = {"controller.thesis.control_period": "0.005"}
    outcome = simulate(load_scenario("thesis", {"duration": str(begin + 0.1), "actuation.pd.law": law} | period))
    run = outcome.save(tmp_path / "run")
    return outcome, Run.open(run.path)


@pytest.mark.parametrize("law", ["implicit", "semi_implicit"])
def test_nan_in_the_controller_ends_the_run_and_keeps_what_was_before(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, law: PdLaw
) -> None:
    outcome, run = ended(monkeypatch, tmp_path, 0.05, not_a_number, law)
    assert outcome.end == "not a number" or outcome.end.startswith("solver failed")
    assert len(outcome.end.splitlines()) == 1
    before = run.time < 0.05 - 1e-9
    assert before.sum() == 5
    for name in run.signals.column_names:
        assert np.isfinite(run[name][before]).all(), name
    assert run.summary["survived"] is False


@pytest.mark.parametrize("phase", ["standing", "first landing", "left swing", "right swing"])
def test_solver_that_fails_in_a_phase_of_the_gait_leaves_its_record(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, phase: Any
) -> None:
    scenario = load_scenario("thesis")
    first = scenario.controller.walk(scenario.subject).start_time  # type: ignore[attr-defined]
    stride = 0.5 / 0.6 / 1.4
    begin = {
        "standing": 0.05,
        "first landing": first,
        "left swing": first + 0.25 * stride,
        "right swing": first + 0.75 * stride,
    }[phase]
    begin = 0.005 * round(begin / 0.005)
    outcome, run = ended(monkeypatch, tmp_path, begin, throw)
    assert outcome.end == "solver failed: the solver gave up"
    assert run.summary["end"] == outcome.end
    assert run.signals.num_rows == pytest.approx(begin / run.scenario.recording.signal_period, abs=3)
    assert run.signals[TIME].to_numpy()[-1] <= begin


def test_solver_that_fails_at_the_start_is_refused_and_leaves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    broken_from(monkeypatch, 0.0, throw)
    with pytest.raises(ParameterError, match="it ended at its start: solver failed: the solver gave up"):
        simulate(load_scenario("thesis", {"duration": "0.1"}))


def test_error_of_another_kind_is_no_reason_to_lose_the_record(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def singular(self: Any, context: Context, discrete: Any) -> None:
        np.linalg.inv(np.zeros((2, 2)))

    outcome, run = ended(monkeypatch, tmp_path, 0.02, singular)
    assert outcome.end == "solver failed: Singular matrix"
    assert run.signals.num_rows > 1


def test_checkpoints_grow_and_are_runs(tmp_path: Path) -> None:
    seen = []
    outcome = simulate(load_scenario("thesis", {"duration": "0.06"}), on_checkpoint=seen.append, checkpoint_period=0.0)
    rows = [checkpoint.signals.num_rows for checkpoint in seen]
    assert rows == sorted(rows)
    assert rows[-1] > rows[0]
    assert {checkpoint.end for checkpoint in seen} == {"unfinished"}
    last = seen[-1].signals
    assert outcome.signals.slice(0, last.num_rows).equals(last)
    assert pq.read_metadata(seen[-1].save(tmp_path / "run").path / SIGNALS).num_rows == last.num_rows


# Servers.


def listening(pid: Any) -> Any:
    """Local addresses of the sockets on which a process listens, as the kernel writes them: hexadecimal."""
    sockets = set()
    for entry in os.listdir(f"/proc/{pid}/fd"):
        try:
            sockets.add(os.readlink(f"/proc/{pid}/fd/{entry}"))
        except OSError:
            continue
    addresses = []
    for table in ("tcp", "tcp6", "udp", "udp6"):
        with open(f"/proc/{pid}/net/{table}") as file:
            for line in list(file)[1:]:
                cells = line.split()
                if f"socket:[{cells[9]}]" in sockets and (table.startswith("udp") or cells[3] == "0A"):
                    addresses.append(cells[1].partition(":")[0])
    return addresses


LOOPBACK = {"0100007F", "00000000000000000000000001000000"}


@pytest.mark.skipif(not os.path.exists("/proc/net/tcp"), reason="needs Linux' list of sockets")
def test_live_view_and_replay_listen_on_this_machine_only(tmp_path: Path) -> None:
    code = (
        "import threading; from humanwalk.view.replay import make_meshcat;"
        "from humanwalk.view.serve import replay_server; m = make_meshcat(live=True); s = replay_server(b'');"
        "threading.Thread(target=s.serve_forever, daemon=True).start();"
        "print('ready', flush=True); input()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    )
    try:
        assert process.stdout.readline() == b"ready\n"
        addresses = listening(process.pid)
    finally:
        process.kill()
        process.communicate()
    assert len(addresses) >= 2
    assert set(addresses) <= LOOPBACK


# The same for the walker on its own feet, whose program may fail.


@pytest.mark.parametrize(
    ("phase", "begin", "breaks"),
    [(0, 0.1, throw), (1, 0.8, throw), (3, 1.4, throw), (2, 1.78, throw), (3, 1.4, not_a_number)],
    ids=["standing", "weight shift", "single support", "double support", "not a number"],
)
def test_program_that_fails_in_a_phase_of_the_balanced_walk_leaves_its_record(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, phase: Any, begin: float, breaks: Callable[..., Any]
) -> None:
    solve = whole_body_controller.WholeBodyController._update

    def broken(self: Any, context: Context, discrete: Any) -> Any:
        status = solve(self, context, discrete)
        if context.get_time() >= begin - 1e-9:
            breaks(self, context, discrete)
        return status

    monkeypatch.setattr(whole_body_controller.WholeBodyController, "_update", broken)
    points = "[{time: 0.1, forward: 0.5}]"
    outcome = simulate(
        load_scenario("walk", {"duration": str(begin + 0.1), "controller.balanced.command.points": points})
    )
    run = Run.open(outcome.save(tmp_path / "run").path)
    assert outcome.end == "not a number" or outcome.end.startswith("solver failed: ")
    assert run.summary["end"] == outcome.end
    assert run.summary["survived"] is False
    before = run.time < begin - 1e-9
    assert run["planner.phase"][before][-1] == phase
    assert run.time[before][-1] == pytest.approx(begin, abs=0.011)
    for name in run.signals.column_names:
        assert np.isfinite(run[name][before]).all(), name
