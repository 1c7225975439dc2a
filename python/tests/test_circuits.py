# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Circuits of SONATA and NeuroML: what stands where, by the files' own numbers, by libsonata, MorphIO and libNeuroML, and by rays."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest

import caplet
from caplet.bridges import cells
from shared_data import data

# A soma of radius 5 that is not at 0, a dendrite that tapers, an axon that forks.
NEURON = """1 1 3 4 5 5 -1
2 3 3 9 5 1 1
3 3 3 29 5 .5 2
4 2 3 -1 5 .75 1
5 2 3 -21 5 .5 4
6 2 13 -31 5 .25 5
7 2 -7 -31 9 .25 5
"""
SOMA = np.array([3.0, 4, 5])
STICK = "1 1 0 0 0 2 -1\n2 4 0 2 0 1 1\n3 4 0 42 0 1 2\n"
GREY = (0.55, 0.56, 0.52)


def sonata():
    return pytest.importorskip("libsonata"), pytest.importorskip("morphio"), pytest.importorskip("h5py")


def write_nodes(h5py, path, populations):
    """populations: {name: {attribute: values}}; lists of text are written with an @library where the attribute ends in "*"."""
    with h5py.File(path, "w") as file:
        for name, attributes in populations.items():
            group = file.create_group(f"nodes/{name}")
            attributes = dict(attributes)
            count = len(next(iter(attributes.values())))
            group["node_type_id"] = np.asarray(attributes.pop("node_type_id", np.full(count, -1)))
            group["node_group_id"], group["node_group_index"] = np.zeros(count, np.int64), np.arange(count)
            held = group.create_group("0")
            for key, values in attributes.items():
                if key.endswith("*"):
                    labels = sorted(set(values))
                    held[f"@library/{key[:-1]}"] = np.array(labels, dtype=h5py.string_dtype())
                    held[key[:-1]] = np.array([labels.index(one) for one in values], dtype=np.uint32)
                elif len(values) and isinstance(values[0], str):
                    held[key] = np.array(values, dtype=h5py.string_dtype())
                else:
                    held[key] = np.asarray(values)
    return path


def write_config(folder, populations, **more):
    """populations: {name: its properties}, all in nodes.h5."""
    types = more.pop("node_types_file", None)
    made = {"manifest": {"$BASE": "."}, "networks": {"nodes": [{"nodes_file": "$BASE/nodes.h5", "node_types_file": types, "populations": populations}],
                                                     "edges": []}, **more}
    (folder / "circuit_config.json").write_text(json.dumps(made))
    return str(folder / "circuit_config.json")


BIO = {"type": "biophysical", "biophysical_neuron_models_dir": "."}


def turned(q, points):
    """Points turned by a quaternion (w, x, y, z), by q p q* with Hamilton's product."""
    def product(a, b):
        return np.concatenate([[a[0] * b[0] - a[1:] @ b[1:]], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])

    q = np.asarray(q, dtype=np.float64) / np.linalg.norm(q)
    return np.array([product(product(q, np.array([0, *p])), q * [1, -1, -1, -1])[1:] for p in points])


def about(axis, angle, points):
    """Points turned about a fixed axis, by Rodrigues' formula."""
    k = np.eye(3)[axis]
    return np.array([p * math.cos(angle) + np.cross(k, p) * math.sin(angle) + k * (k @ p) * (1 - math.cos(angle)) for p in points])


def segments(morphio, path):
    """(p0, p1, radii) of all segments of a morphology's sections, as MorphIO has them."""
    held = [(a, b, (ra / 2, rb / 2)) for section in morphio.Morphology(path).iter()
            for a, b, ra, rb in zip(section.points[:-1], section.points[1:], section.diameters[:-1], section.diameters[1:])]
    return tuple(np.array([one[k] for one in held], dtype=np.float64) for k in range(3))


def capsules(scene, prefix, soma=False):
    """Sorted rows (p0, p1, radii) of all capsules of shapes whose names begin so."""
    parts = [scene[name] for name in scene.shapes if name.startswith(prefix) and (soma or not name.endswith("soma"))]
    return ordered(*(np.concatenate([getattr(part, key) for part in parts]) for key in ("p0", "p1", "radius")))


def ordered(*columns):
    rows = np.concatenate(columns, axis=1).astype(np.float64)
    return rows[np.lexsort(rows.T[::-1].round(4))]


# --- SONATA ---


@pytest.fixture
def circuit(tmp_path):
    """Five cells of two morphologies, turned by quaternions that are not of length 1, and three point neurons."""
    libsonata, morphio, h5py = sonata()
    rng = np.random.default_rng(7)
    (tmp_path / "morphologies").mkdir()
    (tmp_path / "morphologies/fork.swc").write_text(NEURON)
    (tmp_path / "morphologies/stick.swc").write_text(STICK)
    q = rng.normal(size=(5, 4))
    at = rng.uniform(-500, 500, (5, 3))
    cells = {"x": at[:, 0].astype("f4"), "y": at[:, 1].astype("f4"), "z": at[:, 2], "morphology": ["fork", "stick", "fork", "fork", "stick"],
             "mtype*": ["L5", "L2", "L2", "L5", "L5"], "depth": [0.0, 1, 2, 3, 4]}
    cells.update({f"orientation_{axis}": q[:, k] for k, axis in enumerate("wxyz")})
    points = {"x": [1000.0, 1010, 1020], "y": [0.0, 0, 0], "z": [0.0, 1, 2]}
    write_nodes(h5py, tmp_path / "nodes.h5", {"cells": cells, "points": points, "inputs": {"x": [0.0], "y": [0.0], "z": [0.0]}, "rates": {"rate": [1.0, 2]}})
    path = write_config(tmp_path, {"cells": {**BIO, "morphologies_dir": "$BASE/morphologies"}, "points": {"type": "point_neuron"}, "inputs": {"type": "virtual"}, "rates": {"type": "virtual"}},
                        node_sets_file="$BASE/sets.json")
    (tmp_path / "sets.json").write_text(json.dumps({"deep": {"mtype": "L5"}, "both": {"node_id": [0, 1], "population": "cells"}}))
    return path


def expected_places(h5py, libsonata, path, population, names):
    """{node: (its soma's place, function that turns)}, by h5py, which libsonata's arrays are compared with."""
    nodes = os.path.join(os.path.dirname(path), "nodes.h5")
    with h5py.File(nodes) as file:
        columns = {name: file[f"nodes/{population}/0/{name}"][:] for name in names}
    held = libsonata.NodeStorage(nodes).open_population(population)
    for name, values in columns.items():
        assert np.array_equal(held.get_attribute(name, held.select_all()), values)
    return columns


