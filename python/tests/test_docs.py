# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The examples of docs/python.md and of docstrings do what they say; stubs name what is there."""
import ast
import doctest
import importlib
import importlib.resources
import inspect
import os
import pathlib
import subprocess
import sys

import caplet
import numpy as np
import pytest

SOURCE = pathlib.Path(os.environ.get("CAPLET_SOURCE", pathlib.Path(__file__).parents[2]))


def test_the_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = doctest.testfile(str(SOURCE / "docs/python.md"), module_relative=False)
    assert result.attempted > 30 and result.failed == 0
    assert (tmp_path / "dust.exr").exists() and (tmp_path / "scene.pbrt").exists()


def test_the_example_of_the_page_of_clusters(tmp_path):
    text = (SOURCE / "docs/cluster.md").read_text()
    (tmp_path / "shares.py").write_text(text.split("```python\n")[1].split("```")[0])
    (tmp_path / "scenes").symlink_to(SOURCE / "scenes")
    subprocess.run([sys.executable, "shares.py"], cwd=tmp_path, check=True, timeout=300, env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})
    summed = {name: caplet.load_film(tmp_path / f"{name}.film") for name in range(4)}
    whole = caplet.render(caplet.load(SOURCE / "scenes/capsules.pbrt"), size=(96, 54), spp=16)
    together = sum(list(summed.values())[1:], summed[0])
    assert together.spp == 16 and together.samples == [(0, 16)]
    for name in whole.channels:
        assert np.array_equal(together[name], whole[name]), name
    assert (tmp_path / "sum.exr").exists()


def test_the_page_of_circuits():
    for package in ("libsonata", "morphio", "h5py", "neuroml"):
        pytest.importorskip(package)
    result = doctest.testfile(str(SOURCE / "docs/formats/circuits.md"), module_relative=False)
    assert result.attempted > 15 and result.failed == 0


@pytest.mark.parametrize("name", ["scene", "rendering", "colors", "sensors", "scanner", "batches"])
def test_docstrings(name):
    result = doctest.testmod(importlib.import_module(f"caplet.{name}"))
    assert result.attempted > 0 and result.failed == 0


@pytest.mark.parametrize("name", ["materials", "textures", "lights", "media", "cameras"])
def test_stubs_have_what_is_there(name):
    module = importlib.import_module(f"caplet.{name}")
    stub = importlib.resources.files("caplet").joinpath(f"{name}.pyi").read_text()
    functions = {one.name: one.args for one in ast.parse(stub).body if isinstance(one, ast.FunctionDef)}
    assert list(functions) == module.__all__ and len(functions) > 1
    for function, arguments in functions.items():
        there = {key: one.default for key, one in inspect.signature(getattr(module, function)).parameters.items()}
        said = {one.arg: ast.literal_eval(default) for one, default in zip(arguments.kwonlyargs, arguments.kw_defaults)}
        assert said == there and not arguments.args, function


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
