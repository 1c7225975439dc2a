# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Many worlds against closed forms, against each world alone, and against MuJoCo."""
import os
import pathlib

import numpy as np
import pytest

import caplet
from caplet import materials
from caplet.sensors import Pinhole
from shared_data import data

SOURCE = pathlib.Path(os.environ["CAPLET_SOURCE"])
NONE = 2**32 - 1


def placed(*at):
    out = np.eye(4)
    out[:3, 3] = at
    return out


def turned(rng):
    """A random rotation: of a matrix of normal numbers, what is orthogonal."""
    q, r = np.linalg.qr(rng.normal(size=(3, 3)))
    q = q * np.sign(np.diag(r))
    return q if np.linalg.det(q) > 0 else q[:, [1, 0, 2]]


@pytest.fixture
def parts():
    """Shapes of most kinds about the origin; the last two do not move, and one of them is an instance's."""
    scene = caplet.Scene()
    scene.add_capsules([[-0.5, 0, 0], [0, -0.5, 0]], [[0.5, 0, 0], [0, 0.5, 0]], [0.2, 0.1], color=[(1, 0, 0), (0, 1, 0)], name="cross")
    scene.add("cylinder", p0=(0, 0, -0.4), p1=(0, 0, 0.4), radius=0.2, name="rod", onesided=True, material=materials.diffuse(reflectance=(0, 0, 1)))
    scene.add("box", p0=(-0.3, -0.2, -0.1), p1=(0.3, 0.2, 0.1), name="brick")
    scene.add_mesh([[0, 0, 0], [0.8, 0, 0], [0, 0.8, 0], [0, 0, 0.8]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]], name="tetrahedron")
    scene.add("sphere", radius=0.4, name="egg", transform=np.diag([1, 2, 0.5, 1]))
    scene.add("box", p0=(-4, -4, 5), p1=(4, 4, 5.5), name="wall")
    scene.add("sphere", radius=0.3, object="bead", name="bead")
    scene.add_instances("bead", [placed(1.5, 0, 0), placed(-1.5, 0, 0)])
    return scene


CAMERA = Pinhole(40, 30, fx=30, cx=18.3, cy=15.2, distortion=(-0.1, 0.02, 0.001, -0.002))


def poses_of(scene, moving, count, rng):
    worlds = np.zeros((count, len(moving), 4, 4))
    for world in worlds:
        for i, which in enumerate(moving):
            own = np.asarray(scene.shape(which).transform).reshape(-1, 4)
            own = np.vstack([own[:3], [0, 0, 0, 1]])
            place = placed(*rng.uniform(-1.5, 1.5, 3))
            place[:3, :3] = turned(rng)
            world[i] = place @ own
    return worlds


def test_worlds_are_those_of_each_alone(parts):
    rng = np.random.default_rng(1)
    moving = ["egg", "cross", 1, "brick", "tetrahedron"]
    worlds = poses_of(parts, moving, 12, rng)
    poses = np.stack([[placed(0, 0, -5), placed(0.5, -0.3, -4)]] * 12)
    poses[:, 1, :3, :3] = [[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]]
    batch = caplet.Batch(parts, moving)
    layers = ("depth", "shape", "instance", "primitive", "material_id", "normal", "point")
    seen = batch.look(worlds, CAMERA, poses, layers, kind="range")
    assert seen["depth"].shape == (12, 2, 30, 40) and seen["normal"].shape == (12, 2, 30, 40, 3)
    ways = CAMERA.unproject(CAMERA.pixels())
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    hits_seen, other = 0, 0
    for w, world in enumerate(worlds):
        for which, place in zip(moving, world):
            parts.shape(which).transform = place
        for c in range(2):
            hits = caplet.trace(parts, poses[w, c, :3, 3], ways @ poses[w, c, :3, :3].T)
            own = {layer: seen[layer][w, c].reshape(1200, -1).squeeze() for layer in layers}
            is_hit = np.isfinite(hits["t"])
            # Rays are the same to the bit; where a shape is placed by an instance rounds otherwise, so that a ray that grazes may miss.
            same = (own["shape"] == hits["shape"]) & (own["instance"] == hits["instance"]) & (own["primitive"] == hits["primitive"])
            assert (np.isnan(own["depth"]) == (own["shape"] == NONE)).all()
            assert (own["material_id"] == hits["material_id"])[same].all()
            cosine = np.abs((hits["normal"] * (ways @ poses[w, c, :3, :3].T)).sum(axis=1))
            front = same & is_hit & (cosine > 0.1)
            # Each is within `error` of the surface along the normal (docs/numerics.md): two of them, and the rounding of the places.
            bound = (4 * hits["error"] + 64 * 2**-24 * 8)[front] / cosine[front]
            assert (np.abs(own["depth"] - hits["t"])[front] <= bound).all()
            assert (np.abs(own["point"] - hits["point"])[front].max(axis=1) <= bound).all()
            assert np.abs(own["normal"] - hits["normal"])[front].max() < 1e-3
            assert (own["normal"][own["shape"] == NONE] == 0).all()
            hits_seen += is_hit.sum()
            other += (~same).sum()
    assert hits_seen > 10_000 and other <= 12, (hits_seen, other)
    assert {1, 2, 5, 6} <= set(np.unique(seen["shape"])) and set(np.unique(seen["instance"])) == {0, 1, NONE}