def test_cells_are_where_their_files_have_them(circuit):
    libsonata, morphio, h5py = sonata()
    scene = caplet.from_sonata(circuit)
    assert scene.objects == ["fork", "stick"] and scene.instances == 5 and scene.unit == "um"
    assert scene.shapes == ["points", "fork soma", "fork axon", "fork basal dendrite", "stick soma", "stick apical dendrite"]
    folder = os.path.dirname(circuit)
    for name in ("fork", "stick"):
        p0, p1, radii = segments(morphio, f"{folder}/morphologies/{name}.swc")
        assert np.array_equal(capsules(scene, name), ordered(p0, p1, radii))
    assert scene["fork soma"].p0.tolist() == [SOMA.tolist()] and scene["fork soma"].radius.tolist() == [[5, 5]]
    columns = expected_places(h5py, libsonata, circuit, "cells", [*"xyz", *(f"orientation_{axis}" for axis in "wxyz")])
    owners = scene.info["instances"]
    assert scene.info["populations"] == ["cells", "points"]
    assert owners[:, 0].tolist() == [0] * 5 and sorted(owners[:, 1]) == [0, 1, 2, 3, 4]
    points = np.concatenate([scene[name].p1 for name in ("fork axon", "fork basal dendrite")]).astype(np.float64)
    for number, (_, node) in enumerate(owners):
        place = scene.instance(number)
        soma = np.zeros(3) if node in (1, 4) else SOMA
        at = np.array([columns[axis][node] for axis in "xyz"], dtype=np.float64)
        q = [columns[f"orientation_{axis}"][node] for axis in "wxyz"]
        want = turned(q, points - soma) + at
        # Coordinates up to 600 in doubles, ten operations each: 600 * 2^-53 * 10 is 1e-12.
        assert np.allclose(points @ place[:3, :3].T + place[:3, 3], want, rtol=0, atol=1e-11)


def test_rays_meet_the_cells_and_tell_who_they_are(circuit):
    _, _, h5py = sonata()
    scene = caplet.from_sonata(circuit, radius=3)
    with h5py.File(os.path.join(os.path.dirname(circuit), "nodes.h5")) as file:
        at = np.stack([file[f"nodes/cells/0/{axis}"][:] for axis in "xyz"], axis=1)
    hits = caplet.trace(scene, at, (0, 0, 1), mode="all")  # from the somata's middles: out of a sphere of 5 or of 2
    for node, size in enumerate([5, 2, 5, 5, 2]):
        own = hits[(hits["ray"] == node) & (np.abs(hits["t"] - size) < 1e-3)]
        assert scene.info["instances"][own["instance"]].tolist() == [[0, node]]
        assert scene.shapes[own["shape"][0]] == ("stick soma" if size == 2 else "fork soma")
    hits = caplet.trace(scene, [[1010, 0, 51]], (0, 0, -1))
    assert hits["t"][0] == pytest.approx(47, abs=1e-4) and scene.shapes[hits["shape"][0]] == "points"
    assert scene.info["nodes"]["points"][hits["primitive"][0]] == 1


def test_angles_go_about_z_then_y_then_x(tmp_path):
    libsonata, _, h5py = sonata()
    (tmp_path / "stick.swc").write_text(STICK)
    angles = {"x": 0.3, "y": -1.1, "z": 2.5}
    for known in ("xyz", "z", "zx", "y"):
        held = {"x": [10.0], "y": [20.0], "z": [30.0], "morphology": ["stick"], **{f"rotation_angle_{axis}axis": [angles[axis]] for axis in known}}
        path = str(write_nodes(h5py, tmp_path / "nodes.h5", {"A": held}))
        scene = caplet.from_sonata(path, morphologies=tmp_path)
        want = np.array([[0, 42.0, 0]])
        for axis in "zyx":
            want = about("xyz".index(axis), angles[axis] if axis in known else 0, want)
        got = scene.instance(0) @ [0, 42, 0, 1]
        assert np.allclose(got[:3], want[0] + (10, 20, 30), atol=1e-12)
    # Quaternions go before angles.
    write_nodes(h5py, tmp_path / "nodes.h5", {"A": {**held, "orientation_w": [0.0], "orientation_x": [0.0], "orientation_y": [0.0], "orientation_z": [7.0]}})
    assert np.allclose(caplet.from_sonata(path, morphologies=tmp_path).instance(0)[:3, :3], np.diag([-1, -1, 1]))
    for size in (1e-300, 1e300):  # of any length
        write_nodes(h5py, tmp_path / "nodes.h5", {"A": {**held, **{f"orientation_{k}": [size] for k in "wxyz"}}})
        assert np.allclose(caplet.from_sonata(path, morphologies=tmp_path).instance(0)[:3, :3], [[0, 0, 1], [1, 0, 0], [0, 1, 0]])  # by 120 degrees about (1, 1, 1)


def test_somata_are_moved_to_the_node_unless_it_says_no(tmp_path):
    _, _, h5py = sonata()
    (tmp_path / "fork.swc").write_text(NEURON)
    (tmp_path / "outline.swc").write_text("1 1 0 0 0 3 -1\n2 1 6 0 0 3 1\n3 2 6 9 0 1 2\n4 2 6 19 0 1 3\n")
    held = {"x": [100.0] * 3, "y": [0.0] * 3, "z": [0.0] * 3, "morphology": ["fork", "fork", "outline"], "recenter": np.array([1, 0, 1], np.int8),
            "rotation_angle_zaxis": [np.pi / 2] * 3}
    scene = caplet.from_sonata(str(write_nodes(h5py, tmp_path / "nodes.h5", {"A": held})), morphologies=str(tmp_path))
    of = {int(node): scene.instance(k) for k, (_, node) in enumerate(scene.info["instances"])}
    assert np.allclose(of[0] @ [*SOMA, 1], (100, 0, 0, 1)) and np.allclose(of[0] @ [*(SOMA + (1, 0, 0)), 1], (100, 1, 0, 1))
    assert np.allclose(of[1] @ [*SOMA, 1], (100 - SOMA[1], SOMA[0], SOMA[2], 1))
    assert np.allclose(of[2] @ [3, 0, 0, 1], (100, 0, 0, 1))  # the mean of the soma's points


def test_every_format_of_morphologies_and_folders(tmp_path):
    _, morphio, h5py = sonata()
    from morphio.mut import Morphology
    for folder in ("swc", "h5", "asc"):
        (tmp_path / folder / "deep").mkdir(parents=True)
    (tmp_path / "swc/one.swc").write_text(STICK)
    outline = """("CellBody" (CellBody) (1 0 0 0.1) (0 1 0 0.1) (-1 0 0 0.1) (0 -1 0 0.1))
((Axon) (0 1 0 2) (0 31 0 1) (5 41 0 1))"""
    (tmp_path / "asc/three.asc").write_text(outline)
    (tmp_path / "two.asc").write_text(outline.replace("31", "-17"))
    Morphology(str(tmp_path / "two.asc")).write(str(tmp_path / "h5/deep/two.h5"))
    held = {"x": [0.0, 100, 200], "y": [0.0] * 3, "z": [0.0] * 3, "morphology": ["one.swc", "deep/two", "three"]}
    write_nodes(h5py, tmp_path / "nodes.h5", {"A": held})
    path = write_config(tmp_path, {"A": {**BIO, "morphologies_dir": "swc", "alternate_morphologies": {"h5v1": "h5", "neurolucida-asc": "asc"}}})
    scene = caplet.from_sonata(path)
    assert sorted(scene.objects) == ["one", "three", "two"]
    for name, file in (("one", "swc/one.swc"), ("two", "h5/deep/two.h5"), ("three", "asc/three.asc")):
        assert np.array_equal(capsules(scene, name), ordered(*segments(morphio, str(tmp_path / file))))
    assert scene["three soma"].p0.tolist() == [[0, 0, 0]] and scene["three soma"].radius.tolist() == [[1, 1]]  # of an outline the mean
    assert scene["three axon"].radius.tolist() == [[1, 0.5], [0.5, 0.5]]  # a file of diameters
    # A folder of one format holds no others.
    shutil.copy(tmp_path / "two.asc", tmp_path / "h5/three.asc")
    os.remove(tmp_path / "asc/three.asc")
    with pytest.raises(caplet.InputError, match=r"no morphology 'three' in .*/swc, .*/h5"):
        caplet.from_sonata(path)
    # A container holds them by their names.
    with h5py.File(tmp_path / "all.h5", "w") as file, h5py.File(tmp_path / "h5/deep/two.h5") as one:
        one.copy(one, file, name="deep/two")
    path = str(write_nodes(h5py, tmp_path / "nodes.h5", {"A": {name: values[1:2] for name, values in held.items()}}))
    assert caplet.from_sonata(path, morphologies=tmp_path / "all.h5").objects == ["deep/two"]


