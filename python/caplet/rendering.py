# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Renders, sessions, rays, devices."""
from __future__ import annotations

import sys
from typing import Any

import numpy as np

from . import _caplet, arrays
from .errors import InputError
from .image import Image
from .scene import Scene
from .spelling import keywords

_PARTS = 16  # of a session's render, between which others may read it


def _devices(choice):
    if choice is None:
        return _caplet.choose_devices("")
    if isinstance(choice, int) and not isinstance(choice, bool):
        choice = str(choice)
    if not isinstance(choice, str):
        raise InputError('device: an index, "cpu", "gpu", "bundled", "all" or part of a name is needed')
    return _caplet.choose_devices(choice)


def _scene(scene):
    if not isinstance(scene, Scene):
        raise InputError(f"scene: a caplet.Scene is needed, not {type(scene).__name__}")
    scene._present()
    return scene


class _Progress:
    """Tells how far it is: to tqdm where that is there, else on one line of a terminal; or to a function of the caller."""

    def __init__(self, wanted, total):
        self._bar = self._function = None
        self._total, self._before, self._is_line = total, 0.0, False
        if callable(wanted):
            self._function = wanted
        elif wanted or (wanted is None and (sys.stderr is not None and sys.stderr.isatty() or "ipykernel" in sys.modules)):
            try:
                from tqdm.auto import tqdm
                self._bar = tqdm(total=total, unit="spp", leave=False)
            except ImportError:
                self._is_line = True

    def part(self, done, of):
        """The function to tell of a part of `of` samples, `done` being done."""
        def tell(fraction, speed):
            self.at((done + fraction * of) / self._total, speed)
        return tell

    def at(self, fraction, speed):
        if self._function:
            self._function(fraction, speed)
        elif self._bar is not None:
            self._bar.n = min(round(fraction * self._total, 2), self._total)
            self._bar.refresh()
        elif self._is_line:
            print(f"\r{100 * fraction:5.1f} %  {speed / 1e6:.2f} M samples/s", end="", file=sys.stderr, flush=True)

    def close(self):
        if self._bar is not None:
            self._bar.close()
        elif self._is_line:
            print("\r" + " " * 40 + "\r", end="", file=sys.stderr, flush=True)