def test_balls_are_where_they_are_put():
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 0.5, name="ball")
    z = np.linspace(2, 40, 500)
    worlds = np.stack([[placed(0, 0, far)] for far in z])
    camera = Pinhole(33, 33, fx=40)
    seen = caplet.render_batch(scene, worlds, camera, np.eye(4))
    assert list(seen) == ["depth", "shape"]
    for far, depth in zip(z, seen["depth"]):
        ways = camera.unproject(camera.pixels())
        b, c, dd = far, far * far - 0.25, (ways**2).sum(axis=1)
        inside = b * b - dd * c
        near = np.where(inside > 0, (b - np.sqrt(np.maximum(inside, 0))) / dd, np.nan).reshape(33, 33)
        clear = np.abs(inside).reshape(33, 33) > 1e-4 * far * far
        assert (np.isnan(depth) == np.isnan(near))[clear].all()
        met = clear & ~np.isnan(near)
        # The depth of a point that is off by 16 eps of the distance along the normal, at this angle.
        assert met.sum() > 0 or far > 20
        assert np.abs(depth - near)[met].max(initial=0) < 64 * 2**-24 * far / 0.01


def test_numbers_of_rays_and_worlds_do_not_matter(parts):
    rng = np.random.default_rng(2)
    worlds = poses_of(parts, ["rod", "egg"], 40, rng)
    batch = caplet.Batch(parts, ["rod", "egg"])
    camera = Pinhole(97, 61, fx=60)  # 40 x 5917 rays: several launches, none with a round number
    layers = ("depth", "shape", "instance", "primitive", "material_id", "normal", "point")
    whole = batch.look(worlds, camera, placed(0, 0, -5), layers)
    for w in (0, 17, 39):
        alone = batch.look(worlds[w:w + 1], camera, placed(0, 0, -5), layers)
        for layer, pixels in alone.items():
            assert np.array_equal(pixels[0], whole[layer][w], equal_nan=True), (w, layer)
    large = Pinhole(500, 400, fx=300)  # more rays than a launch has
    a = batch.look(worlds[:2], large, placed(0, 0, -5))
    b = batch.look(worlds[1:2], large, placed(0, 0, -5))
    assert np.array_equal(a["depth"][1], b["depth"][0], equal_nan=True) and np.isfinite(a["depth"]).any()
    assert batch.look(worlds[:0], camera, np.eye(4))["depth"].shape == (0, 61, 97)