def test_thousands_of_cells_are_not_thousands_of_copies(tmp_path, monkeypatch):
    _, morphio, h5py = sonata()
    count = 20_000
    rng = np.random.default_rng(3)
    (tmp_path / "fork.swc").write_text(NEURON)
    (tmp_path / "stick.swc").write_text(STICK)
    names = ["fork", "stick"]
    which = rng.integers(0, 2, count)
    at = rng.uniform(0, 3000, (count, 3))
    held = {**dict(zip("xyz", at.T)), "morphology": [names[k] for k in which], "layer": rng.integers(1, 7, count)}
    path = str(write_nodes(h5py, tmp_path / "nodes.h5", {"A": held}))
    read = []
    real = morphio.Morphology
    monkeypatch.setattr(morphio, "Morphology", lambda path: read.append(path) or real(path))
    scene = caplet.from_sonata(path, morphologies=tmp_path)
    assert len(read) == 2 and scene.objects == names and scene.instances == count and len(scene.shapes) == 5
    order = scene.info["instances"][:, 1]
    assert sorted(order) == list(range(count))
    place = np.array([scene.instance(k)[:3, 3] for k in range(0, count, 97)])
    assert np.allclose(place + np.where(which[order[::97], None] == 0, SOMA, 0), at[order[::97]])
    colored = caplet.from_sonata(path, morphologies=tmp_path, color="layer")
    assert len(read) == 4 and len(colored.objects) == 12 and colored.instances == count


def albedo(scene, at, z=1e4):
    """The colour that is seen at a place from above: of 2304 samples whose wavelengths spread it by half or less, so that 0.02 is two deviations
    of a picture that is always the same."""
    seen = scene.copy()
    seen.camera = caplet.cameras.orthographic(screenwindow=(-0.05, 0.05, -0.05, 0.05), transform=np.array([[1.0, 0, 0, at[0]], [0, 1, 0, at[1]], [0, 0, -1, z], [0, 0, 0, 1]]))
    return caplet.render(seen, spp=256, size=(3, 3)).albedo.mean(axis=(0, 1))


def test_colors(circuit):
    linear = lambda code: [((int(code[k:k + 2], 16) / 255 + 0.055) / 1.055)**2.4 for k in (0, 2, 4)]  # noqa: E731
    libsonata, _, _ = sonata()
    nodes = libsonata.NodeStorage(os.path.join(os.path.dirname(circuit), "nodes.h5")).open_population("cells")
    at = np.stack([nodes.get_attribute(axis, nodes.select_all()) for axis in "xyz"], axis=1)
    close = {"rtol": 0, "atol": 0.02}
    scene = caplet.from_sonata(circuit, color="mtype")
    assert sorted(scene.objects) == ["fork L2", "fork L5", "stick L2", "stick L5"] and set(scene.info["colors"]) == {"L2", "L5", ""}
    assert scene.info["colors"][""] == (0.5, 0.5, 0.5)
    for label, code in (("L2", "1f77b4"), ("L5", "ff7f0e")):
        assert np.allclose(scene.info["colors"][label], linear(code), atol=0.004)  # of dark values the power is not quite a screen's
    for node, label in enumerate(["L5", "L2", "L2", "L5", "L5"]):
        assert np.allclose(albedo(scene, at[node]), scene.info["colors"][label], **close), node
    assert np.allclose(albedo(scene, (1010, 0)), scene.info["colors"][""], **close)
    scene = caplet.from_sonata(circuit)
    assert np.allclose(albedo(scene, at[0]), (0.86, 0.62, 0.22), **close) and np.allclose(albedo(scene, (1010, 0)), linear("ff7f0e")[:2] + [0.004], **close)
    scene = caplet.from_sonata(circuit, color="population")
    assert scene.objects == ["fork cells", "stick cells"] and np.allclose(albedo(scene, at[1]), scene.info["colors"]["cells"], **close)
    scene = caplet.from_sonata(circuit, color=(0.2, 0.4, 0.6))
    assert scene.objects == ["fork", "stick"] and np.allclose(albedo(scene, at[1]), (0.2, 0.4, 0.6), **close) and np.allclose(albedo(scene, (1010, 0)), (0.2, 0.4, 0.6), **close)
    scene = caplet.from_sonata(circuit, color="#336699")
    assert scene.objects == ["fork", "stick"] and all(np.allclose(albedo(scene, place), linear("336699"), **close) for place in (*at, (1010, 0), (1020, 0)))
    # Numbers: by the colour map's ends, those without one grey, with a colour bar.
    scene = caplet.from_sonata(circuit, color="depth")
    assert np.allclose(albedo(scene, at[0]), caplet.color_map(0.0, 0, 1)[0], **close) and np.allclose(albedo(scene, at[4]), caplet.color_map(1.0, 0, 1)[0], **close)
    assert np.allclose(albedo(scene, at[2]), caplet.color_map(8 / 15, 0, 1)[0], **close) and np.allclose(albedo(scene, (1010, 0)), 0.5, **close)
    caplet.render(scene, spp=1, size=(64, 48)).save("bar.png", color_bar=True)
    scene = caplet.from_sonata(circuit, population="cells", color=np.array([9.0, 0, np.nan, 4, 4]), low=0, high=4)
    assert np.allclose(albedo(scene, at[0]), caplet.color_map(1.0, 0, 1)[0], **close) and np.allclose(albedo(scene, at[2]), 0.5, **close)
    scene = caplet.from_sonata(circuit, population="points", ids=[0, 1], color=[0, 1], low=0, high=4)
    assert np.allclose(albedo(scene, (1010, 0)), caplet.color_map(1.0, 0, 4)[0], **close)
    given = np.linspace(0.05, 0.9, 15).reshape(5, 3)
    scene = caplet.from_sonata(circuit, population="cells", ids=[4, 0, 1, 3, 2], color=given)
    assert len(scene.objects) == 5 and np.allclose(albedo(scene, at[4]), given[0], **close) and np.allclose(albedo(scene, at[3]), given[3], **close)


