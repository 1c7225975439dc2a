# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Models of MuJoCo look as their compiled textures and materials say, and as the program's reader has the same files."""
import numpy as np
import pytest

import caplet
from caplet import cameras

mujoco = pytest.importorskip("mujoco")

# OpenGL numbers a cube's faces so: each lies on this axis with this sign, and its image runs right and down in these directions.
FACES = [(0, 1, (0, 0, -1), (0, -1, 0)), (0, -1, (0, 0, 1), (0, -1, 0)), (1, 1, (1, 0, 0), (0, 0, 1)),
         (1, -1, (1, 0, 0), (0, 0, -1)), (2, 1, (1, 0, 0), (0, -1, 0)), (2, -1, (-1, 0, 0), (0, -1, 0))]


def linear(screen):
    screen = np.asarray(screen, dtype=float)
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)


def screen(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1 / 2.4) - 0.055)


def compiled(text, **files):
    model = mujoco.MjModel.from_xml_string(text, files or None)
    state = mujoco.MjData(model)
    mujoco.mj_forward(model, state)
    return model, state


def paint(model, level):
    """Makes the first texture grey: level (rows, columns) or (faces, rows, columns)."""
    model.tex_data[:3 * level.size] = np.repeat(level.astype(np.uint8).ravel(), 3)


def seen_points(scene, eye, target=(0, 0, 0), size=(96, 72), fov=40):
    """Points (n, 3) that one sample a pixel meets, their shapes, and their grey albedos as bytes of a screen."""
    scene.look_at(eye, target, (0, 0, 1))
    scene.fov = fov
    scene.filter("box", xradius=0.5, yradius=0.5)
    image, white = caplet.render(scene, spp=1, size=size), scene.copy()
    for number in range(len(scene.materials)):  # of the same wavelengths
        white.set_material(number, caplet.materials.diffuse(reflectance=1.0))
    white = caplet.render(white, spp=1, size=size)
    met = image.object_id < len(scene.shapes)
    share = image.albedo[met].astype(float).sum(axis=1) / white.albedo[met].astype(float).sum(axis=1)
    return image.position[met].astype(float), image.object_id[met], 255 * screen(share)


def flat_texel(model, s, t):
    """Texels of the first texture at (s, t) from its lower left corner, and whether a texel of another colour is near."""
    height, width = int(model.tex_height[0]), int(model.tex_width[0])
    image = model.tex_data[:height * width * 3].reshape(height, width, 3)[:, :, 0].astype(int)

    def at(ds, dt):
        row, column = np.floor((1 - (t + dt) % 1) * height).astype(int), np.floor((s + ds) % 1 * width).astype(int)
        return image[row % height, column % width]
    near = np.max([np.abs(at(ds, dt) - at(0, 0)) for ds in (-0.05, 0.05) for dt in (-0.05, 0.05)], axis=0)
    return at(0, 0), near > 0


CHECKER = """<mujoco><asset>
<texture name="t" type="2d" builtin="checker" rgb1="0.9 0.9 0.9" rgb2="0.3 0.3 0.3" width="64" height="32"/>
<material name="m" texture="t" specular="0" %s/></asset><worldbody>
<geom type="plane" size="%s 0.1" material="m"/></worldbody></mujoco>"""


@pytest.mark.parametrize("material, size, repeats", [
    ('texrepeat="3 2"', "2 1", (3, 2)), ('texrepeat="2 3" texuniform="true"', "2 1.5", (4, 4.5)),
    ('texrepeat="2 4"', "0 0", None), ('texrepeat="2 1" texuniform="true"', "0 1", None)])
