# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""How MuJoCo's geoms look: their materials, textures and skies are the program's own (docs/formats/robots.md).

Textures are mapped by the shapes' own uv where that is possible, so that they move with the shapes.
"""
import numpy as np

from .. import materials, textures

_DEFAULT_RGBA = (0.5, 0.5, 0.5, 1.0)  # of a geom that names none
_MOST_TEXELS = 512  # to a side of an image that is made of a cube texture
_BRIGHTEST_SKY = 0.35  # the mean of its radiance


def linear(screen):
    """The linear values of a screen's, which are clamped to 0..1."""
    screen = np.clip(np.asarray(screen, dtype=np.float64), 0, 1)
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055)**2.4)


def rgba_of(model, geom):
    """MuJoCo's own rule: the geom's colour, or that of its material where it names none."""
    own, material = model.geom_rgba[geom], model.geom_matid[geom]
    return model.mat_rgba[material] if material >= 0 and tuple(np.float32(own)) == tuple(np.float32(_DEFAULT_RGBA)) else own


def _power_of_two(count):
    return int(min(_MOST_TEXELS, 2**np.ceil(np.log2(max(2, count)))))


def _pixels(model, texture):
    """(height, width, 3) bytes, from the top row down; of a cube its six faces, one below the other."""
    channels = int(model.tex_nchannel[texture]) if hasattr(model, "tex_nchannel") else 3
    data = model.tex_data if hasattr(model, "tex_data") else model.tex_rgb
    height, width, first = int(model.tex_height[texture]), int(model.tex_width[texture]), int(model.tex_adr[texture])
    image = np.asarray(data[first:first + height * width * channels]).reshape(height, width, channels)
    return image[:, :, :3] if channels >= 3 else np.repeat(image[:, :, :1], 3, axis=2)


def _faces(image):
    """(6, n, n, 3): right, left, up, down, front and back of a cube texture; an image of one face is all six."""
    size = image.shape[1]
    return image.reshape(6, size, size, 3) if image.shape[0] == 6 * size else np.repeat(image[np.newaxis], 6, axis=0)


def _seen(faces, directions):
    """The texels (..., 3) of a cube texture in these directions, by OpenGL's convention: x is right, y up, z front."""
    x, y, z = np.moveaxis(directions, -1, 0)
    ways = np.abs(directions)
    along_x = (ways[..., 0] >= ways[..., 1]) & (ways[..., 0] >= ways[..., 2])
    along_y = ~along_x & (ways[..., 1] >= ways[..., 2])
    face = np.select([along_x, along_y], [np.where(x > 0, 0, 1), np.where(y > 0, 2, 3)], np.where(z > 0, 4, 5))
    right = np.select([along_x, along_y], [np.where(x > 0, -z, z), x], np.where(z > 0, x, -x))
    down = np.select([along_x, along_y], [-y, np.where(y > 0, z, -z)], -y)
    rows, columns = faces.shape[1:3]
    most = np.maximum(ways.max(axis=-1), 1e-300)

    def texel(share, size):
        return np.clip((0.5 * (share / most + 1) * size).astype(np.int64), 0, size - 1)
    return faces[face, texel(down, rows), texel(right, columns)]


def _shares(rows, columns):
    """v and u in the middles of an image's texels, in columns and rows that broadcast; the top row has the greatest v."""
    return (1 - (np.arange(rows)[:, np.newaxis] + 0.5) / rows, (np.arange(columns)[np.newaxis] + 0.5) / columns)


def _turned(radius, z, u):
    """Points (rows, columns, 3) at radii and heights (rows, 1), at the angles of u around z."""
    return np.stack(np.broadcast_arrays(radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u), z), axis=-1)


def _sphere(size, texels):
    v, u = _shares(_power_of_two(2 * texels), _power_of_two(4 * texels))
    return [_turned(np.sin(np.pi * v), -np.cos(np.pi * v), u) * size]


