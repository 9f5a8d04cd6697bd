"""Any study file is a study or refused, so is any table of points, and any table of rows in a study's folder."""

from typing import Any

from humanwalk.quantity import ParameterError
from humanwalk.study.study import dump_study, load_study, parse_study, shipped_studies
from humanwalk.study.table import STUDY, TABLE, open_journal, read_table, table_columns

SHIPPED = [path.read_bytes() for path in shipped_studies().values()]
SMALL = (
    b"factors:\n  duration: [1, 2]\n  seed: {seeds: {first: 1, count: 3}}\n  start.joint_noise: {range: {low: 0, high:"
    b" 0.1, number: 2}}\n  push: {variants: {none: {}, hard: {pushes.given.0.impulse: 60}}}\ndesign: full_factorial\n"
)
SAMPLED = (
    b"set: {duration: 3}\nfactors:\n  subject.mass: {normal: {mean: 70, standard_deviation: 5, low: 50, high: 90}}\n"
    b"  start.rate_noise: {uniform: {low: 0, high: 0.1}}\n  subject.stature: {log_range: {low: 1.6, high: 1.9}}\n"
    b"design: {latin_hypercube: {number: 8, seed: 1}}\nkeep: runs\n"
)
TOKENS = [
    b".nan", b".inf", b"-.inf", b"1e308", b"-1e308", b"1e999", b"9" * 400, b"1e-300", b"0", b"-1", b"''", b"null",
    b"[]", b"{}", b"[[[]]]", b"true", b"!!int ''", b"!!set {a}", b"!!binary aGk=", b"!!timestamp 2001-01-01",
    b"&a [*a]", b"&a", b"*a", b"<<: *a", b"[" * 2000, b"'\\0'", b'"\\ud800"', b"\x07", b"\xff", b"\xe2\x80\xae",
    b"pushes.given.0.", b"pushes.given.99999999999999999999: ", b"pushes.given.1000", b".", b"..", b"0.0",
    b"values: ", b"range: ", b"log_range: ", b"uniform: ", b"normal: ", b"seeds: ", b"variants: ", b"low: ", b"high: ",
    b"number: ", b"count: ", b"sobol", b"latin_hypercube", b"one_at_a_time", b"rows: {file: points.csv}",
    b"{rows: {file: /dev/zero}}", b"scenario: ", b"scenario: bad.yaml\n", b"set: ", b"factors: ", b"keep: ",
    b"controller", b"controller.balanced.command.points.0.forward", b"row", b"end", b"seed", b"200000", b": ", b"\n",
    b"!!python/object/apply:os.system ['touch pwned']",
]  # fmt: skip
CELLS = [
    b"nan", b"inf", b"1e999", b"", b'"', b'""', b"\n", b"\r", b"\r\n", b"\0", b",", b",,,", b"[1]", b"{", b"[" * 2000,
    b"9" * 5000, b"-1", b"0", b"\xff", b"\xef\xbb\xbf", b"true", b"maybe", b"duration", b"seed", b"=cmd|' /C calc'!A0",
    b"\x1b[2J", b"a" * 3000,
]  # fmt: skip
SIZE = 20
"""Points that are built of a study; the others differ in numbers alone."""


def test_file(fuzzer: Any) -> None:
    def check(content: bytes) -> None:
        path = fuzzer.place / "bad.yaml"
        path.write_bytes(content)

        def use() -> None:
            study = load_study(path)
            assert parse_study(dump_study(study)) == study
            points = study.points
            assert all(name.isprintable() for name in table_columns(study))
            for point in points[:SIZE]:
                study.scenario_at(point)

        fuzzer.attempt(use)
        assert list(fuzzer.place.iterdir()) == [path]

    corpus = fuzzer.corpus("study")
    seeds = [*corpus, SMALL, SAMPLED, *(text for text in SHIPPED if b"rows:" not in text)]
    large = [
        b"factors: {" + b",".join(b"f%d: [1, 2]" % i for i in range(3000)) + b"}",
        b"design: {latin_hypercube: {number: 200000}}\nfactors: {"
        + b",".join(b"f%d: {uniform: {low: 0, high: 1}}" % i for i in range(1000))
        + b"}",
        b"factors: {duration: [" + b"1," * 30_000 + b"]}",
        b"factors: {a" + b".a" * 30_000 + b": [1]}",
        b"scenario: " + b"a" * 90_000,
    ]
    fuzzer.run(check, fuzzer.mutated(seeds, TOKENS), [*seeds, *large], inputs=100)


def test_points(fuzzer: Any) -> None:
    """The CSV file of the design `rows`."""
    (fuzzer.place / "study.yaml").write_text("design: {rows: {file: points.csv}}")

    def check(content: bytes) -> None:
        (fuzzer.place / "points.csv").write_bytes(content)

        def use() -> None:
            study = load_study(fuzzer.place / "study.yaml")
            for point in study.points[:SIZE]:
                study.scenario_at(point)

        fuzzer.attempt(use)

    good = [b"duration,seed\n1,2\n2.5,3\n", b'contact,duration\npoint,\n"{""point"": {}}",3\n']
    fuzzer.run(check, fuzzer.mutated(good, CELLS), [*good, b"a\n" + b"1\n" * 300_000, b"," * 1_000_000], inputs=150)


def test_table(fuzzer: Any) -> None:
    """The table of a study's folder, which somebody else may have made."""
    study = parse_study("factors: {duration: [1, 2, 3]}")
    folder = fuzzer.place / "out"
    with open_journal(folder, study) as journal:
        for index in range(3):
            journal.append(index, {"end": "fell", "survived": False, "mean_speed_m_s": 0.1, "steps": 3})
    good = (folder / TABLE).read_bytes()

    def check(content: bytes) -> None:
        (folder / TABLE).write_bytes(content)
        fuzzer.attempt(lambda: read_table(folder))
        assert {entry.name for entry in folder.iterdir()} == {STUDY, TABLE}

    fuzzer.run(check, fuzzer.mutated([good], CELLS), [good, b"", b"\n" * 1_000_000], inputs=150)
    (folder / TABLE).unlink()
    (folder / TABLE).symlink_to("/dev/zero")
    try:
        read_table(folder)
    except ParameterError as error:
        assert "leads out of" in str(error)
    else:
        raise AssertionError
