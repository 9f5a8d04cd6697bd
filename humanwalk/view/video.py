"""The replay of a run as a video or a strip of stills, drawn frame by frame in a headless browser."""

import io
import math
import re
import signal
import subprocess
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Literal, get_args

from humanwalk.files import make_folder, write_whole
from humanwalk.quantity import ParameterError, check, quantity, require_in_range
from humanwalk.run.folder import Run
from humanwalk.view.browser import Camera, missing_extra, open_stage
from humanwalk.view.replay import CAMERA_POSITION, CAMERA_TARGET

View = Literal["follow", "side", "front", "orbit"]

ORBIT_PERIOD_S = 10.0
"""Time of the replay in which the camera of `orbit` goes round the walker once."""
ORBIT_RADIUS_M = math.hypot(*CAMERA_POSITION[:2])

FORMATS = (".mp4", ".gif", ".webp")
SIZE_RANGE = (64, 3840)

FRAME_END = 1e-9
"""Share of a frame by which the last one may be over the end: sums of fractions are not exact."""

STRIP_GAP = 8
STRIP_LABEL = 30
"""Pixels between stills, and of the line of text below them."""

# The picture is the JPEG of the browser, in its colours; everyone's players want those of television.
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
# The same frames make the same bytes: one thread, no date, no version of the encoder.
EXACT = ["-threads", "1", "-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact"]


@dataclass(frozen=True)
class VideoParameters:
    """What is recorded of a replay.

    Attributes:
        width, height: of the picture in pixels; even numbers, as H.264 wants them.
        view: from where: `follow` as the replay page begins, `side` from the right, `front`, or `orbit` around.
        begin, end: stretch of the replay [s]; no end is the replay's.
    """

    frame_rate: float = quantity(30.0, "1/s", 1.0, 120.0)
    """Frames per second of the video."""

    speed: float = quantity(1.0, "", 0.02, 50.0)
    """Seconds of walking per second of video: 0.25 is slow motion."""

    width: int = 1280
    height: int = 720
    view: View = "follow"
    begin: float = 0.0
    end: float | None = field(default=None)

    def __post_init__(self) -> None:
        """Check every value.

        Raises:
            ParameterError: with the option, the value, the allowed range and a mend.
        """
        check(self, "video")
        check_picture(self.width, self.height, self.view)

    def times(self, duration: float) -> list[float]:
        """Instants of the frames in a replay of `duration` [s].

        Raises:
            ParameterError: the stretch is not in the replay.
        """
        end = duration if self.end is None else self.end
        require_in_range("--from", self.begin, "s", 0.0, duration)
        require_in_range("--to", end, "s", self.begin, duration)
        step = self.speed / self.frame_rate
        return [self.begin + k * step for k in range(1 + math.floor((end - self.begin) / step + FRAME_END))]


def check_picture(width: int, height: int, view: str) -> None:
    """Raise ParameterError for a size or a view that cannot be drawn."""
    low, high = SIZE_RANGE
    if not all(low <= length <= high and length % 2 == 0 for length in (width, height)):
        raise ParameterError(
            f"--size {width}x{height}: cannot be drawn; allowed: even numbers from {low} to {high}; like 1280x720"
        )
    if view not in get_args(View):
        raise ParameterError(f"--view {view}: unknown; allowed: {', '.join(get_args(View))}; choose one of them")


def parse_size(text: str) -> tuple[int, int]:
    """Width and height out of "1280x720"."""
    match = re.fullmatch(r"(\d{1,5})x(\d{1,5})", text)
    if match is None:
        raise ParameterError(f"--size {text}: no size; allowed: WIDTHxHEIGHT in pixels; like 1280x720")
    return int(match[1]), int(match[2])


