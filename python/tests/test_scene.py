# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Scenes that are built from arrays hold what the arrays say; wrong ones are told and change nothing."""
import copy
import math
import os
import typing

import numpy as np
import pytest

import caplet
from caplet import cameras, lights, materials, media, textures


def same_pictures(one, two, **options):
    options = {"spp": 2, "size": (24, 18), **options}
    a, b = caplet.render(one, **options), caplet.render(two, **options)
    return all(np.array_equal(a[name].view(np.uint32), b[name].view(np.uint32)) for name in a.channels)


def test_capsules_are_the_arrays():
    scene = caplet.Scene()
    p0 = np.arange(12, dtype=np.float32).reshape(4, 3)
    shape = scene.add_capsules(p0, p0 + 1, [1, 2, 3, 4], radius1=0.5, name="four")
    assert scene.primitives == {"capsule": 4} and len(shape) == 4 and shape.name == "four" and scene.shapes == ["four"]
    assert np.array_equal(shape.p0, p0) and np.array_equal(shape.p1, p0 + 1)
    assert np.array_equal(shape.radius, [[1, 0.5], [2, 0.5], [3, 0.5], [4, 0.5]])


def test_u_of_chains():
    scene = caplet.Scene()
    shape = scene.add_capsules([[0, 0, 0], [1, 0, 0]], [[1, 0, 0], [3, 0, 0]], 0.1, u=[[0, 0.25], [0.25, 1]])
    assert shape.u.dtype == np.float32 and np.array_equal(shape.u, [[0, 0.25], [0.25, 1]])
    # Down from above, 0.05 beside the axis: ray x axis is -y, and 1/2 - 0.05 / 0.2.
    hits = caplet.trace(scene, [[0.5, 0.05, 1], [2, 0, 1]], [0, 0, -1])
    assert np.allclose(hits["uv"], [[0.125, 0.25], [0.625, 0.5]], atol=1e-6)
    shape.set(radius=0.2)
    assert np.array_equal(shape.u, [[0, 0.25], [0.25, 1]])
    shape.set(u=(0, 1))
    assert np.array_equal(shape.u, [[0, 1], [0, 1]])
    assert scene.add_capsules((0, 0, 0), np.eye(3), 1).u.shape == (0, 2)
    with pytest.raises(caplet.InputError, match="u has 3 entries"):
        scene.add_capsules(np.zeros((2, 3)), np.ones((2, 3)), 1, u=np.zeros((3, 2)))
    with pytest.raises(caplet.InputError, match="u"):
        scene.add_capsules((0, 0, 0), (1, 0, 0), 1, u=(0, np.nan))


@pytest.mark.parametrize("given", [
    lambda a: a.astype(np.float32), lambda a: a.astype(np.float64), lambda a: a.astype(np.int32), lambda a: a.astype(np.float16),
    lambda a: a.astype(">f8"), lambda a: a.astype(np.longdouble), lambda a: np.asfortranarray(a), lambda a: np.repeat(a, 2, axis=0)[::2],
    lambda a: a[::-1][::-1], lambda a: np.concatenate([a, a], axis=1)[:, :3], lambda a: a.tolist(), lambda a: memoryview(a),
    lambda a: np.lib.stride_tricks.as_strided(a, a.shape, a.strides, writeable=False), lambda a: np.ma.masked_array(a)])
def test_arrays_of_every_kind(given):
    p0 = np.arange(15.0).reshape(5, 3)
    scene = caplet.Scene()
    shape = scene.add_capsules(given(p0), given(p0 + 10), given(p0)[:, 0] if isinstance(given(p0), np.ndarray) else [0, 3, 6, 9, 12])
    assert np.array_equal(shape.p0, p0) and np.array_equal(shape.p1, p0 + 10) and np.array_equal(shape.radius[:, 0], p0[:, 0])


def test_fields_of_packed_records_and_unaligned_arrays():
    records = np.zeros(7, dtype=[("tag", "u1"), ("at", "f8", (3,)), ("r", "f4")])
    records["at"], records["r"] = np.arange(21).reshape(7, 3), 2
    assert records["at"].strides[0] % 8 and not records["at"].flags.aligned
    shape = caplet.Scene().add_spheres(records["at"], records["r"])
    assert np.array_equal(shape.p0, records["at"]) and np.array_equal(shape.radius, np.full((7, 2), 2))


def test_one_stands_for_all():
    scene = caplet.Scene()
    shape = scene.add_capsules((0, 0, 0), np.eye(3), 1)
    assert np.array_equal(shape.p0, np.zeros((3, 3))) and np.array_equal(shape.p1, np.eye(3)) and np.array_equal(shape.radius, np.ones((3, 2)))


EMPTY = np.empty((0, 3))


@pytest.mark.parametrize("arguments, says", [
    ((EMPTY, EMPTY, 1), "there are none"), ((EMPTY, np.ones((1, 3)), 1), "none"), ((np.ones((4, 3)), np.ones((5, 3)), 1), "p1 has 5 entries, and p0 4"),
    ((np.ones((4, 3)), np.ones((4, 3)), np.ones(3)), "radius has 3 entries"), ((np.ones((4, 2)), np.ones((4, 3)), 1), r"p0: shape \(n, 3\)"),
    ((np.ones((4, 3, 3)), np.ones((4, 3)), 1), "p0: shape"), ((np.ones((4, 3)), np.ones((4, 3)), np.ones((4, 3))), "radius: shape"),
    (("a", "b", 1), "p0: an array of numbers"), (([[1, 2, 3], [1, 2]], (0, 0, 0), 1), "p0: not an array|p0: an array of numbers"),
    ((np.ones((4, 3), dtype=complex), np.ones((4, 3)), 1), "not of complex128"), ((np.ones((4, 3), dtype=bool), np.ones((4, 3)), 1), "not of bool"),
    ((np.array([[None] * 3]), np.ones((4, 3)), 1), "not of object"), ((None, (0, 0, 0), 1), "p0: an array of numbers"),
    (([[math.nan, 0, 0]], (0, 0, 0), 1), "finite"), (([[math.inf, 0, 0]], (0, 0, 0), 1), "finite"), (([[1e300, 0, 0]], (0, 0, 0), 1), "finite|1e18"),
    (((0, 0, 0), (1, 0, 0), -1), "radius|radii"), (((0, 0, 0), (1, 0, 0), math.nan), "finite"), (((0, 0, 0), (1, 0, 0), math.inf), "finite"),
    (((1e30, 0, 0), (1, 0, 0), 1), "1e18"),
    ((np.datetime64("2020"), (0, 0, 0), 1), "datetime"), ((np.broadcast_to(np.zeros(3), (2**40, 3)), (0, 0, 1), 1), "at most"),
])
def test_wrong_arrays_are_told_and_change_nothing(arguments, says):
    scene = caplet.Scene()
    with pytest.raises(caplet.InputError, match=says):
        scene.add_capsules(*arguments)
    assert scene.primitives == {} and scene.shapes == []