def test_a_batch_keeps_the_scene_as_it_was(parts):
    worlds = np.eye(4)[None, None]
    assert caplet.Batch(parts).moving == list(range(6))  # all but those of objects
    batch = caplet.Batch(parts, "rod")
    before = batch.look(worlds, CAMERA, placed(0, 0, -5))
    parts.shape("wall").transform = placed(0, 0, 9)
    again = batch.look(worlds, CAMERA, placed(0, 0, -5))
    assert np.array_equal(before["depth"], again["depth"], equal_nan=True)
    assert not np.array_equal(caplet.Batch(parts, "rod").look(worlds, CAMERA, placed(0, 0, -5))["depth"], before["depth"], equal_nan=True)


def alone(scene, spp):
    """The scene's picture without layers: its samples are one net of points, not two that tell the noise."""
    native = scene._native.copy()
    native.set_size(40, 30)
    session = caplet._caplet.Session(native, caplet.rendering._devices(None), none=True)
    session.render(spp, None, None)
    image = caplet.Image(session.film())
    assert image.channels == ["R", "G", "B", "A"]
    return image.rgb


def test_pictures_are_those_of_each_alone(parts):
    rng = np.random.default_rng(3)
    parts.look_at((0, 0, -5), (0, 0, 0))
    worlds = poses_of(parts, ["rod", "egg"], 3, rng)
    poses = np.stack([placed(0, 0, -5), placed(0.2, 0.1, -5), placed(0, 0, -5)])  # the last as the first
    lit = caplet.render_batch(parts, worlds, CAMERA, poses, ["rod", "egg"], "paths", spp=4, seed=3)["rgb"]
    direct = caplet.render_batch(parts, worlds, CAMERA, poses, ["rod", "egg"], "direct", spp=4, seed=3)["rgb"]
    assert lit.shape == direct.shape == (3, 30, 40, 3)
    k1, k2, p1, p2 = CAMERA.distortion[:4]
    parts.seed = 3
    for w in range(3):
        for which, place in zip(["rod", "egg"], worlds[w]):
            parts.shape(which).transform = place
        parts.camera = caplet.cameras.opencv(fx=CAMERA.fx, fy=CAMERA.fy, cx=CAMERA.cx, cy=CAMERA.cy, k1=k1, k2=k2, p1=p1, p2=p2,
                                             transform=poses[w] @ np.diag([1, -1, 1, 1]))
        assert np.array_equal(alone(parts, 4), lit[w])
        assert abs(caplet.render(parts, size=(40, 30), spp=4).rgb.mean() / lit[w].mean() - 1) < 0.02
        depth, parts.max_depth = parts.max_depth, 1
        assert np.array_equal(alone(parts, 4), direct[w])
        parts.max_depth = depth
    assert (direct.mean(axis=(1, 2, 3)) < lit.mean(axis=(1, 2, 3))).all()
    # The picture is the right way up, and of the same shapes as the rays of the same camera.
    shapes = caplet.render_batch(parts, worlds[2:], CAMERA, poses[2:], ["rod", "egg"])["shape"][0]
    image = caplet.render(parts, size=(40, 30), spp=1)
    ids = np.where(shapes == 6, NONE, shapes)  # an instance's shape has the instance's number there
    assert (image.object_id == ids)[ids != NONE].mean() > 0.9


def test_worlds_have_materials_of_their_own():
    scene = caplet.Scene()
    scene.add_light(caplet.lights.infinite(L=(0.5, 0.6, 0.7)))
    scene.add_spheres((0, 0, 0), 1, name="ball", material=caplet.materials.diffuse(name="paint"))
    scene.add_spheres((0, 2.2, 0), 1, material=caplet.materials.diffuse(name="rest", reflectance=0.3))
    checks = caplet.textures.checkerboard(tex1=0.1, tex2=0.9)
    looks = [caplet.materials.diffuse(reflectance=(0.9, 0.1, 0.1)), caplet.materials.conductor(roughness=0.2), caplet.materials.diffuse(reflectance=checks)]
    worlds = np.tile(np.eye(4), (3, 1, 1, 1))
    seen = caplet.render_batch(scene, worlds, CAMERA, placed(0, 0, -5), "ball", "paths", spp=4, seed=3, materials={"paint": looks})["rgb"]
    assert seen[0][15, 20, 0] > 3 * seen[0][15, 20, 1] and not np.array_equal(seen[1], seen[2])
    for w, look in enumerate(looks):
        scene.set_material("paint", look)
        single = caplet.render_batch(scene, worlds[:1], CAMERA, placed(0, 0, -5), "ball", "paths", spp=4, seed=3)["rgb"]
        assert np.array_equal(single[0], seen[w])
    # The scene keeps its own.
    before = caplet.render_batch(scene, worlds[:1], CAMERA, placed(0, 0, -5), "ball", "paths", spp=4, seed=3)["rgb"]
    caplet.render_batch(scene, worlds, CAMERA, placed(0, 0, -5), "ball", "paths", spp=4, materials={0: looks, "rest": looks[::-1]})
    assert np.array_equal(before, caplet.render_batch(scene, worlds[:1], CAMERA, placed(0, 0, -5), "ball", "paths", spp=4, seed=3)["rgb"])


