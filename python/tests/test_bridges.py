# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What comes from other packages is what they and the files themselves say. Each is skipped where its package is not installed."""
import math
import os
import pathlib

import numpy as np
import pytest

import caplet
from shared_data import data

EVERY_GEOM = """<mujoco><asset>
<hfield name="hills" nrow="7" ncol="9" size="2 3 0.7 0.1"/>
<mesh name="wedge" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/>
<material name="red" rgba="0.9 0.1 0.1 1"/></asset>
<worldbody>
<light pos="0 0 9" dir="0 0 -1"/><camera name="side" pos="0 -9 3" xyaxes="1 0 0 0 0.3 1" fovy="40"/>
<geom name="floor" type="plane" size="20 20 1" pos="0 0 -1"/>
<body pos="1 2 3" euler="10 20 30">
<geom name="ball" type="sphere" size="0.4" material="red"/>
<geom name="pill" type="capsule" size="0.2 0.6" pos="2 0 0" euler="40 0 10"/>
<geom name="egg" type="ellipsoid" size="0.3 0.5 0.8" pos="-2 0 0" euler="0 50 0"/>
<geom name="tin" type="cylinder" size="0.3 0.5" pos="0 2 0" euler="0 30 60"/>
<geom name="crate" type="box" size="0.3 0.4 0.5" pos="0 -2 0" euler="5 6 7"/>
<geom name="chip" type="mesh" mesh="wedge" pos="3 3 0"/>
<geom name="land" type="hfield" hfield="hills" pos="-5 4 0"/>
<geom name="ghost" type="sphere" size="0.4" pos="0 0 2" rgba="1 1 1 0"/>
<geom name="collision" type="sphere" size="0.4" pos="0 0 3" group="3"/>
</body></worldbody></mujoco>"""


def rays_around(model, data, rng, count):
    center, extent = np.asarray(model.stat.center), max(model.stat.extent, 0.5)
    around = rng.standard_normal((count, 3))
    origins = center + 2 * extent * around / np.linalg.norm(around, axis=1, keepdims=True)
    targets = np.asarray(data.geom_xpos)[rng.integers(0, model.ngeom, count)] + rng.normal(0, 0.1 * extent, (count, 3))
    way = targets - origins
    return origins.astype(np.float32).astype(float), (way / np.linalg.norm(way, axis=1, keepdims=True)).astype(np.float32).astype(float)


def mujoco_rays(mujoco, model, data, origins, directions, groups):
    chosen = np.array([group in groups for group in range(6)], dtype=np.uint8)
    t, geoms, found = np.empty(len(origins)), np.empty(len(origins), dtype=int), np.zeros((1, 1), dtype=np.int32)
    for i, (at, way) in enumerate(zip(origins, directions)):
        found = np.full((1, 1), -1, dtype=np.int32)
        t[i] = mujoco.mj_ray(model, data, at, way, chosen, 1, -1, found)
        geoms[i] = found[0, 0]
    return np.where(t < 0, np.inf, t), geoms


def same_hits(mujoco, model, data, scene, rng, count=3000, groups=(0, 1, 2)):
    """The share of rays whose nearest hit is that of MuJoCo: within 1e-5 of the model's extent, and on the same geom."""
    origins, directions = rays_around(model, data, rng, count)
    t, geoms = mujoco_rays(mujoco, model, data, origins, directions, groups)
    hits = caplet.trace(scene, origins, directions)
    both = np.isfinite(t) & np.isfinite(hits["t"])
    assert both.mean() > 0.2
    at = scene.info["geom"][hits["shape"].clip(max=len(scene.info["geom"]) - 1)]
    close = np.abs(np.where(both, hits["t"] - np.where(both, t, 0), 0)) < 1e-5 * max(1, 3 * model.stat.extent)
    agree = (np.isfinite(t) == np.isfinite(hits["t"])) & close & (~both | (at == geoms))
    return agree, origins, directions, t, geoms, hits