def test_checkers_of_planes_are_where_mujoco_has_them(material, size, repeats):
    model, state = compiled(CHECKER % (material, size))
    scene = caplet.from_mujoco(model, state)
    points, _, levels = seen_points(scene, (0.3, -2, 4))
    half = [float(v) for v in size.split()]
    expected = []
    for k in range(2):
        if half[k]:  # from the edge: so many times from side to side
            count = repeats[k] if repeats else model.mat_texrepeat[0, k] * (half[k] if model.mat_texuniform[0] else 1)
            expected.append(count * (points[:, k] + half[k]) / (2 * half[k]) + (0 if k == 0 else 1 - count))
        else:  # so many times in two units, from the middle of the texture
            expected.append(model.mat_texrepeat[0, k] * points[:, k] / 2 + 0.5)
    texels, near = flat_texel(model, *expected)
    clear = ~near
    assert clear.mean() > 0.3 and len(np.unique(texels[clear])) == 2
    assert np.abs(levels - texels)[clear].max() < 2


SOLIDS = """<mujoco><asset><texture name="t" type="cube" builtin="flat" width="32" height="32"/>
<material name="m" texture="t" specular="0"/><material name="u" texture="t" specular="0" texuniform="true"/></asset><worldbody>
<body pos="-4 0 1"><freejoint/><geom name="box" type="box" size="0.9 0.6 0.5" material="M"/></body>
<body pos="-2 0 1"><freejoint/><geom name="sphere" type="sphere" size="0.8" material="M"/></body>
<body pos="0 0 1"><freejoint/><geom name="ellipsoid" type="ellipsoid" size="0.9 0.6 0.5" material="M"/></body>
<body pos="2 0 1"><freejoint/><geom name="capsule" type="capsule" size="0.4 0.5" material="M"/></body>
<body pos="2 4 1"><freejoint/><geom name="long" type="capsule" size="0.3 0.7" material="M"/></body>
<body pos="4 0 1"><freejoint/><geom name="cylinder" type="cylinder" size="0.7 0.4" material="M"/></body>
<geom name="mesh" type="mesh" mesh="wedge" material="M" pos="6 0 1" euler="20 50 70"/>
<geom name="other" type="mesh" mesh="wedge" material="M" pos="6 4 1" euler="80 10 50"/></worldbody><asset>
<mesh name="wedge" vertex="1 0 0  -0.6 0.9 0  -0.6 -0.9 0.1  0 0 1" face="0 2 1  0 1 3  1 2 3  2 0 3"/></asset></mujoco>"""


@pytest.mark.parametrize("what", ["face", "right", "down"])
@pytest.mark.parametrize("material", ["m", "u"])
def test_cube_textures_go_with_solids(material, what, rng):
    model, state = compiled(SOLIDS.replace("M", material))
    face, row, column = np.mgrid[:6, :32, :32]
    paint(model, {"face": 40 * face + 30, "right": 40 + 6 * column, "down": 40 + 6 * row}[what])
    scene = caplet.from_mujoco(model, state)
    file_from_geom = np.zeros(9)
    mujoco.mju_quat2Mat(file_from_geom, model.mesh_quat[0])
    for turn in range(2):
        if turn:
            for body in range(6):
                state.qpos[7 * body + 3:7 * body + 7] = rng.normal(size=4)
            mujoco.mj_normalizeQuat(model, state.qpos)
            mujoco.mj_forward(model, state)
            caplet.bridges.update_mujoco(scene, state)
        for name in ("box", "sphere", "ellipsoid", "capsule", "long", "cylinder", "mesh", "other"):
            sizes = {"sphere": [0, 0, 0], "capsule": [0, 0, 1], "long": [0, 0, 1], "cylinder": [0, 0, 1]}.get(name, [0, 1, 2])
            geom = model.geom(name).id
            number, at = scene.info["geom"].tolist().index(geom), state.geom_xpos[geom]
            for eye in (3, -4, 3), (-3, 4, -3):
                points, shapes, levels = seen_points(scene, at + eye, at, size=(48, 48), fov=22)
                ways = ((points - at) @ state.geom_xmat[geom].reshape(3, 3))[shapes == number]
                levels = levels[shapes == number]
                if name in ("mesh", "other"):  # the space of the file
                    ways = ways @ file_from_geom.reshape(3, 3).T + model.mesh_pos[0]
                elif material == "m":
                    ways = ways / model.geom_size[geom][sizes]
                most = np.sort(np.abs(ways), axis=1)
                clear = most[:, 1] < 0.9 * most[:, 2]  # of one face
                ways, levels = ways[clear] / most[clear, 2:], levels[clear]
                axes = np.abs(ways).argmax(axis=1)
                faces = 2 * axes + (np.take_along_axis(ways, axes[:, None], 1)[:, 0] < 0)
                assert len(ways) > 100 and len(np.unique(faces)) >= 2
                if what == "face":
                    expected = 40 * faces + 30
                else:
                    axis = 2 if what == "right" else 3
                    expected = [40 + 6 * (16 * (way @ FACES[face][axis] + 1) - 0.5) for face, way in zip(faces, ways)]
                error = np.abs(levels - expected)  # a texel is 6, and filters take in two; seams are beyond
                assert np.quantile(error, 0.95) < 12, (name, turn, np.quantile(error, 0.95))


