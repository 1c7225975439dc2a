# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Pictures as arrays; sessions that are read, interrupted, cancelled and changed."""
import os
import re
import signal
import struct
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import caplet
from caplet import cameras, lights, materials


@pytest.fixture
def ball():
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1, color=(0.8, 0.4, 0.2), name="ball")
    scene.camera = cameras.perspective(eye=(0, 0, 5), target=(0, 0, 0), fov=40)
    scene.add_light(lights.infinite(L=(1, 1, 1)))
    scene.size = 32, 24
    return scene


def equal(a, b):
    return all(np.array_equal(a[name].view(np.uint32), b[name].view(np.uint32)) for name in a.channels)


def test_a_scene_without_shapes_is_its_sky():
    scene = caplet.Scene()
    scene.add_light(lights.infinite(L=(2, 2, 2)))
    scene.size = 16, 16
    image = caplet.render(scene, spp=256)
    assert abs(image.rgb.mean() - 2) < 0.02 and not image.alpha.any()  # 65,536 samples of four wavelengths: 0.003
    assert (scene.bounds[0] > scene.bounds[1]).all()
    report = caplet.verify(scene)
    assert report.agrees and "nothing to verify" in report.text
    scene.camera = cameras.perspective(eye=(0, 0, 5), target=(0, 0, 0), fov=40)
    assert not (caplet.trace(scene, [[0, 0, 5]], [[0, 0, -1]])["t"] < np.inf).any()
    scene.add_spheres((0, 0, 0), 1)
    assert caplet.render(scene, spp=4).alpha.any()
    with pytest.raises(caplet.InputError, match="no shapes, no light and no camera"):
        caplet.render(caplet.Scene())


def test_mattes_tell_things_apart(ball, tmp_path):
    ball.add_spheres((1.2, 0, -1), 0.5, name="other", color=(0.1, 0.2, 0.9))
    image = caplet.render(ball, spp=16, cryptomatte=True, deep=True)
    assert image.matte_names() == ["ball", "other"]
    one, other = image.matte("ball"), image.matte("other")
    assert one.shape == (24, 32) and one.dtype == np.float32
    assert np.array_equal(one + other, image.alpha) and other.max() > 0.5 and one[12, 16] == 1
    ids = image["CryptoObject00.R"].view(np.uint32)
    assert len(np.unique(ids[one == 1])) == len(np.unique(ids[other == 1])) == 1
    assert np.array_equal(sum(image.matte(name, by="material") for name in image.matte_names("material")), image.alpha)
    image.save_deep(tmp_path / "deep.exr")
    assert (tmp_path / "deep.exr").read_bytes()[:4] == b"v/1\x01"
    for wrong in (lambda: image.matte("balls"), lambda: image.matte("ball", by="colour"), lambda: caplet.render(ball, spp=1).matte("ball"),
                  lambda: caplet.render(ball, spp=1).save_deep(tmp_path / "none.exr")):
        with pytest.raises(caplet.InputError):
            wrong()
    assert not (tmp_path / "none.exr").exists()
    session = caplet.Session(ball, cryptomatte=True)
    session.render(4)
    assert session.image().matte_names("asset") == ["scene"]


def test_files_may_ask_for_a_noise(tmp_path):
    file = tmp_path / "noisy.pbrt"
    file.write_text('Sampler "sobol" "float noise" 0.2 "integer pixelsamples" 100\nFilm "rgb" "integer xresolution" 12 "integer yresolution" 8\n'
                    'WorldBegin\nLightSource "infinite"\nShape "sphere"\nShape "disk" "float radius" 5\n')
    scene = caplet.load(file)
    assert scene.noise == 0.2 and scene.spp == 100
    by_file, by_call, even = caplet.render(scene), caplet.render(scene, noise=0.2, spp=100), caplet.render(scene, spp=3)
    assert np.array_equal(by_file.rgb, by_call.rgb) and 16 <= by_file.spp <= 100 and even.spp == 3


def test_layers_are_arrays(ball):
    image = caplet.render(ball, spp=64)
    assert image.size == (32, 24) and image.shape == (24, 32) and image.spp == 64 and image.samples == [(0, 64)]
    for name in ("rgb", "normal", "position", "albedo", "variance"):
        assert getattr(image, name).shape == (24, 32, 3) and getattr(image, name).dtype == np.float32
    for name in ("depth", "alpha"):
        assert getattr(image, name).shape == (24, 32) and getattr(image, name).dtype == np.float32
    assert image.object_id.dtype == image.primitive_id.dtype == np.uint32
    assert image.object_id[12, 16] == 0 and image.object_id[0, 0] == 0xffffffff
    assert image.depth[12, 16] == pytest.approx(4, abs=0.01)
    assert image.normal[12, 16] == pytest.approx([0, 0, 1], abs=0.1)
    assert image.albedo[12, 16] == pytest.approx([0.8, 0.4, 0.2], abs=0.01)
    # A convex diffuse solid under light of 1 from everywhere shows its reflectance.
    assert image.rgb[8:16, 12:20].mean(axis=(0, 1)) == pytest.approx([0.8, 0.4, 0.2], abs=0.02)
    with pytest.raises(caplet.InputError, match="nearest"):
        image["albedo.Red"]


