# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Molecules that gemmi has read."""
import numpy as np

from .. import materials
from ..errors import InputError
from ..scene import Scene
from ..spelling import keywords

# Colours of elements as Jmol has them (https://jmol.sourceforge.net/jscolors), of a screen.
_JMOL = {"H": "ffffff", "C": "909090", "N": "3050f8", "O": "ff0d0d", "F": "90e050", "Na": "ab5cf2", "Mg": "8aff00", "Al": "bfa6a6",
         "Si": "f0c8a0", "P": "ff8000", "S": "ffff30", "Cl": "1ff01f", "K": "8f40d4", "Ca": "3dff00", "Ti": "bfc2c7", "Cr": "8a99c7",
         "Mn": "9c7ac7", "Fe": "e06633", "Co": "f090a0", "Ni": "50d050", "Cu": "c88033", "Zn": "7d80b0", "Se": "ffa100", "Br": "a62929",
         "Ag": "c0c0c0", "I": "940094", "Pt": "d0d0e0", "Au": "ffd123"}
_OTHER = "ff1493"
_STRETCH = 1.3  # bonds are up to so many times as long as the sum of the covalent radii
_CHAINS = ("1f77b4", "ff7f0e", "2ca02c", "d62728", "9467bd", "8c564b", "e377c2", "7f7f7f", "bcbd22", "17becf")


def _linear(code):
    screen = np.array([int(code[i:i + 2], 16) for i in (0, 2, 4)]) / 255
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)


def _atoms(gemmi, structure, model, hydrogens, waters):
    if isinstance(structure, gemmi.SmallStructure):
        for site in structure.get_all_unit_cell_sites():
            at = structure.cell.orthogonalize(site.fract)
            yield (at.x, at.y, at.z), site.element, "", "\0", None
        return
    if not 0 <= model < len(structure):
        raise InputError(f"model: {model} of {len(structure)}, counted from 0")
    for chain in structure[model]:
        for residue in chain:
            if not waters and residue.is_water():
                continue
            first = {}  # of an atom in several places the first
            for atom in residue:
                if first.setdefault(atom.name, atom.altloc) != atom.altloc or (not hydrogens and atom.is_hydrogen()):
                    continue
                yield (atom.pos.x, atom.pos.y, atom.pos.z), atom.element, chain.name, residue.name, atom


def bonds_of(positions, radii):
    """Pairs (i, j), i < j, of atoms no further apart than 1.3 times the sum of their covalent radii (angstroms)."""
    count = len(positions)
    if count < 2:
        return np.empty((0, 2), dtype=np.int64)
    reach = _STRETCH * 2 * radii.max()
    cell = np.floor((positions - positions.min(axis=0)) / reach).astype(np.int64)
    wide = cell.max(axis=0) + 3
    key = ((cell[:, 0] + 1) * wide[1] + cell[:, 1] + 1) * wide[2] + cell[:, 2] + 1
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    found = []
    for dx in (-1, 0, 1):
        for dy in (-1, 0, 1):
            for dz in (-1, 0, 1):
                other = key + (dx * wide[1] + dy) * wide[2] + dz
                begin, end = np.searchsorted(ordered, other, "left"), np.searchsorted(ordered, other, "right")
                many = end - begin
                one = np.repeat(np.arange(count), many)
                within = np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
                two = order[np.repeat(begin, many) + within]
                one, two = one[one < two], two[one < two]
                away = np.linalg.norm(positions[one] - positions[two], axis=1)
                found.append(np.stack([one, two], 1)[(away <= _STRETCH * (radii[one] + radii[two])) & (away > 0.1)])
    pairs = np.concatenate(found)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


@keywords
def from_gemmi(structure, model=0, style="ball-and-stick", color="element", hydrogens=True, waters=True, probe=1.4):
    """A scene of a molecule, in angstroms: shapes "atoms" (spheres) and "bonds" (capsules halved by the atoms' colours), or "surface".

    structure: a gemmi.Structure, or a SmallStructure (its cell's atoms). model: counted from 0. style: "ball-and-stick", "spheres"
    (van der Waals radii), "sticks", "surface" (the solvent-excluded surface of all atoms but water, for a probe of this radius) or
    "accessible" (the same atoms with the probe's radius added). color: "element" (Jmol's colours) or "chain". Of atoms in several places (altlocs) the first
    is shown. Bonds are found by distance: up to 1.3 times the sum of the covalent radii, never between hydrogens.

    scene.info: "positions" (n, 3), "elements", "chains", and "bonds" (m, 2), pairs of rows.
    """
    import gemmi
    styles = {"ball-and-stick": (0.25, 0.15), "spheres": (1.0, 0.0), "sticks": (0.0, 0.2), "surface": None, "accessible": (1.0, 0.0)}
    if style not in styles:
        raise InputError(f"style: one of {', '.join(styles)} is needed, not {style!r}")
    if color not in ("element", "chain"):
        raise InputError(f'color: "element" or "chain" is needed, not {color!r}')
    if not isinstance(structure, (gemmi.Structure, gemmi.SmallStructure)):
        raise InputError(f"structure: gemmi's is needed, not {type(structure).__name__}")
    covered = style in ("surface", "accessible")
    held = list(_atoms(gemmi, structure, model, hydrogens, waters and not covered))
    if not held:
        raise InputError("the structure has no atoms")
    positions = np.array([one[0] for one in held])
    elements = [one[1].name for one in held]
    chains = [one[2] for one in held]
    kinds = sorted({one[1].name: one[1] for one in held}.items())
    index = {name: i for i, (name, _) in enumerate(kinds)}
    of = np.array([index[name] for name in elements])
    covalent = np.array([kind.covalent_r for _, kind in kinds])[of]
    wide = np.array([kind.vdw_r for _, kind in kinds])[of]
    if color == "element":
        colors = np.array([_linear(_JMOL.get(name, _OTHER)) for name, _ in kinds])[of]
    else:
        names = sorted(set(chains))
        colors = np.array([_linear(_CHAINS[names.index(name) % len(_CHAINS)]) for name in chains])
    base = materials.coateddiffuse(alpha=0.1)
    scene = Scene()
    if style == "surface":
        scene.add_molecular_surface(positions, wide, probe, color=colors, material=base, name="surface")
        scene.info.update(positions=positions, elements=elements, chains=chains, bonds=np.empty((0, 2), dtype=np.int64))
        return scene
    ball, stick = styles[style]
    scene.add_spheres(positions, (ball * wide if ball else stick) + (probe if covered else 0), color=colors, material=base, name="atoms")
    pairs = np.empty((0, 2), dtype=np.int64)
    if stick:
        pairs = bonds_of(positions, covalent)
        hydrogen = np.array([kind.is_hydrogen for _, kind in kinds])[of]
        pairs = pairs[~(hydrogen[pairs[:, 0]] & hydrogen[pairs[:, 1]])]
    if len(pairs):
        one, two = positions[pairs[:, 0]], positions[pairs[:, 1]]
        middle = (one + two) / 2
        scene.add_capsules(np.concatenate([one, two]), np.concatenate([middle, middle]), stick,
                           color=np.concatenate([colors[pairs[:, 0]], colors[pairs[:, 1]]]), material=base, name="bonds")
    scene.info.update(positions=positions, elements=elements, chains=chains, bonds=pairs)
    return scene