@pytest.mark.parametrize("along", ["s", "t"])
def test_flat_textures_of_boxes_are_projected_along_z(along):
    model, state = compiled("""<mujoco><asset><texture name="t" type="2d" builtin="flat" width="64" height="64"/>
<material name="m" texture="t" specular="0" texrepeat="1.3 0.6"/></asset><worldbody>
<geom type="box" size="1 0.7 0.5" material="m"/></worldbody></mujoco>""")
    row, column = np.mgrid[:64, :64]

    def ramp(k):  # up, and down more steeply: it goes on beyond the edges, and is not its own mirror image
        return 30 + 4 * np.minimum(k, 3 * (63 - k))
    paint(model, ramp(column if along == "s" else 63 - row))
    scene = caplet.from_mujoco(model, state)
    seen = set()
    for eye in (2, -3, 3), (-3, 2, -2):
        points, _, levels = seen_points(scene, eye)
        st = 1.3 * (points[:, 0] / 2 + 0.5) if along == "s" else 0.6 * (points[:, 1] / 1.4 + 0.5) + 0.4  # from the top edge down
        expected = ramp(64 * (st % 1) - 0.5)
        for k, half in enumerate((1, 0.7, 0.5)):
            for sign in (-1, 1):
                on = np.abs(points[:, k] - sign * half) < 1e-4
                if on.sum() > 30:
                    seen.add((k, sign))
                    assert np.abs(levels - expected)[on].max() < 14, (k, sign)
    assert len(seen) == 6


@pytest.mark.parametrize("along", ["s", "t"])
@pytest.mark.parametrize("kind, size", [
    ("sphere", "0.8"), ("ellipsoid", "0.9 0.6 0.5"), ("capsule", "0.4 0.5"), ("cylinder", "0.7 0.4")])
def test_flat_textures_go_around_solids_from_the_top_down(kind, size, along):
    of_size = {"sphere": (0.8, 0.8), "ellipsoid": (0.9, 0.6), "capsule": (0.4, 0.4), "cylinder": (0.7, 0.7)}[kind]
    double = " ".join(str(2 * float(one)) for one in size.split())
    for uniform, factor in ("false", (1, 1)), ("true", of_size):
        model, state = compiled(f"""<mujoco><asset><texture name="t" type="2d" builtin="flat" width="64" height="64"/>
<material name="m" texture="t" specular="0" texrepeat="2 1.5" texuniform="{uniform}"/></asset>
<worldbody><geom type="{kind}" size="{double}" pos="90 0 0" material="m"/>
<geom type="{kind}" size="{size}" material="m"/></worldbody></mujoco>""")
        row, column = np.mgrid[:64, :64]
        paint(model, 30 + 3 * (column if along == "s" else row))
        scene, half = caplet.from_mujoco(model, state), np.array(model.geom_size[1])
        for eye in (2, -2, 1), (-2, 3, -1):
            points, _, levels = seen_points(scene, eye)
            if kind in ("sphere", "ellipsoid"):
                points /= half if kind == "ellipsoid" else half[0]
                down, on = np.arccos(points[:, 2].clip(-1, 1)) / np.pi, np.abs(points[:, 2]) < 0.9
            else:  # the side
                down, on = 0.5 - points[:, 2] / (2 * half[1]), np.abs(points[:, 2]) < 0.99 * half[1]
            around = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1
            st = (2 * factor[0] * around if along == "s" else 1.5 * factor[1] * down) % 1
            clear = on & (np.abs(st - 0.5) < 0.44) & (np.abs(around - 0.5) < 0.48)
            assert clear.sum() > 100
            error = np.abs(levels - 30 - 3 * (64 * st - 0.5))[clear]
            assert np.quantile(error, 0.95) < 3  # footprints are long at the rim


