# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""What is drawn on pictures, colours that tell numbers, images as textures: lengths and colours by hand, and as the program has them."""
import inspect
import os
import subprocess

import numpy as np
import pytest

import caplet
from caplet import cameras, materials, textures


def pixels(path):
    """A PPM of 8 bits as (height, width, 3)."""
    kind, width, height, most, rest = path.read_bytes().split(maxsplit=4)
    assert kind == b"P6" and most == b"255"
    return np.frombuffer(rest[-3 * int(width) * int(height):], np.uint8).reshape(int(height), int(width), 3).astype(int)


def test_a_deep_picture_flattens_to_the_picture(tmp_path):
    oiio = pytest.importorskip("OpenImageIO")
    scene = caplet.Scene()
    scene.add_spheres([(0, 0, 0), (0.7, 0.2, -3)], [0.8, 0.9], color=(0.8, 0.4, 0.2))
    scene.camera = cameras.perspective(eye=(0, 0, 5), target=(0, 0, 0), fov=40)
    scene.size = 48, 32
    image = caplet.render(scene, spp=16, deep=True)
    image.save_deep(tmp_path / "deep.exr")
    deep = oiio.ImageBuf(str(tmp_path / "deep.exr"))
    assert deep.deep and list(deep.spec().channelnames) == ["A", "Z"]
    flat = oiio.ImageBufAlgo.flatten(deep).get_pixels(oiio.FLOAT)
    assert np.array_equal(flat[..., 0], image.alpha)
    samples = np.array([[deep.deep_samples(x, y) for x in range(48)] for y in range(32)])
    plain = (samples <= 2) & (image.alpha == 1)  # it weighs Z as we do
    assert (samples == 0).any() and (plain & (samples == 2)).any()
    assert np.allclose(flat[plain, 1], image.depth[plain], rtol=4e-7)


@pytest.fixture
def saved(tmp_path):
    """Saves a picture and reads it back."""
    def save(image, **overlays):
        try:
            image.save(tmp_path / "a.ppm", **overlays)
        except caplet.InputError as error:
            if "OpenImageIO" in str(error):
                pytest.skip("built without OpenImageIO")
            raise
        return pixels(tmp_path / "a.ppm")
    return save


def the_program():
    program = os.environ.get("CAPLET_PROGRAM", "")
    if not os.path.exists(program):
        pytest.skip("needs the program (CAPLET_PROGRAM)")
    return program


def balls():
    """Two balls seen along -z: 4 x 2 units on 400 x 200 pixels, so 100 pixels a unit."""
    scene = caplet.Scene()
    scene.add_spheres((0.8, 0, 0), 0.5, color=(0.8, 0.3, 0.1))
    scene.add_spheres((-0.8, 0, -3), 0.5, color=(0.1, 0.3, 0.8))
    scene.size = 400, 200
    scene.camera = cameras.orthographic(eye=(0, 0, 9), target=(0, 0, 0))
    return scene


def test_overlays_are_the_programs():
    from caplet import _caplet
    names = [name.replace("-", "_") for name, _, _ in _caplet.overlays()]
    for method in (caplet.Image.save, caplet.Image.png):
        given = [name for name, one in inspect.signature(method).parameters.items() if one.kind == one.KEYWORD_ONLY]
        assert given == names and all(f"\n{name}: " in method.__doc__ for name in names)
    program = the_program()
    said = subprocess.run([program, "render", "--help"], capture_output=True, text=True, check=True).stdout
    group = said[said.index("Drawn on the preview"):].split("\n\n")[0]
    assert [line.split()[0] for line in group.splitlines() if line.strip().startswith("--")] == ["--" + name.replace("_", "-") for name in names]