@pytest.fixture
def limbs():
    """Capsules of two colours, a chain with u, and a wall."""
    scene = caplet.Scene()
    scene.add_light(caplet.lights.infinite(L=0.7))
    scene.add_capsules([[-1, 0, 0], [0, 0, 0]], [[0, 0, 0], [1, 0, 0]], [0.2, 0.1], color=[(1, 0, 0), (0, 1, 0)], name="arm")
    scene.add("box", p0=(-4, -4, 5), p1=(4, 4, 5.5), name="wall")
    checks = caplet.textures.checkerboard(tex1=0.1, tex2=0.9, uscale=4)
    scene.add_capsules([[0, -1, 0], [0, -0.5, 0]], [[0, -0.5, 0], [0, 0.5, 0]], 0.15, u=[[0, 0.5], [0.5, 1.5]], name="tail",
                       material=caplet.materials.diffuse(reflectance=checks))
    return scene


def test_capsules_have_other_ends_in_each_world(limbs):
    rng = np.random.default_rng(6)
    count = 8
    p0, p1 = rng.uniform(-1.5, 1.5, (2, count, 2, 3))
    p1[::3, 0] = p0[::3, 0]  # balls
    radius = rng.uniform(0.1, 0.5, (count, 2, 2))
    tail = rng.uniform(-1.5, 1.5, (2, count, 2, 3))
    places = np.stack([[placed(*rng.uniform(-1, 1, 3))] for _ in range(count)])
    places[:, 0, :3, :3] = 0.8 * np.stack([turned(rng) for _ in range(count)])
    ends = {"arm": (p0, p1, radius), 2: (tail[0], tail[1])}
    layers = ("depth", "shape", "primitive", "material_id", "normal", "point")
    batch = caplet.Batch(limbs, "tail", deforming=["tail", "arm"])
    assert batch.deforming == [2, 0] and batch.moving == [2]
    pose = placed(0, 0, -5)
    seen = batch.look(places, CAMERA, pose, layers, kind="range", ends=ends)
    lit = caplet.render_batch(limbs, places, CAMERA, pose, "tail", "paths", spp=2, seed=5, ends=ends)["rgb"]
    rays = caplet.render_batch(limbs, places, CAMERA, pose, "tail", ends=ends)
    assert np.array_equal(rays["shape"], seen["shape"])
    ways = CAMERA.unproject(CAMERA.pixels())
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    of_capsules = 0
    for w in range(count):
        limbs.shape("arm").set(p0[w], p1[w], radius[w])
        limbs.shape("tail").set(tail[0, w], tail[1, w])
        limbs.shape("tail").transform = places[w, 0]
        hits = caplet.trace(limbs, pose[:3, 3], ways)
        own = {layer: seen[layer][w].reshape(1200, -1).squeeze() for layer in layers}
        ours = (hits["shape"] == 0) | (hits["shape"] == 2)
        of_capsules += ours.sum()
        for layer in layers:  # capsules stand in the world's tree as in the scene of that world
            expected = hits["t" if layer == "depth" else layer]
            assert np.array_equal(own[layer][ours], expected[ours]), layer
        assert (own["shape"] == hits["shape"]).all()
        single = caplet.render_batch(limbs, places[w:w + 1], CAMERA, pose, "tail", "paths", spp=2, seed=5)["rgb"]
        assert np.array_equal(single[0], lit[w])
    assert of_capsules > 800 and {0, 1} == set(np.unique(seen["primitive"][seen["shape"] == 0]))
    # A shape whose ends are not given keeps those that it had when the batch was made, though the scene has changed since.
    some = batch.look(places[:1], CAMERA, pose, ends={"arm": (p0[:1], p1[:1])})
    none = batch.look(places[:1], CAMERA, pose)
    assert not np.array_equal(some["depth"], none["depth"], equal_nan=True)
    radii = batch.look(places[:2], CAMERA, pose, ends={"arm": (p0[:2], p1[:2], np.array([0.2, 0.1]))})
    assert np.array_equal(radii["depth"][0], some["depth"][0], equal_nan=True)


