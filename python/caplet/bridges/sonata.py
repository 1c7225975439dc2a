# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Circuits of the SONATA format, that libsonata reads.

The format is that of Dai et al., The SONATA data format for efficient description of large-scale network models, PLoS Comput. Biol. 16
(2020), doi:10.1371/journal.pcbi.1007696, and of its developer guide (github.com/AllenInstitute/sonata).
"""
import csv
import json
import os
import re

import numpy as np

from ..errors import InputError
from ..scene import Scene
from .cells import MOST_NODES, Look, add_cell, package, wrong
from .neurons import neurites, soma_of
from ..spelling import keywords

_NONE = ("", "NULL", "None", "_NONE")  # names of morphologies that say that there is none
_FORMATS = (".swc", ".h5", ".asc")
_ALTERNATE = {"h5v1": ".h5", "neurolucida-asc": ".asc"}  # of "alternate_morphologies"
_UNSEEN = ("virtual", "vasculature", "astrocyte")  # populations that are shown when they are named
_MOST_MISSING = 20  # that are told
_QUATERNION = ("orientation_w", "orientation_x", "orientation_y", "orientation_z")
_ANGLES = ("rotation_angle_xaxis", "rotation_angle_yaxis", "rotation_angle_zaxis")


def _first_line(problem):
    lines = [line for line in str(problem).splitlines() if line.strip()]
    return lines[0].strip() if lines else type(problem).__name__


class _Told:
    """What libsonata, MorphIO and h5py raise becomes an InputError of the file."""

    def __init__(self, path, of=""):
        self.path, self.of = path, of

    def __enter__(self):
        return self

    def __exit__(self, kind, problem, trace):
        if kind is None or not issubclass(kind, Exception) or issubclass(kind, (InputError, MemoryError)):
            return False
        place = re.match(r"\s*(?:\x1b\[[\d;]*m)?[^\n]*:(\d+):error\S*\s+(.*)", str(problem), re.DOTALL)  # as MorphIO says it
        text, line = (place[2], int(place[1])) if place else (problem, None)
        raise wrong(self.path, f"{self.of}{_first_line(text)}", line) from None


def _types_of(path, population):
    """A file of node types: {id: {column: text}}, the rows of this population and those of none."""
    out = {}
    with _Told(path), open(path, newline="", encoding="utf-8") as file:
        rows = csv.reader(file, delimiter=" ", skipinitialspace=True)
        columns = next(rows, [])
        if "node_type_id" not in columns:
            raise wrong(path, "there is no column node_type_id", 1)
        for row in rows:
            row = row[:-1] if len(row) == len(columns) + 1 and not row[-1] else row  # a blank at the end of the line
            if not row:
                continue
            if len(row) != len(columns):
                raise wrong(path, f"{len(row)} fields; the first line has {len(columns)}", rows.line_num)
            held = dict(zip(columns, row))
            if held.pop("population", population) in (population, "NULL", ""):
                number = held.pop("node_type_id")
                if not re.fullmatch(r"-?\d{1,18}", number):
                    raise wrong(path, f"node_type_id: a whole number is needed, not {number!r}", rows.line_num)
                out[int(number)] = held
    return out


class _Population:
    """Nodes of one population that are shown: their ids, and columns of what is known of them."""

    def __init__(self, libsonata, name, open_it, file, types_path=None, folders=(), config=None):
        self.libsonata, self.name, self.file, self.types_path, self.folders, self.config = libsonata, name, file, types_path, folders, config
        self.types = _types_of(types_path, name) if types_path else {}
        self.of_types = set().union(*self.types.values())
        with self.told():
            self.held = open_it()
            self.own, self.kinds = self.held.attribute_names, self.held.enumeration_names
        self._type_ids = None

    def close(self):
        """libsonata has the file open while its objects are there: one that is written anew meanwhile would be read as it was, or worse."""
        self.held = self.selection = None

    def told(self):
        return _Told(self.file, f"population {self.name!r}: ")

    def wrong(self, text):
        return wrong(self.file, f"population {self.name!r}: {text}")

    @property
    def columns(self):
        return self.own | self.of_types

    @property
    def is_seen(self):
        """Whether its nodes have places, and are not virtual by their types."""
        return {"x", "y", "z"} <= self.columns and {one.get("model_type") for one in self.types.values()} != {"virtual"}

    def choose(self, ids):
        """ids: None, an array, or the name of a node set."""
        with self.told():
            size = self.held.size
        if ids is None:
            self.selection = self.libsonata.Selection([(0, size)] if size else [])
        elif isinstance(ids, str):
            path = self.config.node_sets_path if self.config else ""
            if not path:
                raise InputError(f"ids: {self.file} has no node sets, so no {ids!r}")
            if size > MOST_NODES:  # whose columns would be read to find them
                raise self.wrong(f"{size} nodes; node sets are looked up among at most {MOST_NODES}")
            with _Told(path, f"node set {ids!r}: "):
                self.selection = self.libsonata.NodeSets.from_file(path).materialize(ids, self.held)
        else:
            if ids.size and int(ids.max()) >= size:
                raise InputError(f"ids: {int(ids.max())}; population {self.name!r} of {self.file} has {size} nodes, counted from 0")
            self.selection = self.libsonata.Selection(ids.astype(np.uint64))
        self.count = self.selection.flat_size

    def ids(self):
        return self.selection.flatten().astype(np.int64)

    def column(self, name):
        """Numbers or texts (count,) of an attribute: a node's own, or else its type's."""
        if name in self.kinds or name not in self.own:
            texts, which = self.texts(name)
            if name not in self.own:
                try:
                    return np.array([np.nan if text in _NONE else float(text) for text in texts], dtype=np.float64)[which]
                except ValueError:
                    pass
            return np.array(texts, dtype=object)[which]
        with self.told():
            values = np.asarray(self.held.get_attribute(name, self.selection))
        if values.shape != (self.count,):
            raise self.wrong(f"{name}: {len(values)} values of {self.count} nodes")
        return values

    def texts(self, name):
        """An attribute as texts, and which of them each node has (count,)."""
        if name in self.kinds:
            with self.told():
                texts, which = self.held.enumeration_values(name), np.asarray(self.held.get_enumeration(name, self.selection)).astype(np.int64)
            if which.size and not (0 <= which.min() and which.max() < len(texts)):
                raise self.wrong(f"{name}: a number beyond the {len(texts)} names of its @library")
            return texts, which
        if name in self.own:
            different, which = np.unique(self.column(name), return_inverse=True)
            return list(map(str, different)), which
        if self._type_ids is None:
            self._type_ids = self._read_type_ids()
        known, which = np.unique(self._type_ids, return_inverse=True)
        lacking = [int(one) for one in known if int(one) not in self.types]
        if lacking:
            raise self.wrong(f"node type {lacking[0]} is not in {self.types_path}")
        return [self.types[int(one)][name] for one in known], which

    def _read_type_ids(self):
        """Of the chosen nodes, which libsonata does not give: by blocks, for they may be few of many."""
        h5py = package("h5py", "from_sonata (of circuits with node types)")
        ids, block = self.ids(), 1 << 20
        out, order = np.empty(self.count, dtype=np.int64), np.argsort(ids)
        with self.told(), h5py.File(self.file, "r") as file:
            of = file["nodes"][self.name]["node_type_id"]
            for rows in np.split(order, np.flatnonzero(np.diff(ids[order] // block)) + 1):
                begin = int(ids[rows[0]] // block * block) if len(rows) else 0
                out[rows] = of[begin:begin + block][ids[rows] - begin]
        return out

    def numbers(self, name):
        values = self.column(name)
        if values.dtype.kind not in "fiub":
            raise self.wrong(f"{name}: numbers are needed, not {values[0]!r}" if len(values) else f"{name}: numbers are needed")
        values = values.astype(np.float64)
        bad = np.flatnonzero(~np.isfinite(values))
        if len(bad):
            raise self.wrong(f"node {self.ids()[bad[0]]}: {name} is {values[bad[0]]}")
        return values

    def positions(self):
        lacking = [name for name in "xyz" if name not in self.columns]
        if lacking:
            raise self.wrong(f"its nodes have no {', '.join(lacking)}")
        return np.stack([self.numbers(name) for name in "xyz"], axis=1)

    def rotations(self):
        """(count, 3, 3): of quaternions, of any length; or of angles in radians about the fixed axes, z first, then y, then x."""
        quaternion = [name for name in _QUATERNION if name in self.columns]
        if quaternion:
            if len(quaternion) < 4:
                raise self.wrong(f"has {', '.join(quaternion)} and not all of {', '.join(_QUATERNION)}")
            q = np.stack([self.numbers(name) for name in _QUATERNION], axis=1)
            largest = np.abs(q).max(axis=1, keepdims=True, initial=0)
            nothing = np.flatnonzero(largest[:, 0] == 0)
            if len(nothing):
                raise self.wrong(f"node {self.ids()[nothing[0]]}: its orientation is 0")
            q /= largest  # squares neither overflow nor vanish
            w, x, y, z = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
            rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)], [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
            return np.moveaxis(np.array(rows), 2, 0)
        out = np.broadcast_to(np.eye(3), (self.count, 3, 3))
        for axis, name in enumerate(_ANGLES):
            if name in self.columns:
                angle = self.numbers(name)
                cosine, sine, one = np.cos(angle), np.sin(angle), np.zeros((self.count, 3, 3))
                a, b = (axis + 1) % 3, (axis + 2) % 3
                one[:, axis, axis] = 1
                one[:, a, a], one[:, a, b], one[:, b, a], one[:, b, b] = cosine, -sine, sine, cosine
                out = out @ one
        return out

    def files(self):
        """(count,) numbers of morphologies, -1 without one, and what finds each: (the file, or the container and a name in it)."""
        out = np.full(self.count, -1)
        if "morphology" not in self.columns:
            return out, []
        names, which = self.texts("morphology")
        ids, number, found, missing = self.ids(), np.full(len(names), -1), [], []
        for name, row in zip(*np.unique(which, return_index=True)):  # those that occur, and where first
            text = names[name]
            if text in _NONE:
                continue
            if not self.folders:
                raise self.wrong(f"node {ids[row]} has morphology {text!r}, and no folder of morphologies is known: "
                                 "morphologies= takes one, or False for spheres")
            place = _find(self.folders, text)
            if place is None:
                missing.append(f"{self.file}: population {self.name!r}: node {ids[row]}: there is no morphology {text!r} in "
                               f"{', '.join(folder for folder, _ in self.folders)}")
                continue
            number[name] = len(found)
            found.append(place)
        out = number[which] if len(names) else out
        if missing:
            more = len(missing) - _MOST_MISSING
            error = InputError(missing[:_MOST_MISSING] + ([f"{self.file}: {more} more morphologies are missing"] if more > 0 else []))
            error.file = self.file
            raise error
        return out, found


def _find(folders, name):
    """(file, None), or (container, name)."""
    for folder, formats in folders:
        if os.path.isfile(folder):
            return folder, name  # a container, which tells itself what it lacks
        path = os.path.join(folder, name)
        if path.endswith(formats) and os.path.isfile(path):
            return path, None
        for end in formats:
            if os.path.isfile(path + end):
                return path + end, None
    return None


def _load(morphio, place):
    path, name = place
    with _Told(path, "" if name is None else f"{name}: "):
        return morphio.Morphology(path) if name is None else morphio.Collection(path).load(name)


def _completed(libsonata, path, config):
    """With the populations of files for which a configuration names none: all that they hold."""
    base = os.path.dirname(os.path.abspath(path))
    made = json.loads(config.expanded_json)
    open_ones = [entry for entry in made["networks"]["nodes"] if not entry.get("populations")]
    for entry in open_ones:
        file = os.path.join(base, entry["nodes_file"])
        if not os.path.isfile(file):
            raise wrong(path, f"there is no file {file}")
        entry["populations"] = {name: {} for name in libsonata.NodeStorage(file).population_names}
    return libsonata.CircuitConfig(json.dumps(made), base) if open_ones else config


def _config(libsonata, path):
    """(name, _Population maker, type) of all populations that a circuit's configuration names."""
    try:
        with open(path, encoding="utf-8") as file:
            json.load(file)
    except json.JSONDecodeError as problem:
        raise InputError(f"{path}:{problem.lineno}:{problem.colno}: {problem.msg}") from None
    except (UnicodeDecodeError, RecursionError) as problem:
        raise wrong(path, f"is no circuit configuration ({_first_line(problem)})") from None
    with _Told(path):
        config = _completed(libsonata, path, libsonata.CircuitConfig.from_file(path))
        names = sorted(config.node_populations)
    for name in names:
        with _Told(path, f"population {name!r}: "):
            properties = config.node_population_properties(name)
        folders = [(properties.morphologies_dir, _FORMATS)] if properties.morphologies_dir else []
        folders += [(folder, (_ALTERNATE[kind],)) for kind, folder in properties.alternate_morphology_formats.items() if kind in _ALTERNATE]

        def make(name=name, properties=properties, folders=folders):
            if not os.path.isfile(properties.elements_path):
                raise wrong(path, f"population {name!r}: there is no file {properties.elements_path}")
            return _Population(libsonata, name, lambda: config.node_population(name), properties.elements_path, properties.types_path or None, folders, config)

        yield name, make, properties.type