def _capsule(size, texels):
    """v runs over the whole profile by length."""
    radius, half = size[0], size[2]
    cap = 0.5 * np.pi * radius
    v, u = _shares(_power_of_two(2 * texels * (cap + half) / cap), _power_of_two(4 * texels))
    at = v * 2 * (cap + half) - (cap + half)  # along the profile, from the middle
    turn = np.maximum(np.abs(at) - half, 0) / radius
    return [_turned(radius * np.cos(turn), np.sign(at) * (np.minimum(np.abs(at), half) + radius * np.sin(turn)), u)]


def _cylinder(size, texels):
    """Its side, the end below and the end above."""
    radius, half = size[0], size[2]
    v, u = _shares(_power_of_two(texels * max(1, half / radius)), _power_of_two(4 * texels))
    side = _turned(radius + 0 * v, half * (2 * v - 1), u)
    v, u = _shares(_power_of_two(texels * max(1, radius / half)), _power_of_two(4 * texels))
    return [side, _turned(radius * v, -half + 0 * v, u), _turned(radius * (1 - v), half + 0 * v, u)]


def _box(size, texels):
    """Its faces of least and greatest x, y and z: v runs up z (or y), u to the right as seen from outside."""
    v, u = (2 * share - 1 for share in _shares(*[_power_of_two(texels)] * 2))
    ways = [(-1, -u, v), (1, u, v), (u, -1, v), (-u, 1, v), (-u, v, -1), (u, v, 1)]
    return [np.stack(np.broadcast_arrays(*way), axis=-1) * size for way in ways]