def parse_times(text: str) -> list[float]:
    """Instants [s] out of "1.0,1.1,1.2"."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise ParameterError(f"--times {text}: no times; allowed: seconds with commas between; like 1.0,1.2") from None


def camera(view: View, time: float) -> Camera:
    """The camera of a view at an instant of the replay [s]; see `browser.Camera` for its frame."""
    if view == "side":
        return Camera((0.0, -4.7, 1.0), (0.0, 0.0, 0.86))
    if view == "front":
        return Camera((4.7, 0.0, 1.2), (0.0, 0.0, 0.86))
    if view == "orbit":
        angle = math.atan2(CAMERA_POSITION[1], CAMERA_POSITION[0]) + 2.0 * math.pi * time / ORBIT_PERIOD_S
        x, y = ORBIT_RADIUS_M * math.cos(angle), ORBIT_RADIUS_M * math.sin(angle)
        return Camera((x, y, CAMERA_POSITION[2]), CAMERA_TARGET)
    return Camera(CAMERA_POSITION, CAMERA_TARGET)


def record_video(
    run: Path,
    output: Path,
    parameters: VideoParameters,
    on_progress: Callable[[int, int], None] = lambda done, frames: None,
) -> int:
    """Record the replay of a run into a video file, whole or not at all.

    The same run and parameters make the same frames, whatever the machine's speed.

    Args:
        run: folder of the run.
        output: H.264 as .mp4, or .gif or .webp, which play over and over.
        parameters: what to record.
        on_progress: called with the number of frames that are drawn, and of all of them.

    Returns:
        Number of frames.

    Raises:
        ParameterError: no run or replay, an unknown format, nothing to record with, or no room; nothing is written.
        KeyboardInterrupt: Ctrl-C; nothing is written.
    """
    opened = Run.open(run)
    page, duration = opened.replay, opened.summary["duration_s"]
    form = output.suffix.lower()
    if form not in FORMATS:
        raise ParameterError(f"-o {output}: unknown video format; allowed: {', '.join(FORMATS)}; name it walk.mp4")
    ffmpeg = find_ffmpeg()
    # Now, rather than when all frames are drawn.
    make_folder(output.parent)
    with tempfile.TemporaryDirectory(prefix="humanwalk-video-") as folder, between_frames() as interrupted:
        frames = Path(folder) / "frames.mjpeg"
        with (
            open_stage(page, parameters.width, parameters.height, duration) as stage,
            frames.open("wb") as file,
        ):
            times = parameters.times(stage.duration)
            for done, time in enumerate(times, start=1):
                file.write(stage.still(time, camera(parameters.view, time)))
                if interrupted():
                    raise KeyboardInterrupt
                on_progress(done, len(times))
        write_whole(output, partial(_encode, ffmpeg, frames, parameters.frame_rate))
        if interrupted():
            raise KeyboardInterrupt
    return len(times)


def write_snapshot(run: Path, output: Path, times: Sequence[float], width: int, height: int, view: View) -> None:
    """Write stills of a replay side by side into a PNG file, each with its time below, whole or not at all.

    Args:
        run: folder of the run.
        output: the picture.
        times: of the stills [s].
        width, height: of one still in pixels.
        view: from where; `orbit` turns from one still to the next.

    Raises:
        ParameterError: no run or replay, a time outside it, a name other than .png, or nothing to draw with.
    """
    from PIL import Image, ImageDraw, ImageFont

    opened = Run.open(run)
    page, duration = opened.replay, opened.summary["duration_s"]
    if output.suffix.lower() != ".png":
        raise ParameterError(f"-o {output}: unknown picture format; allowed: .png; name it strip.png")
    check_picture(width, height, view)
    if not times:
        raise ParameterError("--times: none; allowed: at least one instant; like 1.0,1.2")
    make_folder(output.parent)
    strip = Image.new("RGB", (len(times) * (width + STRIP_GAP) - STRIP_GAP, height + STRIP_LABEL), "white")
    draw = ImageDraw.Draw(strip)
    font = ImageFont.load_default(18)
    with open_stage(page, width, height, duration) as stage:
        for time in times:
            require_in_range("--times", time, "s", 0.0, stage.duration)
        for place, time in enumerate(times):
            left = place * (width + STRIP_GAP)
            strip.paste(Image.open(io.BytesIO(stage.still(time, camera(view, time), "png"))), (left, 0))
            draw.text((left + width / 2, height + STRIP_LABEL / 2), f"{time:g} s", "#202020", font, anchor="mm")
    write_whole(output, lambda beside: strip.save(beside, optimize=True))


def find_ffmpeg() -> str:
    """The ffmpeg that comes with imageio-ffmpeg, or that $IMAGEIO_FFMPEG_EXE names.

    Raises:
        ParameterError: there is none, with what to install.
    """
    try:
        from imageio_ffmpeg import get_ffmpeg_exe
    except ImportError:
        raise ParameterError(missing_extra("imageio-ffmpeg")) from None
    try:
        return str(get_ffmpeg_exe())
    except RuntimeError:
        raise ParameterError(
            "video: imageio-ffmpeg holds no ffmpeg for this machine; install ffmpeg and name it in $IMAGEIO_FFMPEG_EXE"
        ) from None


@contextmanager
def between_frames() -> Iterator[Callable[[], bool]]:
    """Within the block Ctrl-C only sets what the function returns; a second one does what it always did."""
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
    source = ["-f", "mjpeg", "-framerate", f"{frame_rate:g}", "-i", str(frames)]
    match output.suffix.lower():
        case ".mp4":
            _run(ffmpeg, *source, *H264, *EXACT, str(output))
        case ".webp":
            _run(ffmpeg, *source, *WEBP, *EXACT, str(output))
        case _:
            palette = frames.with_name("palette.png")
            _run(ffmpeg, *source, *PALETTE, str(palette))
            _run(ffmpeg, *source, "-i", str(palette), *GIF, *EXACT, str(output))


def _run(ffmpeg: str, *arguments: str) -> None:
    # In a session of its own, Ctrl-C does not reach it: the file is whole, and then thrown away.
    result = subprocess.run(
        [ffmpeg, "-hide_banner", "-loglevel", "error", "-nostdin", "-y", *arguments],
        capture_output=True,
        text=True,
        start_new_session=True,
    )
    if result.returncode != 0:
        reason = (result.stderr.strip().splitlines() or ["no reason given"])[-1]
        raise ParameterError(f"video: ffmpeg failed: {reason}; try another size or format")