LIMBS = {"worlds": np.zeros((2, 0, 4, 4)), "camera": CAMERA, "poses": np.eye(4), "moving": []}


@pytest.mark.parametrize("ends, said", [
    ([0], "ends: a dict of shapes is needed, not list"), ({"arm": (np.zeros((2, 2, 3)),) * 2, 0: (np.zeros((2, 2, 3)),) * 2}, "there twice"),
    ({"wall": (np.zeros((2, 1, 3)),) * 2}, "deforming: shape 1 is not one of capsules"), ({"leg": 0}, "leg"), ({9: 0}, "names of shapes, or numbers below 3"),
    ({"arm": np.zeros((2, 2, 3))}, "(p0, p1) or (p0, p1, radius) are needed of shape 'arm'"), ({"arm": (np.zeros((2, 3)),) * 2}, "p0 of 'arm': shape (2, 2, 3) is needed, not (2, 3)"),
    ({"arm": (np.zeros((2, 2, 3)), np.zeros((1, 2, 3)))}, "p1 of 'arm': shape (2, 2, 3) is needed"), ({"arm": (*np.zeros((2, 2, 2, 3)), np.zeros(3))}, "radius of 'arm': one, shape (2,)"),
    ({"arm": (*np.zeros((2, 2, 2, 3)), -1)}, "world 0: capsule 0 of shape 0 is not finite or has a negative radius"),
    ({"arm": (np.zeros((2, 2, 3)), np.full((2, 2, 3), np.nan))}, "world 0: capsule 0 of shape 0 is not finite")])
@pytest.mark.parametrize("mode", ["rays", "direct"])
def test_ends_that_are_wrong_are_told(limbs, ends, said, mode):
    with pytest.raises(caplet.InputError) as problem:
        caplet.render_batch(limbs, **LIMBS, ends=ends, mode=mode, spp=1)
    assert (said if mode == "rays" or "world 0" not in said else "capsule 0") in str(problem.value)


def test_shapes_that_do_not_deform_are_told(limbs):
    batch = caplet.Batch(limbs, [], deforming="arm")
    with pytest.raises(caplet.InputError, match="shape 'tail' is not among those that deform"):
        batch.look(LIMBS["worlds"], CAMERA, np.eye(4), ends={"tail": (np.zeros((2, 2, 3)),) * 2})
    with pytest.raises(caplet.InputError, match="shape 0 is there twice"):
        caplet.Batch(limbs, [], deforming=["arm", 0])
    stretched = np.tile(np.diag([1.0, 2, 1, 1]), (2, 1, 1, 1))
    with pytest.raises(caplet.InputError, match="world 0: the transform of shape 0, whose ends change, is not a similarity"):
        caplet.Batch(limbs, "arm", deforming="arm").look(stretched, CAMERA, np.eye(4))