class Looks:
    """Materials, emission and alpha of a model's geoms; what looks the same is one material.

    mujoco, model: the package and its MjModel.
    """

    def __init__(self, mujoco, model):
        self.mujoco, self.model, self._made, self._images = mujoco, model, {}, {}
        self._mirror = materials.conductor(reflectance=1.0, name="mirror")

    def _is(self, geom, *names):
        return int(self.model.geom_type[geom]) in [int(getattr(self.mujoco.mjtGeom, "mjGEOM_" + name)) for name in names]

    def texture(self, material):
        """The number of a material's colour texture, or -1."""
        if material < 0:
            return -1
        ids = np.atleast_1d(self.model.mat_texid[material])
        if len(ids) == 1:  # before MuJoCo 3.2
            return int(ids[0])
        roles = self.mujoco.mjtTextureRole
        found = [int(ids[int(role)]) for role in (roles.mjTEXROLE_RGB, roles.mjTEXROLE_RGBA)]
        return max(found)

    def _is_cube(self, texture):
        return int(self.model.tex_type[texture]) != int(self.mujoco.mjtTexture.mjTEXTURE_2D)

    def _image(self, texture, rgba):
        """The texture's bytes times the colour, as a screen has both."""
        key = texture, tuple(rgba[:3])
        if key not in self._images:
            self._images[key] = (_pixels(self.model, texture) * np.clip(rgba[:3], 0, 1)).astype(np.uint8)
        return self._images[key]

    def _size(self, geom):
        """What a texture spans along x, y and z, in half lengths; 1 where there is no end."""
        size = np.array(self.model.geom_size[geom], dtype=np.float64)
        if self._is(geom, "CAPSULE", "CYLINDER"):
            size = size[[0, 0, 1]]
        elif self._is(geom, "SPHERE"):
            size = size[[0, 0, 0]]
        elif self._is(geom, "PLANE"):
            size[2] = 0
        elif not self._is(geom, "BOX", "ELLIPSOID"):
            size[:] = 1
        return size > 0, np.where(size > 0, size, 1)

    def _repeat(self, geom):
        """How often a flat texture is repeated over a geom's width and height, or over two units where there is no end."""
        material, (ends, size) = self.model.geom_matid[geom], self._size(geom)
        repeat = np.array(self.model.mat_texrepeat[material], dtype=np.float64)
        return np.where(ends[:2] & bool(self.model.mat_texuniform[material]), repeat * size[:2], repeat)

    def _file_from_geom(self, geom):
        """MuJoCo turns meshes to the axes of their inertia; the file's own space is where textures are."""
        out, mesh = np.eye(4), self.model.geom_dataid[geom]
        if self._is(geom, "MESH", "SDF") and mesh >= 0:
            turn = np.empty(9)
            self.mujoco.mju_quat2Mat(turn, np.asarray(self.model.mesh_quat[mesh], dtype=np.float64))
            out[:3, :3], out[:3, 3] = turn.reshape(3, 3), self.model.mesh_pos[mesh]
        return out

    def uv(self, geom, points, texcoords=None):
        """(n, 2) of the points (n, 3) of a plane, mesh or height field, in its space; None where it needs none.

        texcoords: a mesh's own coordinates (n, 2), as MuJoCo has them; they replace the points'.
        """
        texture = self.texture(self.model.geom_matid[geom])
        if texture < 0 or self._is_cube(texture):
            return None
        repeat, (ends, size) = self._repeat(geom), self._size(geom)
        if texcoords is not None:
            return (np.asarray(texcoords) * [1, -1] + [0, 1]) * self.model.mat_texrepeat[self.model.geom_matid[geom]]
        start = np.where(ends[:2], [0.5 * repeat[0], 1 - 0.5 * repeat[1]], 0.5)
        file_from_geom = self._file_from_geom(geom)
        points = np.asarray(points) @ file_from_geom[:3, :3].T + file_from_geom[:3, 3]
        return 0.5 * repeat * points[:, :2] / size[:2] + start

    def _flat(self, geom, image):
        """Textures of the geom's surfaces, or one for all."""
        def mapped(pixels=image, **mapping):
            return textures.imagemap(pixels=pixels, filter="trilinear", **mapping)
        if self._is(geom, "PLANE", "MESH", "SDF", "HFIELD"):
            return [mapped()]
        x, y = self._repeat(geom)
        if self._is(geom, "BOX"):  # it is projected along z
            across = np.ascontiguousarray(image[::-1, ::-1].swapaxes(0, 1))
            right, left = {"uscale": x}, {"uscale": -x, "udelta": x}
            top, bottom, whole = {"vscale": 0, "vdelta": 1}, {"vscale": 0, "vdelta": 1 - y}, {"vscale": y, "vdelta": 1 - y}
            return [mapped(across, uscale=-y, udelta=1, vscale=0, vdelta=0),
                    mapped(across, uscale=y, udelta=1 - y, vscale=0, vdelta=x),
                    mapped(**right, **bottom), mapped(**left, **top), mapped(**left, **whole), mapped(**right, **whole)]
        if self._is(geom, "CAPSULE"):  # v covers the whole profile, the texture the side
            _, size = self._size(geom)
            share = 0.25 * np.pi * size[0] / size[2]
            return [mapped(uscale=x, vscale=y * (1 + 2 * share), vdelta=1 - y * (1 + share))]
        return [mapped(uscale=x, vscale=y, vdelta=1 - y)]

    def _cube(self, geom, image, place):
        """Textures of the geom's surfaces; their texels are no wider than the cube's, up to _MOST_TEXELS to a side."""
        faces, (_, size) = _faces(image), self._size(geom)
        is_uniform = bool(self.model.mat_texuniform[self.model.geom_matid[geom]])
        texels, over = faces.shape[1], 1 if is_uniform else size
        stretched = texels * size.max() / size.min() if is_uniform else texels
        solids = {"SPHERE": (_sphere, texels), "ELLIPSOID": (_sphere, stretched), "CAPSULE": (_capsule, texels),
                  "CYLINDER": (_cylinder, texels), "BOX": (_box, stretched)}
        for name, (points, detail) in solids.items():
            if self._is(geom, name):
                wrap = "clamp" if name == "BOX" else "repeat"
                return [textures.imagemap(pixels=_seen(faces, at / over), filter="trilinear", wrap=wrap)
                        for at in points(size, detail)]
        v, u = _shares(_power_of_two(4 * texels), _power_of_two(2 * texels))  # by angles from z and around it
        around = _turned(np.sin(np.pi * u), np.cos(np.pi * u), v)
        place = place @ np.linalg.inv(self._file_from_geom(geom)) @ np.diag([*np.broadcast_to(over, 3), 1])
        return [textures.imagemap(pixels=_seen(faces, around), filter="trilinear", mapping="spherical", transform=place)]

    def _surface(self, material, rgba, texture=None):
        """MuJoCo's specular and shininess are an interface whose reflectance at right angles is 0.08 specular, and whose GGX
        roughness is that of Phong's exponent 128 shininess; its reflectance is the share of a mirror.

        texture: of the colour, which it replaces.
        """
        color = tuple(linear(rgba[:3])) if texture is None else texture
        if material < 0:
            return materials.diffuse(reflectance=color)
        model = self.model
        name = self.mujoco.mj_id2name(model, self.mujoco.mjtObj.mjOBJ_MATERIAL, material) or f"material {material}"
        specular, shininess, mirror = (float(np.clip(field[material], 0, 1)) for field in
                                       (model.mat_specular, model.mat_shininess, model.mat_reflectance))
        metallic, roughness = float(model.mat_metallic[material]), float(model.mat_roughness[material])
        if not hasattr(model, "light_type") and roughness == 1:  # older ones have 1 where a file says nothing
            metallic, roughness = -1 if metallic == 1 else metallic, -1
        if specular > 0 or metallic >= 0:
            root = np.sqrt(0.08 * specular)
            out = materials.principled(
                base_color=color, eta=(1 + root) / (1 - root), metallic=min(max(metallic, 0), 1), name=name,
                roughness=min(roughness, 1) if roughness >= 0 else (2 / (128 * shininess + 2))**0.25)
        else:
            out = materials.diffuse(reflectance=color, name=name)
        if mirror > 0:
            out = materials.mix(materials=(out, self._mirror), amount=mirror, name=name + " reflecting")
        return out

    def options(self, geom, place):
        """What Scene.add takes of a geom at `place` (4 x 4) besides its shape: material; alpha and emission where it has them.

        A cube texture of a plane, mesh or height field is placed in the world, and stays there.
        """
        model, rgba = self.model, np.asarray(rgba_of(self.model, geom), dtype=np.float64)
        material = int(model.geom_matid[geom])
        texture, out = self.texture(material), {}
        if rgba[3] < 1:
            out["alpha"] = float(rgba[3])
        if material >= 0 and model.mat_emission[material] > 0 and rgba[:3].any():
            out["emission"] = {"L": tuple(linear(rgba[:3])), "scale": float(model.mat_emission[material])}
        key = material, tuple(rgba[:3])
        if texture >= 0 and self._is(geom, "SPHERE", "ELLIPSOID", "CAPSULE", "CYLINDER", "BOX"):
            size = self._size(geom)[1]
            shape = tuple(np.round(size / size.max(), 6))
            key += int(model.geom_type[geom]), shape, () if self._is_cube(texture) else tuple(self._repeat(geom))
        elif texture >= 0 and self._is_cube(texture):
            key += geom,
        if key not in self._made:
            if texture < 0:
                surfaces = [None]
            elif self._is_cube(texture):
                surfaces = self._cube(geom, self._image(texture, rgba), place)
            else:
                surfaces = self._flat(geom, self._image(texture, rgba))
            self._made[key] = [self._surface(material, rgba, one) for one in surfaces]
        made = self._made[key]
        return {**out, "material": made[0] if len(made) == 1 else made}

    def sky(self):
        """(image, scale) of the model's first sky; None where it has none.

        image: bytes (n, 2 n, 3) by latitude and longitude, z up. scale: makes the mean of its radiance 0.35 at most.
        """
        skies = np.flatnonzero(self.model.tex_type == int(self.mujoco.mjtTexture.mjTEXTURE_SKYBOX))
        if not len(skies):
            return None
        faces = _faces(_pixels(self.model, skies[0]))
        height = int(np.clip(2 * faces.shape[1], 2, 1024))
        v, u = _shares(height, 2 * height)
        x, y, z = np.moveaxis(_turned(np.sin(np.pi * v), -np.cos(np.pi * v), u), -1, 0)
        image = _seen(faces, np.stack([x, z, -y], axis=-1))
        mean = np.average(linear(image / 255).mean(axis=(1, 2)), weights=np.sin(np.pi * v[:, 0]))
        return image, min(1, _BRIGHTEST_SKY / max(mean, 1e-6))