def test_some_of_the_nodes(circuit):
    sonata()
    scene = caplet.from_sonata(circuit, population="cells", ids=[4, 1])
    assert scene.objects == ["stick"] and scene.info["instances"].tolist() == [[0, 4], [0, 1]] or scene.info["instances"].tolist() == [[0, 1], [0, 4]]
    full = caplet.from_sonata(circuit)
    for number, (_, node) in enumerate(scene.info["instances"]):
        other = full.info["instances"][:, 1].tolist().index(node)
        assert np.array_equal(scene.instance(number), full.instance(other))
    assert sorted(caplet.from_sonata(circuit, population="cells", ids="deep").info["instances"][:, 1]) == [0, 3, 4]
    assert sorted(caplet.from_sonata(circuit, ids="both").info["instances"][:, 1]) == [0, 1]
    assert caplet.from_sonata(circuit, population="inputs").info["nodes"]["inputs"].tolist() == [0]
    spheres = caplet.from_sonata(circuit, population=["points", "cells"], morphologies=False, radius=2)
    assert spheres.objects == [] and spheres.primitives == {"capsule": 8} and set(spheres.shapes) == {"cells", "points"}
    assert np.array_equal(spheres["points"].p0[:, 0], [1000, 1010, 1020]) and (spheres["cells"].radius == 2).all()


def test_node_types_are_read_from_their_table(tmp_path):
    _, _, h5py = sonata()
    (tmp_path / "m").mkdir()
    (tmp_path / "m/fork.swc").write_text(NEURON)
    (tmp_path / "m/stick.swc").write_text(STICK)
    (tmp_path / "types.csv").write_text('node_type_id population model_type morphology   pop_name rotation_angle_zaxis layer\n'
                                        '100 A biophysical fork.swc "e 4" 0.5 4\n7 A point_neuron NULL LIF NULL 5\n100 B biophysical stick NULL 0 1\n8 A biophysical stick "e 4" 1.5 6 \n\n')
    held = {"x": [0.0, 100, 200, 300], "y": [0.0] * 4, "z": [0.0] * 4, "node_type_id": [8, 100, 7, 100], "layer": [40, 50, 60, 70]}
    write_nodes(h5py, tmp_path / "nodes.h5", {"A": held})
    path = write_config(tmp_path, {"A": {}}, node_types_file="types.csv", components={"morphologies_dir": "$BASE/m", "biophysical_neuron_models_dir": "."})
    with pytest.raises(caplet.InputError, match=r"node 2: rotation_angle_zaxis is nan"):
        caplet.from_sonata(path)
    text = (tmp_path / "types.csv").read_text()
    (tmp_path / "types.csv").write_text(text.replace("LIF NULL", "LIF 0"))
    scene = caplet.from_sonata(path, color="pop_name")
    assert sorted(scene.objects) == ["fork e 4", "stick e 4"] and scene.info["nodes"]["A"].tolist() == [2] and set(scene.info["colors"]) == {"e 4", "LIF"}
    of = {int(node): scene.instance(k) for k, (_, node) in enumerate(scene.info["instances"])}
    assert sorted(of) == [0, 1, 3]
    assert np.allclose(of[0][:2, 0], (math.cos(1.5), math.sin(1.5))) and np.allclose(of[3][:2, 0], (math.cos(0.5), math.sin(0.5)))
    some = caplet.from_sonata(path, ids=[3, 0], color="layer")  # a node's own go before its type's
    assert {int(node) for node in some.info["instances"][:, 1]} == {0, 3} and sorted(some.objects) == ["fork color 15", "stick color 0"]
    again = caplet.from_sonata(path, ids=[3, 0, 2, 1])  # all of them, in another order
    assert {int(node): again.instance(k).tolist() for k, (_, node) in enumerate(again.info["instances"])} == {node: place.tolist() for node, place in of.items()}
    (tmp_path / "m/007.swc").write_text(STICK)  # a name that looks like a number
    (tmp_path / "types.csv").write_text(text.replace("LIF NULL", "LIF 0").replace("fork.swc", "007").replace("stick", "007"))
    assert caplet.from_sonata(path).objects == ["007"]
    (tmp_path / "types.csv").write_text(text.replace("100 A", "100 C"))
    with pytest.raises(caplet.InputError, match=r"node type 100 is not in .*types\.csv"):
        caplet.from_sonata(path)
    (tmp_path / "types.csv").write_text(text.replace("0.5 4", "0.5"))
    with pytest.raises(caplet.InputError, match=r"types\.csv:2: 6 fields; the first line has 7") as caught:
        caplet.from_sonata(path)
    assert caught.value.line == 2
    for wrong, says in (("id a\n1 2\n", ":1: there is no column node_type_id"), ("node_type_id a\nx 2\n", ":2: node_type_id"), ("", ":1: there is no column")):
        (tmp_path / "types.csv").write_text(wrong)
        with pytest.raises(caplet.InputError, match=says):
            caplet.from_sonata(path)


def test_a_billion_nodes_are_announced_and_some_are_shown(tmp_path):
    _, _, h5py = sonata()
    import resource
    path, count = str(tmp_path / "nodes.h5"), 10**9
    with h5py.File(path, "w") as file:
        for name in ("node_type_id", "node_group_id", "node_group_index"):
            file.create_dataset(f"nodes/A/{name}", (count,), "i8", chunks=(1 << 16,))
        for name, value in (("x", 1.5), ("y", 0), ("z", 0)):
            file.create_dataset(f"nodes/A/0/{name}", (count,), "f4", chunks=(1 << 16,), fillvalue=value)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(caplet.InputError, match="1000000000 nodes; at most 10000000 are shown: ids=") as caught:
        caplet.from_sonata(path)
    assert caught.value.file == path
    scene = caplet.from_sonata(path, ids=[5, count - 1], radius=1)
    assert scene.info["nodes"]["A"].tolist() == [5, count - 1] and scene["A"].p0[:, 0].tolist() == [1.5, 1.5]
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 300_000  # KB; a column would be 4 GB


def test_configurations_that_name_no_populations(tmp_path):
    """As those of the Allen Institute's tools are."""
    _, _, h5py = sonata()
    for folder in ("network", "components/morphologies"):
        (tmp_path / folder).mkdir(parents=True)
    (tmp_path / "components/morphologies/stick.swc").write_text(STICK)
    places = {axis: [0.0, 100] for axis in "xyz"}
    write_nodes(h5py, tmp_path / "network/nodes.h5", {"v1": {**places, "node_type_id": [1, 2]}})
    write_nodes(h5py, tmp_path / "network/outside.h5", {"lgn": {**places, "node_type_id": [5, 5]}})
    (tmp_path / "network/types.csv").write_text("node_type_id population model_type morphology\n1 v1 biophysical stick.swc\n2 v1 point_neuron NULL\n")
    (tmp_path / "network/outside.csv").write_text("node_type_id model_type\n5 virtual\n")
    made = {"manifest": {"$BASE_DIR": ".", "$NET": "$BASE_DIR/network", "$PARTS": "$BASE_DIR/components"},
            "components": {"morphologies_dir": "$PARTS/morphologies", "biophysical_neuron_models_dir": "$PARTS"},
            "networks": {"nodes": [{"nodes_file": "$NET/nodes.h5", "node_types_file": "$NET/types.csv"},
                                   {"nodes_file": "$NET/outside.h5", "node_types_file": "$NET/outside.csv"}], "edges": []}}
    path = tmp_path / "circuit_config.json"
    path.write_text(json.dumps(made))
    scene = caplet.from_sonata(path)
    assert scene.info["populations"] == ["v1"] and scene.objects == ["stick"] and scene.info["nodes"]["v1"].tolist() == [1]
    assert scene.info["instances"].tolist() == [[0, 0]]
    assert caplet.from_sonata(path, population="lgn").info["nodes"]["lgn"].tolist() == [0, 1]
    os.remove(tmp_path / "network/outside.h5")
    with pytest.raises(caplet.InputError, match="circuit_config.json: there is no file .*outside.h5"):
        caplet.from_sonata(path)