@pytest.mark.skipif("CAPLET_SANITIZED" in os.environ, reason="under ASan memory that cannot be had ends the process")
def test_what_does_not_fit_into_memory():
    with pytest.raises((MemoryError, caplet.InputError)):
        caplet.Scene().add_capsules(np.broadcast_to(np.zeros(3), (2**31 - 1, 3)), (0, 0, 1), np.broadcast_to(1.0, 2**31 - 2))


def test_a_million_at_a_time(rng):
    p0 = rng.random((1_000_000, 3), dtype=np.float32)
    shape = caplet.Scene().add_capsules(p0, p0 + np.float32(0.01), 0.001)
    assert len(shape) == 1_000_000 and np.array_equal(shape.p0, p0)


def test_colors_of_all_and_of_each():
    scene = caplet.Scene()
    scene.add_spheres(np.eye(3), 0.1, color=(1, 0, 0))
    scene.add_spheres(np.eye(3) * 2, 0.1, color=[(1, 0, 0), (0, 1, 0), (1, 0, 0)])
    assert len(scene.materials) == 3
    hits = caplet.trace(scene, [(2, 0, 5), (0, 2, 5), (0, 0, 5), (1, 0, 5)], (0, 0, -1))
    assert hits["material_id"].tolist() in ([1, 2, 1, 0], [2, 1, 2, 0]) and hits["primitive"].tolist() == [0, 1, 2, 0]
    scene.shape(1).set(radius=0.2)  # the colours stay
    assert np.array_equal(caplet.trace(scene, [(2, 0, 5), (0, 2, 5), (0, 0, 5), (1, 0, 5)], (0, 0, -1))["material_id"], hits["material_id"])
    for wrong in ((2, 0, 0), (1, 0), np.ones((2, 3)), np.full((3, 3), math.nan), "red", -1.0):
        with pytest.raises(caplet.InputError):
            scene.add_spheres(np.eye(3), 0.1, color=wrong)
    same, hexed = caplet.Scene(), caplet.Scene()
    same.add_spheres((0, 0, 0), 1, color=tuple([((128 / 255 + 0.055) / 1.055)**2.4] * 3))
    hexed.add_spheres((0, 0, 0), 1, color="#808080")
    assert same_pictures(same, hexed)


def test_more_colors_than_materials_are_rounded(rng):
    scene = caplet.Scene()
    scene.add_spheres(rng.random((20000, 3)), 0.01, color=rng.random((20000, 3)))
    assert 100 < len(scene.materials) <= 4096


def at_the_middle(scene, p=(0, 0, 10), d=(0, 0, -1)):
    return caplet.trace(scene, p, d)[0]


SHAPES = {  # with where a ray from (0, 0, 10) down hits it
    "sphere": (dict(radius=2), 8), "capsule": (dict(p0=(0, 0, -1), p1=(0, 0, 1), radius=0.5), 8.5),
    "capsules": (dict(p0=[(0, 0, -1), (5, 0, 0)], p1=[(0, 0, 2), (6, 0, 0)], radius=[0.5, 0.1]), 7.5),
    "cylinder": (dict(p0=(0, 0, -1), p1=(0, 0, 3), radius=1), 7), "cone": (dict(p0=(0, 0, 2), p1=(0, 0, -1), radius=(1, 0.5)), 8),
    "box": (dict(p0=(-1, -1, -1), p1=(1, 1, 1.5)), 8.5), "disk": (dict(height=4, radius=1), 6),
    "molecularsurface": (dict(P=[(0, 0, 0), (0, 0, 1.5)], radius=[1, 1], probe=1), 7.5),
    "polyhedron": (dict(P=[(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)],
                        N=[(0, 0, 1), (0, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]), 9),
    "trianglemesh": (dict(P=[(-1, -1, 1), (2, -1, 1), (-1, 2, 1)], indices=[0, 1, 2]), 9),
    "bilinearmesh": (dict(P=[(-1, -1, 2), (1, -1, 2), (-1, 1, 2), (1, 1, 2)]), 8),
    "curve": (dict(P=[(-3, 0, 0), (-1, 0, 0), (1, 0, 0), (3, 0, 0)], width=1), 9.5),
    "loopsubdiv": (dict(P=[(-1, -1, 1), (2, -1, 1), (-1, 2, 1)], indices=[0, 1, 2], levels=1), 9),
    "csg": (dict(operation="difference", operands=["whole", "part"]), 9), "plymesh": (None, None),
}


def test_every_type_of_shape_is_there_by_its_parameters(tmp_path):
    assert set(caplet.shape_types()) <= set(SHAPES), "a new shape is to be tried here"
    ply = tmp_path / "one.ply"
    ply.write_text("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                   "property list uchar int vertex_indices\nend_header\n-1 -1 3\n2 -1 3\n-1 2 3\n3 0 1 2\n")
    SHAPES["plymesh"] = dict(filename=ply), 7
    for type in caplet.shape_types():
        given, t = SHAPES[type]
        known = dict(caplet.shape_parameters(type))
        assert set(given) <= set(known), type
        scene = caplet.Scene()
        if type == "csg":
            scene.add("box", p0=(-1, -1, -1), p1=(1, 1, 2), object="whole")
            scene.add("box", p0=(-2, -2, 1), p1=(2, 2, 3), object="part")
        scene.add(type, name="it", **given)
        hit = at_the_middle(scene)
        assert hit["t"] == pytest.approx(t, abs=2e-3 if type == "curve" else 1e-5), type
        assert scene.shapes[hit["shape"]] == "it"
        with pytest.raises(caplet.InputError, match="nearest"):
            scene.add(type, raduis=1, **given)


def test_shapes_in_bulk_are_shapes_of_their_own(rng):
    n = 50
    at = rng.random((n, 3)) * 10
    scene = caplet.Scene()
    tubes = scene.add_cylinders(at, at + [0, 0, 0.1], 0.01, caps="round")
    boxes = scene.add_boxes(at + 20, at + 20.05, color=rng.random((n, 3)))
    cones = scene.add_cones(at + 40, at + [40, 40, 40.1], np.tile([0.02, 0.01], (n, 1)))
    balls = scene.add_ellipsoids(at + 60, (0.01, 0.02, 0.03))
    disks = scene.add_disks(np.full(n, 0.01), transform=np.array([[[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z + 80], [0, 0, 0, 1]] for x, y, z in at]))
    assert scene.primitives == {"box": n, "cone": n, "cylinder": n, "disk": n, "sphere": n}
    for shapes, offset, top in ((tubes, 0, 0.11), (boxes, 20, 0.05), (cones, 40, 0.1), (balls, 60, 0.03), (disks, np.array([0, 0, 80]), 0)):
        assert len(shapes) == n
        inner = 0.025 if shapes is boxes else 0.002
        origins = at + offset + [inner, inner, 1] if shapes is boxes else at + offset + [0, 0, 1]
        hits = caplet.trace(scene, origins, (0, 0, -1), t_max=2)
        assert np.array_equal(hits["object_id"], [shape.number for shape in shapes])
        assert np.allclose(hits["t"], 1 - top, atol=1e-4)
    for wrong in (dict(p0=at, p1=at[:7], radius=1), dict(p0=at, p1=at, radius=1), dict(p0=at, p1=at + 1, radius=-1),
                  dict(p0=at[:0], p1=at[:0], radius=1), dict(p0=at * math.nan, p1=at, radius=1)):
        with pytest.raises(caplet.InputError):
            scene.add_cylinders(**wrong)
    with pytest.raises(caplet.InputError):
        scene.add_many("cylinder", 3, each={"p0": np.zeros((2, 3))})
    assert scene.primitives["cylinder"] == n


def test_ellipsoids_are_turned():
    # Turned by a quarter about z: the first radius lies along y, the second along x.
    turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1.0]])
    scene = caplet.Scene()
    scene.add_ellipsoids((0, 0, 0), (1, 2, 3), rotation=turn)
    for way, t in (((1, 0, 0), 8), ((0, 1, 0), 9), ((0, 0, 1), 7)):
        assert caplet.trace(scene, -10 * np.array(way), way)["t"][0] == pytest.approx(t, abs=1e-4)


