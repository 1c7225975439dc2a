# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Cells and networks of NeuroML 2, that libNeuroML reads.

The format is that of Cannon et al., LEMS: a language for expressing complex biological models ..., Front. Neuroinform. 8 (2014),
doi:10.3389/fninf.2014.00079, and of its schema (docs.neuroml.org).
"""
import importlib
import os
import re
import types
import warnings

import numpy as np

from ..errors import InputError
from ..scene import Scene
from .cells import MOST_NODES, Look, add_cell, package, wrong
from ..spelling import keywords

# What groups of segments are, as SWC types: by their identifiers of the Gene Ontology, or by the first word of their names.
_ONTOLOGY = {"GO:0043025": 1, "GO:0030424": 2, "GO:0030425": 3, "GO:0097441": 3, "GO:0097440": 4}
_WORDS = {"soma": 1, "axon": 2, "myel": 2, "apic": 4, "dend": 3, "basa": 3}
_STRONGEST = (1, 2, 4, 3)  # of several groups of a segment


def _word(name):
    found = re.match(r"[^A-Za-z]*([A-Za-z]{4})", name or "")
    return _WORDS.get(found[1].lower(), 0) if found else 0


def _line(element):
    node = getattr(element, "gds_elementtree_node_", None)
    return None if node is None else node.sourceline


class _Documents:
    """A file and all that it includes, each once."""

    def __init__(self, path):
        package("neuroml", "from_neuroml", of="libneuroml")
        self.loaders = importlib.import_module("neuroml.loaders")
        self.documents, self.has_others = [], False
        waiting, seen = [(path, None, None)], set()
        while waiting:
            file, includer, line = waiting.pop(0)
            if os.path.realpath(file) in seen:
                continue
            seen.add(os.path.realpath(file))
            if not os.path.isfile(file):
                raise wrong(file, "no such file") if includer is None else wrong(includer, f"includes {file}, which is no file", line)
            document = self._read(file, includer)
            if document is None:
                continue
            self.documents.append((file, document))
            for include in document.includes:
                if not include.href:
                    raise wrong(file, "an include without href", _line(include))
                waiting.append((os.path.join(os.path.dirname(file), include.href), file, _line(include)))

    def _read(self, file, includer):
        if file.endswith((".h5", ".hdf5")):
            raise wrong(file, "NeuroML in HDF5 is not read: write it as XML (libNeuroML's writers.NeuroMLWriter)")
        try:
            with warnings.catch_warnings():
                return self.loaders.read_neuroml2_file(os.path.abspath(file), print_method=lambda *_: None)
        except TypeError:  # another root element
            if includer is None:
                raise wrong(file, "is no NeuroML 2 document (no <neuroml>)") from None
            self.has_others = True  # of LEMS: dynamics, no shapes
            return None
        except Exception as problem:
            inner = problem.args[1] if len(problem.args) > 1 and isinstance(problem.args[1], Exception) else problem
            place = re.search(r"\bline (\d+)(?:, column (\d+))?", str(inner))
            text = (str(inner).splitlines() or [""])[0].replace("{http://www.neuroml.org/schema/neuroml2}", "")
            text = re.sub(r"(, line \d+(, column \d+)?)?( \([^()]*line \d+\))?$", "", text) or type(inner).__name__
            where = "" if not place else f":{place[1]}" + (f":{place[2]}" if place[2] else "")
            if where:
                raise InputError(f"{file}{where}: {text}") from None
            raise wrong(file, text) from None

    def every(self, *lists):
        """(file, element) of these lists of all documents."""
        for file, document in self.documents:
            for name in lists:
                for element in getattr(document, name, None) or ():
                    yield file, element

    def has_component(self, name):
        """Whether any element of this id is there."""
        for _, document in self.documents:
            for held in vars(document).values():
                if isinstance(held, list) and any(getattr(one, "id", None) == name for one in held):
                    return True
        return False


class _Cell:
    """Segments of one cell: ids, p0, p1 (n, 3), radii (n, 2), kinds (SWC types)."""

    def __init__(self, documents, file, cell):
        self.cell, self.name = cell, str(cell.id)
        self.file, self.morphology = self._morphology(documents, file)
        segments = self.morphology.segments
        if not segments:
            raise self.wrong("has no segments", self.morphology)
        self.segments = {}
        for segment in segments:
            if segment.id is None:
                raise self.wrong("a segment without id", segment)
            if self.segments.setdefault(segment.id, segment) is not segment:
                raise self.wrong(f"segment {segment.id} is there twice", segment)
        self.ids = np.array(list(self.segments), dtype=np.int64)
        self.order = self._ordered()
        ends = self._ends()
        ends = np.array([ends[one] for one in self.segments])
        self.p0, self.p1, self.radii = ends[:, 0, :3], ends[:, 1, :3], ends[:, :, 3] / 2
        self.kinds = self._kinds()

    def wrong(self, text, element=None):
        return wrong(self.file, f"cell {self.name!r}: {text}", _line(element))

    def _morphology(self, documents, file):
        if self.cell.morphology is not None:
            return file, self.cell.morphology
        name = self.cell.morphology_attr
        if name is None:
            self.file = file
            raise self.wrong("has no morphology", self.cell)
        for there, morphology in documents.every("morphology"):
            if morphology.id == name:
                return there, morphology
        self.file = file
        raise self.wrong(f"there is no morphology {name!r}", self.cell)

    def parent(self, segment):
        return None if segment.parent is None else segment.parent.segments

    def _ordered(self):
        """Ids, each behind its parent's."""
        done, order = set(), []
        for start in self.segments:
            way, at = {}, start  # in their order
            while at is not None and at not in done:
                way[at] = len(way)
                done.add(at)
                up = self.parent(self.segments[at])
                if up is not None and up not in self.segments:
                    raise self.wrong(f"segment {at}: there is no segment {up}, its parent", self.segments[at])
                if up in way:
                    circle = list(way)[way[up]:]
                    said = ", ".join(map(str, circle[:8])) + (", ..." if len(circle) > 8 else "")
                    raise self.wrong(f"segment {up} is its own ancestor, by {said}", self.segments[up])
                at = up
            order += reversed(way)
        return order

    def _point(self, segment, point, name):
        if any(value is None for value in (point.x, point.y, point.z, point.diameter)):
            raise self.wrong(f"segment {segment.id}: its {name} lacks x, y, z or diameter", point)
        values = np.array([point.x, point.y, point.z, point.diameter], dtype=np.float64)
        if not np.isfinite(values).all() or values[3] < 0:
            raise self.wrong(f"segment {segment.id}: its {name} is {', '.join(map(str, values))}", point)
        return values

    def _ends(self):
        """{id: (2, 4)}: proximal and distal with their diameters."""
        out = {}
        for number in self.order:
            segment = self.segments[number]
            if segment.distal is None:
                raise self.wrong(f"segment {number} has no distal point", segment)
            distal, up = self._point(segment, segment.distal, "distal"), self.parent(segment)
            if segment.proximal is not None:
                proximal = self._point(segment, segment.proximal, "proximal")
            elif up is None:
                raise self.wrong(f"segment {number} has neither a proximal point nor a parent", segment)
            else:
                along = float(segment.parent.fraction_along)
                if not 0 <= along <= 1:
                    raise self.wrong(f"segment {number}: fractionAlong is {along:g}; from 0 to 1 is needed", segment.parent)
                proximal = (1 - along) * out[up][0] + along * out[up][1]
            out[number] = np.stack([proximal, distal])
        return out

    def _kinds(self):
        groups = {group.id: group for group in self.morphology.segment_groups}
        held = {kind: set() for kind in _STRONGEST}
        for group in groups.values():
            kind, word = _ONTOLOGY.get(group.neuro_lex_id, 0), _word(group.id)
            if kind == 0 or (kind == 3 and word == 4):  # apical dendrites are dendrites
                kind = word
            if kind:
                held[kind] |= self._members(groups, group)
        out = []
        for number in self.segments:
            of = [kind for kind in _STRONGEST if number in held[kind]]
            out.append(of[0] if of else _word(self.segments[number].name))
        return np.array(out, dtype=np.int64)

    def _members(self, groups, group):
        members, waiting, seen = set(), [group], set()
        while waiting:
            group = waiting.pop()
            if group.id in seen:
                continue
            seen.add(group.id)
            members.update(one.segments for one in group.members)
            for path in group.paths:
                if path.from_ is not None and path.to is not None:
                    members |= self._path(path.from_.segments, path.to.segments)
            roots = {tree.from_.segments for tree in group.sub_trees if tree.from_ is not None}
            if roots:
                for number in self.order:  # parents come first
                    if self.parent(self.segments[number]) in roots:
                        roots.add(number)
                members |= roots
            for include in group.includes:
                if include.segment_groups not in groups:
                    raise self.wrong(f"group {group.id!r} includes {include.segment_groups!r}, which is not there", include)
                waiting.append(groups[include.segment_groups])
        return members

    def _path(self, begin, end):
        way, at = [], end
        while at is not None and at in self.segments:
            way.append(at)
            if at == begin:
                return set(way)
            at = self.parent(self.segments[at])
        return set()