def test_pictures_are_those_of_the_program(tmp_path, saved, scenes):
    program = the_program()
    scene = balls()
    scene.spp = 4
    scene.save(tmp_path / "balls.pbrt")
    image = caplet.render(caplet.load(tmp_path / "balls.pbrt"))
    for overlays, options in ((dict(scale_bar="0.5 cells", outline=True, axes=True), ["--scale-bar", "0.5 cells", "--outline", "--axes"]),
                              (dict(scale_bar=True, depth_cue=0.25), ["--scale-bar", "auto", "--depth-cue", "0.25"]),
                              (dict(label=["0,0,0 middle", "0.2,0.1,0 beside"]), ["--label", "0,0,0 middle", "--label", "0.2,0.1,0 beside"]), ({}, [])):
        made = saved(image, **overlays)
        subprocess.run([program, "render", "balls.pbrt", "-q", "--variance", "-o", "none", "--preview", "b.ppm", *options], cwd=tmp_path, check=True)
        assert np.array_equal(made, pixels(tmp_path / "b.ppm")), options
    neuron = scenes / "neuron.swc"
    made = saved(caplet.render(caplet.load(neuron, least_width=4), spp=2, size=(96, 54)))  # thin branches, widened
    subprocess.run([program, "render", neuron, "-q", "--variance", "-o", "none", "--preview", "b.ppm", "--least-width", "4", "--spp", "2", "--size", "96x54"],
                   cwd=tmp_path, check=True)
    assert np.array_equal(made, pixels(tmp_path / "b.ppm"))
    file = tmp_path / "two.pdb"
    file.write_text("".join(f"ATOM  {i:5}  C   ALA A{i:4}    {2 * i:8.3f}{0:8.3f}{0:8.3f}  1.00{10 * i:6.2f}           C\n" for i in (1, 2, 3)))
    made = saved(caplet.render(caplet.load(file, color="bfactor"), spp=2, size=(96, 54)), color_bar=True)
    subprocess.run([program, "render", "two.pdb", "-q", "--variance", "-o", "none", "--preview", "b.ppm", "--color", "bfactor", "--color-bar", "--spp", "2",
                    "--size", "96x54"], cwd=tmp_path, check=True)
    assert np.array_equal(made, pixels(tmp_path / "b.ppm"))


def test_a_scale_bar_is_as_long_as_it_says(saved):
    scene = balls()
    image = caplet.render(scene, spp=1)
    plain = saved(image)
    for asked, wide in ((0.5, 50), ("0.25", 25), ("0.75 cells", 75), (True, 100)):  # round: a quarter of the width is one unit
        differ = (saved(image, scale_bar=asked) != plain).any(axis=2)
        rows = np.flatnonzero(differ.sum(axis=1) == differ.sum(axis=1).max())
        assert differ[rows].sum(axis=1).tolist() == [wide] * len(rows) and 2 <= len(rows) < 10, asked
    # The unit is the scene's, and others are turned into it.
    scene.unit = "mm"
    assert scene.unit == "mm" and scene.copy().unit == "mm"
    image = caplet.render(scene, spp=1)
    differ = (saved(image, scale_bar="300 um") != plain).any(axis=2)
    assert differ.sum(axis=1).max() == 30
    with pytest.raises(caplet.InputError, match="cells"):
        saved(image, scale_bar="1 cells")
    with pytest.raises(caplet.InputError, match="unit"):
        scene.unit = 3
    session = caplet.Session(scene)
    scene.unit = "m"
    session.update(scene)
    session.render(1)
    with pytest.raises(caplet.InputError, match="pixels"):
        saved(session.image(), scale_bar="1 km")


def test_outlines_depth_cues_and_axes_are_drawn(saved):
    image = caplet.render(balls(), spp=16)
    rgb, plain = image.rgb.copy(), saved(image)
    covered = image.alpha > 0
    inside = image.alpha == 1
    outlined = saved(image, outline=3)
    black = (outlined.max(axis=2) < 8) & (plain.max(axis=2) >= 8)
    # Two circles of radius 50 pixels, three wide: 2 * 2 pi 50 * 3; those of the edges' pixels that are only half black are not counted.
    assert 0.6 * 1885 < black.sum() < 1.05 * 1885
    ring = np.abs(np.hypot(np.arange(400)[None] + 0.5 - 280, np.arange(200)[:, None] + 0.5 - 100) - 50)
    assert ring[black & (np.arange(400) > 200)].max() < 2.5
    cued = saved(image, depth_cue=1)
    far = inside & (image.object_id == 1)
    near = inside & (image.object_id == 0)
    assert (np.abs(cued - plain)[far].max(axis=1) > 5).mean() > 0.9 and np.abs(cued - plain)[near].mean() < np.abs(cued - plain)[far].mean() / 3
    assert np.array_equal(cued[~covered], plain[~covered])
    axes = saved(image, axes=True)
    changed = (axes != plain).any(axis=2)
    assert 20 < changed.sum() < 4000 and not changed[:100].any() and not changed[:, 200:].any()  # at the lower left
    red = changed & (axes[:, :, 0] > axes[:, :, 1] + 80)
    green = changed & (axes[:, :, 1] > axes[:, :, 0] + 60)
    assert red.any() and green.any() and np.flatnonzero(red.any(axis=0)).mean() > np.flatnonzero(green.any(axis=0)).mean()  # x to the right
    # Nothing is drawn where nothing is asked, and the picture itself stays.
    assert np.array_equal(saved(image, outline=False, axes=None), plain) and np.array_equal(image.rgb, rgb)
    assert image.png() == image.png(outline=None) != image.png(outline=True) and image.png(axes=True) != image.png(outline=True)