def test_copies_are_of_their_own():
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1, name="ball")
    scene.info["numbers"] = [1]
    other = scene.copy()
    other.info["numbers"] = [2]
    other["ball"].set(radius=3)
    other.add_spheres((9, 0, 0), 1)
    assert scene.info == {"numbers": [1]} and scene["ball"].radius[0, 0] == 1 and scene.shapes == ["ball"] and other["ball"].radius[0, 0] == 3


def test_meshes():
    scene = caplet.Scene()
    vertices = np.array([(-1, -1, 1), (2, -1, 1), (-1, 2, 1.0)])
    for faces in ([[0, 1, 2]], np.array([[0, 1, 2]], dtype=np.int8), np.asfortranarray([[0, 1, 2]])):
        scene.add_mesh(vertices, faces, normals=[(0, 0, 1)] * 3, uv=[(0, 0), (1, 0), (0, 1)])
    assert scene.primitives == {"triangle": 3} and at_the_middle(scene)["t"] == 9
    for wrong in (dict(faces=[[0, 1, 3]]), dict(faces=[[0, 1, -1]]), dict(faces=[[0.0, 1, 2]]), dict(faces=np.empty((0, 3), int)), dict(faces=[0, 1, 2]),
                  dict(faces=[[0, 1]]), dict(faces=[[0, 1, 2**40]]), dict(faces=[[0, 1, 2**32]]), dict(faces=[[0, 1, 2]], normals=[(0, 0, 1)]),
                  dict(faces=[[0, 1, 2]], uv=[(math.nan, 0)] * 3), dict(vertices=vertices * math.inf, faces=[[0, 1, 2]])):
        with pytest.raises(caplet.InputError):
            scene.add_mesh(**{"vertices": vertices, **wrong})
    assert scene.primitives == {"triangle": 3}


def test_objects_and_instances():
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1, name="floor")
    leaf = scene.add("box", p0=(-1, -1, -1), p1=(1, 1, 1), object="leaf", name="blade")
    places = np.tile(np.eye(4), (3, 1, 1))
    places[:, 0, 3] = [10, 20, 30]
    assert list(scene.add_instances("leaf", places)) == [0, 1, 2] and scene.instances == 3
    assert scene.primitives == {"capsule": 1, "box": 3} and leaf.number == 1 and leaf.name == "blade"
    hit = caplet.trace(scene, (20, 0, 5), (0, 0, -1))[0]
    assert hit["t"] == 4 and hit["instance"] == 1 and hit["shape"] == leaf.number
    scene.set_instance(1, np.diag([1, 1, 2, 1]) + np.array([[0, 0, 0, 20], [0] * 4, [0] * 4, [0] * 4]))
    assert caplet.trace(scene, (20, 0, 5), (0, 0, -1))["t"][0] == 3
    scene.add_spheres((50, 0, 0), 1)  # numbers of objects' shapes follow those of the world
    assert leaf.number == 2 and scene.shape(2).name == "blade" and scene.shape("blade").object == "leaf" and scene["floor"].number == 0
    for wrong in (np.zeros((4, 4)), np.eye(3), np.full((4, 4), math.nan), np.ones((4, 4)), np.empty((0, 4, 4)), "here"):
        with pytest.raises(caplet.InputError):
            scene.add_instances("leaf", wrong)
    with pytest.raises(caplet.InputError, match="nearest is 'leaf'"):
        scene.add_instances("leav", np.eye(4))
    assert scene.instances == 3


