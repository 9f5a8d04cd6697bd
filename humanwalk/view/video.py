"""The replay of a run as a video or a strip of stills, rendered frame by frame in a headless browser."""

import asyncio
import io
import math
import re
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from os import cpu_count
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from humanwalk.extras import missing_package
from humanwalk.files import make_folder, write_whole
from humanwalk.quantity import ParameterError, check, number_of, quantity, require_in_range
from humanwalk.run.fall_picture import replay_duration
from humanwalk.run.folder import Run
from humanwalk.view.browser import open_stage, run_browsers
from humanwalk.view.views import VIEWS, View, camera

FORMATS = (".mp4", ".gif", ".webp")
SIZE_RANGE = (64, 3840)
MAX_FRAMES = 36_000
"""Longest video: 20 minutes at 30 frames per second."""
MAX_STRIP_PIXELS = 50_000_000
"""Largest strip; its memory is 3 bytes per pixel."""

FRAME_END = 1e-9
"""Fraction of a frame by which the last one may exceed the end: sums of fractions are not exact."""

FRAME = "{:05}.jpeg"
FRAMES = "%05d.jpeg"
"""Names of the files of frames, for Python and for ffmpeg."""

MAX_BROWSERS = 4
MIN_FRAMES_PER_BROWSER = 20
"""Software WebGL uses little more than one core, and starting a browser takes as long as ten frames."""

STRIP_GAP = 8
STRIP_LABEL = 30
"""Gap between stills, and height of the text line below them [pixels]."""

# The input is the browser's JPEG, in full-range BT.601; players expect BT.709 of limited range.
H264 = [
    "-vf",
    "scale=in_color_matrix=bt601:in_range=full:out_color_matrix=bt709:out_range=limited,format=yuv420p",
    *("-c:v", "libx264", "-preset", "medium", "-crf", "20"),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"),
    *("-movflags", "+faststart"),
]
WEBP = ["-c:v", "libwebp_anim", "-quality", "70", "-compression_level", "4", "-loop", "0"]
PALETTE = ["-vf", "palettegen=stats_mode=diff", "-frames:v", "1"]
GIF = ["-lavfi", "paletteuse=dither=bayer:bayer_scale=4:diff_mode=rectangle", "-loop", "0"]
# The same frames give the same bytes: one thread, no date, no encoder version.
EXACT = ["-threads", "1", "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"]


@dataclass(frozen=True)
class VideoParameters:
    """Rendering of a replay.

    Attributes:
        width, height: Size of the picture in pixels; even numbers, which H.264 requires.
        view: See `humanwalk.view.views`.
        begin, end: Part of the replay [s]; None is its end.
    """

    frame_rate: float = quantity(30.0, "1/s", 1.0, 120.0)
    """Frames per second of the video."""

    speed: float = quantity(1.0, "", 0.02, 50.0)
    """Seconds of walking per second of video: 0.25 is slow motion."""

    width: int = 1280
    height: int = 720
    view: View = "follow"
    begin: float = 0.0
    end: float | None = None

    def __post_init__(self) -> None:
        """Check every value.

        Raises:
            ParameterError: A value is out of range.
        """
        check(self, "video")
        check_picture(self.width, self.height, self.view)

    def times(self, duration: float) -> list[float]:
        """Times of the frames in a replay of `duration` [s].

        Raises:
            ParameterError: The part is not in the replay, or has more than MAX_FRAMES frames.
        """
        end = duration if self.end is None else self.end
        require_in_range("--from", self.begin, "s", 0.0, duration, other_units=False)
        require_in_range("--to", end, "s", self.begin, duration, other_units=False)
        step = self.speed / self.frame_rate
        frames = 1 + math.floor((end - self.begin) / step + FRAME_END)
        if frames > MAX_FRAMES:
            raise ParameterError(
                f"video: {frames} frames; allowed: up to {MAX_FRAMES}; shorten it (--from, --to) or lower --fps"
            )
        return [self.begin + k * step for k in range(frames)]


