# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
import os
import pathlib

import numpy as np
import pytest

import caplet


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """What packages write beside them stays out of the tree."""
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def scenes():
    return pathlib.Path(os.environ.get("CAPLET_SCENES", pathlib.Path(__file__).parents[2] / "scenes"))


@pytest.fixture
def row():
    """Three capsules side by side along x, from y = 0 to 1, of radius 0.25, 0.25 and 0.5 to 0.1."""
    scene = caplet.Scene()
    scene.add_capsules([[0, 0, 0], [2, 0, 0], [4, 0, 0]], [[0, 1, 0], [2, 1, 0], [4, 1, 0]], [[0.25, 0.25], [0.25, 0.25], [0.5, 0.1]],
                       name="row")
    return scene


@pytest.fixture
def rng():
    return np.random.default_rng(16)