def _nodes(libsonata, path):
    with _Told(path):
        names = sorted(libsonata.NodeStorage(path).population_names)
    for name in names:

        def make(name=name):
            return _Population(libsonata, name, lambda: libsonata.NodeStorage(path).open_population(name), path)

        yield name, make, ""


def _populations(libsonata, path, wanted, out):
    """Adds to `out`, which is let go of whatever happens."""
    with open(path, "rb") as file:
        is_nodes = file.read(8) == b"\x89HDF\r\n\x1a\n" or path.endswith((".h5", ".hdf5"))
    held = list((_nodes if is_nodes else _config)(libsonata, path))
    there = [name for name, _, _ in held]
    for name in wanted or ():
        if name not in there:
            raise InputError(f"population: {path} has no {name!r}; it has {', '.join(map(repr, there)) or 'none'}")
    for name, make, kind in held:
        if name in wanted if wanted else kind not in _UNSEEN:
            out.append(make())
            if not (wanted or out[-1].is_seen):
                out.pop().close()
    if not out:
        raise wrong(path, f"no population has nodes with x, y and z, of {', '.join(map(repr, there)) or 'none'}")


def _ids(given):
    if given is None or isinstance(given, str):
        return given
    ids = np.asarray(given)
    if ids.dtype.kind not in "iu" or ids.ndim != 1 or not ids.size:
        raise InputError(f"ids: whole numbers (n,), or the name of a node set are needed, not {ids.dtype} of shape {ids.shape}")
    if ids.size > MOST_NODES:
        raise InputError(f"ids: {ids.size}; at most {MOST_NODES}")
    if ids.min() < 0:
        raise InputError(f"ids: {int(ids.min())} is negative")
    if len(np.unique(ids)) != len(ids):
        raise InputError("ids: each node once")
    return ids