def test_every_kind_of_geom_is_where_mujoco_has_it(rng):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(EVERY_GEOM)
    field = rng.random(63)
    model.hfield_data[:] = (field - field.min()) / (field.max() - field.min())
    state = mujoco.MjData(model)
    mujoco.mj_forward(model, state)
    scene = caplet.from_mujoco(model, state)
    assert scene.shapes == ["floor", "ball", "pill", "egg", "tin", "crate", "chip", "land"]
    assert scene.primitives["sphere"] == 2 and scene.primitives["capsule"] == 1
    pill = scene["pill"]
    half = model.geom("pill").size[1]
    ends = np.array([[0, 0, -half, 1], [0, 0, half, 1]])
    place = np.eye(4)
    place[:3, :3], place[:3, 3] = state.geom("pill").xmat.reshape(3, 3), state.geom("pill").xpos
    got = np.concatenate([pill.p0, pill.p1]) @ pill.transform[:3, :3].T + pill.transform[:3, 3]
    assert np.allclose(got, (ends @ place.T)[:, :3], atol=1e-6)
    # MuJoCo's hulls of meshes are seen by rays as meshes; what touches edges may differ.
    agree, *_ = same_hits(mujoco, model, state, scene, rng)
    assert agree.mean() > 0.998, agree.mean()
    state.qpos[:] = state.qpos
    with pytest.raises(caplet.InputError, match="no camera"):
        caplet.from_mujoco(model, state, camera="top")
    with pytest.raises(caplet.InputError, match="studio"):
        caplet.from_mujoco(model, state, lights="none")
    assert len(caplet.from_mujoco(model, state, groups=None).shapes) == 9
    seen = caplet.from_mujoco(model, state, camera="side", lights="model")
    assert np.allclose(seen.camera[:3, 3], (0, -9, 3)) and seen.fov == pytest.approx(40)
    image = caplet.render(seen, spp=2, size=(64, 48))
    assert image.rgb.max() > 0 and {0, 1}.issubset(image.object_id.ravel().tolist())


@pytest.mark.parametrize("path", ["mujoco/humanoid/humanoid.xml", "mujoco/humanoid/humanoid100.xml", "mujoco/replicate/helix.xml",
                                  "dm_control_suite/humanoid.xml", "gymnasium/ant.xml"])
def test_robots_of_the_data(path, rng):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(data("mjcf", path))
    state = mujoco.MjData(model)
    mujoco.mj_forward(model, state)
    scene = caplet.from_mujoco(model, state)
    shown = [i for i in range(model.ngeom) if model.geom_group[i] in (0, 1, 2) and caplet.bridges.mujoco_looks.rgba_of(model, i)[3] > 0]
    assert scene.info["geom"].tolist() == shown
    for number, geom in enumerate(shown):
        assert np.abs(scene.shape(number).transform[:3, 3] - state.geom_xpos[geom]).max() < 1e-6
    agree, *_ = same_hits(mujoco, model, state, scene, rng, 1500)
    assert agree.mean() > 0.995, agree.mean()


def test_a_pose_is_followed(rng):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(data("mjcf", "mujoco/humanoid/humanoid.xml"))
    state = mujoco.MjData(model)
    mujoco.mj_forward(model, state)
    scene = caplet.from_mujoco(model, state)
    session = caplet.Session(scene, size=(32, 24))
    session.render(1)
    for _ in range(100):
        mujoco.mj_step(model, state)
    caplet.bridges.update_mujoco(scene, state)
    session.update(scene)
    agree, *_ = same_hits(mujoco, model, state, scene, rng, 1000)
    assert agree.mean() > 0.995
    session.render(1)
    fresh = caplet.render(scene, spp=1, size=(32, 24))
    assert np.array_equal(session.image().rgb, fresh.rgb)


# --- Molecules ---


def records(path):
    """Atoms of a PDB file's first model that are shown: the first place of each, by its own records."""
    seen, out = {}, []
    for line in pathlib.Path(path).read_text().splitlines():
        if line.startswith("ENDMDL"):
            break
        if line[:6] not in ("ATOM  ", "HETATM"):
            continue
        residue, name, place = line[17:27], line[12:16], line[16]
        if seen.setdefault((residue, name), place) == place:
            out.append([float(line[30:38]), float(line[38:46]), float(line[46:54])])
    return np.array(out)


