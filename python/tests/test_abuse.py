# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Whatever is given in place of an argument works or is told: nothing crashes, nothing else is raised, and nothing half done stays.

The entries are those of the package itself: a new function or argument is on trial at once, and fails here until VALUES knows a good
value of its required arguments.
"""
import inspect
import os

import numpy as np
import pytest

import caplet
from caplet import cameras, lights, materials, media, sensors, textures

TOLD = (TypeError, ValueError)  # InputError is a ValueError
# What takes objects of other packages, and has tests with these; what takes none of what is tried here.
OTHERS = {"from_gemmi", "from_meshio", "from_morphio", "from_mujoco", "from_pyvista", "from_trimesh", "to_xarray", "denoise",
          "formats", "shape_types", "devices", "set_log_level", "load_film", "view"}
PACKAGES = {"from_neuroml": ("neuroml",), "from_sonata": ("libsonata", "morphio", "h5py")}  # of entries that take files
RECORDS = np.zeros(4, dtype=[("tag", "u1"), ("at", "f8", (3,))])


class Broken:
    def __array__(self, *_, **__):
        raise ValueError("no array")


class Odd:
    def __array__(self, *_, **__):
        return "no array"

    def __len__(self):
        return 2**62


def overlapping(base):
    """Rows that share memory with their neighbours."""
    if base.ndim == 0 or base.size == 0:
        return base
    flat = np.resize(base, base.size + base.shape[0])
    return np.lib.stride_tricks.as_strided(flat, base.shape, tuple([flat.itemsize] * base.ndim), writeable=False)


def unaligned(base):
    held = np.zeros(base.nbytes + 1, np.uint8)
    out = held[1:].view(base.dtype).reshape(base.shape)
    out[...] = base
    return out


def read_only(base):
    out = base.copy()
    out.flags.writeable = False
    return out


def arrays_like(base):
    """The same numbers in every way that arrays hold them, and arrays that are like it but wrong."""
    base = np.asarray(base, dtype=np.float64)
    for dtype in ("f2", "f4", "f8", "g", "i1", "u1", "i2", "u4", "i8", "u8", "?", "c8", "c16", "O", ">f4", ">f8", ">i4", "S8", "U8", "M8[s]", "m8[s]"):
        with np.errstate(all="ignore"):
            yield dtype, base.astype(dtype)
    yield "Fortran", np.asfortranarray(base)
    yield "transposed", base.T
    yield "unaligned", unaligned(base)
    yield "read-only", read_only(base)
    yield "overlapping", overlapping(base)
    yield "matrix", np.matrix(base) if base.ndim == 2 else base
    yield "masked", np.ma.masked_array(base, np.ones(base.shape, bool))
    yield "memoryview", memoryview(np.ascontiguousarray(base))
    yield "stack", base[np.newaxis]
    yield "deep", base.reshape((1,) * 20 + base.shape)
    yield "huge", np.broadcast_to(base.reshape(-1)[:1], (2**50, *base.shape[1:]))
    yield "wide", np.broadcast_to(0.5, (3, 2**56))
    for wrong in (np.nan, np.inf, -np.inf, -1.0, 0.0, 1e300, 1e-320, 3.5):
        out = base.copy()
        out.reshape(-1)[-1] = wrong
        yield f"with {wrong}", out
        yield f"all {wrong}", np.full_like(base, wrong)
    if base.ndim:
        yield "backwards", base[::-1]
        yield "every second", np.repeat(base, 2, axis=0)[::2]
        yield "repeated", np.broadcast_to(base[:1], base.shape)
        yield "none", base[:0]
        yield "one", base[:1]
        yield "fewer", base[:-1]
        yield "more", np.concatenate([base, base[:1]])
        yield "narrow", base[..., :-1]
        yield "flat", base.reshape(-1)
        yield "turned", base[..., ::-1]


ANYTHING = {"None": None, "text": "text", "object": object(), "ragged": [[1], [2, 3]], "dict": {}, "set": {1}, "bytes": b"bytes", "Broken": Broken(), "Odd": Odd(),
            "records": RECORDS, "field": RECORDS["at"], "0-d": np.array(2.0), "0-d nan": np.array(np.nan), "0-d object": np.array(None), "empty": np.array([]),
            "no columns": np.empty((3, 0)), "negative": -1, "big": 2**70, "complex": 1j, "generator": (one for one in (1, 2)), "class": int, "surrogate": "\ud800",
            "null": "a\0b", "list of lists": [[[[]]]], "nothing": (), "bool": True}


def row(with_csg=False):
    scene = caplet.Scene()
    scene.add_capsules([[0, 0, 0], [2, 0, 0]], [[0, 1, 0], [2, 1, 0]], 0.25, name="row")
    scene.add("box", p0=(-1, -1, -1), p1=(1, 1, 1), object="crate")
    scene.add("sphere", radius=0.5, object="ball")
    scene.add_instances("crate", [np.eye(4)])
    if with_csg:  # not in batches
        scene.add_csg("difference", ["crate", "ball"], name="hole")
    scene.add("disk", radius=1, emission={"L": (1, 1, 1)}, name="lamp")
    scene.add_light(lights.point(from_=(0, 9, 0)))
    scene.size, scene.spp = (4, 3), 1
    return scene


THREE = [[0.0, 1, 2], [3, 4, 5], [6, 7, 9]]
VALUES = {  # of required arguments, and of those that are tried as arrays: as they may be
    "p0": THREE, "p1": np.add(THREE, 1), "radius": [0.1, 0.2, 0.3], "center": THREE, "radii": np.add(THREE, 1), "rotation": np.eye(3), "vertices": THREE,
    "faces": [[0, 1, 2]], "normals": THREE, "uv": [[0, 0], [1, 0], [0, 1.0]], "color": [0.1, 0.2, 0.3], "transform": np.eye(4), "emission": [1.0, 2, 3],
    "radius1": [0.1, 0.2, 0.3], "object": "crate", "transforms": [np.eye(4)], "eye": [0.0, 0, 9], "target": [0.0, 0, 0], "up": [0.0, 1, 0], "origins": THREE,
    "directions": THREE, "t_min": [0.1, 0.2, 0.3], "t_max": [10.0, 20, 30], "points": [[0, 0, 1.0], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]],
    "operation": "union", "operands": ["crate", "ball"], "type": "sphere", "count": 3, "each": {"radius": [0.1, 0.2, 0.3]}, "which": 0, "number": 0, "L": [1.0, 2, 3],
    "title": "values", "low": 1.0, "high": 2.0, "unit": "mm", "x": 1, "y": 1, "x0": 0, "y0": 0, "x1": 2, "y1": 2, "values": [1.0, 2, 3], "spp": 1, "size": [4, 3],
    "seed": 1, "pose": np.eye(4), "azimuth": [0.0, 10], "elevation": [0.0, 5], "reach": 5.0, "tractogram": [THREE], "rays": 100, "most": 8, "time_limit": 5.0,
    "name": "name", "material": materials.diffuse(), "medium": None, "light": lights.point(), "scene": row, "path": None, "kelvin": 5000.0,
    "parameters": {}, "inside": media.homogeneous(), "messages": "wrong", "film": None, "image": None, "device": None, "devices": None, "agrees": True, "text": "", "json": "",
    "open": 0.25, "close": 0.75, "index": 0, "first": 0, "times": [0.0, 1.0], "time": 0.5, "worlds": np.tile(np.eye(4), (2, 2, 1, 1)), "poses": [np.eye(4)] * 2,
}
OF = {  # where the same name is something else
    ("add_polyhedron", "normals"): [[0, 0, 1.0], [0, 0, -1], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]], ("set_light", "color"): [1.0, 2, 3],
    ("add_disks", "transform"): [np.eye(4)] * 3, ("add_mesh", "color"): [0.1, 0.2, 0.3], ("set", "p0"): THREE[:2], ("set", "p1"): np.add(THREE[:2], 1),
    ("set", "radius"): [0.1, 0.2], ("resume", "image"): None, ("film", "type"): "rgb", ("filter", "type"): "box", ("sampler", "type"): "independent",
    ("integrator", "type"): "path", ("set_material", "material"): materials.diffuse(), ("add_many", "type"): "sphere", ("shape_parameters", "type"): "sphere",
    ("from_nibabel", "radius"): 0.1, ("from_sonata", "radius"): 0.1, ("from_neuroml", "radius"): 0.1, ("from_neuroml", "cell"): "c",
    ("from_sonata", "ids"): [0, 1], ("from_sonata", "color"): [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6], [0.7, 0.8, 0.9]],
    ("add", "radius"): 0.5, ("add_molecular_surface", "probe"): 1.4, ("add_many", "radius"): 0.5, ("animate_instance", "transforms"): [np.eye(4)] * 2, ("animate_camera", "transforms"): [np.eye(4)] * 2,
    ("animate_operand", "operand"): 1, ("animate_operand", "transforms"): [np.eye(4)] * 2,
    ("render_batch", "camera"): sensors.Pinhole(4, 3, fx=4), ("render_batch", "moving"): [0, 1], ("render_batch", "mode"): "rays", ("render_batch", "layers"): ["depth"],
    ("animate", "p0"): [THREE[:2]] * 2, ("animate", "p1"): np.add([THREE[:2]] * 2, 1), ("animate", "radius"): [[0.1, 0.2]] * 2,
    ("animate", "vertices"): None, ("animate", "normals"): None,
}
# Of entries that take more by **options: what of it holds numbers.
MORE = {"add_spheres": ("color", "transform"), "add_cylinders": ("color", "transform"), "add_cones": ("color", "transform"), "add_boxes": ("color", "transform"),
        "add_disks": ("color", "transform"), "add_ellipsoids": ("color",), "add_polyhedron": ("color", "transform"), "add_csg": ("color", "transform"), "add": ("radius",),
        "add_many": ("radius",)}
SLOW = {"render", "verify"}  # of which each call takes a while


def entries():
    """(name, how it is called with a scene and arguments, its parameters) of all that is public and takes arguments."""
    for name in caplet.__all__:
        thing = getattr(caplet, name)
        if name in OTHERS or inspect.ismodule(thing) or not callable(thing) or inspect.isclass(thing):
            continue
        yield name, lambda scene, given, thing=thing: thing(**given), inspect.signature(thing).parameters
    for holder in ("Scene", "Shape"):
        for name, method in vars(getattr(caplet, holder)).items():
            of = (lambda scene: scene) if holder == "Scene" else lambda scene, name=name: scene[{"set_emission": "lamp", "animate_operand": "hole"}.get(name, "row")]
            if isinstance(method, property) and method.fset:
                yield f"{holder}.{name}", lambda scene, given, of=of, name=name: setattr(of(scene), name, given["to"]), {
                    "to": inspect.Parameter("to", inspect.Parameter.POSITIONAL_OR_KEYWORD)}
            elif inspect.isfunction(method) and not name.startswith("_"):
                parameters = dict(list(inspect.signature(method).parameters.items())[1:])
                if parameters:
                    yield f"{holder}.{name}", lambda scene, given, of=of, name=name: getattr(of(scene), name)(**given), parameters


PROPERTIES = {"size": [4, 3], "spp": 1, "max_depth": 3, "seed": 1, "unit": "mm", "camera": cameras.perspective(), "fov": 30.0, "transform": np.eye(4)}


def good(entry, name):
    short = entry.split(".")[-1]
    if name == "to":
        return PROPERTIES[short]
    value = OF.get((short, name), VALUES.get(name))
    return value() if name == "scene" else value


def file_for(entry, folder):
    """A file that it reads."""
    if entry == "from_neuroml":
        (folder / "cell.nml").write_text('<neuroml xmlns="http://www.neuroml.org/schema/neuroml2"><cell id="c"><morphology id="m"><segment id="0"><proximal x="0" y="0" '
                                         'z="0" diameter="1"/><distal x="0" y="1" z="0" diameter="1"/></segment></morphology></cell><izhikevichCell id="i"/><network id="n"><population id="p" component="i" size="1">'
                                         '<instance id="0"><location x="0" y="0" z="0"/></instance></population><population id="q" component="c" size="1"/></network></neuroml>')
        return str(folder / "cell.nml")
    if entry == "from_sonata":
        import h5py
        with h5py.File(folder / "nodes.h5", "w") as file:
            file["nodes/A/node_type_id"] = [0, 0, 0]
            for name in "xyz":
                file[f"nodes/A/0/{name}"] = [0.0, 1, 2]
        return str(folder / "nodes.h5")
    row().save(folder / "scene.pbrt")
    return str(folder / "scene.pbrt")


def trial(scene, call, given):
    """Calls it. Where it is told that something is wrong, the scene is as it was."""
    held = len(scene.shapes), scene.instances, scene._native.lights
    try:
        with np.errstate(all="ignore"):
            call(scene, given)
        return True
    except TOLD:
        pass
    except MemoryError:
        pass
    assert (len(scene.shapes), scene.instances, scene._native.lights) == held
    return False


ENTRIES = {name: (call, parameters) for name, call, parameters in entries()}


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.filterwarnings("ignore")
def test_every_entry(entry, tmp_path):
    call, parameters = ENTRIES[entry]
    short = entry.split(".")[-1]
    named = {name: one for name, one in parameters.items() if one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL)}
    for package in PACKAGES.get(entry, ()):
        pytest.importorskip(package)
    VALUES["path"] = file_for(entry, tmp_path)
    needed = {name for name, one in named.items() if one.default is one.empty}
    quick = {name for name in named if entry in SLOW and name in ("scene", "spp", "rays", "size")}
    unknown = [name for name in needed if name != "to" and name not in VALUES and (short, name) not in OF]
    assert not unknown, f"{entry} has arguments that VALUES does not know: {unknown}"
    for name in [*named, *MORE.get(short, ())]:
        base = good(entry, name)
        tried = dict(ANYTHING)
        numbers = isinstance(base, (list, float, np.ndarray)) and not isinstance(base, str) and np.asarray(base).dtype.kind in "fiu" and not (entry in SLOW and np.ndim(base) == 0)
        if numbers:
            tried.update(arrays_like(base))
        if name == "each":
            tried.update((f"each {way}", {"radius": value}) for way, value in [*arrays_like([0.1, 0.2, 0.3]), *ANYTHING.items()])
        if name == "tractogram":
            tried.update((f"lines {way}", [value]) for way, value in [*arrays_like(THREE), *ANYTHING.items()])
        worked = 0
        for way, value in tried.items():
            given = {one: good(entry, one) for one in needed | quick}
            given[name] = value
            try:
                worked += trial(row(with_csg=short == "animate_operand"), call, given)
            except BaseException as problem:
                pytest.fail(f"{entry}({name}={way}): {type(problem).__name__}: {problem}")
        # Of numbers at least those of other types and orders are taken.
        assert not numbers or worked >= 5, f"{entry}({name}=): nothing works"


@pytest.mark.parametrize("module", [cameras, lights, materials, media, textures], ids=lambda module: module.__name__.split(".")[-1])
@pytest.mark.filterwarnings("ignore")
def test_every_constructor(module):
    uses = {cameras: lambda scene, one: setattr(scene, "camera", one), lights: lambda scene, one: scene.add_light(one),
            materials: lambda scene, one: scene.add("sphere", material=one), media: lambda scene, one: scene.add("sphere", inside=one),
            textures: lambda scene, one: scene.add("sphere", material=materials.diffuse(reflectance=one))}
    tried = [*ANYTHING.items(), *arrays_like([0.1, 0.2, 0.3]), *arrays_like(THREE)]
    scene = row()
    for type in module.__all__:
        for name in inspect.signature(getattr(module, type)).parameters:
            for way, value in tried:
                if scene._native.lights + len(scene.shapes) > 50:
                    scene = row()
                try:
                    trial(scene, lambda scene, given: uses[module](scene, getattr(module, type)(**given)), {name: value})
                except BaseException as problem:
                    pytest.fail(f"{type}({name}={way}): {problem.__class__.__name__}: {problem}")


@pytest.mark.filterwarnings("ignore")
def test_sessions_and_images(tmp_path):
    scene = row()
    session = caplet.Session(scene)
    session.render(1)
    image = session.image()
    calls = {"Session.render": lambda value: session.render(value), "Session.update": session.update, "Session.resume": session.resume, "Image.save": image.save,
             "Session.time_limit": lambda value: session.render(1, time_limit=value), "Session.progress": lambda value: session.render(1, progress=value),
             "Image.save_film": image.save_film, "Image.getitem": lambda value: image[value], "Image.add": lambda value: image + value,
             "outline": lambda value: image.png(outline=value), "scale_bar": lambda value: image.png(scale_bar=value), "load_film": lambda value: caplet.load_film(value, scene),
             "load_film of": lambda value: caplet.load_film("none.exr", value), "Session": lambda value: caplet.Session(scene, device=value),
             "Session.size": lambda value: caplet.Session(scene, size=value), "denoise": caplet.denoise, "to_xarray": caplet.to_xarray,
             "set_log_level": caplet.set_log_level, "Blackbody": caplet.Blackbody}
    os.chdir(tmp_path)
    for name, call in calls.items():
        for way, value in [*ANYTHING.items(), *arrays_like([4.0, 3.0])]:
            try:
                call(value)
            except (*TOLD, MemoryError, caplet.RunError):
                pass
            except (AttributeError, ImportError):
                if name not in ("denoise", "to_xarray"):
                    raise
            except BaseException as problem:
                pytest.fail(f"{name}({way}): {type(problem).__name__}: {problem}")
    assert np.isfinite(image.rgb).all() and session.render(1) == 1
