"""Any file is a map of heights or refused."""

import io
from typing import Any

import numpy as np
from PIL import Image

from humanwalk.terrain.height_map import FORMATS, MAX_BYTES, HeightMap

HEIGHTS = np.linspace(-0.1, 0.3, 12).reshape(3, 4)


def made() -> list[bytes]:
    """The same map in every format."""
    npy, png, fine = io.BytesIO(), io.BytesIO(), io.BytesIO()
    np.save(npy, HEIGHTS)
    Image.fromarray((255 * (HEIGHTS + 0.1)).astype(np.uint8)).save(png, "PNG")
    Image.fromarray((65535 * (HEIGHTS + 0.1)).astype(np.uint16)).save(fine, "PNG")
    csv = "\n".join(",".join(f"{value:g}" for value in row) for row in HEIGHTS).encode()
    return [csv, npy.getvalue(), png.getvalue(), fine.getvalue()]


TOKENS = [
    b"nan", b"inf", b"-1e308", b"1e999", b"9" * 400, b"0x1", b"1_0", b"", b'"', b",", b"\n", b"\r", b"\0", b"\xff",
    b"\xef\xbb\xbf", b"\x1b[2J", b"\x93NUMPY\x01\x00", b"\x93NUMPY\x03\x00", b"(4000, 4000)", b"(-1, 3)", b"'<f8'",
    b"'|O'", b"'<M8[s]'", b"'fortran_order': True", b"(" * 3000, b"IHDR", b"IDAT", b"tEXt", b"iCCP", b"acTL",
    b"\x00\x00\x27\x10", b"\x7f\xff\xff\xff",
]  # fmt: skip


def test_height_map(fuzzer: Any) -> None:
    def check(content: bytes) -> None:
        for suffix in FORMATS:
            path = fuzzer.place / f"bad{suffix}"
            path.write_bytes(content)
            piece = HeightMap(file=str(path))
            fuzzer.attempt(lambda piece=piece: piece.faces(2.0))
        assert {path.suffix for path in fuzzer.place.iterdir()} == set(FORMATS)

    large = [
        b"0," * 2_000_000,
        b"0\n" * 2_000_000,
        b"1" * 4_000_000,
        b" " * (MAX_BYTES + 1),
        b"\x93NUMPY\x01\x00\xff\xff" + b"(" * 65_535,
    ]
    fuzzer.run(check, fuzzer.mutated(made(), TOKENS), [*made(), *large], inputs=300)