def test_atoms_are_the_records():
    gemmi = pytest.importorskip("gemmi")
    files = sorted(pathlib.Path(data("mol", "pdb")).glob("*.pdb"))
    if not files:
        pytest.skip("no PDB files in the data")
    for file in files:
        structure = gemmi.read_structure(str(file))
        expected = records(file)
        scene = caplet.from_gemmi(structure, style="spheres")
        assert len(scene["atoms"]) == len(expected) == len(scene.info["elements"]), file
        assert np.abs(np.sort(scene.info["positions"], axis=0) - np.sort(expected, axis=0)).max() < 1e-6
        assert np.allclose(scene["atoms"].p0, scene.info["positions"], atol=1e-3)


def test_bonds_are_those_of_small_molecules():
    gemmi = pytest.importorskip("gemmi")
    # Benzene, by hand: a hexagon of 1.39 A with hydrogens at 2.48 A.
    angles = np.arange(6) * math.pi / 3
    positions = [(r * math.cos(a), r * math.sin(a), 0) for r in (1.39, 2.48) for a in angles]
    lines = [f"HETATM{i + 1:5} {'C' if i < 6 else 'H'}{i % 6:<3} BNZ A   1    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00          {'C' if i < 6 else 'H':>2}"
             for i, (x, y, z) in enumerate(positions)]
    structure = gemmi.read_pdb_string("\n".join([*lines, "END", ""]))
    scene = caplet.from_gemmi(structure)
    ring = {tuple(sorted((i, (i + 1) % 6))) for i in range(6)} | {(i, i + 6) for i in range(6)}
    assert set(map(tuple, scene.info["bonds"].tolist())) == ring
    assert len(scene["atoms"]) == 12 and len(scene["bonds"]) == 24
    assert np.allclose(np.sort(scene["bonds"].p1[:, 0]), np.sort(np.repeat([(positions[a][0] + positions[b][0]) / 2 for a, b in sorted(ring)], 2)), atol=2e-3)
    assert len(caplet.from_gemmi(structure, hydrogens=False)["atoms"]) == 6
    # A probe of 1.4 rests on the middle of the ring, at 1.7 + 1.4 from all six carbons.
    surface = caplet.from_gemmi(structure, style="surface", color="chain")
    assert list(surface.primitives) == ["molecular_patch"] and len(surface.shapes) == 1
    assert caplet.trace(surface, (0, 0, 10), (0, 0, -1))["t"][0] == pytest.approx(10 - (math.sqrt(3.1**2 - 1.39**2) - 1.4), abs=1e-3)
    assert caplet.trace(caplet.from_gemmi(structure, style="surface", probe=0.1), (0, 0, 10), (0, 0, -1))["t"][0] > 8.9
    reached = caplet.from_gemmi(structure, style="accessible", probe=0.5)["atoms"].radius
    assert sorted(set(np.round(np.asarray(reached).reshape(-1), 3))) == pytest.approx([1.7, 2.2])
    for wrong in (dict(style="cartoon"), dict(color="pink"), dict(model=3)):
        with pytest.raises(caplet.InputError):
            caplet.from_gemmi(structure, **wrong)
    with pytest.raises(caplet.InputError):
        caplet.from_gemmi("benzene")


def test_bonds_by_cells_are_those_of_all_pairs(rng):
    pytest.importorskip("gemmi")
    from caplet.bridges.gemmi import bonds_of
    positions, radii = rng.random((400, 3)) * 12, rng.choice([0.31, 0.76, 1.05], 400)
    away = np.linalg.norm(positions[:, None] - positions[None], axis=2)
    i, j = np.nonzero(np.triu((away <= 1.3 * (radii[:, None] + radii[None])) & (away > 0.1), 1))
    assert np.array_equal(bonds_of(positions, radii), np.stack([i, j], 1)) and len(i) > 50


# --- Streamlines and meshes ---


