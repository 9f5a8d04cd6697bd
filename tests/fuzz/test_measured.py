"""Any file is measured segments or refused."""

from typing import Any

from humanwalk.body.subject import Subject
from humanwalk.parameter_file import MAX_FILE_SIZE

CSV = b"""segment,length_m,width_m,mass_kg
thigh,0.42,0.15,
right_shank,0.43,,3.0
left_shank,0.41,,2.8
head,,,5.5
"""
YAML = (
    b"segments:\n  thigh: {length: 0.42, width: 0.15}\n  right_shank: {length: 0.43, mass: 3.0}\n  hand: {mass: 0.5}\n"
)

TOKENS = [
    b"nan", b"inf", b"-1", b"1e999", b"1e-300", b"9" * 400, b"0.9", b"", b'"', b",", b"\n", b"\r", b"\0", b"\xff",
    b"\xef\xbb\xbf", b"\x1b[2J", b"segment", b"length_m", b"mass_kg", b"foot", b"upper_trunk", b"left_", b": ", b"{",
    b"[", b"&a", b"*a", b"<<: *a", b"!!python/object:os.system", b"null", b"~", b"true", b"(" * 3000,
]  # fmt: skip


def test_measured_segments(fuzzer: Any) -> None:
    def check(content: bytes) -> None:
        for suffix in (".csv", ".yaml"):
            path = fuzzer.place / f"bad{suffix}"
            path.write_bytes(content)
            subject = Subject(75.0, 1.80, "male", measured=str(path))
            fuzzer.attempt(lambda subject=subject: subject.body)

    large = [b"segment,mass_kg\n" + b"thigh,8\n" * 10_000, b"," * 90_000, b'"' * 90_000, b" " * (MAX_FILE_SIZE + 1)]
    fuzzer.run(check, fuzzer.mutated([CSV, YAML], TOKENS), [CSV, YAML, *large], inputs=300)