OBJ = """v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
vt 0.1 0.1
vt 0.9 0.2
vt 0.4 0.8
vt 0.7 0.6
vt 0.2 0.9
f 1/1 3/2 2/3
f 1/4 2/1 4/5
f 1/5 4/3 3/1
f 2/2 3/5 4/4
"""
MESH = """<mujoco><asset><texture name="t" type="2d" builtin="flat" width="64" height="64"/><mesh name="tetra" file="tetra.obj"/>
<mesh name="plain" vertex="0 0 0  1 0 0  0 1 0  0 0 1" face="0 2 1  0 1 3  0 3 2  1 2 3"/>
<material name="m" texture="t" specular="0" texrepeat="0.5 1"/>
<material name="glass" texture="t" specular="0" texrepeat="0.5 1" rgba="1 1 1 0.5"/></asset>
<worldbody><geom type="mesh" mesh="%s" material="%s" pos="1 2 3" euler="10 20 30"/></worldbody></mujoco>"""


@pytest.mark.parametrize("along", [0, 1])
@pytest.mark.parametrize("mesh, material", [("tetra", "m"), ("tetra", "glass"), ("plain", "m")])
def test_meshes_keep_their_texture_coordinates(mesh, material, along):
    model, state = compiled(MESH % (mesh, material), **{"tetra.obj": OBJ.encode()})
    row, column = np.mgrid[:64, :64]
    paint(model, 30 + 3 * (63 - row if along else column))
    scene = caplet.from_mujoco(model, state)
    place = np.eye(4)
    mujoco.mju_euler2Quat(quat := np.zeros(4), np.radians([10, 20, 30]), "xyz")
    mujoco.mju_quat2Mat(turn := np.zeros(9), quat)
    place[:3, :3], place[:3, 3] = turn.reshape(3, 3), (1, 2, 3)
    lines = [line.split() for line in OBJ.splitlines()]
    faces = [[[int(part) - 1 for part in corner.split("/")] for corner in line[1:]] for line in lines if line[0] == "f"]
    corners, coordinates = (np.array([line[1:] for line in lines if line[0] == word], dtype=float) for word in ("v", "vt"))
    for eye in (4, 3.5, 6), (-1, -2, 1):
        points, _, levels = seen_points(scene, eye, (1.2, 2.3, 3.3), fov=25)
        local = (points - place[:3, 3]) @ place[:3, :3]
        checked = 0
        for face in faces:
            p = corners[[v for v, _ in face]]
            normal = np.cross(p[1] - p[0], p[2] - p[0])
            on = np.abs((local - p[0]) @ normal) < 1e-4
            shares = np.linalg.lstsq(np.vstack([p.T, np.ones(3)]), np.vstack([local[on].T, np.ones(on.sum())]), rcond=-1)[0].T
            if mesh == "tetra":
                st = shares @ coordinates[[t for _, t in face]] * (0.5, 1)
            else:  # by x and y, once in two units
                st = np.stack([0.25 * local[on, 0] + 0.25, 0.5 * local[on, 1] + 0.5], axis=1)
            clear = (shares.min(axis=1) > 0.05) & (np.abs(st % 1 - 0.5) < 0.45).all(axis=1)
            checked += clear.sum()
            expected = 30 + 3 * (64 * (st[:, along] % 1) - 0.5)
            assert (np.abs(levels[on] - expected)[clear] < 8).all()
        assert checked > 200
    if material == "glass":  # two surfaces stop half of what comes each
        image = caplet.render(scene, spp=64, size=(48, 36))
        inner = image.alpha[18, 24]
        assert abs(inner - 0.75) < 0.2


