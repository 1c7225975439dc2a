# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The examples of docs/python.md and of docstrings do what they say; stubs are those of the lists."""
import doctest
import importlib
import os
import pathlib
import subprocess
import sys

import pytest

SOURCE = pathlib.Path(os.environ.get("CAPLET_SOURCE", pathlib.Path(__file__).parents[2]))


def test_the_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = doctest.testfile(str(SOURCE / "docs/python.md"), module_relative=False)
    assert result.attempted > 30 and result.failed == 0
    assert (tmp_path / "dust.exr").exists() and (tmp_path / "scene.pbrt").exists()


@pytest.mark.parametrize("name", ["scene", "rendering"])
def test_docstrings(name):
    result = doctest.testmod(importlib.import_module(f"caplet.{name}"))
    assert result.attempted > 2 and result.failed == 0


def test_stubs_are_those_of_the_lists():
    script = SOURCE / "tools/python_stubs.py"
    result = subprocess.run([sys.executable, script, "--check"], capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr


def test_everything_public_is_described():
    import caplet
    for name in caplet.__all__:
        thing = getattr(caplet, name)
        if callable(thing):
            assert thing.__doc__, name
    for part in (caplet.Scene, caplet.Shape, caplet.Session, caplet.Image):
        for name, method in vars(part).items():
            if not name.startswith("_") and callable(method):
                assert method.__doc__, (part, name)