def _property(population, tag):
    found = [one.value for one in population.properties if one.tag == tag]
    return found[0] if found else None


def _numbers(text, count):
    try:
        values = np.array([float(one) for one in (text or "").replace(",", " ").split()])
    except ValueError:
        return None
    return values if len(values) == count and np.isfinite(values).all() and values.min() >= 0 else None


class _Placed:
    """A population: its component, where its cells are (n, 3) and their ids."""

    def __init__(self, file, population):
        self.file, self.population, self.name, self.component = file, population, str(population.id), population.component
        at = []
        for one in population.instances:
            if one.location is None or any(value is None for value in (one.location.x, one.location.y, one.location.z)):
                raise wrong(file, f"population {self.name!r}: instance {one.id} lacks a location of x, y and z", _line(one))
            at.append((one.location.x, one.location.y, one.location.z))
            if not np.isfinite(at[-1]).all():
                raise wrong(file, f"population {self.name!r}: instance {one.id} is at {', '.join(map(str, at[-1]))}", _line(one))
        self.has_places = bool(at)
        self.at = np.array(at or [(0, 0, 0)], dtype=np.float64)
        self.ids = np.array([k if one.id is None else one.id for k, one in enumerate(population.instances)] or [0], dtype=np.int64)

    def color(self):
        values = _numbers(_property(self.population, "color"), 3)
        return None if values is None or values.max() > 1 else values

    def radius(self, otherwise):
        values = _numbers(_property(self.population, "radius"), 1)
        return otherwise if values is None or values[0] == 0 else values[0]