@pytest.mark.parametrize("name", ["standard.trk", "standard.tck", "simple.tck", "tracks300.trk"])
def test_streamlines_are_their_points(name):
    nibabel = pytest.importorskip("nibabel")
    loaded = nibabel.streamlines.load(data("fibres", "streamlines", name))
    scene = caplet.from_nibabel(loaded, radius=0.2)
    lines = [line for line in loaded.streamlines if len(line) > 1]
    shape = scene["streamlines"]
    assert len(shape) == sum(len(line) - 1 for line in lines)
    assert np.array_equal(shape.p0, np.concatenate([line[:-1] for line in lines])) and np.array_equal(shape.p1, np.concatenate([line[1:] for line in lines]))
    assert (shape.radius == np.float32(0.2)).all() and len(scene.info["streamline"]) == len(shape)
    # u rises with the length from 0 to 1 along each.
    row = 0
    for line in lines:
        u, length = shape.u[row:row + len(line) - 1], np.linalg.norm(np.diff(line.astype(float), axis=0), axis=1)
        assert u[0, 0] == 0 and u[-1, 1] == 1 and np.array_equal(u[1:, 0], u[:-1, 1])
        assert np.allclose(u[:, 1] - u[:, 0], length / length.sum(), atol=1e-6)
        row += len(line) - 1


def test_meshes_are_their_faces(rng):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=2)
    scene = caplet.from_trimesh(ball)
    assert scene.primitives == {"triangle": len(ball.faces)} and np.allclose(scene.bounds, ball.bounds, atol=1e-6)
    held = trimesh.Scene()
    held.add_geometry(ball, geom_name="ball", node_name="one")
    moved = np.eye(4)
    moved[0, 3] = 5
    held.add_geometry(trimesh.creation.box(), geom_name="box", node_name="two", transform=moved)
    scene = caplet.from_trimesh(held)
    assert scene.primitives == {"triangle": len(ball.faces) + 12} and np.allclose(scene.bounds, held.bounds, atol=1e-6)
    with pytest.raises(caplet.InputError):
        caplet.from_trimesh(3)
    file = data("meshes", "2CylinderEngine", "2CylinderEngine.glb")
    engine = trimesh.load(file)
    scene = caplet.from_trimesh(engine)
    assert scene.primitives["triangle"] == sum(len(engine.geometry[engine.graph[node][1]].faces) for node in engine.graph.nodes_geometry)
    assert np.allclose(scene.bounds, engine.bounds, rtol=1e-5, atol=1e-4 * engine.extents.max())


def test_xarray():
    pytest.importorskip("xarray")
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1)
    image = caplet.render(scene, spp=1, size=(12, 8))
    held = caplet.to_xarray(image)
    assert held.rgb.shape == (8, 12, 3) and held.depth.dims == ("y", "x") and held.attrs["samples_per_pixel"] == 1
    assert np.array_equal(held.object_id.values, image.object_id)


def test_a_scanner_measures_a_ball():
    scene = caplet.Scene()
    scene.add("sphere", radius=1, name="ball")
    around, above = np.array([-8.0, 0.0, 10.0, 90.0]), np.array([0.0, 5.0, 12.0])
    distance, shapes = caplet.lidar(scene, (-5, 0, 0), around, above)
    # The angle between a ray and the way to the middle, five away: cos = cos(above) cos(around).
    cosine = np.outer(np.cos(np.deg2rad(above)), np.cos(np.deg2rad(around)))
    inside = 1 - 25 * (1 - cosine**2)
    expected = np.where((inside > 0) & (cosine > 0), 5 * cosine - np.sqrt(np.maximum(inside, 0)), np.inf)
    assert distance.shape == (3, 4) and np.isfinite(expected).sum() == 6
    assert np.allclose(distance, expected, atol=1e-5)
    assert (shapes == np.where(np.isfinite(expected), 0, 2**32 - 1)).all()
    # Turned by a quarter about z: what was ahead is now to the right of a scanner that looks along y.
    pose = np.array([[0, -1, 0, -5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    assert np.allclose(caplet.lidar(scene, pose, around - 90, above)[0], expected, atol=1e-5)
    assert np.isinf(caplet.lidar(scene, (-5, 0, 0), [0.0], [0.0], reach=3.9)[0]).all()
    with pytest.raises(caplet.InputError, match="pose"):
        caplet.lidar(scene, np.eye(3), around, above)


def test_a_scanner_on_a_robot_is_mujocos_rays():
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(EVERY_GEOM)
    state = mujoco.MjData(model)
    mujoco.mj_forward(model, state)
    scene = caplet.from_mujoco(model, state)
    around, above = np.linspace(-180, 170, 36), np.linspace(-40, 30, 8)
    distance, shapes = caplet.lidar(scene, (0.2, 0.1, 3.3), around, above)
    agree = 0
    for i, up in enumerate(np.deg2rad(above)):
        for k, turn in enumerate(np.deg2rad(around)):
            way = np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)])
            geom = np.full((1, 1), -1, dtype=np.int32)
            t = mujoco.mj_ray(model, state, np.array([0.2, 0.1, 3.3]), way, np.array([1, 1, 1, 0, 0, 0], np.uint8), 1, -1, geom)
            same = np.isinf(distance[i, k]) if t < 0 else abs(distance[i, k] - t) < 1e-3 and scene.info["geom"][shapes[i, k]] == geom[0, 0]
            agree += bool(same)
    assert agree >= 0.99 * distance.size


