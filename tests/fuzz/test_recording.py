"""Any recording and any mapping is a motion of the body or refused."""

from pathlib import Path
from typing import Any

import numpy as np

from humanwalk.body.opensim_names import COORDINATES, PELVIS_ROTATIONS, PELVIS_TRANSLATIONS
from humanwalk.body.subject import Subject
from humanwalk.motion.followed import REQUIRED_JOINTS, followed_motion
from humanwalk.motion.motion_table import MAX_BYTES, MotionTable, storage_text
from humanwalk.motion.recorded_motion import MotionMapping
from humanwalk.parameter_file import load_as
from humanwalk.terrain import Plane

COLUMNS = (*(COORDINATES[name][0] for name in REQUIRED_JOINTS), *PELVIS_ROTATIONS, *PELVIS_TRANSLATIONS)
TIME = np.linspace(0.0, 0.2, 3)
STILL = storage_text("still", MotionTable(COLUMNS, TIME, np.zeros((3, len(COLUMNS))), True)).encode()
TABLE = "\n".join((",".join(["time", *(f"{name}.angle_deg" for name in REQUIRED_JOINTS)]), *["0" + ",0" * 14] * 2))

CELLS = [
    b"nan", b"inf", b"-1e308", b"1e308", b"1e999", b"1e-17", b"1e-300", b"", b"0x1p3", b"1_0", b"1,5", b'"', b'""',
    b"'",
    b"\0", b"\r", b"\n", b"\t", b"\n\n\n", b" ", b",", b"\xff", b"\xef\xbb\xbf", b"\xff\xfe", b"\x1b[2J",
    b"\xe2\x80\xae",
    b"=cmd|' /C calc'!A0", b"9" * 400, b"a" * 5000, b"0\t" * 3000, b"endheader\n", b"inDegrees=", b"nRows=1e9\n",
    "\N{ARABIC-INDIC DIGIT ONE}".encode(), "\N{LINE SEPARATOR}".encode(), *(name.encode() for name in COLUMNS[:4]),
]  # fmt: skip

FULL = (
    "angle_unit: deg\nlength_unit: m\ncolumns:\n"
    f"  {REQUIRED_JOINTS[0]}: {{column: {COLUMNS[0]}, scale: 1.0, offset: 0.0}}\nhold: {{{REQUIRED_JOINTS[1]}: 0.1}}\n"
).encode()
VALUES = [
    b".nan", b".inf", b"1e308", b"-1e6", b"1e6", b"1e-300", b"[]", b"{}", b"null", b"''", b'!!float ""', b"1:30",
    b"abc",
    b'!!int ""', b"!!bool maybe", b"&a [*a]", b"<<: *a", b"&a", b"*a", b"rad", b"mm", b"auto", b"\x07", b'"\\e[2J"',
    b"pelvis_tx: {column: time}\n", b"columns: ", b"hold: ", b"column: ", b"scale: ", b"offset: ", b"  ", b"\n", b": ",
    b"!!python/object/apply:os.system ['touch pwned']", *(name.encode() for name in (*COLUMNS, *REQUIRED_JOINTS)),
]  # fmt: skip


def follow(recording: Path, mapping: Path | None = None) -> None:
    read = load_as(MotionMapping, mapping) if mapping else MotionMapping()
    motion = followed_motion(recording, read, Subject(), Plane(), ease_in=0.3)
    for time in (0.0, 0.05, motion.time[-1], 1e3):
        angles, rates = motion.joints(time)
        pose = motion.pelvis(time)
        assert np.isfinite([*angles, *rates, *pose.X_WP.translation(), *pose.V_WP.get_coeffs()]).all()


def test_recording(fuzzer: Any) -> None:
    def check(content: bytes) -> None:
        for suffix in (".csv", ".mot"):
            path = fuzzer.place / f"bad{suffix}"
            path.write_bytes(content)
            fuzzer.attempt(lambda path=path: follow(path))
        assert {path.name for path in fuzzer.place.iterdir()} == {"bad.csv", "bad.mot"}

    corpus = fuzzer.corpus("recording")
    head = STILL[: STILL.index(b"time")]
    large = [
        b"time," + b",".join(b"c%d" % i for i in range(40_000)) + b"\n" + b"0" + b",0" * 40_000,
        head + b"\t".join([b"time", *(b"c%d" % i for i in range(1999))]) + b"\n" + (b"0\t" * 1999 + b"0\n") * 2,
        b"time,a\n0," + b"1" * 200_000 + b"\n1,1\n",
        b"0" * 4_000_000,
        b"\0" * 4_000_000,
        b"\n" * 4_000_000,
        b"0," * 2_000_000,
        b"time,a\n" + b"".join(b"%d,0\n" % i for i in range(150_000)),
        b" " * (MAX_BYTES + 1),
    ]
    fuzzer.run(check, fuzzer.mutated([*corpus, STILL, TABLE.encode()], CELLS), [*corpus, *large, STILL], inputs=400)


def test_mapping(fuzzer: Any) -> None:
    recording = fuzzer.place / "still.mot"
    recording.write_bytes(STILL)

    def check(content: bytes) -> None:
        path = fuzzer.place / "bad.yaml"
        path.write_bytes(content)
        fuzzer.attempt(lambda: follow(recording, path))
        assert {path.name for path in fuzzer.place.iterdir()} == {"still.mot", "bad.yaml"}

    corpus = fuzzer.corpus("mapping")
    assert fuzzer.attempt(lambda: follow(recording))
    fuzzer.run(check, fuzzer.mutated([*corpus, FULL], VALUES), [*corpus, FULL], inputs=400)