def test_size_samples_and_seed_are_of_the_render_alone(ball):
    a = caplet.render(ball, spp=2, size=(20, 10), seed=3)
    assert a.size == (20, 10) and a.spp == 2 and ball.size == (32, 24) and ball.seed == 0
    assert equal(a, caplet.render(ball, spp=2, size=(20, 10), seed=3))
    assert not np.array_equal(a.rgb, caplet.render(ball, spp=2, size=(20, 10), seed=4).rgb)
    for wrong in (dict(spp=0), dict(spp=1.5), dict(spp=2**30), dict(size=(0, 1)), dict(device="no such"), dict(device=99), dict(device=1.5), dict(seed=-1)):
        with pytest.raises((caplet.InputError, TypeError)):
            caplet.render(ball, **{"spp": 1, **wrong})
    with pytest.raises(caplet.InputError, match="caplet.Scene"):
        caplet.render("ball")


def test_files(ball, tmp_path):
    image = caplet.render(ball, spp=2)
    image.save(tmp_path / "a.exr")
    assert (tmp_path / "a.exr").read_bytes()[:4] == b"\x76\x2f\x31\x01"
    try:
        image.save(tmp_path / "a.png")
    except caplet.InputError:
        pytest.skip("built without OpenImageIO")
    png = (tmp_path / "a.png").read_bytes()
    assert png[:8] == b"\x89PNG\r\n\x1a\n" and struct.unpack(">II", png[16:24]) == (32, 24)
    assert image._repr_png_() == png
    with pytest.raises(caplet.InputError):
        image.save(tmp_path / "a.xyz")
    with pytest.raises(caplet.RunError):
        image.save(tmp_path / "none" / "a.exr")


def test_a_session_goes_on_and_films_add_up(ball, tmp_path):
    session = caplet.Session(ball)
    assert session.render(3) == 3 and session.render(5) == 5 and session.spp == 8
    whole = caplet.render(ball, spp=8)
    assert equal(session.image(), whole)
    first = caplet.Session(ball)
    first.render(3)
    first.image().save_film(tmp_path / "film.exr")
    second = caplet.Session(ball)
    second.resume(caplet.load_film(tmp_path / "film.exr", ball))
    second.render(5)
    assert equal(second.image(), whole)
    with pytest.raises(caplet.InputError):
        whole + whole  # the same samples twice


def test_a_picture_has_the_noise_that_is_asked_for(ball):
    ball.add_light(lights.point(from_=(2, 2, 2), I=(20, 20, 20)))
    ball.add("disk", radius=3, height=-1)
    image = caplet.render(ball, noise=0.01, min_spp=8)
    samples = image["samples"]
    assert samples.dtype == np.uint32 and samples.min() >= 8 and samples.max() > 2 * samples.min()
    assert image.spp == round(samples.mean()) and image.samples == [(0, samples.max())]
    assert "samples" not in caplet.render(ball, spp=4).channels
    session = caplet.Session(ball)
    assert 0.005 < session.render_to(0.01, min_spp=8) <= 0.01 and equal(session.image(), image)
    assert session.render_to(0.02) <= 0.01 and equal(session.image(), image)  # it is there already
    assert session.render(3) == 3 and (session.image()["samples"] == samples + 3).all()
    assert caplet.render(ball, noise=0.0001, spp=32).spp == 32
    fractions = []
    caplet.render(ball, noise=0.0005, spp=4096, progress=lambda fraction, speed: fractions.append(fraction))  # for about a second
    assert fractions == sorted(fractions) and fractions[-1] <= 1
    for noise in (0, -1, 2, float("nan")):
        with pytest.raises(caplet.InputError, match="noise"):
            caplet.render(ball, noise=noise)
    with pytest.raises(caplet.InputError, match="most samples"):
        caplet.render(ball, noise=0.1, min_spp=9, spp=8)
    with pytest.raises(caplet.InputError, match="noise: does not go with samples"):
        caplet.render(ball, noise=0.1, samples=(0, 4))
    ball.sampler("zsobol")
    with pytest.raises(caplet.InputError, match="the sampler is zsobol"):
        caplet.render(ball, noise=0.1)


