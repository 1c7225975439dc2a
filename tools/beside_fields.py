#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Pictures of each field's files beside those of the programs that the field uses, as docs/gallery.md shows them.

usage: beside_fields.py CAPLET DATA OUT [NAME...]

Left is Caplet's picture, right the other program's, of the same file at the same size: PyMOL (Debian's package `pymol`), MuJoCo's own
renderer, VTK by PyVista, and FURY. Needs Open Image Denoise, PyPI's mujoco, pyvista, 'fury<2' (later ones draw by
WebGPU), nibabel and pillow, OSMesa, and a display, as `xvfb-run -a` makes one. Prints the seconds that each command takes.
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("MUJOCO_GL", "osmesa")
import numpy as np
from PIL import Image

SIZE = (450, 380)


def timed(what, work, *args):
    begin = time.monotonic()
    out = work(*args)
    print(f"{what}: {time.monotonic() - begin:.1f} s", flush=True)
    return out


def caplet(program, file, out, *options):
    subprocess.run([program, "render", str(file), "-o", "none", "--preview", str(out), "--size", "{}x{}".format(*SIZE), "--spp", "64", "-q", *options], check=True)


def molecule(program, data, ours, theirs):
    file = data / "mol/pdb/1crn.pdb"
    timed("caplet, molecule", caplet, program, file, ours, "--style", "cartoon", "--color", "secondary", "--background", "white")
    commands = f"load {file}; hide everything; show cartoon; color red, ss h; color yellow, ss s; color green, ss l+''; bg_color white; orient; ray {SIZE[0]},{SIZE[1]}; png {theirs}"
    timed("PyMOL", lambda: subprocess.run(["pymol", "-cq", "-d", commands], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "PATH": "/usr/bin:/bin"}))


def robot(program, data, ours, theirs):
    import mujoco
    file = data / "mjcf/mujoco/humanoid/humanoid.xml"
    timed("caplet, robot", caplet, program, file, ours, "--camera", "side", "--denoise")

    def draw():
        model = mujoco.MjModel.from_xml_path(str(file))
        model.vis.global_.offwidth, model.vis.global_.offheight = SIZE
        state = mujoco.MjData(model)
        mujoco.mj_forward(model, state)
        with mujoco.Renderer(model, SIZE[1], SIZE[0]) as renderer:
            renderer.update_scene(state, camera="side")
            Image.fromarray(renderer.render()).save(theirs)
    timed("MuJoCo", draw)


def _plotter():
    """PyVista's window, white and smooth."""
    import pyvista
    plotter = pyvista.Plotter(off_screen=True, window_size=SIZE)
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    return plotter


def _branches(file):
    """Runs of points of a neuron, from each branch's first point to its last."""
    rows = {int(r[0]): r for r in (line.split() for line in open(file) if line.strip() and not line.startswith("#"))}
    children = {}
    for number, row in rows.items():
        children.setdefault(int(row[6]), []).append(number)
    for parent, ones in children.items():
        for one in ones:
            if parent in rows and len(children.get(parent, ())) == 1 and int(rows[parent][6]) in rows:
                continue
            run = ([parent] if parent in rows else []) + [one]
            while len(children.get(run[-1], ())) == 1:
                run.append(children[run[-1]][0])
            if len(run) > 1:
                yield np.array([[float(v) for v in rows[i][2:6]] for i in run])


def neuron(program, data, ours, theirs):
    import pyvista
    file = data / "swc/neuromorpho/C040600B3.CNG.swc"
    timed("caplet, neuron", caplet, program, file, ours, "--background", "white", "--view", "front", "--orthographic")

    def draw():
        plotter = _plotter()
        for points in _branches(file):
            line = pyvista.lines_from_points(points[:, :3])
            line["radius"] = points[:, 3]
            plotter.add_mesh(line.tube(scalars="radius", absolute=True), color="tab:blue")
        plotter.view_xy()
        plotter.enable_parallel_projection()
        plotter.screenshot(theirs)
    timed("PyVista", draw)


def streamlines(program, data, ours, theirs):
    import fury
    import nibabel
    if int(fury.__version__.split(".")[0]) >= 2:
        raise SystemExit(f"FURY before 2 is needed (pip install 'fury<2'), not {fury.__version__}")
    file = data / "fibres/streamlines/tracks300.trk"
    timed("caplet, streamlines", caplet, program, file, ours, "--view", "right", "--background", "black", "--radius", "0.4")

    def draw():
        lines = [np.asarray(line) for line in nibabel.streamlines.load(file).streamlines]
        scene = fury.window.Scene()
        scene.add(fury.actor.streamtube(lines, linewidth=0.4))
        middle = np.concatenate(lines).mean(axis=0)
        scene.set_camera(position=middle + (200, 0, 0), focal_point=middle, view_up=(0, 0, 1))
        scene.reset_camera()
        fury.window.record(scene=scene, out_path=str(theirs), size=SIZE, reset_camera=False)
    timed("FURY", draw)


def lattice(program, data, ours, theirs):
    import pyvista
    file = pathlib.Path(__file__).parents[1] / "scenes/lattice.capsules"
    timed("caplet, lattice", caplet, program, file, ours, "--view", "1,0.45,0.62", "--background", "white", "--outline", "1.2", "--depth-cue", "0.5")

    def draw():
        plotter = _plotter()
        for line in file.read_text().splitlines():
            numbers = re.findall(r"-?[0-9.]+(?:e-?[0-9]+)?", line.split("#")[0])
            if len(numbers) < 7:
                continue
            a, b, radius = np.array(numbers[:3], float), np.array(numbers[3:6], float), float(numbers[6])
            ball = np.array_equal(a, b)
            solid = pyvista.Sphere(radius=radius, center=a) if ball else pyvista.Tube(pointa=a, pointb=b, radius=radius)
            plotter.add_mesh(solid, color="#4f8fc0" if ball else "#c87860", smooth_shading=True)
        plotter.enable_ssao(radius=0.6)
        plotter.view_vector((1, 0.45, 0.62), (0, 1, 0))
        plotter.screenshot(theirs)
    timed("PyVista", draw)


def mesh(program, data, ours, theirs):
    file = data / "meshes/2CylinderEngine/2CylinderEngine.glb"
    timed("caplet, mesh", caplet, program, file, ours, "--view", "1,0.6,1.2", "--background", "white", "--denoise")

    def draw():
        plotter = _plotter()
        plotter.import_gltf(str(file))
        plotter.view_vector((1, 0.6, 1.2), (0, 1, 0))
        plotter.screenshot(theirs)
    timed("PyVista", draw)


def main(arguments):
    program, data, out = arguments[0], pathlib.Path(arguments[1]).resolve(), pathlib.Path(arguments[2])
    out.mkdir(parents=True, exist_ok=True)
    for one in (molecule, robot, neuron, streamlines, lattice, mesh):
        if arguments[3:] and one.__name__ not in arguments[3:]:
            continue
        with tempfile.TemporaryDirectory() as folder:
            ours, theirs = pathlib.Path(folder) / "a.png", pathlib.Path(folder) / "b.png"
            one(program, data, ours, theirs)
            both = Image.new("RGB", (2 * SIZE[0], SIZE[1]), "white")
            for place, part in enumerate((ours, theirs)):
                with Image.open(part) as image:
                    both.paste(image.convert("RGB"), (place * SIZE[0], 0))
            both.save(out / f"{one.__name__}.png", optimize=True)


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    main(sys.argv[1:])