def check_picture(width: int, height: int, view: str) -> None:
    """Raise ParameterError for an invalid size or view."""
    low, high = SIZE_RANGE
    if not all(low <= length <= high and length % 2 == 0 for length in (width, height)):
        raise ParameterError(
            f"--size {width}x{height}: invalid; allowed: even numbers from {low} to {high}; like 1280x720"
        )
    if view not in VIEWS:
        raise ParameterError(f"--view {view}: unknown; allowed: {', '.join(VIEWS)}; choose one of them")


def parse_size(text: str) -> tuple[int, int]:
    """Width and height from text such as "1280x720"."""
    match = re.fullmatch(r"([0-9]{1,5})x([0-9]{1,5})", text)
    if match is None:
        low, high = SIZE_RANGE
        raise ParameterError(
            f"--size {text}: invalid; allowed: WIDTHxHEIGHT in pixels, from {low} to {high}; like 1280x720"
        )
    return int(match[1]), int(match[2])


def parse_times(text: str) -> list[float]:
    """Times [s] from text such as "1.0,1.1,1.2"."""
    try:
        return [number_of(word) for word in text.split(",")]
    except ValueError:
        raise ParameterError(f"--times {text}: invalid; allowed: seconds separated by commas; like 1.0,1.2") from None


def record_video(
    run: Path,
    output: Path,
    parameters: VideoParameters,
    on_progress: Callable[[int, int], None] = lambda done, frames: None,
) -> int:
    """Render the replay of a run as a video file, written whole or not at all.

    The same run and parameters give the same frames, independent of the machine's speed.

    Args:
        run: Folder of the run.
        output: H.264 as .mp4, or .gif or .webp, which loop.
        parameters: What to render.
        on_progress: Called with the number of rendered frames, and of all frames, in the thread that draws.

    Returns:
        Number of frames.

    Raises:
        ParameterError: No run or replay, unknown format, missing programs, or no space left; nothing is written.
        KeyboardInterrupt: Ctrl-C; nothing is written.
    """
    opened = Run.open(run)
    page, duration = opened.replay, replay_duration(opened.summary)
    form = output.suffix.lower()
    if form not in FORMATS:
        raise ParameterError(f"-o {output}: unknown video format; allowed: {', '.join(FORMATS)}; name it walk.mp4")
    ffmpeg = find_ffmpeg()
    # Checked before the frames are rendered.
    make_folder(output.parent)
    with tempfile.TemporaryDirectory(prefix="humanwalk-video-") as folder, between_frames() as interrupted:
        drawn = run_browsers(_draw_frames(page, duration, parameters, Path(folder), on_progress, interrupted))
        if interrupted():
            raise KeyboardInterrupt
        write_whole(output, partial(_encode, ffmpeg, Path(folder), parameters.frame_rate))
        if interrupted():
            raise KeyboardInterrupt
    return drawn


