#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Writes the files beside it by other programs: scalars.trk (nibabel), scalars.trx (trx-python), scalars.vtk, old.vtk and all .vtp (VTK).

usage: make.py    needs the packages nibabel, trx-python and vtk of the package index

Two fibres, of three points and of two. Of points: fa = 0.1 (i + 1), and three columns. Of fibres: weight 5 and -2.
"""
import pathlib

import nibabel
import numpy as np
import vtk
from trx.trx_file_memmap import TrxFile, save
from vtk.util.numpy_support import numpy_to_vtk

HERE = pathlib.Path(__file__).parent
POINTS = np.array([[0, 0, 0], [1, 0, 0], [2, 1, 0], [0, 0, 5], [0, 3, 5]], dtype=np.float32)
ENDS = (3, 5)
FA = np.array([[0.1], [0.2], [0.3], [0.4], [0.5]], dtype=np.float32)
COLUMNS = np.arange(15, dtype=np.float32).reshape(5, 3)
WEIGHT = np.array([[5], [-2]], dtype=np.float32)


def by_fibre(rows):
    return [rows[:ENDS[0]], rows[ENDS[0]:]]


def trk():
    tractogram = nibabel.streamlines.Tractogram(by_fibre(POINTS), affine_to_rasmm=np.eye(4))
    tractogram.data_per_point["columns"] = by_fibre(COLUMNS)
    tractogram.data_per_point["fa"] = by_fibre(FA)
    tractogram.data_per_streamline["weight"] = WEIGHT
    nibabel.streamlines.save(tractogram, str(HERE / "scalars.trk"))


def trx():
    file = TrxFile(nb_vertices=5, nb_streamlines=2)
    file.streamlines._data = POINTS.astype(np.float16)
    file.streamlines._offsets = np.array([0, 3], dtype=np.uint32)
    file.streamlines._lengths = np.array([3, 2], dtype=np.uint32)
    for name, rows in (("columns", COLUMNS), ("fa", FA)):
        sequence = nibabel.streamlines.ArraySequence()
        sequence._data, sequence._offsets, sequence._lengths = rows, file.streamlines._offsets, file.streamlines._lengths
        file.data_per_vertex[name] = sequence
    file.data_per_streamline["weight"] = WEIGHT
    save(file, str(HERE / "scalars.trx"))


def polydata():
    out = vtk.vtkPolyData()
    points = vtk.vtkPoints()
    for p in POINTS:
        points.InsertNextPoint(p.tolist())
    out.SetPoints(points)
    dots, lines = vtk.vtkCellArray(), vtk.vtkCellArray()
    dots.InsertNextCell(1, [4])  # a cell before the lines
    lines.InsertNextCell(3, [0, 1, 2])
    lines.InsertNextCell(2, [3, 4])
    out.SetVerts(dots)
    out.SetLines(lines)
    for name, rows, data in (("three columns", COLUMNS.astype(np.int16), out.GetPointData()), ("fa", FA[:, 0], out.GetPointData()),
                             ("weight", np.array([99, 5, -2], dtype=np.float64), out.GetCellData())):
        array = numpy_to_vtk(rows, deep=True)
        array.SetName(name)
        data.SetScalars(array) if name == "weight" else data.AddArray(array)
    return out


def vtk_file(name, version, is_binary):
    writer = vtk.vtkPolyDataWriter()
    writer.SetFileName(str(HERE / name))
    writer.SetInputData(polydata())
    writer.SetFileVersion(version)
    writer.SetFileTypeToBinary() if is_binary else writer.SetFileTypeToASCII()
    writer.Write()


def vtp_file(name, mode, *settings, pieces=1):
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetFileName(str(HERE / name))
    writer.SetInputData(polydata())
    getattr(writer, f"SetDataModeTo{mode}")()
    writer.SetNumberOfPieces(pieces)
    for setting in settings:
        setting(writer)
    writer.Write()


trk()
trx()
vtk_file("scalars.vtk", vtk.vtkPolyDataWriter.VTK_LEGACY_READER_VERSION_5_1, True)
vtk_file("old.vtk", vtk.vtkPolyDataWriter.VTK_LEGACY_READER_VERSION_4_2, False)
vtp_file("text.vtp", "Ascii")
vtp_file("packed.vtp", "Binary", lambda w: w.SetCompressorTypeToZLib(), lambda w: w.SetHeaderTypeToUInt32())
vtp_file("plain.vtp", "Binary", lambda w: w.SetCompressorTypeToNone(), lambda w: w.SetHeaderTypeToUInt64())
vtp_file("appended.vtp", "Appended", lambda w: w.SetCompressorTypeToZLib(), lambda w: w.SetBlockSize(48))
vtp_file("raw.vtp", "Appended", lambda w: w.SetCompressorTypeToNone(), lambda w: w.EncodeAppendedDataOff())
vtp_file("raw_packed.vtp", "Appended", lambda w: w.SetCompressorTypeToZLib(), lambda w: w.EncodeAppendedDataOff(), lambda w: w.SetHeaderTypeToUInt64())
vtp_file("big.vtp", "Appended", lambda w: w.SetCompressorTypeToZLib(), lambda w: w.SetByteOrderToBigEndian())
vtp_file("pieces.vtp", "Appended", lambda w: w.SetCompressorTypeToNone(), pieces=2)