def test_types_of_few_of_many_nodes(tmp_path):
    _, _, h5py = sonata()
    (tmp_path / "stick.swc").write_text(STICK)
    (tmp_path / "types.csv").write_text("node_type_id morphology\n0 NULL\n1 stick\n")
    count, ids = 3_000_000, [2_999_999, 5, 1_500_000, 2_200_000]
    with h5py.File(tmp_path / "nodes.h5", "w") as file:
        for name in ("node_type_id", "node_group_id", "node_group_index"):
            file.create_dataset(f"nodes/A/{name}", (count,), "i8", chunks=(1 << 14,))
        for axis in "xyz":
            file.create_dataset(f"nodes/A/0/{axis}", (count,), "f4", chunks=(1 << 14,))
        for node in (2_999_999, 1_500_000, 6):
            file["nodes/A/node_type_id"][node] = 1
    path = write_config(tmp_path, {"A": {**BIO, "morphologies_dir": "."}}, node_types_file="types.csv")
    scene = caplet.from_sonata(path, ids=ids)
    assert sorted(scene.info["instances"][:, 1]) == [1_500_000, 2_999_999] and scene.info["nodes"]["A"].tolist() == [5, 2_200_000]


def test_what_circuits_cannot_give(circuit, tmp_path):
    _, _, h5py = sonata()
    folder = pathlib.Path(circuit).parent
    nodes = str(folder / "nodes.h5")
    good = {"x": [0.0, 1], "y": [0.0, 1], "z": [0.0, 1]}

    def with_nodes(**more):
        return str(write_nodes(h5py, tmp_path / "some.h5", {"A": {**good, **more}}))

    def config(text):
        (tmp_path / "c.json").write_text(text)
        return str(tmp_path / "c.json")

    (folder / "morphologies/broken.swc").write_text("1 1 0 0 zero 1 -1\n")
    (folder / "morphologies/notes.txt").write_text(NEURON)
    (folder / "morphologies/two.asc").write_text("(\n(Axon) (0 1 . 2))")
    (folder / "morphologies/flat.swc").write_text("1 1 0 0 0 0 -1\n2 2 0 1 0 0 1\n3 2 0 2 0 0 2\n")
    edges = '"edges": []'
    morphologies = str(folder / "morphologies")
    for make, says in (
            (lambda: caplet.from_sonata("none.json"), "none.json: no such file"), (lambda: caplet.from_sonata(str(tmp_path)), "no such file"),
            (lambda: caplet.from_sonata(config('{"networks": \n  nodes}')), r"c\.json:2:3: "), (lambda: caplet.from_sonata(config("[" * 100000)), "no circuit configuration"),
            (lambda: caplet.from_sonata(config("{}")), "c.json: .*networks"), (lambda: caplet.from_sonata(config("[]")), "c.json: "),
            (lambda: caplet.from_sonata(config('{"networks": {"nodes": [{"nodes_file": "none.h5", "populations": {"A": {"type": "point_neuron"}}}], %s}}' % edges)), "c.json: population 'A': there is no file .*none.h5"),
            (lambda: caplet.from_sonata(config('{"networks": {"nodes": [], %s}}' % edges)), "c.json: "),
            (lambda: caplet.from_sonata(str(shutil.copy(circuit, "text.h5"))), "text.h5: .*HDF5"), (lambda: caplet.from_sonata(circuit, population="none"), "no 'none'; it has 'cells'"),
            (lambda: caplet.from_sonata(circuit, population=3), "population"), (lambda: caplet.from_sonata(circuit, population=[]), "population"),
            (lambda: caplet.from_sonata(circuit, population="rates"), "population 'rates': its nodes have no x, y, z"),
            (lambda: caplet.from_sonata(circuit, ids=[0]), "of which population"), (lambda: caplet.from_sonata(circuit, population="cells", ids=[5]), "5 nodes"),
            (lambda: caplet.from_sonata(circuit, population="cells", ids=[-1]), "negative"), (lambda: caplet.from_sonata(circuit, population="cells", ids=[1, 1]), "once"),
            (lambda: caplet.from_sonata(circuit, population="cells", ids=[0.5]), "whole"), (lambda: caplet.from_sonata(circuit, ids="none"), "node set 'none'"),
            (lambda: caplet.from_sonata(nodes, ids="deep"), "no node sets"), (lambda: caplet.from_sonata(circuit, color="none"), "no 'none'.*mtype"),
            (lambda: caplet.from_sonata(circuit, color=[1.0, 2]), "color"), (lambda: caplet.from_sonata(circuit, color=np.full((8, 3), 2.0)), "0 to 1"),
            (lambda: caplet.from_sonata(circuit, color="depth", low=3, high=2), "low"), (lambda: caplet.from_sonata(circuit, radius=-1), "radi"),
            (lambda: caplet.from_sonata(circuit, morphologies="none"), "no 'none'"), (lambda: caplet.from_sonata(nodes), "node 0 has morphology 'fork', and no folder"),
            (lambda: caplet.from_sonata(circuit, morphologies=tmp_path), r"population 'cells': node 0: there is no morphology 'fork' in"),
            (lambda: caplet.from_sonata(with_nodes(morphology=["", "notes.txt"]), morphologies=morphologies), "node 1: there is no morphology 'notes.txt'"),
            (lambda: caplet.from_sonata(with_nodes(y=[0.0, np.nan])), "population 'A': node 1: y is nan"), (lambda: caplet.from_sonata(with_nodes(y=["a", "b"])), "y: numbers"),
            (lambda: caplet.from_sonata(with_nodes(orientation_w=[1.0, 1])), "has orientation_w and not all"),
            (lambda: caplet.from_sonata(with_nodes(**{f"orientation_{k}": [1.0, 0] for k in "wxyz"})), "node 1: its orientation is 0"),
            (lambda: caplet.from_sonata(with_nodes(z=[1.0])), "some.h5: population 'A': "),
            (lambda: caplet.from_sonata(with_nodes(morphology=["broken", ""]), morphologies=morphologies), r"broken\.swc:1: "),
            (lambda: caplet.from_sonata(with_nodes(morphology=["two", ""]), morphologies=morphologies), r"two\.asc:2: .*converting"),
            (lambda: caplet.from_sonata(with_nodes(morphology=["flat", ""]), morphologies=morphologies), "flat.swc: .*nothing to show"),
            (lambda: caplet.from_sonata(str(write_nodes(h5py, tmp_path / "e.h5", {"A": {name: np.empty(0) for name in "xyz"}}))), "no nodes"),
            (lambda: caplet.from_sonata(str(write_nodes(h5py, tmp_path / "e.h5", {"A": {"x": [1.0]}}))), "no population has nodes with x, y and z")):
        with pytest.raises(caplet.InputError, match=says):
            make()
    with h5py.File(with_nodes(**{"mtype*": ["a", "b"]}), "a") as file:
        file["nodes/A/0/mtype"][1] = 9
    with pytest.raises(caplet.InputError, match="beyond the 2 names"):
        caplet.from_sonata(str(tmp_path / "some.h5"), color="mtype")
    many = str(write_nodes(h5py, tmp_path / "many.h5", {"A": {**{k: np.zeros(300) for k in "xyz"}, "morphology": [f"m{k}" for k in range(300)]}}))
    with pytest.raises(caplet.InputError, match="280 more morphologies are missing") as caught:
        caplet.from_sonata(many, morphologies=morphologies)
    assert len(caught.value.messages) == 21 and caught.value.file == many
    many = str(write_nodes(h5py, tmp_path / "many.h5", {"A": {**{k: np.zeros(300) for k in "xyz"}, "morphology": ["fork"] * 300}}))
    with pytest.raises(caplet.InputError, match="300 different colours of cells; at most 256"):
        caplet.from_sonata(many, morphologies=morphologies, color=np.linspace(0, 1, 900).reshape(300, 3))