LOOKS = """<mujoco><visual><headlight ambient="0.2 0.2 0.2" diffuse="0 0 0"/></visual><asset>
<texture name="sky" type="skybox" builtin="gradient" rgb1="0.3 0.5 0.7" rgb2="0.1 0.1 0.1" width="64" height="64"/>
<texture name="grid" type="2d" builtin="checker" rgb1="0.1 0.2 0.3" rgb2="0.2 0.3 0.4" width="64" height="64"
mark="edge" markrgb="0.8 0.8 0.8"/>
<texture name="body" type="cube" builtin="gradient" rgb1="0.9 0.5 0.2" rgb2="0.2 0.5 0.9" width="64" height="64"/>
<texture name="one" type="cube" file="one.png"/><material name="one" texture="one" specular="0"/>
<material name="layer"><layer texture="grid" role="rgba"/></material>
<material name="grid" texture="grid" texrepeat="1 1" texuniform="true" reflectance="0.3" rgba="0.9 0.8 1 1"/>
<material name="body" texture="body" rgba="0.8 1 0.6 1"/>
<material name="matt" specular="0" rgba="0.7 0.3 0.2 1"/>
<material name="shiny" specular="1" shininess="0.9" rgba="0.2 0.6 0.3 1"/>
<material name="metal" metallic="0.8" roughness="0.3" rgba="0.9 0.7 0.3 1"/><material name="mirror" reflectance="0.8"/>
<material name="lamp" emission="3" rgba="1 0.8 0.4 1"/><material name="glass" rgba="0.5 0.8 1 0.4"/></asset><worldbody>
<light pos="2 -3 6" dir="-0.3 0.4 -1" directional="true" diffuse="0.6 0.5 0.4"/>
<geom type="sphere" size="0.4" pos="-2 0 0.5" material="matt"/><geom type="sphere" size="0.4" pos="-1 0 0.5" material="shiny"/>
<geom type="sphere" size="0.4" pos="0 0 0.5" material="metal"/><geom type="sphere" size="0.4" pos="1 0 0.5" material="mirror"/>
<geom type="capsule" size="0.3 0.2" pos="2 0 0.6" material="lamp"/>
<geom type="box" size="0.3 0.4 0.3" pos="-1.5 -1.3 0.5" material="glass"/>
<geom type="capsule" size="0.3 0.3" pos="-0.3 -1.3 0.7" euler="50 0 20" material="body"/>
<geom type="sphere" size="0.4" pos="1 -1.3 0.5" material="shiny" rgba="0.9 0.1 0.5 1"/>
<geom type="sphere" size="0.3" pos="2 -1.3 0.5" rgba="0.3 0.9 0.1 1"/>
<geom type="sphere" size="0.4" pos="0 1 1.3" euler="20 30 40" material="one"/>
<geom type="sphere" size="0.4" pos="1 1 1.3" material="layer"/>
<geom type="plane" size="6 6 1" material="grid"/></worldbody></mujoco>"""