def _names(population):
    if population is None or isinstance(population, str):
        return None if population is None else [population]
    if not isinstance(population, (list, tuple)) or not population or not all(isinstance(one, str) for one in population):
        raise InputError(f"population: a name, or a list of them is needed, not {population!r}")
    return list(population)


def _of_attribute(populations, which, color, low, high):
    """By a column: numbers through the colour map, texts each a colour."""
    if not any(color in one.columns for one in populations):
        there = sorted(set().union(*(one.columns for one in populations)))
        raise InputError(f'color: the nodes have no {color!r}; "type", "population", a colour, an array of one a node, or one of {", ".join(there)}')
    held = [one.column(color) if color in one.columns else np.full(one.count, np.nan) for one in populations]
    if all(values.dtype.kind in "fiub" for values in held):
        return Look.by_value(np.concatenate(held).astype(np.float64), low, high, color)
    texts = np.concatenate([np.where(values != values, "", values).astype(str) for values in held])
    labels, kinds = np.unique(texts, return_inverse=True)
    return Look.by_kind(kinds.reshape(-1), labels.tolist())


def _look(populations, color, low, high):
    count = sum(one.count for one in populations)
    which = np.repeat(np.arange(len(populations)), [one.count for one in populations])
    if isinstance(color, str):
        if color == "type":
            return Look.by_type(which, len(populations))
        if color == "population":
            return Look.by_kind(which, [one.name for one in populations])
        if not color.startswith("#"):
            return _of_attribute(populations, which, color, low, high)
        return Look.plain(color, count)
    values = np.asarray(color)
    if values.dtype.kind not in "fiub" or values.shape not in ((3,), (count,), (count, 3)):
        raise InputError(f"color: a name, a colour (3,), or numbers ({count},) or colours ({count}, 3) of the nodes are needed, "
                         f"not {values.dtype} of shape {values.shape}")
    values = values.astype(np.float64)
    if values.shape == (3,):
        return Look.plain(values, count)
    return Look.by_value(values, low, high, "value") if values.ndim == 1 else Look.by_colors(values)