def test_what_is_wrong_with_node_sets_is_said_of_their_file(circuit, tmp_path):
    with pytest.raises(caplet.InputError, match="node set 'none'") as caught:
        caplet.from_sonata(circuit, ids="none")
    assert caught.value.file == str(tmp_path / "sets.json")
    (tmp_path / "sets.json").write_text("[")
    with pytest.raises(caplet.InputError, match="node set 'deep'") as caught:
        caplet.from_sonata(circuit, ids="deep")
    assert caught.value.file == str(tmp_path / "sets.json")


def test_files_are_named_by_texts_bytes_and_paths(circuit):
    pytest.importorskip("neuroml.loaders")
    for load, path in ((caplet.from_sonata, circuit), (caplet.from_neuroml, neuroml(CELL))):
        scenes = [load(name) for name in (path, os.fsencode(path), pathlib.Path(path))]
        for scene in scenes[1:]:
            assert scene.shapes == scenes[0].shapes and len(scene.shapes) > 1
            assert scene.objects == scenes[0].objects and np.array_equal(scene.bounds, scenes[0].bounds)


def test_files_are_let_go_of(tmp_path):
    _, _, h5py = sonata()
    path, errors = str(tmp_path / "nodes.h5"), []
    for count, bad in ((2, {"morphology": ["none", ""]}), (3, {"orientation_w": [1.0] * 3}), (400, {"y": ["a"] * 400})):
        write_nodes(h5py, path, {"A": {**{axis: np.arange(float(count)) for axis in "xyz"}, **bad}})
        with pytest.raises(caplet.InputError) as caught:
            caplet.from_sonata(path)
        errors.append(caught.value)  # with all that their frames hold
    write_nodes(h5py, path, {"A": {axis: np.arange(5.0) for axis in "xyz"}})
    assert caplet.from_sonata(path)["A"].p0[:, 0].tolist() == [0, 1, 2, 3, 4] and len(errors) == 3


def test_neurons_of_the_data(tmp_path):
    _, morphio, h5py = sonata()
    folder, name = data("swc/neuromorpho"), "C040600B3.CNG"
    held = {"x": [0.0, 500], "y": [0.0, 0], "z": [0.0, 0], "morphology": [name, name], "rotation_angle_yaxis": [0.0, 1]}
    scene = caplet.from_sonata(str(write_nodes(h5py, tmp_path / "nodes.h5", {"A": held})), morphologies=folder)
    p0, p1, radii = segments(morphio, f"{folder}/{name}.swc")
    assert len(p0) > 1000 and np.array_equal(capsules(scene, name), ordered(p0, p1, radii)) and scene.objects == [name]
    middle = morphio.Morphology(f"{folder}/{name}.swc").soma.center
    assert np.allclose(scene.instance(1) @ [*middle, 1], (500, 0, 0, 1), atol=1e-4)  # of 32-bit points up to 500
    assert scene.info["section"][f"{name} soma"].tolist() == [-1]
    sections = np.concatenate([ids for shape, ids in scene.info["section"].items() if not shape.endswith("soma")])
    assert len(sections) == len(p0) and set(sections) == {one.id for one in morphio.Morphology(f"{folder}/{name}.swc").iter()}


# --- NeuroML ---

CELL = """<cell id="pyramid"><morphology id="m">
<segment id="0" name="Soma"><proximal x="0" y="-5" z="0" diameter="10"/><distal x="0" y="5" z="0" diameter="12"/></segment>
<segment id="4" name="ball"><parent segment="0"/><proximal x="0" y="0" z="50" diameter="6"/><distal x="0" y="0" z="50" diameter="6"/></segment>
<segment id="1"><parent segment="0"/><distal x="0" y="45" z="0" diameter="4"/></segment>
<segment id="7"><parent segment="1" fractionAlong="0.25"/><distal x="30" y="15" z="0" diameter="1"/></segment>
<segment id="8"><parent segment="7" fractionAlong="0.5"/><distal x="15" y="10" z="9" diameter="0.5"/></segment>
<segment id="9"><parent segment="7" fractionAlong="0"/><distal x="0" y="15" z="-9" diameter="0.5"/></segment>
<segment id="2"><parent segment="0" fractionAlong="0"/><proximal x="0" y="-6" z="0" diameter="1"/><distal x="0" y="-30" z="0" diameter="0.5"/></segment>
<segment id="3"><parent segment="2"/><distal x="4" y="-40" z="0" diameter="0.25"/></segment>
<segment id="5"><parent segment="3"/><distal x="4" y="-50" z="0" diameter="0.25"/></segment>
<segmentGroup id="soma_group" neuroLexId="GO:0043025"><member segment="0"/></segmentGroup>
<segmentGroup id="tree"><subTree><from segment="7"/></subTree></segmentGroup>
<segmentGroup id="apical_dendrites" neuroLexId="GO:0030425"><member segment="1"/><include segmentGroup="tree"/></segmentGroup>
<segmentGroup id="dendrite_group" neuroLexId="GO:0030425"><include segmentGroup="apical_dendrites"/></segmentGroup>
<segmentGroup id="ModelViewParmSubset_1" neuroLexId="GO:0030424"><path><from segment="2"/><to segment="3"/></path></segmentGroup>
<segmentGroup id="Myelin_0"><member segment="5"/></segmentGroup>
<segmentGroup id="axon_of_nothing"><include segmentGroup="axon_of_nothing"/></segmentGroup>
<segmentGroup id="all"><include segmentGroup="dendrite_group"/><include segmentGroup="soma_group"/><include segmentGroup="all"/></segmentGroup>
</morphology></cell>"""
# By hand: id: proximal, distal (x, y, z, diameter), SWC type. 7 begins a quarter along from (0, 5, 0; 12) to (0, 45, 0; 4).
WANT = {0: ((0, -5, 0, 10), (0, 5, 0, 12), 1), 4: ((0, 0, 50, 6), (0, 0, 50, 6), 0), 1: ((0, 5, 0, 12), (0, 45, 0, 4), 4), 7: ((0, 15, 0, 10), (30, 15, 0, 1), 4),
        8: ((15, 15, 0, 5.5), (15, 10, 9, 0.5), 4), 9: ((0, 15, 0, 10), (0, 15, -9, 0.5), 4), 2: ((0, -6, 0, 1), (0, -30, 0, 0.5), 2),
        3: ((0, -30, 0, 0.5), (4, -40, 0, 0.25), 2), 5: ((4, -40, 0, 0.25), (4, -50, 0, 0.25), 2)}