def test_the_programs_reader_makes_the_same_picture(tmp_path):
    path = tmp_path / "looks.xml"
    path.write_text(LOOKS)
    row, column = np.mgrid[:32, :32]
    image = np.stack([8 * row, 8 * column, 250 - 4 * row - 4 * column], axis=-1).astype(np.uint8)
    (tmp_path / "one.png").write_bytes(caplet.bridges.mujoco._png(image))
    model = mujoco.MjModel.from_xml_path(str(path))
    one, other = caplet.load(path, up="y"), caplet.from_mujoco(model, lights="model")
    assert len(one.shapes) == len(other.shapes) == 12
    for scene in (one, other):
        scene.camera = cameras.perspective(fov=35, eye=(1, -7, 3), target=(0, -0.3, 0.4), up=(0, 0, 1))
        scene.max_depth = 3
    pictures = [caplet.render(scene, spp=32, size=(120, 80)) for scene in (one, other)]
    for layer in ("rgb", "alpha", "albedo"):
        a, b = (np.asarray(getattr(picture, layer), dtype=float) for picture in pictures)
        for shape in range(12):  # each geom by itself
            here = pictures[1].object_id == shape
            one, other = a[here].mean(axis=0), b[here].mean(axis=0)
            assert here.sum() > 30 and np.allclose(one, other, rtol=0.04, atol=0.004), (layer, shape, one, other)
    sky = pictures[1].object_id > 11
    a, b = (np.asarray(picture.rgb, dtype=float)[sky].mean(axis=0) for picture in pictures)
    assert sky.sum() > 300 and np.allclose(a, b, rtol=0.01)


def test_emission_alpha_and_headlight_are_as_their_formulas_say():
    text = """<mujoco><visual><headlight ambient="0.1 0.2 0.3" diffuse="0.4 0.3 0.2"/></visual><asset>
<material name="matt" specular="0" rgba="0.7 0.3 0.2 1"/><material name="lamp" specular="0" emission="3" rgba="1 0.8 0.4 1"/>
<material name="thin" rgba="1 1 1 0.4"/></asset><worldbody>
<camera name="above" pos="0 0 5" xyaxes="1 0 0 0 1 0"/><geom type="%s" size="%s" material="%s"/></worldbody></mujoco>"""

    def middle(kind, size, material, dark=False):
        model, state = compiled(text % (kind, size, material))
        scene = caplet.from_mujoco(model, state, camera="above", lights="model")
        if dark:
            scene.remove_lights()
        scene.filter("box", xradius=0.5, yradius=0.5)
        image = caplet.render(scene, spp=256, size=(9, 9))
        return image.rgb[3:6, 3:6].mean(axis=(0, 1)), image.alpha[3:6, 3:6].mean()
    # Light of irradiance pi times the headlight falls straight on the plane, and ambient light from everywhere.
    assert np.allclose(middle("plane", "9 9 1", "matt")[0], linear((0.7, 0.3, 0.2)) * (0.5, 0.5, 0.5), rtol=5e-3)
    assert np.allclose(middle("sphere", "1", "lamp", dark=True)[0], 3 * linear((1, 0.8, 0.4)), rtol=5e-3)
    for kind, size in ("sphere", "1"), ("capsule", "1 1"), ("cylinder", "1 1"), ("box", "1 1 1"), ("ellipsoid", "1 1 1"):
        assert abs(middle(kind, size, "thin", dark=True)[1] - 0.64) < 0.04  # four standard deviations of 2304 samples
    assert abs(middle("plane", "9 9 1", "thin", dark=True)[1] - 0.4) < 0.04


def test_skies_are_cubes_around_the_world():
    text = """<mujoco><asset><texture type="skybox" builtin="flat" width="16" height="16"/></asset><worldbody>
<light pos="0 0 9"/><geom type="sphere" size="0.01" pos="0 0 -50"/></worldbody></mujoco>"""
    model, state = compiled(text)
    levels = np.array([60, 90, 120, 150, 200, 250])
    paint(model, np.repeat(levels, 256))
    scene = caplet.from_mujoco(model, state, lights="model")
    # The sky of a mean of 0.35 at most; all faces cover the same solid angle.
    scale = min(1, 0.35 / linear(levels / 255).mean())
    ways = {0: (1, 0, 0), 1: (-1, 0, 0), 2: (0, 0, 1), 3: (0, 0, -1), 4: (0, -1, 0), 5: (0, 1, 0)}
    for face, way in ways.items():
        scene.look_at((0, 0, 0), way, (0, 1, 0) if way[2] else (0, 0, 1))
        scene.fov = 30
        seen = caplet.render(scene, spp=16, size=(16, 16)).rgb.mean(axis=(0, 1))
        assert np.allclose(seen, scale * linear(levels[face] / 255), rtol=0.02), face