async def _draw_frames(
    page: Path,
    duration: float,
    parameters: VideoParameters,
    folder: Path,
    on_progress: Callable[[int, int], None],
    interrupted: Callable[[], bool],
) -> int:
    """Draw every frame into a file of a folder, in one browser per core; returns the number of frames.

    It ends early once `interrupted` is true.
    """
    expected = len(parameters.times(duration))
    browsers = max(1, min(cpu_count() or 1, MAX_BROWSERS, expected // MIN_FRAMES_PER_BROWSER))
    drawn = 0

    async def draw(first: int) -> None:
        nonlocal drawn
        async with open_stage(page, parameters.width, parameters.height, duration) as stage:
            times = parameters.times(stage.duration)
            for number in range(first, len(times), browsers):
                if interrupted():
                    return
                still = await stage.still(times[number], camera(parameters.view, times[number]))
                (folder / FRAME.format(number)).write_bytes(still)
                drawn += 1
                on_progress(drawn, len(times))

    await asyncio.gather(*map(draw, range(browsers)))
    return drawn


def write_snapshot(
    run: Path,
    output: Path,
    times: Sequence[float],
    width: int,
    height: int,
    view: View,
    on_progress: Callable[[int, int], None] = lambda done, frames: None,
) -> None:
    """Write stills of a replay side by side into a PNG file, each with its time below, whole or not at all.

    Args:
        run: Folder of the run.
        output: The picture.
        times: Times of the stills [s].
        width, height: Size of one still in pixels.
        view: Camera; `orbit` turns from one still to the next.
        on_progress: Called with the number of rendered stills, and of all stills, in the thread that draws.

    Raises:
        ParameterError: No run or replay, a time outside it, a suffix other than .png, or missing programs.
        KeyboardInterrupt: Ctrl-C; nothing is written.
    """
    opened = Run.open(run)
    page, duration = opened.replay, replay_duration(opened.summary)
    if output.suffix.lower() != ".png":
        raise ParameterError(f"-o {output}: unknown picture format; allowed: .png; name it strip.png")
    check_picture(width, height, view)
    if not times:
        raise ParameterError("--times: empty; allowed: at least one time; like 1.0,1.2")
    if len(times) * width * height > MAX_STRIP_PIXELS:
        most = MAX_STRIP_PIXELS // (width * height)
        raise ParameterError(f"--times: {len(times)} stills of {width}x{height}; allowed: up to {most}; remove some")
    make_folder(output.parent)
    strip = Image.new("RGB", (len(times) * (width + STRIP_GAP) - STRIP_GAP, height + STRIP_LABEL), "white")
    label = ImageDraw.Draw(strip)
    font = ImageFont.load_default(18)

    async def draw(interrupted: Callable[[], bool]) -> None:
        async with open_stage(page, width, height, duration) as stage:
            for time in times:
                require_in_range("--times", time, "s", 0.0, stage.duration, other_units=False)
            for place, time in enumerate(times):
                if interrupted():
                    return
                left = place * (width + STRIP_GAP)
                still = await stage.still(time, camera(view, time), "png")
                strip.paste(Image.open(io.BytesIO(still)), (left, 0))
                label.text((left + width / 2, height + STRIP_LABEL / 2), f"{time:g} s", "#202020", font, anchor="mm")
                on_progress(place + 1, len(times))

    with between_frames() as interrupted:
        run_browsers(draw(interrupted))
        if interrupted():
            raise KeyboardInterrupt
    write_whole(output, lambda beside: strip.save(beside, optimize=True))


def find_ffmpeg() -> str:
    """The ffmpeg of imageio-ffmpeg, or the one named by $IMAGEIO_FFMPEG_EXE.

    Raises:
        ParameterError: No ffmpeg is found.
    """
    try:
        from imageio_ffmpeg import get_ffmpeg_exe
    except ImportError:
        raise missing_package("imageio-ffmpeg", "video") from None
    try:
        return str(get_ffmpeg_exe())
    except RuntimeError:
        raise ParameterError(
            "video: imageio-ffmpeg has no ffmpeg for this machine; install ffmpeg and name it in $IMAGEIO_FFMPEG_EXE"
        ) from None


@contextmanager
def between_frames() -> Iterator[Callable[[], bool]]:
    """Within the block, the first Ctrl-C only makes the yielded function return True."""
    pressed = False

    def interrupt(signum: int, frame: object) -> None:
        nonlocal pressed
        pressed = True
        signal.signal(signal.SIGINT, previous)

    previous = signal.signal(signal.SIGINT, interrupt)
    try:
        yield lambda: pressed
    finally:
        signal.signal(signal.SIGINT, previous)


def _encode(ffmpeg: str, frames: Path, frame_rate: float, output: Path) -> None:
    source = ["-framerate", f"{frame_rate:g}", "-i", str(frames / FRAMES)]
    match output.suffix.lower():
        case ".mp4":
            _run(ffmpeg, *source, *H264, *EXACT, str(output))
        case ".webp":
            _run(ffmpeg, *source, *WEBP, *EXACT, str(output))
        case _:
            palette = frames / "palette.png"
            _run(ffmpeg, *source, *PALETTE, str(palette))
            _run(ffmpeg, *source, "-i", str(palette), *GIF, *EXACT, str(output))


def _run(ffmpeg: str, *arguments: str) -> None:
    # Ctrl-C does not reach a session of its own: the file is completed, and then discarded.
    result = subprocess.run(
        [ffmpeg, "-hide_banner", "-loglevel", "error", "-nostdin", "-y", *arguments],
        capture_output=True,
        text=True,
        start_new_session=True,
    )
    if result.returncode != 0:
        reason = (result.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise ParameterError(f"video: ffmpeg failed: {reason}; try another size or format")
