# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Robots of xacro are what their macros say. Skipped where the package xacro is not installed, but for what is said then."""
import sys

import numpy as np
import pytest

import caplet

ROBOT = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">
<xacro:property name="size" value="0.5"/>
<xacro:macro name="ball" params="name at"><link name="${name}"><visual><geometry><sphere radius="${size / 2}"/></geometry></visual></link>
<joint name="to_${name}" type="fixed"><parent link="base"/><child link="${name}"/><origin xyz="${at} 0 0"/></joint></xacro:macro>
<link name="base"><visual><geometry>%s</geometry></visual></link><xacro:ball name="a" at="1"/><xacro:ball name="b" at="${4 * size}"/></robot>"""
TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 0 3\nf 1 2 3\n"


def written(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def test_macros_are_expanded(tmp_path):
    pytest.importorskip("xacro")
    scene = caplet.load(written(tmp_path / "robot.urdf.xacro", ROBOT % '<box size="1 1 1"/>'), up="y")
    assert scene.primitives == {"box": 1, "sphere": 2}
    assert np.allclose(sorted(scene.shape(k).transform[0, 3] for k in range(3)), (0, 1, 2))
    assert np.allclose(scene.bounds, [(-0.5, -0.5, -0.5), (2.25, 0.5, 0.5)], atol=1e-6)


@pytest.mark.parametrize("name, at", [("part.obj", "a/urdf/part.obj"), ("package://robot/meshes/part.obj", "a/meshes/part.obj"),
                                      ("package://robot/meshes/part.obj", "robot/meshes/part.obj"),
                                      ("file://{}/far/part.obj", "far/part.obj")])
def test_meshes_are_found_from_the_file(tmp_path, name, at):
    pytest.importorskip("xacro")
    written(tmp_path / at, TRIANGLE)
    path = written(tmp_path / "a/urdf/robot.xacro", ROBOT % f'<mesh filename="{name.format(tmp_path)}"/>')
    scene = caplet.load(path, up="y")
    assert scene.primitives == {"triangle": 1, "sphere": 2} and np.isclose(scene.bounds[1, 2], 3)


def test_mistakes_name_the_file(tmp_path):
    pytest.importorskip("xacro")
    for text, told in ((ROBOT % "${1 / 0}", "division by zero"), ("<robot", "unclosed token"), ("<mujoco/>", "not <robot>"),
                       (ROBOT % '<box size="1"/>', r"\(expanded\):\d+:\d+: ")):
        path = written(tmp_path / "bad.xacro", text)
        with pytest.raises(caplet.InputError, match=told) as raised:
            caplet.load(path)
        assert raised.value.file.startswith(str(path))
    with pytest.raises(caplet.InputError, match="no such file"):
        caplet.load(tmp_path / "none.xacro")
    with pytest.raises(caplet.InputError, match="no_outside"):
        caplet.load(written(tmp_path / "fine.xacro", ROBOT % '<box size="1 1 1"/>'), no_outside=True)


def test_without_xacro_it_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "xacro", None)
    with pytest.raises(ModuleNotFoundError, match="pip install xacro"):
        caplet.load(written(tmp_path / "robot.xacro", ROBOT % '<box size="1 1 1"/>'))