def test_cells_of_meshio():
    meshio = pytest.importorskip("meshio")
    grid = np.array([[x, y, z] for x in range(3) for y in range(2) for z in range(2)], dtype=float)
    number = {tuple(p): i for i, p in enumerate(grid.astype(int).tolist())}
    cube = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [[number[x + by, y, z] for x, y, z in cube] for by in (0, 1)]
    scene = caplet.from_meshio(meshio.Mesh(grid, [("hexahedron", np.array(cells)), ("line", np.array([[0, 11], [1, 2]]))]), radius=0.1)
    assert scene.primitives == {"triangle": 20, "capsule": 2}  # ten faces: that between the cubes is none
    hits = caplet.trace(scene, (-5, 0.4, 0.3), (1, 0, 0), mode="all")
    faces = hits[[scene.shapes[i] == "faces" for i in hits["shape"]]]
    assert faces["t"].tolist() == [5, 7]
    tetra = caplet.from_meshio(meshio.Mesh(np.eye(4)[:, :3], [("tetra", np.array([[3, 0, 1, 2]]))]))
    assert tetra.primitives == {"triangle": 4}
    with pytest.raises(caplet.InputError, match="triangle6"):
        caplet.from_meshio(meshio.Mesh(np.zeros((6, 3)), [("triangle6", np.arange(6)[None])]))


# --- PyVista ---


def vtk_hits(mesh, origins, directions, reach):
    """The nearest crossing of each ray with a surface, by VTK: t, infinite where there is none."""
    out = np.full(len(origins), np.inf)
    for i, (at, way) in enumerate(zip(origins, directions)):
        points, _ = mesh.ray_trace(at, at + reach * way)
        if len(points):
            out[i] = np.linalg.norm(points - at, axis=1).min()
    return out


def rays_at(bounds, rng, count):
    """From a ball around a box towards points in it."""
    low, high = np.array(bounds[::2]), np.array(bounds[1::2])
    around = rng.standard_normal((count, 3))
    origins = (low + high) / 2 + 2 * np.linalg.norm(high - low) * around / np.linalg.norm(around, axis=1, keepdims=True)
    way = low + rng.random((count, 3)) * (high - low) - origins
    return origins, way / np.linalg.norm(way, axis=1, keepdims=True)


def wave(pyvista):
    """A curve of 60 points whose radius grows from 0.1 to 0.4."""
    t = np.linspace(0, 4, 60)
    curve = pyvista.MultipleLines(np.stack([2 * t, np.sin(2 * t), np.cos(t)], axis=1))
    curve.point_data["thick"] = np.linspace(0.1, 0.4, 60)
    return curve