@keywords
class Session:
    """A scene on one or several devices that is rendered and changed again and again.

    device: an index, "cpu", "gpu", "bundled", part of a name, several between commas, or "all"; None: a GPU if there is one, else the first.
    first_sample: the first sample of every pixel, for shares of a picture's samples, whose images are added (Image.__add__).
    cryptomatte: mattes by object, material and file (Image.matte). deep: what a deep EXR takes (Image.save_deep). Both take memory.
    The scene stays as it is here until `update`. Any thread may call any of it: they wait for each other.

    >>> scene = Scene()
    >>> ball = scene.add_spheres((0, 0, 0), 1)
    >>> session = Session(scene, size=(16, 9))
    >>> session.render(4)
    4
    >>> session.image().rgb.shape
    (9, 16, 3)
    """

    def __init__(self, scene, device=None, size=None, first_sample=0, cryptomatte=False, deep=False):
        native = _scene(scene)._native.copy()
        self._size = size
        if size is not None:
            native.set_size(*arrays.size(size))
        self._native = _caplet.Session(native, _devices(device), bool(cryptomatte), bool(deep))
        self._cancelled = False
        if first_sample:
            self._native.begin_at(_count(first_sample, "first_sample", 1 << 24))

    def render(self, spp=16, time_limit=None, progress=None) -> int:
        """Adds the next `spp` samples of every pixel; returns how many were finished.

        time_limit: seconds, after which no more are begun. progress: True, False, None (on a terminal or in a notebook), or a
        function of (fraction, samples a second). Ctrl-C raises KeyboardInterrupt after what is under way; what was finished stays.
        """
        spp = _count(spp, "spp", 1 << 24)
        told = _Progress(progress, spp)
        done = 0
        import time
        end = None if time_limit is None else time.monotonic() + float(time_limit)
        try:
            while done < spp:
                part = min(spp - done, max(1, spp // _PARTS) if end is None else spp)
                left = None if end is None else max(0.0, end - time.monotonic())
                now = self._native.render(part, left, told.part(done, part))
                if now == 0 and self._cancelled:  # of an interrupt that came when the render before had ended
                    now = self._native.render(part, left, told.part(done, part))
                self._cancelled = False
                done += now
                if now < part:
                    break
            return done
        except KeyboardInterrupt:
            self._cancelled = True
            raise
        finally:
            told.close()

    def render_to(self, noise=0.05, min_spp=16, max_spp=16384, time_limit=None, progress=None, noise_space="relative") -> float:
        """Gives each pixel the samples that it still needs for a noise; returns the noise that the picture has.

        noise: the root of the mean, over the pixels that show something, of the variance of a pixel over the square of the luminance
        around it, with a quarter of the picture's mean luminance added. noise_space: "display" for a share of a display's range, after
        the previews' tone curve. min_spp, max_spp: samples a pixel, at least and at most. Others as of `render`.

        >>> scene = Scene()
        >>> ball = scene.add_spheres((0, 0, 0), 1)
        >>> session = Session(scene, size=(16, 9))
        >>> session.render_to(0.1) <= 0.1
        True
        """
        noise, min_spp, max_spp = float(noise), _count(min_spp, "min_spp", 1 << 24), _count(max_spp, "max_spp", 1 << 24)
        in_display = _in_display(noise_space)
        told = _Progress(progress, max_spp)
        try:
            reached = self._native.render_to(noise, min_spp, max_spp, in_display, time_limit, told.part(0, max_spp))
            if self._cancelled:  # of an interrupt that came when the render before had ended
                reached = self._native.render_to(noise, min_spp, max_spp, in_display, time_limit, told.part(0, max_spp))
            self._cancelled = False
            return reached
        except KeyboardInterrupt:
            self._cancelled = True
            raise
        finally:
            told.close()

    def cancel(self) -> None:
        """From any thread: the render under way finishes its passes and begins no more."""
        self._native.cancel()

    def image(self) -> Image:
        """What has been added up."""
        return Image(self._native.film())

    @property
    def spp(self) -> int:
        """Samples a pixel that are there."""
        return self._native.film().spp

    def update(self, scene) -> None:
        """The scene as it now is; the picture begins anew. Of the same scene with edits only what differs is sent."""
        native = _scene(scene)._native.copy()
        if self._size is not None:
            native.set_size(*arrays.size(self._size))
        self._native.update(native)

    def resume(self, image):
        """Goes on with the samples of an image of this scene and view."""
        if not isinstance(image, Image):
            raise InputError(f"image: a caplet.Image is needed, not {type(image).__name__}")
        self._native.resume(image._film)


def _count(value, name, most, least=1):
    try:
        is_good = not isinstance(value, (bool, str)) and int(value) == value and least <= value <= most
    except (TypeError, ValueError, OverflowError):
        is_good = False
    if not is_good:
        raise InputError(f"{name}: a whole number from {least} to {most} is needed, not {value!r}")
    return int(value)


def _range(samples):
    """The first of (A, B), and how many there are before B."""
    try:
        begin, end = samples
    except (TypeError, ValueError):
        raise InputError(f"samples: (A, B) is needed, for samples A to B - 1 of every pixel, not {samples!r}; how many there are is spp") from None
    begin = _count(begin, "samples: A", (1 << 24) - 1, 0)
    return begin, _count(end, "samples: B", 1 << 24, begin + 1) - begin


def _in_display(noise_space):
    if not isinstance(noise_space, str) or noise_space not in ("relative", "display"):
        raise InputError(f'noise_space: "relative" or "display" is needed, not {noise_space!r}')
    return noise_space == "display"


@keywords
def render(scene: Scene, spp: int | None = None, size: tuple[int, int] | None = None, device: Any = None, seed: int | None = None,
           time_limit: float | None = None, progress: Any = None, samples: tuple[int, int] | None = None, noise: float | None = None,
           min_spp: int = 16, cryptomatte: bool = False, deep: bool = False, noise_space: str = "relative") -> Image:
    """Renders a scene. Returns an Image.

    spp: samples a pixel; None: the scene's (Scene.noise, Scene.spp). noise: what the picture is rendered to (Session.render_to has
    noise_space), where min_spp is the fewest and spp the most samples a pixel (None: 16384). samples: (A, B), only samples A to B - 1 of every pixel, in place of spp: images of
    different samples add to that of all. size: (width, height) in pixels. Others as of Session. After Ctrl-C there is no image:
    a Session keeps what was done.
    """
    native = _scene(scene)._native.copy()
    if seed is not None:
        native.seed = _count(seed, "seed", (1 << 32) - 1, 0)
    if size is not None:
        native.set_size(*arrays.size(size))
    native.widen_to_least()
    first = 0
    if samples is not None:
        if spp is not None:
            raise InputError("spp: does not go with samples")
        first, spp = _range(samples)
    session = Session.__new__(Session)
    session._native = _caplet.Session(native, _devices(device), bool(cryptomatte), bool(deep))
    session._cancelled, session._size = False, None
    if first:
        session._native.begin_at(first)
    if noise is None and spp is None and samples is None and native.noise_target:
        noise, least, spp, in_display = native.noise_target
        min_spp, noise_space = min(min_spp, spp), "display" if in_display else "relative"
    if noise is not None:
        if samples is not None:
            raise InputError("noise: does not go with samples")
        session.render_to(noise, min_spp, 16384 if spp is None else spp, time_limit, progress, noise_space)
        return session.image()
    told = _Progress(progress, spp or native.spp)
    try:
        session._native.render(_count(native.spp if spp is None else spp, "spp", 1 << 24), time_limit, told.part(0, spp or native.spp))
    finally:
        told.close()
    return session.image()


CROSSING = np.dtype({"names": [name for name, _, _, _ in _caplet.crossing_layout()],
                     "formats": [type if count == 1 else (type, (count,)) for _, type, count, _ in _caplet.crossing_layout()],
                     "offsets": [offset for _, _, _, offset in _caplet.crossing_layout()], "itemsize": _caplet.crossing_bytes})


def _picker(scene, device):
    key = str(device)
    _scene(scene)
    pickers = scene._pickers
    picker = pickers.get(key)
    if picker is None:
        picker = pickers[key] = _caplet.Picker(scene._native, _devices(device)[0])
    return picker


@keywords
def trace(scene: Scene, origins: Any, directions: Any, mode: str = "nearest", t_min: Any = 0.0, t_max: Any = np.inf, most: int = 256,
          device: Any = None, time: Any = 0.0) -> np.ndarray:
    """What rays hit, by the exact shapes.

    origins, directions: (n, 3), or (3,) for all; directions of any length, in which t counts. t_min, t_max: one or (n,); hits are
    strictly between. Rays that are not finite or have no direction miss. time: seconds, one or (n,), for scenes that move; they stand
    still before the shutter opens and after it closes.

    mode "nearest": a structured array of (n,), with "t" infinite where nothing is hit: t, error (bound on the distance of the point
    from the true surface, scene units), uv, object_id (as in Image.object_id), material_id, primitive (within its shape: of
    capsules the row), surface, shape (index of Scene.shapes), instance, leaving (1: out of the solid), ray, point, normal (unit);
    ids are 2^32 - 1 where there is none. "any": bool (n,), whether there is a hit. "all": every hit, by rays and in order, "ray"
    telling which; a ray of more than `most` (up to 2^20) is a RunError.

    >>> scene = Scene()
    >>> ball = scene.add_spheres((0, 0, 5), 1)
    >>> trace(scene, (0, 0, 0), [(0, 0, 1), (0, 1, 0)])["t"].tolist()
    [4.0, inf]
    >>> trace(scene, (0, 0, 0), (0, 0, 1), mode="all")["t"].tolist()
    [4.0, 6.0]
    """
    if mode not in ("nearest", "any", "all"):
        raise InputError(f'mode: "nearest", "any" or "all" is needed, not {mode!r}')
    origins, directions = arrays.rows(origins, "origins", 3), arrays.rows(directions, "directions", 3)
    t_min, t_max, time = arrays.scalars(t_min, "t_min"), arrays.scalars(t_max, "t_max"), arrays.scalars(time, "time")
    count = arrays.common(origins=origins, directions=directions, t_min=t_min, t_max=t_max, time=time)
    picker = _picker(scene, device)
    if mode == "all":
        most = _count(most, "most", 1 << 20)
        if count == 0:
            return np.empty(0, CROSSING)
        return picker.crossings(count, origins, directions, t_min, t_max, time, most).view(CROSSING)
    out = np.empty(count, CROSSING)
    if count:
        picker.nearest(count, origins, directions, t_min, t_max, time, out.view(np.uint8))
    return np.isfinite(out["t"]) if mode == "any" else out


def carry(scene, hits, points, start, end, device=None):
    """Where points (n, 3) go that `trace` hit at the time start, by the time end (seconds; sensors.flow says how)."""
    points = np.ascontiguousarray(points, dtype=np.float64).copy()
    _picker(scene, device).carry(np.ascontiguousarray(hits).view(np.uint8), float(start), float(end), points)
    return points


@keywords
def pick(scene: Scene, x: int, y: int, device: Any = None) -> dict[str, Any] | None:
    """What the middle of a pixel shows (from the top left): a dict with names, or None."""
    return _picker(scene, device).pixel(int(x), int(y))


class Report:
    """What `verify` found. agrees: whether every device does. devices: a dict each. text, json: the whole of it."""

    def __init__(self, agrees, devices, text, json):
        self.agrees, self.devices, self.text, self.json = agrees, devices, text, json

    def __bool__(self):
        return self.agrees

    def __repr__(self):
        return f"<caplet.Report: {'agrees' if self.agrees else 'DISAGREES'}, {sum(one['rays'] for one in self.devices)} rays>"

    def __str__(self):
        return self.text


@keywords
def verify(scene: Scene | None = None, rays: int = 1_000_000, devices: Any = None, seed: int = 0) -> Report:
    """A device's hits beside those of a host reference that finds them by another method; without a scene, on hard ones of all shapes."""
    native = None if scene is None else _scene(scene)._native
    choice = "" if devices is None else str(devices)
    return Report(*_caplet.verify(native, choice, _count(rays, "rays", 1 << 40), _count(seed, "seed", (1 << 64) - 1, 0)))


def devices() -> list[dict[str, Any]]:
    """The OpenCL devices that there are: a dict each."""
    return _caplet.devices()