def _folders(morphologies):
    folder = os.fspath(morphologies)
    if isinstance(folder, bytes) or not os.path.exists(folder):
        raise InputError(f"morphologies: there is no {folder!r}")
    return [(folder, _FORMATS)]


@keywords
def from_sonata(path, population=None, ids=None, morphologies=None, color="type", radius=5.0, low=None, high=None):
    """A scene of a SONATA circuit, in its units (micrometres): cells as instances of their morphologies, which are read once each (by
    MorphIO: .swc, .h5, .asc), and nodes without one as spheres, a shape for each population, by its name.

    path: of a circuit's configuration (circuit_config.json) or of a file of nodes (.h5). population: a name or a list of them; None: all
    of nodes with positions that are neither virtual, vasculature nor astrocytes. ids: of the nodes that are shown, (n,), of one population; or
    the name of a node set; None: all. morphologies: their folder, or MorphIO's container; None: the configuration's; False: spheres for
    all. radius: of the spheres.

    color: "type" (of segments, as in files of neurons; spheres by population), "population", the name of an attribute ("mtype",
    "layer"), one colour (any three numbers are), or an array with a number or a colour of each node. Texts have a colour each
    (scene.info["colors"]); numbers are told by caplet.color_map between low and high, for cells in 16 steps. Cells of n colours need a
    morphology n times.

    A morphology is moved to have its soma at 0 (unless the node's `recenter` is 0), turned by the node's quaternion (orientation_w, x, y, z, of
    any length) or by its angles about the fixed axes, z first, then y, then x (radians), and moved to x, y, z. At most 10^7 nodes.

    scene.info: "populations" (names); "instances" (n, 2): the population's number and the node's id of each instance, so that
    scene.info["instances"][hits["instance"]] tells who was hit; "nodes": {shape: ids} of the spheres; "section" {shape: sections} of capsules.
    """
    path, wanted, ids = os.fspath(path), _names(population), _ids(ids)
    if isinstance(path, bytes):
        path = os.fsdecode(path)
    if not os.path.isfile(path):
        raise wrong(path, "no such file")
    libsonata = package("libsonata", "from_sonata")
    populations = []
    try:
        _populations(libsonata, path, wanted, populations)
        return _scene(path, populations, ids, morphologies, color, radius, low, high)
    finally:
        for one in populations:
            one.close()