def test_editing_in_place(row):
    shape = row.shape("row")
    shape.transform = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 3], [0, 0, 0, 1]]
    assert shape.transform[2, 3] == 3
    assert np.allclose(caplet.trace(row, (0, 0.5, 10), (0, 0, -1))["t"], 10 - 3 - 0.25)
    shape.set(p0=shape.p0 + [0, 0, 1], p1=shape.p1 + [0, 0, 1])
    assert np.allclose(caplet.trace(row, (0, 0.5, 10), (0, 0, -1))["t"], 10 - 4 - 0.25)
    shape.set(p0=[(0, 0, 0)], p1=[(0, 1, 0)], radius=0.5)
    assert len(shape) == 1 and np.allclose(caplet.trace(row, (0, 0.5, 10), (0, 0, -1))["t"], 10 - 3 - 0.5)
    with pytest.raises(caplet.InputError):
        shape.set(radius=-1)
    for wrong in (np.zeros((4, 4)), np.eye(3), np.full((4, 4), math.inf)):
        with pytest.raises(caplet.InputError):
            shape.transform = wrong
    assert len(shape) == 1 and shape.transform[2, 3] == 3


def test_a_copy_goes_its_own_way(row):
    for other in (row.copy(), copy.copy(row), copy.deepcopy(row)):
        other.add_spheres((9, 9, 9), 1)
        assert len(other.shapes) == 2 and len(row.shapes) == 1


def test_transforms_place_shapes():
    scene = caplet.Scene()
    scene.add("sphere", radius=1, transform=np.array([[2, 0, 0, 0], [0, 2, 0, 0], [0, 0, 2, 1], [0, 0, 0, 1.0]]))
    scene.add("sphere", radius=1, transform=np.array([[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0.0]]))
    assert caplet.trace(scene, [(0, 0, 10), (5, 0, 10)], (0, 0, -1))["t"].tolist() == [7, 9]
    with pytest.raises(caplet.InputError, match="last row"):
        scene.add("sphere", radius=1, transform=np.ones((4, 4)))


# --- The lists of the library ---


def test_misspelt_names_are_told_the_nearest():
    for call, near in ((lambda: lights.spot(conangle=3), "coneangle"), (lambda: caplet.render(None, noize=0.1), "noise"),
                       (lambda: caplet.Scene().add_capsules([(0, 0, 0)], [(1, 0, 0)], radiuss=1), "radius"),
                       (lambda: caplet.Session(None, sise=(4, 4)), "size"), (lambda: caplet.denoise(None, qualty="high"), "quality")):
        with pytest.raises(TypeError, match=f"unexpected keyword argument '.*'; the nearest is '{near}'$"):
            call()
    with pytest.raises(TypeError, match="; it has I, from_, to, coneangle"):
        lights.spot(zzzzz=3)
    with pytest.raises(AttributeError, match="'caplet.textures' has no attribute 'checker'; the nearest is 'checkerboard'$"):
        caplet.textures.checker()
    assert not hasattr(caplet.materials, "zzzzz")


def test_every_type_has_a_constructor_of_its_parameters():
    from caplet import named
    for kind, module in (("material", materials), ("texture", textures), ("light", lights), ("medium", media), ("camera", cameras)):
        assert module.__all__ == [named.spelled(type) for type in named.types(kind)] and module.__all__
        for type in named.types(kind):
            make = getattr(module, named.spelled(type))
            assert make().type == type and make.__doc__
            for key, name, _ in named.signature(kind, type):
                if name != "alpha":
                    assert make(**{key: 1}).parameters == {name: 1}
            with pytest.raises(TypeError, match="unexpected"):
                make(no_such=1)
    assert {"principled", "hair", "mix", "dielectric"} <= set(materials.__all__)
    assert {"spot", "infinite", "distant", "ies"} <= set(lights.__all__)
    assert lights.spot(from_=(0, 0, 1)).parameters == {"from": (0, 0, 1)}
    assert materials.coatedconductor(conductor_alpha_u=0.3).parameters == {"conductor.alpha_u": 0.3}
    assert materials.conductor(alpha=0.2).parameters == {"alpha_u": 0.2, "alpha_v": 0.2}