@pytest.mark.parametrize("overlays, says", [
    (dict(scale_bar="long"), "scale-bar.*'long'"), (dict(scale_bar=-1), "scale-bar"), (dict(scale_bar=float("nan")), "scale-bar"),
    (dict(scale_bar="9999"), "pixels"), (dict(outline=0), "outline"), (dict(outline=1000), "64"), (dict(outline="wide"), "outline"), (dict(depth_cue=2), "depth-cue"),
    (dict(depth_cue=float("inf")), "depth-cue"), (dict(axes="x"), "switch"), (dict(axes=[1]), "axes"), (dict(outline=""), "outline"), (dict(color_bar=True), "have no legend")])
def test_wrong_overlays_are_told_and_nothing_is_written(tmp_path, overlays, says):
    image = caplet.render(balls(), spp=1)
    with pytest.raises(caplet.InputError, match=says) as caught:
        image.save(tmp_path / "a.png", **overlays)
    if "OpenImageIO" in str(caught.value):
        pytest.skip("built without OpenImageIO")
    assert not (tmp_path / "a.png").exists() and "--" not in str(caught.value)


def test_names_of_overlays_and_files_without_them(tmp_path):
    image = caplet.render(balls(), spp=1)
    with pytest.raises(TypeError, match="scale_bar"):
        image.save(tmp_path / "a.png", outlin=True)
    with pytest.raises(TypeError, match="outline"):
        image.png(outlin=None)
    with pytest.raises(caplet.InputError, match="outline.*exr"):
        image.save(tmp_path / "a.exr", outline=True)
    image.save(tmp_path / "a.exr", outline=False)
    assert (tmp_path / "a.exr").exists()


def test_colors_tell_numbers():
    # Of matplotlib's viridis (CC0), as a screen's: its first, middle (127.5 of 255) and last colour.
    first, middle, last = (0.267004, 0.004874, 0.329415), (0.1281, 0.5651, 0.5509), (0.993248, 0.906157, 0.143936)

    def linear(screen):
        screen = np.array(screen)
        return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)
    got = caplet.color_map([-5, 0, 5, 10, 99, np.nan], low=0, high=10)
    assert got.shape == (6, 3)
    for color, wanted in zip(got, (first, first, middle, last, last)):
        assert np.allclose(color, linear(wanted), atol=0.01)
    assert (got[5] == 0.5).all()
    assert np.array_equal(caplet.color_map([3, 4, 5]), caplet.color_map([0.0, 0.5, 1.0])) and caplet.color_map(7).shape == (1, 3)
    assert np.array_equal(caplet.color_map([2, 2]), caplet.color_map([0.5, 0.5], 0, 1)) and caplet.color_map([]).shape == (0, 3)
    assert np.allclose(caplet.color_map([-1.7e308, 1.7e308, np.inf, -np.inf])[[0, 1]], linear([first, last]), atol=0.01)
    assert (caplet.color_map([np.nan]) == 0.5).all()
    for wrong in (dict(values="a"), dict(values=[1], low=np.nan), dict(values=[1], low=3, high=2), dict(values=np.ones((2, 3)))):
        with pytest.raises(caplet.InputError):
            caplet.color_map(**wrong)


def test_a_color_bar_has_the_map(saved):
    scene = balls()
    scene.set_color_bar("depth", 2, 8, "mm")
    image = caplet.render(scene, spp=1)
    plain, drawn = saved(image), saved(image, color_bar=True)
    changed = (drawn != plain).any(axis=2)
    yellow = changed & (np.abs(drawn - [253, 231, 37]).max(axis=2) < 8)  # viridis' last and first colour
    violet = changed & (np.abs(drawn - [68, 1, 84]).max(axis=2) < 8)
    assert yellow.any() and violet.any() and np.flatnonzero(yellow.any(axis=1)).max() < np.flatnonzero(violet.any(axis=1)).min()
    for wrong in ((3, 2), (np.nan, 1), (0, np.inf)):
        with pytest.raises(caplet.InputError, match="colour bar"):
            scene.set_color_bar("depth", *wrong)