def _scene(path, populations, ids, morphologies, color, radius, low, high):
    if not (ids is None or isinstance(ids, str)) and len(populations) > 1:
        raise InputError(f"ids: of which population? {', '.join(repr(one.name) for one in populations)}")
    for one in populations:
        one.choose(ids)
        if morphologies is not None:
            one.folders = [] if morphologies is False else _folders(morphologies)
    count = sum(one.count for one in populations)
    if not count:
        raise wrong(path, "there are no nodes")
    if count > MOST_NODES:
        raise wrong(path, f"{count} nodes; at most {MOST_NODES} are shown: ids= or population= choose some")
    look = _look(populations, color, low, high)
    places = np.empty((count, 3, 4))
    numbers, files, recentered = np.full(count, -1), {}, np.ones(count, dtype=bool)
    begin = 0
    for one in populations:
        rows = slice(begin, begin + one.count)
        begin += one.count
        places[rows, :, :3], places[rows, :, 3] = one.rotations(), one.positions()
        if "recenter" in one.columns:
            recentered[rows] = one.numbers("recenter") != 0
        if morphologies is not False:
            of, found = one.files()
            if found:
                known = np.array([*(files.setdefault(place, len(files)) for place in found), -1])
                numbers[rows] = known[of]
    scene = Scene()
    scene.unit = "um"
    owners = np.stack([np.repeat(np.arange(len(populations)), [one.count for one in populations]), np.concatenate([one.ids() for one in populations])], 1)
    scene.info.update(populations=[one.name for one in populations], section={}, nodes={}, colors=look.labels)
    scene.info["instances"] = owners[_cells(scene, look, list(files), numbers, places, recentered)]
    for k, one in enumerate(populations):
        rows = np.flatnonzero((owners[:, 0] == k) & (numbers < 0))
        if len(rows):
            shape = scene.add_spheres(places[rows, :, 3], radius, color=look.colors[rows], name=one.name)
            scene.info["nodes"][shape.name] = owners[rows, 1]
    if look.told:
        scene.set_color_bar(*look.told)
    return scene