def test_what_is_built_is_what_a_file_says(tmp_path):
    file = tmp_path / "scene.pbrt"
    file.write_text("""
Scale -1 1 1
LookAt 3 2 6  0 0.5 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 32 "integer yresolution" 24
PixelFilter "box"
Integrator "path" "integer maxdepth" 7
WorldBegin
LightSource "spot" "point3 from" [1 5 2] "point3 to" [0 0 0] "rgb I" [90 80 70] "float coneangle" 40
LightSource "infinite" "blackbody L" 5000 "float scale" 0.3
Texture "squares" "float" "checkerboard" "float uscale" 4 "float vscale" 8 "float tex2" 0.25
Material "principled" "rgb base_color" [0.8 0.3 0.1] "texture metallic" "squares" "float roughness" 0.3
Shape "sphere"
Material "dielectric" "float eta" 1.4
MakeNamedMedium "fog" "string type" "homogeneous" "float sigma_a" 0.5 "float sigma_s" 2 "float g" 0.3
AttributeBegin
Translate 2 0 0
MediumInterface "fog" ""
Shape "cylinder" "point3 p0" [0 0 0] "point3 p1" [0 1 0] "float radius" 0.5 "string caps" ["round" "flat"]
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [2 1 1] "bool twosided" true
Material "diffuse"
Shape "disk" "float radius" 0.5 "float height" 2
AttributeEnd
""")
    scene = caplet.Scene()
    scene.film(xresolution=32, yresolution=24)
    scene.filter("box")
    scene.integrator("path", maxdepth=7)
    scene.camera = cameras.perspective(fov=30, eye=(3, 2, 6), target=(0, 0.5, 0))
    scene.add_light(lights.spot(from_=(1, 5, 2), to=(0, 0, 0), I=(90, 80, 70), coneangle=40))
    scene.add_light(lights.infinite(L=caplet.Blackbody(5000), scale=0.3))
    squares = textures.checkerboard(uscale=4, vscale=8, tex2=0.25, is_float=True)
    scene.add("sphere", material=materials.principled(base_color=(0.8, 0.3, 0.1), metallic=squares, roughness=0.3))
    fog = media.homogeneous(sigma_a=0.5, sigma_s=2, g=0.3, name="fog")
    scene.add("cylinder", p0=(0, 0, 0), p1=(0, 1, 0), radius=0.5, caps=["round", "flat"], material=materials.dielectric(eta=1.4), inside=fog,
              transform=[[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    scene.add("disk", radius=0.5, height=2, material=materials.diffuse(), emission={"L": (2, 1, 1), "twosided": True})
    loaded = caplet.load(file)
    assert scene.size == (32, 24) and scene.max_depth == 7 and np.allclose(scene.camera, loaded.camera)
    assert same_pictures(scene, loaded, spp=4)
    scene.save(tmp_path / "written.pbrt")
    assert same_pictures(scene, caplet.load(tmp_path / "written.pbrt"), spp=4)


@pytest.mark.parametrize("make, says", [
    (lambda s: s.add_light(lights.spot(coneangle=200)), "coneangle"), (lambda s: s.add_light(lights.spot(I="red")), "red"),
    (lambda s: s.add_light(lights.spot(from_=(1, 2))), "from"), (lambda s: s.add_light(lights.goniometric()), "filename"),
    (lambda s: s.add_light(lights.spot(from_=(0, math.nan, 0))), "finite"), (lambda s: s.add_light(lights.spot(I=[])), "no value"),
    (lambda s: s.add_light(materials.diffuse()), "caplet.lights"), (lambda s: s.add_light(lights.infinite(filename="no.exr")), "no such file"),
    (lambda s: s.add_light(lights.point(transform=np.zeros((4, 4)))), "last row|transform|finite|from"),
    (lambda s: s.add("sphere", material=materials.diffuse(reflectance=2)), "reflectance"), (lambda s: s.add("sphere", material="none"), "no material"),
    (lambda s: s.add("sphere", material=7), "no material 7"), (lambda s: s.add("sphere", inside=7), "no medium 7"),
    (lambda s: s.add("sphere", inside=media.homogeneous(g=2)), '"g"'), (lambda s: s.add("sphere", material=materials.hair(beta_m=textures.imagemap())), "filename"),
    (lambda s: s.add("sphre"), "nearest is 'sphere'"), (lambda s: s.add("sphere", radius=(1, 2)), "radius"), (lambda s: s.add("sphere", radius="1"), "radius"),
    (lambda s: s.add("sphere", emission={"L": -1}), '"L"'), (lambda s: s.add("csg", operation="union", operands=["a", "b"]), "none of"),
    (lambda s: s.add("disk", radius=math.inf), "finite"), (lambda s: setattr(s, "size", (0, 5)), "width"), (lambda s: setattr(s, "spp", 0), "samples"),
    (lambda s: setattr(s, "fov", 180), "field of view|fov|empty"), (lambda s: s.look_at((0, 0, 0), (0, 0, 0)), "no direction"),
    (lambda s: setattr(s, "camera", cameras.perspective(fov=200)), "fov"), (lambda s: setattr(s, "camera", cameras.perspective(eye=(1, 1, 1))), "go together"),
    (lambda s: s.filter("box", xradius=-1), "xradius"), (lambda s: s.integrator("path", maxdepth=-1), "maxdepth"), (lambda s: s.film(iso=0), "iso"),
    (lambda s: s.integrator("parth"), "nearest is 'path'"), (lambda s: s.crop(5, 5, 5, 6), "crop|empty"), (lambda s: s.shape(5), "no shape 5"),
    (lambda s: s.shape("x"), "no shape"), (lambda s: caplet.render(s), "empty"), (lambda s: caplet.trace(s, (0, 0, 0), (0, 0, 1)), "empty"),
    (lambda s: s.save("/tmp/never.pbrt"), "empty"),
])
def test_wrong_words_are_told_and_change_nothing(make, says):
    scene = caplet.Scene()
    with pytest.raises(caplet.InputError, match=says):
        make(scene)
    assert scene.shapes == [] and scene._native.lights == 0


def test_errors_have_places(tmp_path):
    file = tmp_path / "bad.pbrt"
    file.write_text('WorldBegin\n\n    Shape "spher"\n')
    with pytest.raises(caplet.InputError) as caught:
        caplet.load(file)
    assert (caught.value.file, caught.value.line, caught.value.column) == (str(file), 3, 5)
    assert caught.value.messages == [str(caught.value)] and isinstance(caught.value, ValueError)
    with pytest.raises(caplet.InputError) as caught:
        caplet.load(tmp_path / "none.pbrt")
    assert caught.value.file == str(tmp_path / "none.pbrt") and caught.value.line is None
    import pickle
    assert pickle.loads(pickle.dumps(caught.value)).messages == caught.value.messages


def test_open_camera_and_light_follow_the_shapes():
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1)
    near = caplet.render(scene, spp=1, size=(16, 16))
    assert near.rgb.max() > 0.1 and (near.object_id == 0).mean() > 0.4
    camera = scene.camera
    scene.add_spheres((0, 0, 50), 1)
    caplet.render(scene, spp=1, size=(16, 16))
    assert not np.allclose(scene.camera, camera)
    scene.look_at((0, 0, 10), (0, 0, 0))
    scene.add_spheres((0, 0, -50), 1)
    caplet.render(scene, spp=1, size=(16, 16))
    assert np.allclose(scene.camera[:3, 3], (0, 0, 10)) and scene._native.lights == 1
    scene.add_light(lights.point(from_=(0, 0, 10)))
    assert scene._native.lights == 1
    scene.remove_lights()
    assert caplet.render(scene, spp=1, size=(16, 16)).rgb.max() == 0


def test_pictures_of_right_handed_worlds_are_no_mirror_images(tmp_path):
    # Seen from +z with y up, +x is to the right, as the automatic camera has it.
    scene = caplet.Scene()
    scene.add_spheres([(-1, 0, 0), (1, 0, 0)], 0.5)

    def right(of):
        of.fov = 20
        image = caplet.render(of, spp=1, size=(40, 20))
        return [int(np.flatnonzero((image.primitive_id == i).any(axis=0)).mean()) for i in (0, 1)]
    scene.look_at((0, 0, 9), (0, 0, 0))
    at = right(scene)
    assert at[0] < 20 <= at[1]
    scene.look_at((0, 9, 0), (0, 0, 0), (0, 0, -1))
    assert right(scene) == at
    scene.camera = cameras.perspective(eye=(0, 0, -9), target=(0, 0, 0), fov=40)
    assert right(scene)[0] >= 20 > right(scene)[1]
    scene.look_at((0, 0, 9), (0, 0, 0))
    assert right(scene)[0] < 20 <= right(scene)[1]
    # What a file has mirrored stays so.
    file = tmp_path / "mirrored.pbrt"
    file.write_text('LookAt 0 0 9  0 0 0  0 1 0\nCamera "perspective" "float fov" 30\nWorldBegin\n'
                    'Shape "capsules" "point3 p0" [-1 0 0 1 0 0] "point3 p1" [-1 0 0 1 0 0] "float radius" [0.5 0.5]\n')
    loaded = caplet.load(file)
    assert right(loaded)[0] > right(loaded)[1]
    loaded.look_at((0, 0, 12), (0, 0, 0))
    assert right(loaded)[0] > right(loaded)[1]


def test_files_of_every_kind(scenes):
    neuron = caplet.load(scenes / "neuron.swc")
    assert neuron.primitives["capsule"] > 500 and len(neuron.shape(1)) > 0
    assert repr(neuron).startswith("<caplet.Scene: ")
    gallery = caplet.load(str(scenes / "gallery.pbrt"))
    assert gallery.bounds.shape == (2, 3) and len(gallery.shapes) > 5


def test_files_are_read_as_options_say(tmp_path):
    file = tmp_path / "water.xyz"
    file.write_text("3\nwater\nO 0 0 0\nH 0.96 0 0\nH -0.24 0.93 0\n")
    assert caplet.load(file, style="spheres").primitives != caplet.load(file, style="sticks").primitives
    assert not np.array_equal(caplet.load(file, style="spheres", hydrogens=False).bounds, caplet.load(file, style="spheres").bounds)
    assert caplet.load(file, show=["element O: spheres", "hydrogen: sticks opacity 0.5"]).primitives == {"capsule": 3}
    assert caplet.load(file, show="element O: spheres").primitives == {"capsule": 1}
    with pytest.raises(caplet.InputError, match="--show.*'oxygen'"):
        caplet.load(file, show=["oxygen: spheres"])
    with pytest.raises(caplet.InputError, match="--radius"):
        caplet.load(file, radius=1)
    with pytest.raises(caplet.InputError, match="--style"):
        caplet.load(file, style="thick")


@pytest.mark.parametrize("name", [b"K\xfcgel", b"\x80", b"\xc0\xaf", b"\xed\xa0\x80", b"\xf4\x90\x80\x80", b"\xe2\x82", b"\xff\xfe", "K\u00fcgel \u20ac \U0001f600".encode()])
def test_names_of_any_bytes_are_text(tmp_path, name):
    text = b"""MakeNamedMedium "%s" "string type" "homogeneous"
WorldBegin
MakeNamedMaterial "%s" "string type" "diffuse"
NamedMaterial "%s"
MediumInterface "%s" ""
Shape "sphere" "string name" "%s"
ObjectBegin "%s"
Shape "sphere" "string name" "%s"
ObjectEnd
ObjectInstance "%s"
""".replace(b"%s", name)
    (tmp_path / "a.pbrt").write_bytes(text)
    scene = caplet.load("a.pbrt")
    said = name.decode("utf-8", "replace")  # as Python itself has it
    native = scene._native
    assert native.shapes() == [said, said] and native.materials()[0] == said and native.media()[0] == said and native.objects() == [said]
    assert scene.shapes == [said, said]
    scene.add_instances(said, np.eye(4)[None])  # it is found by it
    scene.save("b.pbrt")
    assert caplet.load("b.pbrt")._native.materials()[0] == said
    with pytest.raises(caplet.InputError) as error:
        (tmp_path / "c.pbrt").write_bytes(b'WorldBegin\nNamedMaterial "%s"\nShape "sphere"\n' % name)
        caplet.load("c.pbrt")
    assert "c.pbrt" in str(error.value)


def test_scenes_of_strangers_stay_in_their_folder(tmp_path):
    (tmp_path / "up").mkdir()
    (tmp_path / "cell.swc").write_text("1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n")
    (tmp_path / "up" / "own.swc").write_text("1 1 0 0 0 1 -1\n2 3 5 0 0 1 1\n")
    (tmp_path / "up" / "link.swc").symlink_to("../cell.swc")
    scene = tmp_path / "up" / "a.pbrt"
    for name, is_inside in [("own.swc", True), ("../cell.swc", False), (str(tmp_path / "cell.swc"), False), ("link.swc", False)]:
        scene.write_text(f'WorldBegin\nShape "swc" "string filename" "{name}"\n')
        assert len(caplet.load(scene).shapes) == 2
        if is_inside:
            assert len(caplet.load(scene, no_outside=True).shapes) == 2
            continue
        with pytest.raises(caplet.InputError, match="outside of the scene's folder") as error:
            caplet.load(scene, no_outside=True)
        assert (error.value.file, error.value.line) == (str(scene), 2)
        assert len(caplet.load(scene, no_outside=False).shapes) == 2
    with pytest.raises(caplet.InputError, match="outside"):
        caplet.load(tmp_path / "up" / "link.swc", no_outside=True)


def test_instances_and_cameras_move(tmp_path):
    def ball():
        scene = caplet.Scene()
        scene.add("sphere", radius=0.5, material=materials.diffuse(reflectance=0), object="ball", emission={"L": (1, 1, 1)})
        scene.add_instances("ball", np.eye(4))
        scene.camera = cameras.orthographic(eye=(0, 0, 5), target=(0, 0, 0), screenwindow=(-2, 2, -2, 2))
        return scene

    right = np.eye(4)
    right[0, 3] = 1.5
    render = {"spp": 512, "size": (16, 16)}
    still = ball()
    moving = ball()
    moving.animate_instance(0, [0, 1], [np.eye(4), right])
    image = caplet.render(moving, **render).rgb[..., 1]
    # The window is 4 wide: a ball of radius 1/2 covers pi / 64 of it, all the time.
    assert abs(image.mean() - np.pi / 64) < 0.002
    # The pixel right of the middle is covered while the ball passes: half a chord beyond the pixel's middle of 1.5 a second.
    assert abs(image[8, 8] - (0.125 + math.sqrt(0.25 - 0.125**2)) / 1.5) < 0.03
    assert abs(image[8, 13] - (1.5 + 0.5 - 1.375) / 1.5) < 0.06 and image[8, 3] == 0

    moving.save(tmp_path / "moving.pbrt")
    assert same_pictures(moving, caplet.load(tmp_path / "moving.pbrt"))
    moving.set_instance(0, right)
    # It now goes from there on, and leaves that pixel behind.
    assert abs(caplet.render(moving, **render).rgb[8, 13, 1] - (1.375 - 1.5 + math.sqrt(0.25 - 0.125**2)) / 1.5) < 0.05
    moving.animate_instance(0, [], [])
    moving.set_instance(0, np.eye(4))
    assert same_pictures(moving, still)

    # A camera that goes left sees what one sees of a ball that goes right.
    left = np.eye(4)
    left[:3] = np.asarray(still._native.camera()).reshape(-1, 4)[:3]
    gone = left.copy()
    gone[0, 3] -= 1.5
    still.animate_camera([0, 1], [left, gone])
    seen = caplet.render(still, **render).rgb[..., 1]
    assert abs(seen.mean() - image.mean()) < 0.002 and np.abs(seen - image).max() < 0.12

    for wrong in (([0, 1], [right]), ([1, 0], [right, right]), ([0], [right]), ([0, 1], [right, right @ np.diag([-1, 1, 1, 1])])):
        with pytest.raises(caplet.InputError):
            moving.animate_instance(0, *wrong)
    with pytest.raises(caplet.InputError):
        moving.animate_instance(7, [0, 1], [right, right])


def test_operands_of_csg_move(tmp_path):
    scene = caplet.Scene()
    scene.add("box", p0=(-2, -2, -2), p1=(2, 2, 2), object="block")
    scene.add("sphere", radius=0.5, object="ball")
    left, right = np.eye(4), np.eye(4)
    left[0, 3], right[0, 3] = -1, 1
    shape = scene.add_csg("intersection", ["block", "ball"], material=materials.diffuse(reflectance=0), emission={"L": (1, 1, 1)})
    scene.camera = cameras.orthographic(eye=(0, 0, 5), target=(0, 0, 0), screenwindow=(-2, 2, -2, 2))
    render = {"spp": 256, "size": (16, 16)}
    still = caplet.render(scene, **render).rgb[..., 1]
    shape.animate_operand(1, [0, 1], [left, right])
    image = caplet.render(scene, **render).rgb[..., 1]
    # The ball covers pi / 64 of the window all the time, and the middle's pixel while half a chord to both sides passes at 2 a second.
    assert abs(image.mean() - np.pi / 64) < 0.002 and abs(still.mean() - np.pi / 64) < 0.002
    assert abs(image[8, 8] - math.sqrt(0.25 - 0.125**2)) < 0.05 and image[8, 4] > 0.1 and still[8, 4] == 0
    # A ray meets the ball where it is at the ray's time.
    for time in (0, 0.25, 1):
        hits = caplet.trace(scene, [(2 * time - 1, 0, 9)], [(0, 0, -1)], time=time)
        assert abs(hits["t"][0] - 8.5) < 1e-6
    scene.save(tmp_path / "moving.pbrt")
    assert same_pictures(scene, caplet.load(tmp_path / "moving.pbrt"))
    # Another one moves beside it; and each rests where it was first.
    shape.animate_operand(0, [0, 1], [np.diag([1, 1, 0.05, 1]), np.diag([1, 1, 0.1, 1])])
    assert abs(caplet.trace(scene, [(1, 0, 9)], [(0, 0, -1)], time=1)["t"][0] - 8.8) < 1e-6
    shape.animate_operand(0, [], [])
    shape.animate_operand(1, [], [])
    assert np.allclose(caplet.trace(scene, [(-1, 0, 9), (0, 0, 9)], [(0, 0, -1)] * 2)["t"], [8.9, np.inf])
    for wrong, word in (((2, [0, 1], [left, right]), "operand 2, of 2"), ((1, [0, 1], [left]), "2 times and 1"), ((1, [1, 0], [left, right]), ""),
                        ((1, [0, 1], [left, left @ np.diag([-1, 1, 1, 1])]), "")):
        with pytest.raises(caplet.InputError, match=word):
            shape.animate_operand(*wrong)
    with pytest.raises(caplet.InputError, match="not a csg"):
        scene.add("sphere", radius=1).animate_operand(0, [0, 1], [left, right])


def test_vertices_of_meshes_move(tmp_path):
    scene = caplet.Scene()
    square = np.float32([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    shape = scene.add_mesh(square, [[0, 1, 2], [0, 2, 3]], uv=square[:, :2], material=materials.diffuse(reflectance=0), emission={"L": (1, 1, 1)})
    scene.camera = cameras.orthographic(eye=(0, 0, 5), target=(0, 0, 0), screenwindow=(-2, 2, -2, 2))
    scene.filter("box")
    rest = caplet.render(scene, spp=2, size=(16, 16))
    assert np.array_equal(shape.vertices, square) and shape.faces.tolist() == [[0, 1, 2], [0, 2, 3]] and shape.normals.shape == (0, 3) and shape.times == []

    # Its right side goes from x = 1 to -1: the square covers a quarter of the window, and nothing at the end.
    gone = square * np.float32([0, 1, 1]) - np.float32([1, 0, 0])
    shape.animate([0, 1], vertices=[square, gone])
    assert shape.times == [0, 1] and np.array_equal(shape.vertices, [square, gone])
    image = caplet.render(scene, spp=1024, size=(16, 16)).rgb[..., 1]
    # Column 4 + k is covered until (1 - (k + 1/2) / 8): the window is 4 wide, of 16 pixels.
    assert abs(image.mean() - 0.125) < 0.001
    assert np.abs(image[6, 4:12] - (1 - (np.arange(8) + 0.5) / 8)).max() < 0.02 and image[6, 12:].max() == 0

    scene.save(tmp_path / "moving.pbrt")
    assert same_pictures(scene, caplet.load(tmp_path / "moving.pbrt"))
    held = shape.vertices
    for wrong in (dict(times=[0]), dict(times=[1, 0]), dict(times=[0, 1], vertices=[square[:3]] * 2), dict(times=[0, 1], p0=square), dict(times=[0, 1], radius=1),
                  dict(times=[0, 1], vertices=np.full((2, 4, 3), np.nan)), dict(times=[0, 1], normals=np.zeros((3, 4, 3)))):
        with pytest.raises(caplet.InputError):
            shape.animate(**wrong)
        assert np.array_equal(shape.vertices, held) and shape.times == [0, 1]
    shape.animate([])
    again = caplet.render(scene, spp=2, size=(16, 16))
    assert shape.times == [] and all(np.array_equal(again[name].view(np.uint32), rest[name].view(np.uint32)) for name in rest.channels)

    # A mesh with normals needs those of its new vertices.
    up = np.float32([[0, 0, 1]] * 4)
    smooth = scene.add_mesh(square, [[0, 1, 2]], normals=up)
    with pytest.raises(caplet.InputError, match="normals"):
        smooth.animate([0, 1], vertices=[square, gone])
    smooth.animate([0, 1], vertices=[square, gone], normals=up)
    assert smooth.normals.shape == (2, 4, 3)
    with pytest.raises(caplet.InputError, match="neither of capsules nor a mesh"):
        scene.add("sphere").animate([0, 1])
    with pytest.raises(caplet.InputError, match="of a mesh"):
        scene.add_capsules([[0, 0, 0]], [[1, 0, 0]], 1).animate([0, 1], vertices=[square] * 2)


def test_ends_of_capsules_move(tmp_path):
    scene = caplet.Scene()
    shape = scene.add_capsules([[0, 0, 0], [0, 1, 0]], [[0, 0, 0], [0, 1, 0]], [0.5, 0.1], material=materials.diffuse(reflectance=0), emission={"L": (1, 1, 1)})
    scene.camera = cameras.orthographic(eye=(0, 0, 5), target=(0, 0, 0), screenwindow=(-2, 2, -2, 2))
    scene.filter("box")
    rest = caplet.render(scene, spp=2, size=(16, 16))

    # The first grows to a radius of 1, the other one goes right by 1. They overlap only within x < 1.
    ends = np.float32([[[0, 0, 0], [0, -1.5, 0]], [[0, 0, 0], [1, -1.5, 0]]])
    shape.animate([0, 1], p0=ends, p1=ends, radius=[[0.5, 0.1], [1, 0.1]])
    assert shape.times == [0, 1] and len(shape) == 2
    assert np.array_equal(shape.p0, ends) and np.array_equal(shape.p1, ends) and np.array_equal(shape.radius[..., 0], np.float32([[0.5, 0.1], [1, 0.1]]))
    image = caplet.render(scene, spp=1024, size=(16, 16)).rgb[..., 1]
    # The window is 4 wide. The first covers pi times the mean of r^2, which is 7/12 for r from 1/2 to 1.
    assert abs(image.mean() * 16 - np.pi * (7 / 12 + 0.01)) < 0.02
    # Rows 13 and 14 hold y = -1.25 to -1.75. The other one's middle is left of x = 0.5, where column 10 begins, for half the time.
    assert abs(image[13:15, :10].sum() / 16 - np.pi * 0.01 / 2) < 0.002

    scene.save(tmp_path / "moving.pbrt")
    assert same_pictures(scene, caplet.load(tmp_path / "moving.pbrt"))
    # Whole arrays stay as they are where they are not given: here the other one's radius alone changes.
    shape.animate([0, 0.5, 2], radius=np.float32([[[0.5, 0.5], [0.1, 0.2]]] * 3))
    assert np.array_equal(shape.p0, ends[[0, 0, 0]]) and np.array_equal(shape.radius[2], np.float32([[0.5, 0.5], [0.1, 0.2]]))
    with pytest.raises(caplet.InputError, match="the capsules move"):
        shape.set(radius=1)
    held = shape.p0
    for wrong in (dict(times=[0]), dict(times=[1, 0]), dict(times=[0, np.nan]), dict(times=[[0, 1]]), dict(times=[0, 1], p0=np.zeros((3, 2, 3))),
                  dict(times=[0, 1], p0=np.zeros((2, 3, 3))), dict(times=[0, 1], radius=-1), dict(times=[0, 1], p1=[[[0, 0, np.inf]]])):
        with pytest.raises(caplet.InputError):
            shape.animate(**wrong)
        assert np.array_equal(shape.p0, held) and shape.times == [0, 0.5, 2]

    shape.animate([], p0=[[0, 0, 0], [0, 1, 0]], p1=[[0, 0, 0], [0, 1, 0]], radius=[0.5, 0.1])
    again = caplet.render(scene, spp=2, size=(16, 16))
    assert shape.times == [] and all(np.array_equal(again[name].view(np.uint32), rest[name].view(np.uint32)) for name in rest.channels)
    shape.set(radius=0.2)
    assert np.array_equal(shape.radius, np.full((2, 2), np.float32(0.2)))


def test_types_of_results_are_told():
    for function, told in ((caplet.load, caplet.Scene), (caplet.render, caplet.Image), (caplet.load_film, caplet.Image), (caplet.verify, caplet.Report),
                           (caplet.view, caplet.Viewer), (caplet.Scene.add_capsules, caplet.Shape), (caplet.Scene.add_boxes, caplet.Shapes),
                           (caplet.Scene.copy, caplet.Scene), (caplet.Session.image, caplet.Image), (caplet.Image.rgb.fget, np.ndarray)):
        assert typing.get_type_hints(function)["return"] is told, function
    scene = caplet.Scene()
    shape = scene.add_capsules([[0, 0, 0]], [[1, 0, 0]], 0.5)
    boxes = scene.add_boxes([[0, 0, 0], [2, 0, 0]], [[1, 1, 1], [3, 1, 1]])
    for of, names in ((scene, ("bounds", "primitives", "shapes", "materials", "objects", "size", "spp", "max_depth", "seed", "unit", "fov")),
                      (shape, ("number", "name", "p0", "p1", "radius", "u"))):
        for name in names:
            told = typing.get_type_hints(getattr(type(of), name).fget)["return"]
            assert isinstance(getattr(of, name), typing.get_origin(told) or told), name
    assert type(shape) is caplet.Shape and type(boxes) is caplet.Shapes