def test_images_are_textures(tmp_path):
    image = np.zeros((2, 2, 3))
    image[0, 0], image[0, 1], image[1, 0], image[1, 1] = (0.6, 0.2, 0.2), (0.2, 0.6, 0.2), (0.2, 0.2, 0.6), (0.5, 0.5, 0.5)
    scene = caplet.Scene()
    paint = textures.imagemap(pixels=image, filter="point", wrap="clamp")
    scene.add_mesh([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)], uv=[(0, 0), (1, 0), (1, 1), (0, 1)],
                   material=materials.diffuse(reflectance=paint))
    scene.look_at((0.5, 0.5, 5), (0.5, 0.5, 0))
    scene.fov = 10  # 0.87 units across
    got = caplet.render(scene, spp=64, size=(40, 40)).albedo
    for (row, column), wanted in (((5, 5), image[0, 0]), ((5, 35), image[0, 1]), ((35, 5), image[1, 0]), ((35, 35), image[1, 1])):
        assert np.allclose(got[row, column], wanted, atol=0.02), (row, column)
    # Bytes are a screen's: 188 is 0.503 linear; one channel is grey.
    scene.set_material(0, materials.diffuse(reflectance=textures.imagemap(pixels=np.full((4, 8), 188, np.uint8))))
    assert np.allclose(caplet.render(scene, spp=64, size=(40, 40)).albedo[5, 5], 0.503, atol=0.02)
    # Alpha is no colour: 188 of 255 is 0.737 of what is there; within five standard errors of 64 * 64 * 16 samples, 0.0017.
    half = np.full((4, 4, 4), 188, np.uint8)
    veil = caplet.Scene()
    veil.add("disk", radius=99, alpha=textures.imagemap(pixels=half, is_float=True))
    veil.look_at((0, 0, 5), (0, 0, 0))
    assert caplet.render(veil, spp=16, size=(64, 64)).alpha.mean() == pytest.approx(188 / 255, abs=0.009)
    # Saving writes the images beside the scene.
    file = tmp_path / "scene.pbrt"
    scene.save(str(file))
    assert {one.suffix for one in tmp_path.iterdir() if one != file} == {".exr"}
    again = caplet.load(str(file))
    assert np.array_equal(caplet.render(again, spp=4, size=(20, 20)).rgb, caplet.render(scene, spp=4, size=(20, 20)).rgb)
    for wrong in (np.zeros((2, 2, 2)), np.zeros((0, 2, 3)), np.full((2, 2), np.nan), np.full((2, 2), np.inf), np.zeros(3), "picture", np.zeros((2, 40000)),
                  np.zeros((2, 2), complex), None, [[1], [2, 3]], np.full((2, 2, 3), 1e300)):
        with pytest.raises(caplet.InputError, match="pixels"):
            scene.add("sphere", material=materials.diffuse(reflectance=textures.imagemap(pixels=wrong) if wrong is not None else
                                                           textures.imagemap(pixels=np.zeros((2, 2)), filename="a.png")))
    with pytest.raises(caplet.InputError, match="pixels"):
        scene.add("sphere", pixels=np.zeros((2, 2)))


def test_a_clipping_plane_cuts(tmp_path):
    scene = caplet.Scene()
    scene.add_spheres((0, 0, 0), 1)
    scene.size, scene.spp = (40, 40), 4

    def depth():
        scene.look_at((0, 0, 10), (0, 0, 0), (0, 1, 0))
        return caplet.render(scene).depth[20, 20]

    window = dict(screenwindow=[-2, 2, -2, 2])
    scene.camera = caplet.cameras.orthographic(**window, clipplane=[0, 0, 1, 0.25])
    assert abs(depth() - 9.75) < 1e-5
    scene.save(tmp_path / "cut.pbrt")
    assert abs(caplet.render(caplet.load(tmp_path / "cut.pbrt")).depth[20, 20] - 9.75) < 1e-5
    assert caplet.render(caplet.load(tmp_path / "cut.pbrt", clip="none")).depth[20, 20] < 9.1
    assert abs(caplet.render(caplet.load(tmp_path / "cut.pbrt", clip="z=-0.5")).depth[20, 20] - 10.5) < 1e-5
    scene.camera = caplet.cameras.orthographic(**window)
    assert depth() < 9.1