def _look(color, populations):
    which = np.arange(len(populations))
    if isinstance(color, str) and color == "population":
        look = Look.by_kind(which, [one.name for one in populations])
        own = [one.color() for one in populations]
        colors = [one if mine is None else mine for one, mine in zip(look.colors, own)]
        return Look(which, colors, np.array(colors).reshape(-1, 3), [one.name for one in populations])
    if isinstance(color, str) and color == "type":
        look = Look.by_type(which, len(populations))
        for one, mine in zip(populations, look.colors):
            mine[:] = mine if one.color() is None else one.color()
        return look
    if isinstance(color, str) and not color.startswith("#"):
        raise InputError(f'color: "type", "population" or a colour is needed, not {color!r}')
    return Look.plain(color, len(populations))


@keywords
def from_neuroml(path, cell=None, color="type", radius=5.0):
    """A scene of a NeuroML 2 file and of what it includes, in its units (micrometres): segments of cells as tapered capsules (spheres where
    both ends are the same point), a shape for each SWC type of a cell.

    Where there is a network, the cells of its populations are instances at their locations; a population without locations is shown
    once, its cell as it lies in its file. Cells without segments (point neurons) are spheres, where they have locations. Without a network
    all cells of the file and its includes are shown as they lie, or its morphologies where there are no cells. cell: the id of one cell,
    which is shown alone, without a network.
    radius: of point neurons whose population has no property "radius".

    color: "type": by groups of segments, whose neuroLexId (GO:0043025 soma, GO:0030424 axon, GO:0030425 and GO:0097441 dendrite,
    GO:0097440 apical dendrite) or else name ("soma...", "axon...", "myel...", "apic...", "dend...", "basa...") says what they are;
    "population": by its property "color", or else a palette; or one colour. A segment without a proximal point begins where its parent ends, or fractionAlong it, as thick as that
    is there. At most 10^7 instances.

    scene.info: "segment" {shape: ids of the segments of its capsules}; of a network "populations" (names), "instances" (n, 2): the
    population's number and the id of each instance, and "nodes" {shape: ids} of point neurons.
    """
    path = os.fspath(path)
    if isinstance(path, bytes):
        path = os.fsdecode(path)
    documents = _Documents(path)
    cells = {}
    held = list(documents.every("cells", "cell2_ca_poolses"))
    if not held:  # morphologies alone, as tools write them from SWC
        held = [(file, types.SimpleNamespace(id=one.id, morphology=one, gds_elementtree_node_=one.gds_elementtree_node_))
                for file, one in documents.every("morphology")]
    for file, one in held:
        if str(one.id) in cells and cells[str(one.id)][1] is not one:
            raise wrong(file, f"there are two cells {one.id!r}; the other is in {cells[str(one.id)][0]}", _line(one))
        cells[str(one.id)] = file, one
    scene = Scene()
    scene.unit = "um"
    scene.info.update(segment={})
    networks = list(documents.every("networks"))
    if cell is not None and cell not in cells:
        raise InputError(f"cell: {path} has no {cell!r}; it has {', '.join(map(repr, cells)) or 'none'}")
    if cell is None and networks:
        _network(scene, path, documents, cells, [(file, one) for file, network in networks for one in network.populations], color, radius)
        return scene
    look = _look(color, [])
    if isinstance(color, str) and color == "population":
        raise InputError(f"color: {path} has no populations")
    for name in [cell] if cell is not None else cells:
        _add(scene, look, 0 if look.materials else -1, _Cell(documents, *cells[name]), name)
    if not scene.shapes:
        raise wrong(path, "there are no cells with segments, and no network")
    return scene