@pytest.mark.parametrize("change, said", [
    ({"moving": ["rod", "rod"]}, "shape 1 is there twice"), ({"moving": [6]}, "there is no shape 6 in the world, which has 6"), ({"moving": [-1]}, "numbers below 7"),
    ({"moving": ["wheel"]}, "wheel"), ({"worlds": np.zeros((2, 2, 4, 4))}, "the last row of an affine transform is 0 0 0 1"),
    ({"worlds": np.tile(np.eye(4), (2, 2, 1, 1)) * [1, 1, 0, 1]}, "world 0: the transform of moving shape 0 is not affine, not finite, or singular"),
    ({"worlds": np.tile(np.eye(4), (2, 3, 1, 1))}, "worlds: 3 transforms each, and 2 shapes move"), ({"worlds": np.eye(4)}, "worlds: shape (n, m, 4, 4) is needed"),
    ({"poses": np.tile(np.eye(4), (3, 1, 1))}, "poses: 3 of them, and 2 worlds"), ({"poses": np.zeros(4)}, "poses: shape (4, 4) or (n, 4, 4) or (n, c, 4, 4) is needed"),
    ({"poses": placed(0, np.nan, 0)}, "poses: finite numbers are needed"), ({"camera": 3}, "camera: a caplet.sensors.Pinhole is needed, not int"), ({"layers": ["colour"]}, "layers: depth, shape"), ({"mode": "rasters"}, "mode: one of rays"),
    ({"mode": "paths", "layers": ["depth"]}, 'pictures have "rgb" alone'), ({"materials": {}}, "rays see none, only their numbers"),
    ({"mode": "paths", "materials": {"gold": []}}, "there is no material 'gold'"), ({"mode": "paths", "materials": {99: []}}, "materials: numbers below"),
    ({"mode": "direct", "materials": {0: [caplet.materials.diffuse()]}}, "materials: 1 of 0, and 2 worlds"),
    ({"mode": "paths", "materials": {0: [caplet.materials.diffuse(), "red"]}}, "ones of caplet.materials are needed, not str")])
def test_what_is_wrong_is_told(parts, change, said):
    given = {"worlds": np.tile(np.eye(4), (2, 2, 1, 1)), "camera": CAMERA, "poses": np.eye(4), "moving": ["rod", "egg"], **change}
    with pytest.raises(caplet.InputError) as problem:
        caplet.render_batch(parts, **given)
    assert said in str(problem.value)


def test_scenes_that_move_are_refused():
    scene = caplet.Scene()
    rod = scene.add_capsules((0, 0, 0), (1, 0, 0), 0.1)
    rod.animate([0, 1], p0=[[[0, 0, 0]], [[0, 1, 0]]])
    with pytest.raises(caplet.InputError, match="moves while its shutter is open"):
        caplet.Batch(scene)


def test_robots_are_where_mujoco_has_them():
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(data("mjcf", "mujoco/humanoid/humanoid.xml"))
    scene = caplet.from_mujoco(model)
    rng = np.random.default_rng(4)
    qpos = np.tile(model.qpos0, (6, 1))
    qpos[:, 2] += rng.uniform(0, 0.3, 6)
    qpos[:, 7:] += rng.uniform(-0.4, 0.4, (6, model.nq - 7))
    camera = caplet.bridges.mujoco_camera(model, 0, 64, 48)
    assert camera.fx == camera.fy and np.isclose(2 * np.degrees(np.arctan(24 / camera.fy)), model.cam_fovy[0])
    worlds, poses = caplet.bridges.mujoco_worlds(scene, model, qpos, camera=0)
    assert np.array_equal(worlds, caplet.bridges.mujoco_worlds(scene, model, qpos))
    seen = caplet.Batch(scene, scene.info["moving"]).look(worlds, camera, poses, kind="range")
    assert worlds.shape == (6, len(scene.shapes) - 1, 4, 4)  # all but the floor
    ways = camera.unproject(camera.pixels())
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    agree = total = 0
    for i, state in enumerate(qpos):
        now = mujoco.MjData(model)
        now.qpos[:] = state
        mujoco.mj_forward(model, now)
        assert np.allclose(poses[i, :3, 3], now.cam_xpos[0])
        # MuJoCo's camera looks along -z with y up, OpenCV's along z with y down.
        assert np.allclose(poses[i, :3, :3], now.cam_xmat[0].reshape(3, 3) @ np.diag([1, -1, -1]))
        ranges, geoms = np.zeros(len(ways)), np.zeros(len(ways), np.int32)
        shown = np.zeros(6, np.uint8)
        shown[:3] = 1
        mujoco.mj_multiRay(model, now, poses[i, :3, 3], (ways @ poses[i, :3, :3].T).ravel(), shown, 1, -1, geoms, ranges, None, len(ways), 1e6)
        shape, depth = seen["shape"][i].ravel(), seen["depth"][i].ravel()
        mine = np.where(shape == NONE, -1, scene.info["geom"][np.minimum(shape, len(scene.info["geom"]) - 1)])
        same = mine == geoms
        agree, total = agree + same.sum(), total + len(same)
        met = same & (geoms >= 0)
        assert met.sum() > 500
        assert (np.abs(depth - ranges)[met] < 1e-4 * ranges[met]).all()
        assert np.median(np.abs(depth - ranges)[met]) < 1e-6 * np.median(ranges[met])
    assert agree / total > 0.99, agree / total