TYPES = {0: "undefined", 1: "soma", 2: "axon", 3: "basal dendrite", 4: "apical dendrite"}


def neuroml(text, name="cell.nml"):
    """A file of NeuroML with these elements."""
    pathlib.Path(name).write_text(f'<neuroml xmlns="http://www.neuroml.org/schema/neuroml2" id="test">\n{text}\n</neuroml>\n')
    return name


def test_segments_are_what_they_are_by_hand_and_by_libneuroml():
    loaders = pytest.importorskip("neuroml.loaders")
    path = neuroml(CELL)
    scene = caplet.from_neuroml(path)
    assert scene.unit == "um" and not scene.objects
    assert scene.shapes == ["pyramid undefined", "pyramid soma", "pyramid axon", "pyramid apical dendrite"]
    seen = {}
    for name in scene.shapes:
        shape = scene[name]
        for row, segment in enumerate(scene.info["segment"][name]):
            seen[int(segment)] = (*shape.p0[row], 2 * shape.radius[row, 0]), (*shape.p1[row], 2 * shape.radius[row, 1]), name
    assert set(seen) == set(WANT)
    own = loaders.read_neuroml2_file(path).cells[0]
    for number, (proximal, distal, kind) in WANT.items():
        assert seen[number] == (proximal, distal, f"pyramid {TYPES[kind]}"), number  # all of these are exact in 32 bits
        ends = own.get_actual_proximal(number), own.get_segment(number).distal
        assert [(one.x, one.y, one.z, one.diameter) for one in ends] == [proximal, distal]
    hits = caplet.trace(scene, [[0, 0, 99], [0, -20, 99], [0, 25, 99]], (0, 0, -1))
    assert hits["t"][0] == pytest.approx(46, abs=1e-4)
    assert [scene.shapes[k] for k in hits["shape"]] == ["pyramid undefined", "pyramid axon", "pyramid apical dendrite"]
    assert [int(scene.info["segment"][scene.shapes[hit["shape"]]][hit["primitive"]]) for hit in hits] == [4, 2, 1]
    one = caplet.from_neuroml(path, cell="pyramid", color=(0.1, 0.2, 0.3))
    assert one.shapes == scene.shapes and np.allclose(albedo(one, (0, -20), 99), (0.1, 0.2, 0.3), atol=0.02)
    assert np.allclose(albedo(scene, (0, -20), 99), (0.20, 0.62, 0.95), atol=0.02) and np.allclose(albedo(scene, (0, 0), 99), GREY, atol=0.02)


def test_long_chains_and_trees_out_of_order():
    pytest.importorskip("neuroml")
    count = 3000
    rng = np.random.default_rng(5)
    at = np.cumsum(rng.normal(size=(count + 1, 3)).round(3), axis=0)
    lines = [f'<segment id="{k}"><parent segment="{k - 1}"/><distal x="{x}" y="{y}" z="{z}" diameter="1"/></segment>' for k, (x, y, z) in enumerate(at[1:].tolist())]
    x, y, z = at[0].tolist()
    lines[0] = lines[0].replace('<parent segment="-1"/>', f'<proximal x="{x}" y="{y}" z="{z}" diameter="1"/>')
    path = neuroml('<cell id="c"><morphology id="m">' + "".join(lines[k] for k in rng.permutation(count)) + "</morphology></cell>")
    scene = caplet.from_neuroml(path)
    ids = scene.info["segment"]["c undefined"]
    # 32-bit floats: at most half a unit in the last place of numbers below 128.
    assert np.abs(at).max() < 256 and np.allclose(scene["c undefined"].p0, at[ids], atol=1e-5) and np.allclose(scene["c undefined"].p1, at[ids + 1], atol=1e-5)


NETWORK = """<include href="parts/pyramid.cell.nml"/><include href="parts/dynamics.xml"/><izhikevichCell id="iz" v0="-70mV" thresh="30mV" a="0.02" b="0.2" c="-65" d="6"/>
<network id="net">
<population id="cells" component="pyramid" size="3" type="populationList"><property tag="color" value="0.8 0.1 0.2"/>
<instance id="3"><location x="0" y="0" z="0"/></instance><instance id="5"><location x="100" y="-20" z="30"/></instance><instance id="6"><location x="200" y="0" z="0"/></instance></population>
<population id="others" component="pyramid" size="1000000000"/>
<population id="points" component="iz" size="2" type="populationList"><property tag="radius" value="7"/><property tag="color" value="0.1 0.6 0.1"/>
<instance id="0"><location x="0" y="500" z="0"/></instance><instance id="1"><location x="50" y="500" z="0"/></instance></population>
<population id="more" component="lems" size="1" type="populationList"><instance id="9"><location x="0" y="600" z="0"/></instance></population>
<population id="nowhere" component="iz" size="4"/>
</network>"""


def test_networks_are_instances():
    pytest.importorskip("neuroml")
    os.mkdir("parts")
    neuroml('<include href="../net.nml"/>' + CELL, "parts/pyramid.cell.nml")  # a circle of includes
    pathlib.Path("parts/dynamics.xml").write_text("<Lems></Lems>")
    path = neuroml(NETWORK, "net.nml")
    scene = caplet.from_neuroml(path, radius=2)
    assert scene.objects == ["pyramid"] and scene.instances == 4 and scene.primitives == {"capsule": 4 * 9 + 3}
    assert scene.info["populations"] == ["cells", "others", "points", "more", "nowhere"]
    assert scene.info["instances"].tolist() == [[0, 3], [0, 5], [0, 6], [1, 0]]
    assert np.array_equal(scene.instance(1), [[1, 0, 0, 100], [0, 1, 0, -20], [0, 0, 1, 30], [0, 0, 0, 1]]) and np.array_equal(scene.instance(3), np.eye(4))
    assert (scene["points"].radius == 7).all() and scene["points"].p0.tolist() == [[0, 500, 0], [50, 500, 0]] and scene.info["nodes"]["points"].tolist() == [0, 1]
    assert (scene["more"].radius == 2).all() and "nowhere" not in scene.shapes
    hit = caplet.trace(scene, (100, -20, 199), (0, 0, -1))[0]
    assert hit["t"] == pytest.approx(199 - 80 - 3, abs=1e-4) and scene.info["instances"][hit["instance"]].tolist() == [0, 5]
    assert np.allclose(albedo(scene, (0, 500), 99), (0.1, 0.6, 0.1), atol=0.02)
    scene = caplet.from_neuroml(path, color="population")
    assert scene.objects == ["pyramid", "pyramid others"] and np.allclose(albedo(scene, (100, -45), 99), (0.8, 0.1, 0.2), atol=0.02)
    assert caplet.from_neuroml(path, cell="pyramid").instances == 0


