# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Robots of ROS that are written with macros: the package xacro expands them to URDF."""
import os
import tempfile

from ..errors import InputError
from .cells import package, wrong

_FOLDERS = 5  # that packages are sought in: the file's own and those above, as the program does


def _file_of(name, folder):
    """The file:// of what a mesh names, which is relative to the folder or package://NAME/REST."""
    if name.startswith("file://"):
        return name
    if not name.startswith("package://"):
        return "file://" + os.path.join(folder, name)
    name = name[len("package://"):]
    rest = name.partition("/")[2] or name
    for up in range(_FOLDERS):
        for tried in rest, name:
            at = os.path.join(folder, *[".."] * up, tried)
            if os.path.isfile(at):
                return "file://" + at
    return "file://" + os.path.join(folder, rest)


def expanded(path):
    """The bytes of the URDF file that a xacro file describes. Arguments have their defaults; meshes are named by absolute paths.

    A file that xacro refuses is an InputError, a missing package a ModuleNotFoundError that names it.
    """
    xacro = package("xacro", "load of .xacro files")
    if not os.path.isfile(path):
        raise wrong(path, "no such file")
    try:
        document = xacro.process_file(path)
    except Exception as problem:  # what macros evaluate may raise anything
        raise wrong(path, f"xacro: {problem}") from problem
    folder = os.path.dirname(os.path.abspath(path))
    for mesh in document.getElementsByTagName("mesh"):
        if mesh.getAttribute("filename"):
            mesh.setAttribute("filename", _file_of(mesh.getAttribute("filename"), folder))
    return document.toprettyxml(indent="  ", encoding="utf-8")


def load_xacro(path, read, no_outside=False):
    """What `read` makes of the URDF file that a xacro file describes. Mistakes are told with lines of the expanded text."""
    if no_outside:
        raise wrong(path, "no_outside: macros may read any file, so xacro files of strangers are not read")
    text = expanded(path)
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, os.path.basename(path).removesuffix(".xacro").removesuffix(".urdf") + ".urdf")
        with open(file, "wb") as out:
            out.write(text)
        try:
            return read(file)
        except InputError as error:
            raise InputError([message.replace(file, f"{path} (expanded)") for message in error.messages]) from None