def _cells(scene, look, files, numbers, places, recentered):
    """Adds all cells, file by file: the rows of the instances in their order."""
    if not files:
        return np.empty(0, np.int64)
    morphio = package("morphio", "from_sonata")
    order = np.lexsort((look.classes, numbers))
    order = order[numbers[order] >= 0]
    ends = np.flatnonzero(np.diff(numbers[order], append=-1) | np.diff(look.classes[order], append=-2)) + 1
    taken, loaded, names = [], None, set()
    for rows in np.split(order, ends[:-1]):
        file, cell_class = numbers[rows[0]], int(look.classes[rows[0]])
        if loaded != file:
            loaded, morphology = file, _load(morphio, files[file])
            segments = neurites(morphology)
            centers, balls = soma_of(morphology.soma)
            middle = np.asarray(morphology.soma.points, dtype=np.float64).reshape(-1, 3)
            middle = middle.mean(axis=0) if len(middle) else np.zeros(3)
            p0, p1 = np.concatenate([centers, segments[0]]), np.concatenate([centers, segments[1]])
            radii = np.concatenate([np.stack([balls, balls], axis=1), segments[2]])
            sections = np.concatenate([np.full(len(balls), -1), segments[3]]).astype(np.int32)
            kinds = np.concatenate([np.ones(len(balls), np.int64), segments[4]])
            u = np.concatenate([np.zeros((len(balls), 2)), segments[5]])
        name = stem = " ".join(filter(None, [files[file][1] or os.path.splitext(os.path.basename(files[file][0]))[0], look.name(cell_class)]))
        while name in names:
            name = f"{stem} {len(names)}"
        names.add(name)
        added = list(add_cell(scene, look, cell_class, name, p0, p1, radii, kinds, name, u))
        if not added:
            raise wrong(files[file][0], "the morphology has nothing to show")
        scene.info["section"].update((shape, sections[shown]) for shape, shown in added)
        place = places[rows]
        place[:, :, 3] -= np.where(recentered[rows, np.newaxis], place[:, :, :3] @ middle, 0)
        scene.add_instances(name, place)
        taken.append(rows)
    return np.concatenate(taken)