def test_shares_add_to_one_render(ball, tmp_path):
    whole = caplet.render(ball, spp=8)
    late = caplet.render(ball, samples=(3, 8))
    assert late.spp == 5 and late.samples == [(3, 5)]
    assert equal(late + caplet.render(ball, samples=(0, 3)), whole)
    session = caplet.Session(ball, first_sample=3)
    session.render(5)
    assert equal(session.image(), late)
    session.image().save_film(tmp_path / "late.film")
    # Without its scene a film has its picture, but no overlays.
    alone = caplet.load_film(tmp_path / "late.film")
    assert equal(alone, late)
    with pytest.raises(caplet.InputError, match="overlays need the scene"):
        alone.save(tmp_path / "late.png", outline=True)
    caplet.load_film(tmp_path / "late.film", ball).save(tmp_path / "late.png", outline=True)
    # A session goes on with films of its own scene and view alone.
    session.resume(alone)
    session.render(1)
    assert session.image().samples == [(3, 6)]
    for options in ({"size": (40, 30)}, {"seed": 1}):
        other = caplet.render(ball, samples=(0, 3), **options)
        with pytest.raises(caplet.InputError, match="cannot be continued"):
            session.resume(other)
        with pytest.raises(caplet.InputError):
            late + other
    ball.set_material(0, materials.conductor(alpha=0.3))
    with pytest.raises(caplet.InputError, match="another scene"):
        caplet.Session(ball).resume(late)
    for wrong in ((3, 3), (-1, 2), (4, 2), (0.5, 2), ("a", 2), (0, 1 << 25)):
        with pytest.raises(caplet.InputError, match="samples: [AB]: a whole number from "):
            caplet.render(ball, samples=wrong)
    for wrong in (3, (1, 2, 3), "four"):
        with pytest.raises(caplet.InputError, match=r"samples: \(A, B\) is needed.* how many there are is spp"):
            caplet.render(ball, samples=wrong)
    caplet.render(ball, spp=1, seed=(1 << 32) - 1)
    with pytest.raises(caplet.InputError, match="seed: a whole number from 0 to 4294967295 is needed, not 4294967296"):
        caplet.render(ball, seed=1 << 32)
    for name in ("spp", "seed"):
        for wrong in ("many", -1, 1.5, float("nan"), True, [1]):
            with pytest.raises(caplet.InputError, match=f"{name}: a whole number from . to "):
                caplet.render(ball, **{name: wrong})
    with pytest.raises(caplet.InputError, match="spp"):
        caplet.render(ball, spp=3, samples=(0, 3))


def test_a_session_follows_edits(ball):
    session = caplet.Session(ball)
    session.render(2)
    ball.shape("ball").transform = np.diag([0.5, 0.5, 0.5, 1])
    ball.set_material(0, materials.conductor(alpha=0.3))
    session.update(ball)
    session.render(2)
    assert equal(session.image(), caplet.render(ball, spp=2))
    ball.add_spheres((1.5, 0, 0), 0.3)
    session.update(ball)
    session.render(2)
    assert equal(session.image(), caplet.render(ball, spp=2))


def test_progress_is_told(ball, capsys):
    told = []
    caplet.Session(ball).render(64, progress=lambda fraction, speed: told.append((fraction, speed)))
    big = caplet.Session(ball, size=(640, 480))
    big.render(32, progress=lambda fraction, speed: told.append((fraction, speed)))
    fractions = [fraction for fraction, _ in told]
    assert told and all(0 <= fraction <= 1 for fraction in fractions)
    assert big.render(1, progress=True) == 1

    def stop(fraction, speed):
        raise ValueError("enough")
    with pytest.raises(ValueError, match="enough"):
        big.render(4096, progress=stop)
    assert big.render(1) == 1


def test_a_time_limit_ends_a_render(ball):
    session = caplet.Session(ball, size=(320, 240))
    session.render(1)
    start = time.monotonic()
    done = session.render(1 << 20, time_limit=0.5)
    assert 0 < done < 1 << 20 and time.monotonic() - start < 60


