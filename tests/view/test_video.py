import math
import sys
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from humanwalk.quantity import ParameterError
from humanwalk.run.folder import REPLAY
from humanwalk.view.browser import find_browser, has_sandbox, open_browser, run_browsers
from humanwalk.view.video import VideoParameters, find_ffmpeg, parse_size, parse_times, record_video
from humanwalk.view.views import camera


@pytest.mark.parametrize(
    ("parameters", "count", "last"),
    [
        (VideoParameters(), 451, 15.0),
        (VideoParameters(speed=0.5), 901, 15.0),
        (VideoParameters(begin=1.0, end=2.0), 31, 2.0),
        (VideoParameters(begin=3.0, end=3.0), 1, 3.0),
        (VideoParameters(frame_rate=7.0), 106, 15.0),
        (VideoParameters(frame_rate=32.0, speed=7.0), 69, 14.875),
    ],
)
def test_frames_are_evenly_spaced_and_stay_in_the_selected_part(
    parameters: VideoParameters, count: int, last: float
) -> None:
    times = parameters.times(15.0)
    assert len(times) == count
    assert times[0] == parameters.begin
    assert times[-1] == pytest.approx(last)
    gaps = {round(later - earlier, 9) for earlier, later in pairwise(times)}
    assert gaps <= {round(parameters.speed / parameters.frame_rate, 9)}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"frame_rate": 0.0}, "video.frame_rate: 0 .*allowed: 1 to 120 1/s"),
        ({"speed": math.nan}, "video.speed: nan .*allowed: 0.02 to 50"),
        ({"width": 1281}, "--size 1281x720: .*even numbers from 64 to 3840"),
        ({"height": 10}, "--size 1280x10: .*even numbers from 64 to 3840"),
        ({"view": "top"}, "--view top: unknown; allowed: follow, side, front, above, orbit"),
    ],
)
def test_invalid_parameters_produce_a_one_line_error(arguments: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message) as error:
        VideoParameters(**arguments)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(("begin", "end"), [(-1.0, None), (16.0, None), (2.0, 1.0), (0.0, 15.5)])
def test_times_outside_the_replay_are_refused(begin: float, end: float | None) -> None:
    with pytest.raises(ParameterError, match=r"--(from|to): .*allowed: .* to 15 s"):
        VideoParameters(begin=begin, end=end).times(15.0)


def test_a_late_time_is_not_taken_for_milliseconds() -> None:
    with pytest.raises(ParameterError, match=r"--to: 99 .*the nearest allowed value is 15$"):
        VideoParameters(end=99.0).times(15.0)


def test_sizes_and_times_are_parsed() -> None:
    assert parse_size("1280x720") == (1280, 720)
    assert parse_times("1.0,1.5") == [1.0, 1.5]
    for text in ("1280", "1280x", "x720", "12.5x10", "1280X720p", "\u0661280x720"):
        with pytest.raises(ParameterError, match="allowed: WIDTHxHEIGHT in pixels, from 64 to 3840"):
            parse_size(text)
    for text in ("", "1.0;2.0", "1.0,", "1_0"):
        with pytest.raises(ParameterError, match="seconds separated by commas"):
            parse_times(text)


def test_the_orbit_returns_after_its_period_and_keeps_its_distance() -> None:
    begin, quarter, end = (camera("orbit", time).position for time in (0.0, 2.5, 10.0))
    assert end == pytest.approx(begin)
    assert math.hypot(*quarter[:2]) == pytest.approx(math.hypot(*begin[:2]))
    assert quarter != pytest.approx(begin)
    assert begin == pytest.approx(camera("follow", 0.0).position)


def test_an_unknown_format_is_refused(run: Path) -> None:
    with pytest.raises(ParameterError, match=r"walk\.avi: unknown video format; allowed: \.mp4, \.gif, \.webp"):
        record_video(run, run / "walk.avi", VideoParameters())


def test_a_run_without_replay_is_refused(run: Path) -> None:
    (run / REPLAY).unlink()
    with pytest.raises(ParameterError, match=r"no replay\.html.*humanwalk replay"):
        record_video(run, run / "walk.mp4", VideoParameters())


@pytest.mark.parametrize(
    ("module", "need"), [("playwright.async_api", "playwright"), ("imageio_ffmpeg", "imageio-ffmpeg")]
)
def test_missing_package_produces_an_error_with_the_command(
    run: Path, monkeypatch: pytest.MonkeyPatch, module: str, need: str
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(ParameterError, match=rf"{need}: not installed.*pip install -e '\.\[video\]'"):
        if need == "playwright":
            run_browsers(open_browser().__aenter__())
        else:
            find_ffmpeg()


def test_the_browser_of_the_environment_comes_first_and_must_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CHROMIUM", sys.executable)
    assert find_browser() == sys.executable
    monkeypatch.setenv("CHROMIUM", "/no/such/browser")
    with pytest.raises(ParameterError, match="CHROMIUM: /no/such/browser is not a program"):
        find_browser()


def test_without_any_browser_playwright_looks_for_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CHROMIUM", raising=False)
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("humanwalk.view.browser.MACOS_BROWSERS", ())
    assert find_browser() is None


def test_a_folder_that_cannot_be_written_is_refused_before_a_frame_is_drawn(
    run: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_: object) -> None:
        raise AssertionError("a browser was opened")

    monkeypatch.setattr("humanwalk.view.video.open_stage", never)
    blocked = run / "file"
    blocked.touch()
    with pytest.raises(ParameterError, match="allowed: a folder that you may write to"):
        record_video(run, blocked / "walk.mp4", VideoParameters())


@pytest.mark.parametrize(("user", "sandbox"), [(0, False), (1000, True)])
def test_chromium_keeps_its_sandbox_except_for_root(monkeypatch: pytest.MonkeyPatch, user: int, sandbox: bool) -> None:
    monkeypatch.setattr("os.geteuid", lambda: user)
    assert has_sandbox() is sandbox
