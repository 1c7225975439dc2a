# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The viewer of `caplet view`, in a notebook or a browser."""
from __future__ import annotations

import atexit
import html
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import weakref

from .errors import RunError
from .rendering import _count, _scene
from .spelling import keywords

_PATIENCE = 60  # seconds that the program has to end


def _own_program():
    """The program that came with this package: CAPLET_PROGRAM, else the one beside this Python; None where there is none."""
    told = os.environ.get("CAPLET_PROGRAM")
    if told or not sys.executable:  # an interpreter within another program has none
        return told
    beside = pathlib.Path(sys.executable).parent / "caplet"
    return str(beside) if beside.is_file() else None


def _program():
    """The package's own program, else that of PATH."""
    found = _own_program() or shutil.which("caplet")
    if not found:
        raise RunError("there is no program `caplet` beside this Python or in PATH: install the wheel or the package that has it, or name it in CAPLET_PROGRAM")
    return found


class Viewer:
    """A running viewer. A notebook shows it; `address` is for a browser; `close` ends it, as the end of Python does.

    address: "http://127.0.0.1:PORT/TOKEN/". process: its subprocess.Popen.
    """

    def __init__(self, process, address, width, height, folder):
        self.process, self.address, self.width, self.height, self._folder = process, address, width, height, folder

    def close(self) -> None:
        """Ends the viewer. Its edits end with it, unless they were saved."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(_PATIENCE)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.process.stdout.close()
        if self._folder:
            self._folder.cleanup()

    def __enter__(self):
        return self

    def __exit__(self, *what):
        self.close()

    def _repr_html_(self):
        return f'<iframe src="{html.escape(self.address)}" width="{self.width}" height="{self.height}" style="border:0" allow="clipboard-write"></iframe>'

    def __repr__(self):
        return f"caplet.Viewer({self.address!r}{'' if self.process.poll() is None else ', ended'})"


_open = weakref.WeakSet()


@atexit.register
def _close_all():
    for viewer in list(_open):
        viewer.close()


def _started(command):
    """The running program, and the address that it prints."""
    with tempfile.TemporaryFile() as said:
        # A session of its own: Ctrl-C in a notebook interrupts a cell and not the viewer.
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=said, stdin=subprocess.DEVNULL, text=True, start_new_session=True)
        address = process.stdout.readline().strip()
        if address:
            return process, address
        process.wait()
        process.stdout.close()
        said.seek(0)
        raise RunError(said.read().decode(errors="replace").strip() or f"{command[0]} ended with {process.returncode}")


@keywords
def view(scene, *, width=960, height=600, spp=None, noise=None, device=None, read_only=False, browser=False) -> Viewer:
    """Shows a scene live: in a notebook as the value of a cell, with browser=True in a browser.

    scene: a Scene, which is shown as it is now, or the path of a file of any format, whose edits can be saved beside it.
    width, height: of the frame in a notebook, pixels. spp, noise: when a picture is finished, as of the program. device: part of a
    device's name, or its number. Returns a Viewer. Raises RunError if the program is missing or ends, with what it says.
    """
    width, height = _count(width, "width", 16384), _count(height, "height", 16384)
    is_file = isinstance(scene, (str, os.PathLike))
    if not is_file:
        _scene(scene)
    options = ["--embed", "-q"] + ([] if browser else ["--no-browser"]) + (["--read-only"] if read_only else [])
    for name, value in (("--spp", spp), ("--noise", noise), ("--device", device)):
        options += [] if value is None else [name, str(value)]
    program = _program()
    folder = None if is_file else tempfile.TemporaryDirectory(prefix="caplet-", ignore_cleanup_errors=True)
    path = os.fspath(scene) if is_file else os.path.join(folder.name, "scene.pbrt")
    try:
        if folder:
            scene.save(path)
        process, address = _started([program, "view", path, *options])
    except BaseException:
        if folder:
            folder.cleanup()
        raise
    out = Viewer(process, address, width, height, folder)
    _open.add(out)
    return out