def test_lines_of_pyvista_are_the_tubes_of_vtk(rng):
    pyvista = pytest.importorskip("pyvista")
    curve = wave(pyvista)
    scene = caplet.from_pyvista(curve, radius="thick")
    shape = scene["lines"]
    assert scene.primitives == {"capsule": 59} and scene.info["lines"].tolist() == [0] * 59
    assert np.allclose(shape.p0, curve.points[:-1]) and np.allclose(shape.p1, curve.points[1:])
    assert np.allclose(shape.radius, np.stack([curve["thick"][:-1], curve["thick"][1:]], axis=1))
    # VTK's tube is of 128 flat sides, mitred at the points: within r (1 - cos(pi / 128)) = 0.0003 r of round ones, and, where the
    # curve turns by at most 0.15 from piece to piece, within r (1 / cos(0.075) - 1) = 0.003 r. Its ends are open.
    tube = curve.tube(scalars="thick", absolute=True, n_sides=128)
    origins, way = rays_at(curve.bounds, rng, 400)
    t, hits = vtk_hits(tube, origins, way, 60), caplet.trace(scene, origins, way)
    both = np.isfinite(t) & np.isfinite(hits["t"])
    assert both.sum() > 60 and (np.isfinite(t) == np.isfinite(hits["t"])).mean() > 0.97
    # Along a ray that grazes the error is many times that: nine of ten within 0.01.
    assert (np.abs(t[both] - hits["t"][both]) < 0.01).mean() > 0.9
    # The same radii in an array beside, of one for all, and of cells.
    assert np.array_equal(caplet.from_pyvista(curve, radius=curve["thick"])["lines"].radius, shape.radius)
    assert (caplet.from_pyvista(curve, radius=0.25)["lines"].radius == 0.25).all()
    curve.cell_data["each"] = [0.125]
    assert (caplet.from_pyvista(curve, radius="each")["lines"].radius == 0.125).all()
    extent = np.linalg.norm(np.ptp(curve.points, axis=0))
    assert np.allclose(caplet.from_pyvista(curve)["lines"].radius, extent / 300)


def test_tubes_and_surfaces_of_pyvista_are_their_polygons(rng):
    pyvista = pytest.importorskip("pyvista")
    tube = wave(pyvista).tube(radius=0.2, n_sides=12)  # strips of triangles
    assert tube.n_strips > 0 or tube.n_faces > 0
    hexagons = pyvista.Plane(i_resolution=3, j_resolution=2).rotate_x(30) + pyvista.Disc(inner=0, outer=1, r_res=1, c_res=6).translate((0, 0, 2))
    grid = pyvista.ImageData(dimensions=(4, 3, 5)).cast_to_unstructured_grid()
    for mesh in (tube, hexagons, grid, pyvista.Sphere(), pyvista.ParametricEllipsoid(1, 2, 3)):
        surface = mesh.extract_surface(algorithm="dataset_surface").triangulate()
        scene = caplet.from_pyvista(mesh)
        assert scene.primitives["triangle"] == surface.n_faces
        assert np.allclose(scene.bounds, np.array(mesh.bounds).reshape(3, 2).T, atol=1e-6)
        origins, way = rays_at(mesh.bounds, rng, 150)
        t, hits = vtk_hits(surface, origins, way, 100), caplet.trace(scene, origins, way)
        same = np.where(np.isfinite(t), np.abs(hits["t"] - np.where(np.isfinite(t), t, 0)) < 1e-4, np.isinf(hits["t"]))
        assert same.mean() > 0.98 and np.isfinite(t).sum() > 15  # edges may differ