TUMBLERS = """<mujoco><worldbody><geom type="plane" size="5 5 1"/>
<body pos="-1 0 1"><freejoint/><geom type="ellipsoid" size="0.2 0.5 0.3"/></body><body pos="0 0 1"><freejoint/><geom type="box" size="0.2 0.5 0.3"/></body>
<body pos="1 0 1"><freejoint/><geom type="cylinder" size="0.2 0.5"/></body><geom type="sphere" pos="0 2 1" size="0.4"/></worldbody></mujoco>"""


def test_states_of_a_robot_are_its_motion(rng=np.random.default_rng(8)):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(TUMBLERS)
    qpos = np.tile(model.qpos0, (3, 1))
    for first in (3, 10, 17):  # quaternions
        qpos[:, first:first + 4] = rng.normal(size=(3, 4))
        qpos[:, first:first + 4] /= np.linalg.norm(qpos[:, first:first + 4], axis=1)[:, None]
    qpos[:, [0, 2, 7]] += rng.uniform(-0.3, 0.3, (3, 3))
    times = [2, 2.5, 4]
    scene = caplet.from_mujoco(model, times=times, qpos=qpos)
    assert scene.instances == 3 and scene.info["moving"].tolist() == [2, 3, 4] and len(scene.info["geom"]) == 5
    assert [scene.shapes[i] for i in scene.info["moving"]] == [f"geom {i}" for i in scene.info["geom"][2:]]
    o = rng.uniform((-4, -4, 0.5), (4, 4, 4), (500, 3))
    d = rng.uniform((-1.5, -1, 0.2), (1.5, 2.5, 1.8), (500, 3)) - o
    d /= np.linalg.norm(d, axis=1)[:, None]
    for time, state in zip(times, qpos):
        now = mujoco.MjData(model)
        now.qpos[:] = state
        mujoco.mj_forward(model, now)
        hits = caplet.trace(scene, o, d, time=time)
        geoms, ranges = np.zeros(500, np.int32), np.zeros(500)
        for i in range(500):
            found = np.zeros(1, np.int32)
            ranges[i] = mujoco.mj_ray(model, now, o[i], d[i], None, 1, -1, found, None)
            geoms[i] = found[0]
        mine = np.where(np.isfinite(hits["t"]), scene.info["geom"][hits["shape"].clip(max=4)], -1)
        same = mine == geoms
        assert same.mean() > 0.98 and (geoms > 1).sum() > 50
        met = same & (geoms >= 0)
        assert (np.abs(hits["t"] - ranges)[met] < 1e-4 * ranges[met]).mean() > 0.99
    # Halfway between two states a body is at the middle, turned by half.
    half = caplet.trace(scene, o, d, time=2.25)
    still = scene.copy()
    for i in range(3):
        still.animate_instance(i, [], [])
        ends = [np.eye(4), np.eye(4)]
        for end, state in zip(ends, qpos):
            mujoco.mju_quat2Mat(flat := np.zeros(9), state[7 * i + 3:7 * i + 7])
            end[:3, :3], end[:3, 3] = flat.reshape(3, 3), state[7 * i:7 * i + 3]
        a, b = qpos[0, 7 * i + 3:7 * i + 7], qpos[1, 7 * i + 3:7 * i + 7]
        middle = (a + np.sign(a @ b) * b) / np.linalg.norm(a + np.sign(a @ b) * b)
        mujoco.mju_quat2Mat(flat := np.zeros(9), middle)
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = flat.reshape(3, 3), (ends[0][:3, 3] + ends[1][:3, 3]) / 2
        still.set_instance(i, place)
    expected = caplet.trace(still, o, d)
    assert (half["shape"] == expected["shape"]).mean() > 0.995
    both = np.isfinite(half["t"]) & (half["shape"] == expected["shape"])
    assert np.abs(half["t"][both] - expected["t"][both]).max() < 1e-4
    # As bright as what rests, and blurred between the shutter's times alone.
    scene.shutter(2, 2.001)
    first = caplet.from_mujoco(model)
    first_state = mujoco.MjData(model)
    first_state.qpos[:] = qpos[0]
    mujoco.mj_forward(model, first_state)
    caplet.bridges.update_mujoco(first, first_state)
    render = {"spp": 64, "size": (48, 36)}
    assert np.abs(caplet.render(scene, **render).rgb - caplet.render(first, **render).rgb).mean() < 0.02
    for wrong in ((2, 2), (3, 2), (0, np.nan)):
        with pytest.raises(caplet.InputError):
            scene.shutter(*wrong)
    with pytest.raises(caplet.InputError, match="moves by its states"):
        caplet.bridges.update_mujoco(scene, first_state)
    for wrong in ({"times": [0, 1]}, {"qpos": qpos}, {"times": [0, 1], "qpos": qpos}, {"times": [0, 2, 1], "qpos": qpos}, {"times": [0, 1, 2], "qpos": qpos[:, 1:]}):
        with pytest.raises(caplet.InputError):
            caplet.from_mujoco(model, **wrong)