def test_morphologies_beside_their_cells():
    pytest.importorskip("neuroml")
    inner = CELL[CELL.index("<morphology"):CELL.index("</cell>")]
    path = neuroml(f'{inner}<cell id="a" morphology="m"/><cell2CaPools id="b">{inner}</cell2CaPools>')
    scene = caplet.from_neuroml(path)
    assert scene.primitives == {"capsule": 18} and np.array_equal(scene["a axon"].p0, scene["b axon"].p0)
    alone = caplet.from_neuroml(neuroml(inner))
    assert alone.primitives == {"capsule": 9} and np.array_equal(alone["m axon"].p0, scene["a axon"].p0)
    named = caplet.from_neuroml(neuroml(CELL.replace('name="ball"', 'name="dend_4"').replace('name="Soma"', 'name="axon"')))  # groups go before names
    assert named.info["segment"]["pyramid basal dendrite"].tolist() == [4] and named.info["segment"]["pyramid soma"].tolist() == [0]


def test_what_neuroml_cannot_give():
    pytest.importorskip("neuroml")

    def cell(inner):
        return neuroml(f'<cell id="c">\n<morphology id="m">\n{inner}\n</morphology></cell>')

    root = '<segment id="0"><proximal x="0" y="0" z="0" diameter="1"/><distal x="1" y="0" z="0" diameter="1"/></segment>'
    distal = '<distal x="1" y="0" z="0" diameter="1"/>'
    pathlib.Path("text.nml").write_text("neuron")
    pathlib.Path("lems.xml").write_text("<Lems/>")
    pathlib.Path("bomb.nml").write_text('<!DOCTYPE l [<!ENTITY a "aaaaaaaaaa">' + "".join(
        f'<!ENTITY {chr(98 + k)} "{f"&{chr(97 + k)};" * 10}">' for k in range(9)) + ']><neuroml xmlns="http://www.neuroml.org/schema/neuroml2"><notes>&j;</notes></neuroml>')
    network = '<network id="n"><population id="p" component="{}" size="1">{}</population></network>'
    for make, says, line in (
            (lambda: "none.nml", "none.nml: no such file", None), (lambda: "text.nml", "text.nml:1:1: ", 1), (lambda: "bomb.nml", "entity", 1), (lambda: "lems.xml", "no NeuroML 2", None),
            (lambda: neuroml("<cell id='c'>"), r"cell.nml:2: .*cell", 2), (lambda: neuroml(""), "no cells", None), (lambda: neuroml("<cell id='c'/>"), "cell 'c': has no morphology", 2),
            (lambda: neuroml("<cell id='c' morphology='z'/>"), "no morphology 'z'", 2), (lambda: cell(""), "has no segments", 3),
            (lambda: cell(root + "\n" + root), "segment 0 is there twice", 5), (lambda: cell(f'<segment id="x">{distal}</segment>'), r"integer", 4),
            (lambda: cell(f'<segment id="3">{distal}</segment>'), "segment 3 has neither", 4), (lambda: cell('<segment id="3"/>'), "segment 3 has no distal", 4),
            (lambda: cell(root + f'\n<segment id="1"><parent segment="9"/>{distal}</segment>'), "segment 1: there is no segment 9, its parent", 5),
            (lambda: cell(f'<segment id="5"><parent segment="5"/>{distal}</segment>'), "segment 5 is its own ancestor", 4),
            (lambda: cell(root + f'\n<segment id="1"><parent segment="3"/>{distal}</segment><segment id="2"><parent segment="1"/>{distal}</segment>'
                          f'<segment id="3"><parent segment="2"/>{distal}</segment>'), "segment 1 is its own ancestor, by 1, 3, 2$", 5),
            (lambda: cell(root.replace('x="0"', 'x="nan"')), "segment 0: its proximal is nan", 4), (lambda: cell(root.replace('diameter="1"', 'diameter="-1"')), "its distal is 1.0, 0.0, 0.0, -1.0", 4),
            (lambda: cell(root.replace('diameter="1"/></s', '/></s')), "lacks x, y, z or diameter", 4),
            (lambda: cell(root + f'\n<segment id="1"><parent segment="0" fractionAlong="1.5"/>{distal}</segment>'), "fractionAlong is 1.5", 5),
            (lambda: cell(root.replace('diameter="1"', 'diameter="0"')), "all diameters are 0", 2),
            (lambda: cell(root + '<segmentGroup id="soma"><include segmentGroup="z"/></segmentGroup>'), "includes 'z'", 4),
            (lambda: neuroml('\n<include href="none.nml"/>'), "includes none.nml, which is no file", 3), (lambda: neuroml('<include href="a.nml.h5"/>', "a.nml.h5"), "HDF5", None),
            (lambda: neuroml(CELL + CELL.replace('"m"', '"k"')), "two cells 'pyramid'", 20), (lambda: neuroml(network.format("z", "")), "there is no cell 'z'", 2),
            (lambda: neuroml(CELL + network.format("pyramid", '<instance id="4"/>')), "instance 4 lacks a location", 20),
            (lambda: neuroml(CELL + network.format("pyramid", '<instance id="4"><location x="inf" y="0" z="0"/></instance>')), "instance 4 is at inf", 20),
            (lambda: neuroml('<izhikevichCell id="iz"/>' + network.format("iz", "")), "no cells with segments or locations", None)):
        path = make()
        with pytest.raises(caplet.InputError, match=says) as caught:
            caplet.from_neuroml(path)
        assert caught.value.line == line and os.path.basename(caught.value.file) == os.path.basename(path), says
    path = neuroml(CELL)
    for wrong, says in ((lambda: caplet.from_neuroml(path, cell="z"), "no 'z'; it has 'pyramid'"), (lambda: caplet.from_neuroml(path, color="mtype"), "color"),
                        (lambda: caplet.from_neuroml(path, color="population"), "no populations"), (lambda: caplet.from_neuroml(path, color=(2, 0, 0)), "reflectance")):
        with pytest.raises(caplet.InputError, match=says):
            wrong()


# --- Both ---


@pytest.mark.parametrize("call, module, package", [("from_sonata('file.h5')", "libsonata", "libsonata"), ("from_neuroml('file.nml')", "neuroml", "libneuroml")])
def test_a_package_that_is_missing_is_named(call, module, package):
    pathlib.Path("file.h5").write_text("")
    code = f"import sys; sys.modules[{module!r}] = None\nimport caplet\ntry:\n    caplet.{call}\nexcept ImportError as problem:\n    print(problem)"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.strip() == f"caplet.{call.split('(')[0]} needs the package {package}: pip install {package}"


def test_palette_tells_many_kinds_apart():
    found = cells.categories(200)
    assert found.shape == (200, 3) and found.min() >= 0 and found.max() <= 1
    away = np.linalg.norm(found[:, None] - found[None], axis=2) + np.eye(200)
    assert away.min() > 1e-4 and away[:24, :24].min() > 0.02