def test_clouds_and_mixtures_of_pyvista():
    pyvista = pytest.importorskip("pyvista")
    cloud = pyvista.PolyData(np.eye(3) * 5)
    cloud.point_data["size"] = [1.0, 2.0, 3.0]
    cloud.point_data["paint"] = np.array([[188, 99, 0], [99, 188, 99], [99, 99, 188]], np.uint8)
    scene = caplet.from_pyvista(cloud, radius="size", scalars="paint")
    balls = scene["points"]
    assert np.array_equal(balls.p0, np.eye(3) * 5) and balls.radius[:, 0].tolist() == [1, 2, 3] and scene.info["points"].tolist() == [0, 1, 2]
    scene.look_at((20, 20, 20), (2, 2, 2), (0, 0, 1))
    scene.fov = 25
    image = caplet.render(scene, spp=16, size=(64, 64))
    # sRGB's 188 is 0.503, and its 99 0.125 linear; as spectra they are within 0.02 (docs/textures.md), and inside nothing else is seen.
    for ball, wanted in enumerate(((0.503, 0.125, 0), (0.125, 0.503, 0.125), (0.125, 0.125, 0.503))):
        inside = (image.primitive_id == ball) & (image.alpha == 1)
        assert inside.sum() > 10 and np.allclose(np.median(image.albedo[inside], axis=0), wanted, atol=0.03)
    mixed = pyvista.PolyData(np.eye(4)[:, :3], lines=[2, 0, 1, 3, 1, 2, 3], faces=[3, 0, 1, 2], verts=[1, 3])
    mixed.cell_data["of"] = [10.0, 20.0, 30.0, 40.0]  # vertices, lines, polygons
    scene = caplet.from_pyvista(mixed, radius=[0.1, 0.2, 0.3, 0.4], scalars="of")
    assert scene.primitives == {"capsule": 4, "triangle": 1} and scene.info["lines"].tolist() == [0, 1, 1]
    assert scene["lines"].radius.tolist() == [[np.float32(a), np.float32(b)] for a, b in ((0.1, 0.2), (0.2, 0.3), (0.3, 0.4))]
    assert scene["points"].p0.tolist() == [[0, 0, 0]] and scene["points"].radius[0, 0] == np.float32(0.4)
    blocks = pyvista.MultiBlock({"one": cloud, "two": pyvista.MultiBlock({"three": wave(pyvista)})})
    scene = caplet.from_pyvista(blocks, radius=0.1)
    assert scene.shapes == ["one points", "two three lines"]


def test_scalars_of_pyvista_have_the_map_of_matplotlib():
    pyvista = pytest.importorskip("pyvista")
    pyplot = pytest.importorskip("matplotlib.pyplot")

    def linear(part):
        screen = np.array(pyplot.get_cmap("viridis")(part)[:3])
        return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)
    plane = pyvista.Plane(i_size=4, j_size=1, i_resolution=2, j_resolution=1)  # x from -2 to 2
    plane.clear_data()
    plane.point_data["x"] = plane.points[:, 0] * 10.0
    plane.cell_data["side"] = [3.0, math.nan]

    def colors(scene, parts):
        scene.look_at((0, 0, 9), (0, 0, 0))
        scene.fov = 8
        image = caplet.render(scene, spp=64, size=(400, 100), seed=2)
        # 8 degrees over 100 pixels at a distance of 9: x is at (pixel - 200) / 100 * 2 * 9 tan(4 deg).
        at = [int(200 + 100 * x / (2 * 9 * math.tan(math.radians(4)))) for x in parts]
        return image, [image.albedo[50, x] for x in at]
    scene = caplet.from_pyvista(plane, scalars="x")
    image, got = colors(scene, (-1.8, -1.0, 0.1, 1.0, 1.8))
    for x, color in zip((-1.8, -1.0, 0.1, 1.0, 1.8), got):
        # The program's map is matplotlib's at nine knots, lines between them: within 0.02 of it, as the picture's colours are.
        assert np.allclose(color, linear((x + 2) / 4), atol=0.03), x
    drawn = image.png(color_bar=True)
    assert drawn != image.png() and drawn[:4] == b"\x89PNG"
    # The range that is asked for, beyond which the ends stay.
    _, got = colors(caplet.from_pyvista(plane, scalars=plane["x"], low=0, high=40), (-1.0, 1.0))
    assert np.allclose(got[0], linear(0.0), atol=0.03) and np.allclose(got[1], linear(0.25), atol=0.03)
    # Cells have one colour each, and what has no value is grey.
    scene = caplet.from_pyvista(plane, scalars="side", low=2, high=4)
    assert scene.shapes == ["faces", "faces without values"]
    _, got = colors(scene, (-1.9, -0.1, 1.0))
    assert np.allclose(got[0], linear(0.5), atol=0.03) and np.allclose(got[1], linear(0.5), atol=0.03) and np.allclose(got[2], 0.5, atol=0.01)
    # Of vectors the length; of capsules the mean of both ends.
    line = pyvista.Line((-2, 0, 0), (2, 0, 0), resolution=2)
    line.clear_data()
    line.point_data["way"] = [(0, 0, 0), (3, 4, 0), (0, 0, 10.0)]
    _, got = colors(caplet.from_pyvista(line, radius=0.4, scalars="way"), (-1.0, 1.0))
    assert np.allclose(got[0], linear(0.25), atol=0.03) and np.allclose(got[1], linear(0.75), atol=0.03)