def test_every_kind_of_geom_tumbles_as_mujoco_has_it():
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(TUMBLERS)
    scene = caplet.from_mujoco(model)
    assert scene.info["moving"].tolist() == [2, 3, 4]  # the floor and the sphere, the world's own geoms, come first
    rng = np.random.default_rng(5)
    qpos = np.tile(model.qpos0, (4, 1))
    for first in (3, 10, 17):
        qpos[:, first:first + 4] = rng.normal(size=(4, 4))
        qpos[:, first:first + 4] /= np.linalg.norm(qpos[:, first:first + 4], axis=1)[:, None]
    camera, pose = Pinhole(80, 60, fx=70), np.eye(4)
    pose[:3, :3], pose[:3, 3] = [[1, 0, 0], [0, -0.3162, 0.9487], [0, -0.9487, -0.3162]], (0, -4, 2.5)
    seen = caplet.Batch(scene, scene.info["moving"]).look(caplet.bridges.mujoco_worlds(scene, model, qpos), camera, pose)
    ways = camera.unproject(camera.pixels()) @ pose[:3, :3].T  # t counts depth
    lengths = np.linalg.norm(ways, axis=1)
    for i, state in enumerate(qpos):
        now = mujoco.MjData(model)
        now.qpos[:] = state
        mujoco.mj_forward(model, now)
        ranges, geoms = np.zeros(len(ways)), np.zeros(len(ways), np.int32)
        mujoco.mj_multiRay(model, now, pose[:3, 3], (ways / lengths[:, None]).ravel(), None, 1, -1, geoms, ranges, None, len(ways), 1e6)
        shape, depth = seen["shape"][i].ravel(), seen["depth"][i].ravel()
        mine = np.where(shape == NONE, -1, scene.info["geom"][np.minimum(shape, len(scene.info["geom"]) - 1)])
        same = mine == geoms
        assert same.mean() > 0.995, same.mean()  # but for edges
        assert set(scene.info["geom"]) <= set(geoms)
        assert (np.abs(depth * lengths - ranges)[same & (geoms >= 0)] < 1e-4 * 10).all()
