"""Random numbers of a scenario: independent streams from one seed."""

from hypothesis import given
from hypothesis import strategies as st

from humanwalk.numerics.random_stream import RandomStream

SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS)
def test_a_stream_repeats(seed: int) -> None:
    for stream in RandomStream:
        assert stream.of(seed).random() == stream.of(seed).random()


@given(seed=SEEDS)
def test_streams_differ(seed: int) -> None:
    assert len({stream.of(seed).random() for stream in RandomStream}) == len(RandomStream)