def test_what_pyvista_cannot_give():
    pyvista = pytest.importorskip("pyvista")
    curve = wave(pyvista)
    plane = pyvista.Plane()
    plane.point_data["paint"] = np.zeros((plane.n_points, 3), np.uint8)
    for wrong, says in ((lambda: caplet.from_pyvista("curve"), "PyVista"), (lambda: caplet.from_pyvista(curve, radius="thin"), "no array 'thin'"),
                        (lambda: caplet.from_pyvista(curve, radius=[1.0, 2.0]), "radius"), (lambda: caplet.from_pyvista(curve, scalars="x"), "no array 'x'"),
                        (lambda: caplet.from_pyvista(curve, radius=-1), "radi"), (lambda: caplet.from_pyvista(pyvista.PolyData()), "no points"),
                        (lambda: caplet.from_pyvista(curve, scalars="thick", color=(1, 0, 0)), "color"),
                        (lambda: caplet.from_pyvista(curve, scalars="thick", low=3, high=2), "low"),
                        (lambda: caplet.from_pyvista(plane, scalars="paint"), "colours are of lines")):
        with pytest.raises(caplet.InputError, match=says):
            wrong()


def test_neurons_of_morphio():
    morphio = pytest.importorskip("morphio")
    path = os.path.join(os.environ["CAPLET_SCENES"], "neuron.swc")
    neuron = morphio.Morphology(path)
    scene = caplet.from_morphio(neuron)
    sections = list(neuron.iter())
    assert len(scene["neurites"]) == sum(len(one.points) - 1 for one in sections)
    first = sections[0]
    assert np.array_equal(scene["neurites"].p0[0], first.points[0]) and scene.info["type"][0] == int(first.type)
    assert np.allclose(scene["neurites"].radius[0], first.diameters[:2] / 2)
    u = scene["neurites"].u[:len(first.points) - 1]
    assert u[0, 0] == 0 and u[-1, 1] == 1 and np.array_equal(u[1:, 0], u[:-1, 1]) and (u[:, 0] <= u[:, 1]).all()
    assert scene["soma"].radius[0, 0] == pytest.approx(neuron.soma.diameters[0] / 2)
    # What the program reads has these segments, and those to the soma.
    own = caplet.load(path)
    assert 0 <= own.primitives["capsule"] - len(scene["neurites"]) <= len(neuron.root_sections)


def test_pictures_without_noise():
    pytest.importorskip("pyoidn")
    scene = caplet.Scene()
    scene.add("sphere", radius=1, color=(0.7, 0.4, 0.2))
    scene.add_boxes((-3, -1.2, -3), (3, -1, 3), color=(0.5, 0.5, 0.5))
    noisy, good = caplet.render(scene, spp=2, size=(96, 64)), caplet.render(scene, spp=256, size=(96, 64), seed=5)
    clean = caplet.denoise(noisy)
    scene.film(denoise=True)
    own = caplet.render(scene, spp=2, size=(96, 64))
    for name, was in zip("RGB", np.moveaxis(noisy.rgb, 2, 0)):
        assert np.array_equal(own[f"noisy.{name}"], was)
    assert np.abs(own.rgb - good.rgb).mean() < 0.6 * np.abs(noisy.rgb - good.rgb).mean()
    assert clean.shape == (64, 96, 3) and clean.dtype == np.float32
    assert np.abs(clean - good.rgb).mean() < 0.6 * np.abs(noisy.rgb - good.rgb).mean()
