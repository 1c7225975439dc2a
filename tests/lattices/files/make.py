#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes lib3mf.3mf (lib3mf of the 3MF Consortium) and trx_python.trx (trx-python), which the tests read: files of other programs.

usage: make.py    needs the packages lib3mf and trx-python of the package index
"""
import pathlib

import lib3mf
import numpy as np
from trx.trx_file_memmap import TrxFile, save

HERE = pathlib.Path(__file__).parent


def position(*p):
    out = lib3mf.Position()
    for k in range(3):
        out.Coordinates[k] = p[k]
    return out


def beam(v1, v2, r1, r2, cap1, cap2):
    out = lib3mf.Beam()
    out.Indices[0], out.Indices[1] = v1, v2
    out.Radii[0], out.Radii[1] = r1, r2
    out.CapModes[0], out.CapModes[1] = cap1, cap2
    return out


def lattice():
    model = lib3mf.get_wrapper().CreateModel()
    model.SetUnit(lib3mf.ModelUnit.CentiMeter)
    mesh = model.AddMeshObject()
    mesh.SetName("frame")
    for p in ((0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (5, 5, 8)):
        mesh.AddVertex(position(*p))
    beams = mesh.BeamLattice()
    beams.SetMinLength(0.01)
    beams.SetBallOptions(lib3mf.BeamLatticeBallMode.Mixed, 1.5)
    sphere, half, butt = (lib3mf.BeamLatticeCapMode.Sphere, lib3mf.BeamLatticeCapMode.HemiSphere, lib3mf.BeamLatticeCapMode.Butt)
    beams.AddBeam(beam(0, 1, 0.5, 0.5, sphere, sphere))
    beams.AddBeam(beam(1, 2, 0.5, 0.5, sphere, half))
    beams.AddBeam(beam(2, 3, 0.5, 0.5, butt, sphere))
    beams.AddBeam(beam(3, 0, 0.5, 0.5, butt, butt))
    for corner in range(4):
        beams.AddBeam(beam(corner, 4, 1.0, 0.25, half, sphere))
    ball = lib3mf.Ball()
    ball.Index, ball.Radius = 4, 1.5
    beams.AddBall(ball)
    plate = model.AddMeshObject()
    for p in ((0, 0, -1), (10, 0, -1), (0, 10, -1), (0, 0, -3)):
        plate.AddVertex(position(*p))
    for corners in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)):
        triangle = lib3mf.Triangle()
        for k in range(3):
            triangle.Indices[k] = corners[k]
        plate.AddTriangle(triangle)
    colors = model.AddColorGroup()
    red = colors.AddColor(lib3mf.get_wrapper().RGBAToColor(255, 0, 0, 255))
    plate.SetObjectLevelProperty(colors.GetResourceID(), red)
    wrapper = lib3mf.get_wrapper()
    both = model.AddComponentsObject()
    both.AddComponent(mesh, wrapper.GetIdentityTransform())
    both.AddComponent(plate, wrapper.GetTranslationTransform(0, 0, -2))
    model.AddBuildItem(both, wrapper.GetIdentityTransform())
    model.AddBuildItem(both, wrapper.GetTranslationTransform(20, 0, 0))
    model.QueryWriter("3mf").WriteToFile(str(HERE / "lib3mf.3mf"))


def tracks():
    # 3 streamlines of 2, 3 and 1 points; values that 16 bits have.
    trx = TrxFile(nb_vertices=6, nb_streamlines=3)
    trx.streamlines._data[:] = np.array([[0, 0, 0], [1, 0.5, 0], [-2, 8, 1], [0.25, 100, 3], [4, 4, 4], [7, 0, -1]], np.float16)
    trx.streamlines._offsets[:] = [0, 2, 5, 6][: len(trx.streamlines._offsets)]
    trx.streamlines._lengths[:] = [2, 3, 1]
    trx.header["VOXEL_TO_RASMM"] = np.eye(4).tolist()
    save(trx, str(HERE / "trx_python.trx"))


if __name__ == "__main__":
    lattice()
    tracks()
