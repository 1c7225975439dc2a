# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The viewer in notebooks: what it serves, that it ends, and what it says when it cannot."""
import html.parser
import os
import pathlib
import subprocess
import sys
import urllib.error
import urllib.request

import pytest

import caplet

SCENES = pathlib.Path(os.environ["CAPLET_SCENES"])


@pytest.fixture
def ball():
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1, color=(0.8, 0.4, 0.2), name="ball")
    scene.size = 32, 24
    return scene


def frame_of(viewer):
    class Reader(html.parser.HTMLParser):
        def handle_starttag(self, tag, attributes):
            self.found = tag, dict(attributes)
    reader = Reader()
    reader.feed(viewer._repr_html_())
    return reader.found


def test_a_scene_is_served_and_ends(ball):
    with caplet.view(ball, width=400, height=300, spp=1) as viewer:
        tag, attributes = frame_of(viewer)
        assert tag == "iframe" and attributes["src"] == viewer.address and (attributes["width"], attributes["height"]) == ("400", "300")
        with urllib.request.urlopen(viewer.address, timeout=60) as page:
            assert page.status == 200 and "X-Frame-Options" not in page.headers
            assert b"view.js" in page.read()
        assert os.getsid(viewer.process.pid) != os.getsid(0), "Ctrl-C in a cell does not end it"
        folder = pathlib.Path(viewer.process.args[2]).parent
        assert "ball" in (folder / "scene.pbrt").read_text() and "ended" not in repr(viewer)
    assert viewer.process.returncode == 0 and not folder.exists() and "ended" in repr(viewer)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(viewer.address, timeout=60)


def test_files_are_shown_where_they_are(tmp_path):
    scene = tmp_path / "capsules.pbrt"
    scene.write_bytes((SCENES / "capsules.pbrt").read_bytes())
    with caplet.view(scene, spp=1, read_only=True) as viewer:
        assert viewer.process.args[2] == str(scene) and "--read-only" in viewer.process.args
    assert scene.exists()


def test_no_viewer_outlives_python():
    script = "import caplet, sys; s = caplet.Scene(); s.add_spheres((0, 0, 0), 1); v = caplet.view(s, spp=1); print(v.process.pid, v.process.args[2])"
    pid, path = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True).stdout.split()
    assert not pathlib.Path(path).exists()
    with pytest.raises(ProcessLookupError):
        os.kill(int(pid), 0)


def test_errors_are_those_of_the_program(ball, tmp_path, monkeypatch):
    with pytest.raises(caplet.RunError, match="no device has 'nonesuch' in its name"):
        caplet.view(ball, device="nonesuch")
    with pytest.raises(caplet.RunError, match="missing.pbrt"):
        caplet.view(tmp_path / "missing.pbrt")
    for scene in (None, 5, b"scene.pbrt", [ball], object()):
        with pytest.raises(caplet.InputError, match="a caplet.Scene is needed"):
            caplet.view(scene)
    for width in (0, 2**70, -1, 3.5):
        with pytest.raises(caplet.InputError, match="width: a whole number from 1 to 16384"):
            caplet.view(ball, width=width)
    for width in (None, "wide", [1]):
        with pytest.raises((TypeError, ValueError)):
            caplet.view(ball, width=width)
    for scene in ("a\0b", "\ud800"):
        with pytest.raises(ValueError):
            caplet.view(scene)
    with pytest.raises(caplet.RunError, match="--spp"):
        caplet.view(ball, spp="many")
    monkeypatch.delenv("CAPLET_PROGRAM")
    own = caplet.viewing._own_program
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/caplet").write_text("")
    monkeypatch.chdir(tmp_path / "bin")
    for none in (None, ""):
        monkeypatch.setattr(sys, "executable", none)
        assert own() is None
    monkeypatch.setattr(sys, "executable", str(tmp_path / "bin/python"))
    assert own() == str(tmp_path / "bin/caplet")
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    assert own() is None
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(caplet.RunError, match="CAPLET_PROGRAM"):
        caplet.view(ball)