def _add(scene, look, cell_class, cell, name, object=None):
    added = list(add_cell(scene, look, cell_class, name, cell.p0, cell.p1, cell.radii, cell.kinds, object))
    if not added:
        raise cell.wrong("all diameters are 0", cell.cell)
    scene.info["segment"].update((shape, cell.ids[rows]) for shape, rows in added)


def _network(scene, path, documents, cells, held, color, radius):
    populations = [_Placed(file, one) for file, one in held]
    for one in populations:
        if one.component not in cells and not documents.has_others and not documents.has_component(one.component):
            raise wrong(one.file, f"population {one.name!r}: there is no cell {one.component!r}; there are {', '.join(map(repr, cells)) or 'none'}",
                        _line(one.population))
    look = _look(color, populations)
    count = sum(len(one.at) for one in populations)
    if count > MOST_NODES:
        raise wrong(path, f"{count} cells; at most {MOST_NODES} are shown")
    made, parts, owners, nodes = {}, {}, [np.empty((0, 2), np.int64)], {}
    for k, one in enumerate(populations):
        if one.component in cells:
            object = one.component, int(look.classes[k])
            if object not in made:
                if one.component not in parts:
                    parts[one.component] = _Cell(documents, *cells[one.component])
                made[object] = one.component if one.component not in scene.objects else f"{one.component} {one.name}"
                _add(scene, look, object[1], parts[one.component], made[object], object=made[object])
            places = np.broadcast_to(np.eye(4)[:3], (len(one.at), 3, 4)).copy()
            places[:, :, 3] = one.at
            scene.add_instances(made[object], places)
            owners.append(np.stack([np.full(len(one.ids), k), one.ids], axis=1))
        elif one.has_places:
            shape = scene.add_spheres(one.at, one.radius(radius), color=tuple(look.colors[k]), name=one.name)
            nodes[shape.name] = one.ids
    if not scene.shapes:
        raise wrong(path, "the network has no cells with segments or locations")
    scene.info.update(populations=[one.name for one in populations], instances=np.concatenate(owners), nodes=nodes)
