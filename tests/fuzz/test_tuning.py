"""Any tuning file is a tuning or refused, and so is any table of trials in a tuning's folder."""

from typing import Any

from humanwalk.study.trials import TRIALS, TUNING, best, open_table, pareto_front, read_trials, trial_columns
from humanwalk.study.tuning import dump_tuning, load_tuning, parse_tuning, shipped_tunings, start_values

GAIN = "controller.balanced.planner.dcm_gain"
SHIPPED = [path.read_bytes() for path in shipped_tunings().values()]
SMALL = (
    b"runs: {scenario: walk, set: {duration: 3}, factors: {case: {variants: {walk: {}, push: {pushes.given: [{impulse: "
    b"30.0}]}}}}}\nparameters:\n  " + GAIN.encode() + b": {low: 0.5, high: 2.0, log: true}\n  "
    b"controller.balanced.planner.timing.step: {low: 0.48, high: 0.64}\nobjectives:\n  cost_of_transport: {runs: {"
    b"case: walk}}\n  upright_share: {goal: maximize, weight: 2}\nbounds:\n  speed_error_m_s: {high: 0.04}\n"
    b"sampler: nsga2\ntrials: 24\npopulation: 4\nfalls: 1\nseed: 3\n"
)
TOKENS = [
    b".nan", b".inf", b"-.inf", b"1e308", b"-1e308", b"1e999", b"9" * 400, b"1e-300", b"0", b"-1", b"''", b"null",
    b"[]", b"{}", b"true", b"!!int ''", b"!!set {a}", b"!!binary aGk=", b"&a [*a]", b"*a", b"<<: *a", b"[" * 2000,
    b"'\\0'", b'"\\ud800"', b"\x07", b"\xff", b"\xe2\x80\xae", b"low: ", b"high: ", b"log: ", b"weight: ", b"goal: ",
    b"penalty: ", b"runs: ", b"runs: bad.yaml\n", b"scenario: /dev/zero\n", b"case: ", b"case: none", b"sampler: ",
    b"cma_es", b"nsga2", b"trials: ", b"population: ", b"falls: ", b"seed", b"survived: {}", b"likeness.", b"gait.",
    b"peak_torque_N_m.", b"parameters: ", b"objectives: ", b"bounds: ", b"controller.balanced", b"subject.mass",
    b"pushes.given.0.impulse", b"design: {rows: {file: /dev/zero}}", b": ", b"\n", b"!!python/object/apply:os.system",
]  # fmt: skip
CELLS = [
    b"nan", b"inf", b"1e999", b"", b'"', b"\n", b"\r\n", b"\0", b",", b",,,", b"[1]", b"9" * 5000, b"-1", b"0",
    b"1e308", b"-1e308", b"\xff", b"\xef\xbb\xbf", b"true", b"maybe", b"=cmd|' /C calc'!A0", b"\x1b[2J", b"a" * 3000,
]  # fmt: skip


def test_file(fuzzer: Any) -> None:
    def check(content: bytes) -> None:
        path = fuzzer.place / "bad.yaml"
        path.write_bytes(content)

        def use() -> None:
            tuning = load_tuning(path)
            assert parse_tuning(dump_tuning(tuning)) == tuning
            assert all(name.isprintable() for name in trial_columns(tuning))
            start = start_values(tuning)
            assert all(limits.low <= start[name] <= limits.high for name, limits in tuning.parameters.items())

        fuzzer.attempt(use)
        assert list(fuzzer.place.iterdir()) == [path]

    seeds = [SMALL, *SHIPPED]
    large = [
        SMALL + b"bounds: {" + b",".join(b"m%d: {}" % i for i in range(3000)) + b"}",
        SMALL.replace(b"parameters:\n", b"parameters:\n" + b"".join(b"  a%d: {low: 0}\n" % i for i in range(3000))),
    ]
    fuzzer.run(check, fuzzer.mutated(seeds, TOKENS), [*seeds, *large], inputs=60)


def test_table(fuzzer: Any) -> None:
    """The trials in a tuning's folder, which somebody else may have made."""
    tuning = parse_tuning(SMALL.decode())
    folder = fuzzer.place / "out"
    with open_table(folder, tuning) as table:
        for trial in range(3):
            row = dict.fromkeys(trial_columns(tuning), 0.5) | {"trial": trial}
            table.append(trial, {name: kind(row[name]) for name, kind in trial_columns(tuning).items()})
    good = (folder / TRIALS).read_bytes()
    files = {entry.name for entry in folder.iterdir()}

    def check(content: bytes) -> None:
        (folder / TRIALS).write_bytes(content)

        def use() -> None:
            read, rows = read_trials(folder)
            best(read, rows)
            pareto_front(read, rows)

        fuzzer.attempt(use)
        assert {entry.name for entry in folder.iterdir()} == files

    fuzzer.run(check, fuzzer.mutated([good], CELLS), [good, b"", b"\n" * 1_000_000], inputs=150)
    assert (folder / TUNING).is_file()