@pytest.fixture
def interrupted():
    """Sends SIGINT after so many seconds. Where tests run in the background the shell has it ignored: here Python sees to it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timers = []

    def after(seconds):
        timers.append(threading.Timer(seconds, lambda: os.kill(os.getpid(), signal.SIGINT)))
        timers[-1].start()
    yield after
    for timer in timers:
        timer.cancel()
        timer.join()
    signal.signal(signal.SIGINT, before)


def test_an_interrupt_leaves_a_usable_session(ball, interrupted):
    session = caplet.Session(ball, size=(320, 240))
    session.render(1)
    interrupted(0.7)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        session.render(1 << 20, time_limit=120)
    assert time.monotonic() - start < 100  # it did not wait for the limit
    done = session.spp
    assert 1 <= done < 1 << 20 and np.isfinite(session.image().rgb).all()
    assert session.render(2) == 2 and session.spp == done + 2


def test_an_interrupt_ends_a_render_and_questions(ball, interrupted):
    interrupted(0.7)
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        caplet.render(ball, spp=1 << 20, size=(320, 240), time_limit=120)
    assert time.monotonic() - start < 100
    caplet.trace(ball, (0, 0, 5), (0, 0, -1))  # compiled
    interrupted(0.3)
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):
            caplet.trace(ball, np.zeros((1 << 20, 3), np.float32), (0, 0, 1))
    assert np.isfinite(caplet.trace(ball, (0, 0, 5), (0, 0, -1))["t"]).all()
    interrupted(0.7)
    with pytest.raises(KeyboardInterrupt):
        caplet.verify(ball, rays=1 << 33)
    assert caplet.render(ball, spp=1).spp == 1


def test_other_threads_run_and_read_while_it_renders(ball):
    session = caplet.Session(ball, size=(160, 120))
    session.render(1)
    ticks, seen, stop = [0], [], threading.Event()

    def count():
        while not stop.is_set():
            ticks[0] += 1
            time.sleep(0.001)

    def read():
        while not stop.is_set():
            seen.append(session.image().spp)
            time.sleep(0.01)
    threads = [threading.Thread(target=count), threading.Thread(target=read)]
    for thread in threads:
        thread.start()
    assert session.render(256) == 256
    stop.set()
    for thread in threads:
        thread.join()
    assert ticks[0] > 20 and seen == sorted(seen) and session.spp == 257


@pytest.mark.parametrize("work", ["render", "trace", "all", "pick", "add_capsules", "load"])
def test_the_interpreters_lock_is_released(ball, work, tmp_path):
    """A thread of Python counts on while one call of the binding is under way."""
    native = ball._native.copy()
    native.present()
    devices = caplet.rendering._devices(None)
    held, picker = caplet._caplet.Session(native, devices), caplet._caplet.Picker(native, devices[0])
    held.render(1, None, None)
    n = 1 << 17
    origins, directions, numbers = np.tile([[0, 0, 5.0]], (n, 1)), np.array([[0, 0, -1.0]]), (np.zeros(1), np.full(1, np.inf), np.zeros(1))
    out = np.empty(n, caplet.CROSSING).view(np.uint8)
    many = np.zeros((1_000_000, 3))
    (tmp_path / "big.capsules").write_text("<0, 0, 0> <1, 0, 0> 0.5\n" * 100_000)
    calls = {"render": lambda: held.render(64, None, None), "trace": lambda: picker.nearest(n, origins, directions, *numbers, out),
             "all": lambda: picker.crossings(n, origins, directions, *numbers, 16), "pick": lambda: picker.pixel(1, 1),
             "add_capsules": lambda: native.add_capsules(len(many), many, many, np.ones(1), None, None, None, {}),
             "load": lambda: caplet._caplet.load(str(tmp_path / "big.capsules"), {})}
    ticks, inside, stop = [0], [False], threading.Event()

    def count():
        while not stop.is_set():
            if inside[0]:
                ticks[0] += 1
            time.sleep(0.0005)
    before = sys.getswitchinterval()
    thread = threading.Thread(target=count)
    thread.start()
    try:
        sys.setswitchinterval(60)  # the lock is never asked for: what counts has got it from the call
        end = time.monotonic() + 60
        while ticks[0] < 3 and time.monotonic() < end:
            inside[0] = True
            calls[work]()
            inside[0] = False
    finally:
        sys.setswitchinterval(before)
        stop.set()
        thread.join()
    assert ticks[0] >= 3


def test_a_session_is_cancelled_from_another_thread(ball):
    session = caplet.Session(ball, size=(320, 240))
    session.render(1)
    timer = threading.Timer(0.5, session.cancel)
    timer.start()
    assert session.render(1 << 20) < 1 << 20
    timer.join()


def test_kernels_are_compiled_by_processes_of_the_program(tmp_path):
    program = os.environ.get("CAPLET_PROGRAM")
    if not program:
        pytest.skip("CAPLET_PROGRAM names no program")
    code = "import caplet; caplet.set_log_level('info'); s = caplet.Scene(); s.add_spheres((0, 0, 0), 1); caplet.render(s, spp=1, size=(8, 8))"

    def said(**variables):
        environment = dict(os.environ, POCL_CACHE_DIR=str(tmp_path), CAPLET_CACHE=str(tmp_path), CAPLET_SELF_TEST="0", CAPLET_COMPILERS="3", **variables)
        done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return done.stderr

    assert re.search("compiling [0-9]+ kernels in 3 processes", said())
    assert "compiling" not in said()
