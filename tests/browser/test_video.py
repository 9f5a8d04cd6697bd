import hashlib
import os
import signal
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from humanwalk.quantity import ParameterError
from humanwalk.view.video import VideoParameters, find_ffmpeg, record_video, write_snapshot

pytestmark = pytest.mark.browser

WIDTH, HEIGHT = 160, 120
SMALL = VideoParameters(frame_rate=16.0, width=WIDTH, height=HEIGHT)


def frame_hashes(video: Any) -> Any:
    """One hash a frame, by ffmpeg; of what is decoded, not of the file."""
    result = subprocess.run(
        [find_ffmpeg(), "-loglevel", "error", "-i", str(video), "-f", "framemd5", "-"],
        capture_output=True,
        text=True,
        check=True,
    )
    return [line.split(",")[-1].strip() for line in result.stdout.splitlines() if not line.startswith("#")]


def test_recordings_by_one_and_by_two_browsers_are_the_same_frame_by_frame(
    short_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    videos = [tmp_path / name for name in ("one.mp4", "two.mp4")]
    monkeypatch.setattr("humanwalk.view.video.MIN_FRAMES_PER_BROWSER", 4)
    for browsers, video in enumerate(videos, start=1):
        monkeypatch.setattr("humanwalk.view.video.MAX_BROWSERS", browsers)
        assert record_video(short_run.path, video, SMALL) == 9
    hashes = [frame_hashes(video) for video in videos]
    assert hashes[0] == hashes[1]
    # It moves.
    assert len(set(hashes[0])) == 9
    assert len({hashlib.sha256(video.read_bytes()).digest() for video in videos}) == 1


@pytest.mark.parametrize("suffix", [".gif", ".webp"])
def test_a_gif_or_webp_has_every_frame_and_loops(short_run: Any, tmp_path: Path, suffix: Any) -> None:
    path = tmp_path / f"walk{suffix}"
    record_video(short_run.path, path, VideoParameters(frame_rate=10.0, width=WIDTH, height=HEIGHT))
    with Image.open(path) as picture:
        assert picture.n_frames == 6  # type: ignore[attr-defined]
        assert picture.size == (WIDTH, HEIGHT)
        assert picture.info["loop"] == 0


def test_ctrl_c_leaves_no_file(short_run: Any, tmp_path: Path) -> None:
    def press(done: Any, frames: Any) -> None:
        if done == 2:
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        record_video(short_run.path, tmp_path / "walk.mp4", SMALL, press)
    assert list(tmp_path.iterdir()) == []


def test_a_strip_has_a_still_for_every_time(short_run: Any, tmp_path: Path) -> None:
    path = tmp_path / "strip.png"
    write_snapshot(short_run.path, path, [0.1, 0.2, 0.3], 100, 160, "side")
    with Image.open(path) as strip:
        pixels = np.asarray(strip.convert("RGB"), dtype=float)
    assert pixels.shape == (160 + 30, 3 * 100 + 2 * 8, 3)
    first, second, third = (pixels[:160, left : left + 100] for left in (0, 108, 216))
    assert np.abs(first - second).max() > 20.0
    assert np.abs(second - third).max() > 20.0
    # The gaps are white.
    assert pixels[:, 100:108].min() == 255.0


def test_times_outside_the_replay_are_refused(short_run: Any, tmp_path: Path) -> None:
    with pytest.raises(ParameterError, match=r"--to: 2 .*allowed: 0 to 0.5 s"):
        record_video(short_run.path, tmp_path / "walk.mp4", VideoParameters(end=2.0))
    with pytest.raises(ParameterError, match=r"--times: 3 .*allowed: 0 to 0.5 s"):
        write_snapshot(short_run.path, tmp_path / "strip.png", [0.1, 3.0], 100, 160, "side")
    assert list(tmp_path.iterdir()) == []


def test_an_invalid_browser_is_named_in_the_error(
    short_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CHROMIUM", "/bin/false")
    with pytest.raises(ParameterError, match=r"/bin/false does not start.*CHROMIUM") as error:
        record_video(short_run.path, tmp_path / "walk.mp4", SMALL)
    assert "\n" not in str(error.value)


def test_a_browser_without_webgl_produces_an_error(
    short_run: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("humanwalk.view.browser.FLAGS", ("--disable-gpu", "--disable-3d-apis"))
    with pytest.raises(ParameterError, match=r"no WebGL.*install chromium"):
        record_video(short_run.path, tmp_path / "walk.mp4", SMALL)
    assert list(tmp_path.iterdir()) == []
