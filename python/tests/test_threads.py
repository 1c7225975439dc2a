# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Threads, forked processes, and the interpreter's end: each script in an interpreter of its own, once; three times by `./run test --all`, and
100 times under sanitizers."""
import os
import subprocess
import sys
import time

import pytest

TIMES = 100 if os.environ.get("CAPLET_SANITIZED") else 3 if os.environ.get("CAPLET_THOROUGH") else 1
SECONDS = 300  # that a script may take: it takes one or two, and more where others work beside it

BEGIN = """
import os, sys, threading, time
import numpy as np
import caplet

scene = caplet.Scene()
scene.add_spheres([[0, 0, 0], [3, 0, 0]], [1, 0.5], color=(0.8, 0.4, 0.2), name="balls")
scene.add_boxes([[-3, -1, -1]], [[-1.5, 1, 1]], color=(0.2, 0.4, 0.8))
SIZE = (24, 16)

def picture(**given):
    return caplet.render(scene, **{"spp": 2, "size": SIZE, **given})

def equal(a, b):
    return all(np.array_equal(a[name].view(np.uint32), b[name].view(np.uint32)) for name in a.channels)

def together(*works):
    # At the same time, in a thread each; raises what the first of them raised.
    start, raised = threading.Barrier(len(works)), [None] * len(works)
    def run(i):
        start.wait()
        try:
            works[i]()
        except BaseException as error:
            raised[i] = error
    threads = [threading.Thread(target=run, args=(i,)) for i in range(len(works))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for error in raised:
        if error is not None:
            raise error

def forked(work):
    # Exit status of a child that calls it and ends as Python does.
    sys.stdout.flush()
    child = os.fork()
    if child == 0:
        work()
        sys.exit(0)
    end = time.monotonic() + 120
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(0.005)
    os.kill(child, 9)
    os.waitpid(child, 0)
    return "hangs"

def refused(name, call):
    try:
        call()
    except caplet.RunError as error:
        assert 'multiprocessing.set_start_method("spawn")' in str(error), f"{name}: {error}"
    else:
        raise AssertionError(f"{name} works in a forked process")

def daemon(work):
    threading.Thread(target=work, daemon=True).start()
"""


def run(script, *arguments, exit=0, environment=(), say=""):
    """Runs it; it must end by itself with this exit status, and say nothing else."""
    done = subprocess.run([sys.executable, "-c", BEGIN + script, *map(str, arguments)], stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, timeout=SECONDS, env={**os.environ, **dict(environment)})
    check(done, exit, say)


def check(done, exit=0, say=""):
    assert (done.returncode, done.stdout, done.stderr) == (exit, say, ""), f"exit status {done.returncode}\n{done.stdout}\n{done.stderr}"


def often(script, *arguments, times=TIMES, **given):
    for i in range(times):
        run(script, *(argument(i) if callable(argument) else argument for argument in arguments), **given)


def delay(i):
    """Seconds after which a script is over: all of the first 0.3 s of a render in their turn."""
    return 0.3 * ((i + 1) * 0.618034 % 1)


# --- Threads ---


def test_the_first_use_from_several_threads():
    often("""
found, pictures = [], []
def first():
    found.append(len(caplet.devices()))
    pictures.append(picture())
together(first, first, first)
assert found[0] > 0 and found == [found[0]] * 3
assert equal(pictures[0], pictures[1]) and equal(pictures[0], pictures[2])
""")


def test_the_same_kernels_are_compiled_by_several_threads(tmp_path):
    run("""
pictures = []
together(*[lambda: pictures.append(picture())] * 2)
assert equal(*pictures)
""", environment={"POCL_CACHE_DIR": str(tmp_path), "CAPLET_CACHE": str(tmp_path), "CAPLET_ROWS": "scene"}.items())


def test_a_scene_is_rendered_asked_and_changed_by_several_threads():
    often("""
alone = picture()
pictures, hits = [], []
def render():
    for _ in range(3):
        pictures.append(picture())
def ask():
    for _ in range(10):
        hits.append(caplet.trace(scene, (0, 0, 9), (0, 0, -1))["t"][0])
def change():
    for i in range(100):
        scene.shape("balls").transform = np.diag([1, 1, 1, 1])
        scene.spp = 3 + i % 5
together(render, render, ask, change)
assert len(pictures) == 6 and all(equal(one, alone) for one in pictures)
assert np.allclose(hits, 8)
""")


def test_a_scene_is_built_by_several_threads():
    often("""
big = caplet.Scene()
def add(at):
    p0 = np.full((5000, 3), at, np.float32)
    def add():
        for i in range(30):
            before = big.copy()  # the next one has to copy what both share
            big.add_capsules(p0, p0 + 1, 0.1)
    return add
together(add(0), add(10), add(20))
assert big.primitives == {"capsule": 450000}, big.primitives
assert np.allclose(big.bounds, [[-0.1] * 3, [21.1] * 3], atol=1e-5), big.bounds
""")


def test_a_session_is_used_by_several_threads():
    often("""
alone = picture(spp=24)
session = caplet.Session(scene, size=SIZE)
def render():
    for _ in range(4):
        assert session.render(2) == 2
def read():
    last = 0
    for _ in range(10):
        image = session.image()
        assert image.spp >= last and np.isfinite(image.rgb).all()
        last = image.spp
together(render, render, render, read, read)
assert session.spp == 24 and equal(session.image(), alone)
""")


def test_a_session_is_updated_by_several_threads():
    often("""
alone = picture(spp=3)
session = caplet.Session(scene, size=SIZE)
shape = scene.shape("balls")
def render():
    for _ in range(12):
        session.render(1)
def update():
    for i in range(12):
        shape.transform = np.diag([1, 1, 1 + 0.1 * (i % 3), 1])
        session.update(scene)
together(render, render, update, update)
for z in (1.5, 1):
    shape.transform = np.diag([1, 1, z, 1])
    session.update(scene)
assert session.render(3) == 3 and equal(session.image(), alone)
""")


def test_exceptions_and_exits_in_threads_are_theirs_alone():
    often("""
import concurrent.futures
told = []
threading.excepthook = lambda args: told.append(args.exc_type)
def fails():
    picture(device="there is no such device")
def exits():
    picture(spp=1 << 20, progress=lambda fraction, speed: sys.exit(3))
def raises():
    picture(spp=1 << 20, progress=lambda fraction, speed: 1 / 0)
threads = [threading.Thread(target=work) for work in (fails, exits, raises)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert sorted(one.__name__ for one in told) == ["InputError", "SystemExit", "ZeroDivisionError"], told
with concurrent.futures.ThreadPoolExecutor(3) as pool:
    alone = picture()
    assert all(equal(one, alone) for one in pool.map(lambda i: picture(), range(6)))
    wrong = pool.submit(caplet.render, scene, spp=0)
    assert isinstance(wrong.exception(), caplet.InputError)
""")


def test_an_interrupt_is_not_for_the_render_of_another_thread():
    run("""
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
session = caplet.Session(scene, size=(320, 240))
session.render(1)
done = []
other = threading.Thread(target=lambda: done.append(session._native.render(64, None, None)))
other.start()
while session._native is None:
    pass
time.sleep(0.1)
threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    session._native.render(1 << 20, None, None)  # waits for the other
except KeyboardInterrupt:
    pass
else:
    raise AssertionError("no interrupt")
other.join()
assert done == [64] and session.spp == 65, (done, session.spp)
""")


# --- Forked processes ---


def test_a_fork_before_the_first_use_changes_nothing():
    often("""
assert forked(picture) == 0 and forked(picture) == 0
picture()
""")


def test_a_fork_after_a_render_is_told_to_spawn():
    often("""
alone = picture()
session = caplet.Session(scene, size=SIZE)
session.render(2)
caplet.trace(scene, (0, 0, 9), (0, 0, -1))
def child():
    refused("devices", caplet.devices)
    refused("render", picture)
    refused("Session", lambda: caplet.Session(scene))
    refused("Session.render", lambda: session.render(1))
    refused("Session.image", session.image)
    refused("Session.spp", lambda: session.spp)
    refused("Session.update", lambda: session.update(scene))
    refused("Session.resume", lambda: session.resume(alone))
    refused("trace", lambda: caplet.trace(scene, (0, 0, 9), (0, 0, -1)))
    refused("trace all", lambda: caplet.trace(scene, (0, 0, 9), (0, 0, -1), mode="all"))
    refused("trace anew", lambda: caplet.trace(scene.copy(), (0, 0, 9), (0, 0, -1)))
    refused("pick", lambda: caplet.pick(scene, 1, 1))
    refused("verify", lambda: caplet.verify(rays=10))
    session.cancel()
    assert np.isfinite(alone.rgb).all()
    scene.add_spheres((0, 3, 0), 1)
    scene.save("child.pbrt")
    assert sum(caplet.load("child.pbrt").primitives.values()) == 4
    assert forked(lambda: refused("a grandchild", caplet.devices)) == 0
assert forked(child) == 0
assert session.render(2) == 2 and session.spp == 4 and equal(picture(), alone)
""")


def test_processes_of_multiprocessing_and_subprocess(tmp_path):
    (tmp_path / "job.py").write_text(BEGIN + """
import multiprocessing, subprocess

def job(seed):
    return float(picture(seed=seed).rgb.mean())

if __name__ == "__main__":
    means = [job(seed) for seed in (1, 2)]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        refused("a pool of forked processes", lambda: pool.map(job, (1, 2)))
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(job, (1, 2)) == means
    assert subprocess.run(["true"]).returncode == 0
    print("done")
""")
    done = subprocess.run([sys.executable, "job.py"], capture_output=True, text=True, timeout=SECONDS)
    check(done, say="done\n")


def test_a_fork_while_another_thread_renders():
    often("""
alone = picture()
session, other = caplet.Session(scene, size=SIZE), caplet.Scene()
stop = threading.Event()
def render():
    while not stop.is_set():
        session.render(16)
def build():
    while not stop.is_set():
        other.add_capsules(np.zeros((1000, 3)), np.ones((1000, 3)), 0.1)
threads = [threading.Thread(target=render), threading.Thread(target=build)]
for thread in threads:
    thread.start()
def child():
    refused("devices", caplet.devices)
    refused("Session.render", lambda: session.render(1))
    refused("Session.image", session.image)
    refused("trace", lambda: caplet.trace(scene, (0, 0, 9), (0, 0, -1)))
    try:
        other.bounds
    except caplet.RunError as error:  # the other thread had it
        assert "forked" in str(error), error
ends = [forked(child) for _ in range(3)]
stop.set()
for thread in threads:
    thread.join()
assert ends == [0, 0, 0], ends
assert equal(picture(), alone)
""")


@pytest.mark.parametrize("end", ["return", "sys.exit(5)"])
def test_a_fork_within_a_progress_function(end):
    often("""
alone = picture(spp=4096)
children = []
def progress(fraction, speed):
    if not children:
        children.append(os.fork())
        if children == [0]:
            """ + end + """
try:
    image = picture(spp=4096, progress=progress)
    if not children:
        progress(1, 1)
except caplet.RunError as error:
    assert children == [0] and "forked" in str(error), error
    sys.exit(5)
if children == [0]:
    sys.exit(5 if image else 0)
assert os.waitstatus_to_exitcode(os.waitpid(children[0], 0)[1]) == 5
assert equal(image, alone)
""")


# --- The interpreter's end ---

AT_WORK = {
    "render": "picture(spp=1 << 20)",
    "session": "session = caplet.Session(scene, size=SIZE)\n    while True:\n        session.render(4), session.image()",
    "progress": "picture(spp=1 << 20, progress=lambda fraction, speed: sum(range(10000)))",
    "trace": "while True:\n        caplet.trace(scene, np.tile([[0, 0, 9.0]], (1000, 1)), (0, 0, -1), mode='all')",
    "verify": "caplet.verify(rays=1 << 33)",
    "build": "while True:\n        s = caplet.Scene()\n        s.add_capsules(np.zeros((100000, 3)), np.ones((100000, 3)), 0.1)\n        s.save('daemon.pbrt')",
}


@pytest.mark.parametrize("work", AT_WORK)
def test_the_end_while_a_daemon_thread_works(work):
    often("def work():\n    " + AT_WORK[work] + "\n" + """
for _ in range(2):
    daemon(work)
time.sleep(float(sys.argv[1]))
""", delay)


def test_the_end_keeps_the_exit_status():
    often("""
daemon(lambda: picture(spp=1 << 20))
time.sleep(float(sys.argv[1]))
sys.exit(3)
""", delay, exit=3)
    often("""
daemon(lambda: picture(spp=1 << 20))
time.sleep(0.1)
os._exit(4)
""", exit=4)


def test_the_end_waits_for_no_blocked_function():
    """A progress function that waits for what will not come."""
    run("""
begun = threading.Event()
def progress(fraction, speed):
    begun.set()
    threading.Event().wait()
daemon(lambda: picture(spp=1 << 20, progress=progress))
begun.wait()
""")


def test_what_is_left_at_the_end():
    """Of the module, and in a circle."""
    often("""
session = caplet.Session(scene, size=SIZE)
session.render(2)
image = session.image()
caplet.trace(scene, (0, 0, 9), (0, 0, -1))
class Holder:
    def __init__(self):
        self.me, self.session, self.image = self, session, image
    def __del__(self):
        if self.image.spp != 2:
            print("another image")
holder = Holder()
del holder
holder = Holder()
""")


def test_functions_of_atexit_may_render():
    script = """
import atexit
def last():
    import caplet
    print(len(caplet.devices()) > 0, session.render(2), session.image().spp > 2)
atexit.register(last)
""" + BEGIN + """
session = caplet.Session(scene, size=SIZE)
session.render(2)
daemon(lambda: picture(spp=1 << 20))
time.sleep(0.05)
"""
    for _ in range(TIMES):
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=SECONDS)
        check(done, say="True 2 True\n")


def test_an_interrupt_ends_a_program_of_threads():
    script = BEGIN + """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
daemon(lambda: picture(spp=1 << 20))
threading.Thread(target=picture).start()
print("begun", flush=True)
picture(spp=1 << 24)
"""
    for i in range(TIMES):
        program = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert program.stdout.readline() == "begun\n"
        time.sleep(delay(i))
        program.send_signal(2)
        _, said = program.communicate(timeout=SECONDS)
        assert program.returncode == -2, (program.returncode, said)
        assert "KeyboardInterrupt" in [line.rstrip(":") for line in said.splitlines()], said


def test_an_interrupt_while_kernels_are_compiled(tmp_path):
    """LLVM hears the signal too: it removes the files that it writes, and the kernel is not built."""
    script = BEGIN + """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
print("begun", flush=True)
picture(spp=1 << 24)
"""
    for i in range(1, 3):
        cache = str(tmp_path / str(i))
        program = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                                   env={**os.environ, "POCL_CACHE_DIR": cache, "CAPLET_CACHE": cache, "CAPLET_ROWS": "scene"})
        assert program.stdout.readline() == "begun\n"
        time.sleep(0.5 + 4 * delay(i))
        program.send_signal(2)
        _, said = program.communicate(timeout=SECONDS)
        assert program.returncode == -2, (program.returncode, said)
        assert said.rstrip().rstrip(":").endswith("KeyboardInterrupt"), said


def test_a_second_interpreter_of_the_process_is_refused():
    run("""
try:
    import _xxsubinterpreters as interpreters
except ImportError:
    import _interpreters as interpreters
first = picture()
one = interpreters.create()
for _ in range(2):
    try:
        told = interpreters.run_string(one, "import caplet")
    except interpreters.RunFailedError as error:  # raised before Python 3.13, then returned
        told = error
    assert "caplet works in the main interpreter" in str(told), told
assert equal(picture(), first)
""")
