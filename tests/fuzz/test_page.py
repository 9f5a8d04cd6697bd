"""Of any replay page, nothing but commands and a title reach the page that is shown; see tests/browser for the rest."""

import json
from typing import Any

from humanwalk.view.replay import (
    RECORDING,
    RECORDING_TAG,
    SAMPLES,
    SAMPLES_TAG,
    SCRIPT,
    Recording,
    content_policy,
    replay_page,
    safe_page,
)

TOKENS = [
    b"<script>alert(1)</script>", b"</script>", b"<script", b"<!--", b"-->", b"<base href=//x>", b"]]>", b"<title>",
    b"</title>", b"&lt;/title&gt;&lt;script&gt;", b"&#0;", b"\0", b"\xff", b"\x1b]0;x\x07", b'"', b'\\"', b"\\u003c",
    b"[",
    b"]", b", ", b'["AAAA"]</script>', RECORDING_TAG.encode(), SAMPLES_TAG.encode(),
    b"A" * 3000, b"=" * 100, b'fetch("data:',
    b"\xe2\x80\xae",
]  # fmt: skip


def test_page(fuzzer: Any) -> None:
    empty = replay_page([Recording("", [])])
    scripts = SCRIPT.findall(empty)

    def shortened(commands: list[str], title: str, samples: str = "") -> bytes:
        """A page of ours without its viewer, of which nothing is read."""
        runs = f'{RECORDING_TAG}{json.dumps(commands)}</script>{SAMPLES_TAG}"{samples}"</script>'
        page = f"<title>{title}</title><body>{runs}</body>"
        assert RECORDING.search(page)
        return page.encode()

    def check(content: bytes) -> None:
        path = fuzzer.place / "bad.html"
        path.write_bytes(content)

        def use() -> None:
            page = safe_page([path])
            assert SCRIPT.findall(page) == scripts
            assert page.count("<script") == empty.count("<script")
            assert page.count("<title>") == page.count(content_policy()) == 1
            assert RECORDING.search(page)
            assert SAMPLES.search(page)

        fuzzer.attempt(use)
        assert list(fuzzer.place.iterdir()) == [path]

    corpus = fuzzer.corpus("page")
    ours = [shortened(["AAAA", "BBBB"], "thesis: a walk, 15 s"), shortened(["/+a="], "&lt;b&gt;", "AACAPw==" * 15)]
    large = [
        RECORDING_TAG.encode() + b'["' + b"A" * 20_000_000 + b'"]</script>',
        shortened(["AAAA"], "", "A" * 20_000_000),
        (RECORDING_TAG.encode() + b'["') * 100_000,
        (RECORDING_TAG.encode() + b'["A"') * 100_000,
        b"<title>" * 2_000_000,
        b"<title>" + b"&amp;" * 1_000_000 + b"</title>",
        b"<" * 10_000_000,
    ]
    fuzzer.run(check, fuzzer.mutated([*corpus, *ours], TOKENS), [*corpus, *large, *ours, empty.encode()], inputs=300)
