"""Any scenario file, and any override of it, is a scenario or refused; any scenario is a diagram or refused."""

from typing import Any

from hypothesis import strategies as st

from humanwalk.diagrams.walker import make_walker
from humanwalk.parameter_file import fields_of
from humanwalk.scenario import Scenario, dump_scenario, load_scenario, parse_scenario, shipped_scenarios

SHIPPED = [path.read_bytes() for path in shipped_scenarios().values()]
COMPLETE = [dump_scenario(load_scenario(name)).encode() for name in ("thesis", "walk")]
FIELDS = dict(fields_of(Scenario))
NUMBERS = {
    name: field.metadata
    for name, field in FIELDS.items()
    if "low" in field.metadata and not name.startswith("controller.recorded")
}

TOKENS = [
    b".nan", b".inf", b"-1e308", b"1e999", b"9" * 400, b"1e-300", b"0", b"-1", b"''", b"null", b"~", b"[]", b"{}",
    b"true", b"!!int ''", b"!!float ''", b"!!bool maybe", b"!!float 1:30", b"190:20:30", b"!!binary '*'",
    b"!!timestamp x", b"!!set [1]", b"!!omap x", b"!!pairs [1]", b"!!map [1]", b"!!str {}", b"!!null x",
    b"!!python/object/apply:os.system ['touch pwned']", b"!!python/name:os.system", b"!<x> y", b"&a [*a]",
    b"&a {b: *a}", b"&a {<<: *a}", b"*a", b"&a", b"<<: *a\n", b"<<: [*a, *a]\n", b"<<: 3\n", b"? [a]\n: b\n", b"=",
    b"[" * 3000, b"{a: " * 500, b"'\\0'", b'"\\ud800"', b"\x07", b"\x1b[2J", b"\xff\xfe", b"\xef\xbb\xbf", b"%YAML 9\n",
    b"--- ", b"...\n", b"|\n", b">\n", b"- ", b": ", b"\t", b"\r", b"  ", b"/dev/zero", b"\xe2\x80\xae",
    *(b"%s: " % part.encode() for part in sorted({part for name in FIELDS for part in name.split(".")})),
]  # fmt: skip


def test_file(fuzzer: Any) -> None:
    def check(content: bytes) -> None:
        path = fuzzer.place / "bad.yaml"
        path.write_bytes(content)

        def use() -> None:
            scenario = load_scenario(path)
            assert parse_scenario(dump_scenario(scenario)) == scenario

        fuzzer.attempt(use)
        assert list(fuzzer.place.iterdir()) == [path]

    corpus = fuzzer.corpus("scenario")
    large = [
        b"controller: {balanced: {command: {points: [" + b"{time: 1}," * 5800 + b"]}}}",
        b"pushes: {given: [" + b"{}," * 30_000 + b"]}",
        b"start: {joint_angles: {" + b",".join(b"j%d: 0" % i for i in range(9000)) + b"}}",
        *(character * 90_000 for character in (b"[", b"? ", b"&a ", b"'", b"\0")),
        b"a" * 90_000 + b": 1",
        b"#" * 200_000,
        b"a: " + b"9" * 90_000,
    ]
    fuzzer.run(check, fuzzer.mutated([*corpus, *SHIPPED, *COMPLETE], TOKENS), [*corpus, *large, *SHIPPED], inputs=250)


def test_override(fuzzer: Any) -> None:
    names = st.sampled_from(sorted(FIELDS)) | st.text(max_size=12)
    values = st.text(max_size=20) | st.sampled_from([token.decode("utf-8", "replace") for token in TOKENS])

    def check(overrides: dict[str, str]) -> None:
        fuzzer.attempt(lambda: parse_scenario("", overrides))

    first = [{name: value} for name in ("duration", "seed", "start.joint_angles") for value in ('!!int ""', "1:30")]
    fuzzer.run(check, st.dictionaries(names, values, max_size=3), first, inputs=200)


def test_diagram(fuzzer: Any) -> None:
    """Numbers in their ranges, of which the ends are the most likely."""

    @st.composite
    def numbers(draw: Any) -> dict[str, str]:
        chosen: dict[str, str] = {}
        for name in draw(st.lists(st.sampled_from(sorted(NUMBERS)), max_size=4, unique=True)):
            low, high = NUMBERS[name]["low"], NUMBERS[name]["high"]
            whole = isinstance(FIELDS[name].default, int)
            between = st.integers(int(low), int(high)) if whole else st.floats(low, high)
            chosen[name] = repr(draw(st.sampled_from([low, high]) | between))
        return chosen

    def check(overrides: dict[str, str]) -> None:
        fuzzer.attempt(lambda: make_walker(parse_scenario("", overrides)))

    first = [
        {"pushes.given": "[{body: Nobody}]"},
        {"pushes.given": f"[{'{},' * 1000}]"},
        {"pushes.random_interval": "0.1", "pushes.random_until": "3600"},
        {"start.joint_angles": "{Nobody: 0}"},
        {"controller.recorded.angles": "/dev/zero"},
        {
            "controller.balanced.command.points": "["
            + ",".join(f"{{time: {i}, forward: {i % 3 - 1}}}" for i in range(1000))
            + "]"
        },
    ]
    fuzzer.run(check, numbers(), first, inputs=15)
