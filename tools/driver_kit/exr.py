# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Pictures as `caplet render` writes them (scanlines, ZIP or RLE, 32-bit floats and unsigned integers), and how far two of them differ.

Reads with Python's own library, so that a machine needs nothing more for it.
"""
import array
import math
import struct
import sys
import zlib

ROWS_A_BLOCK = {0: 1, 1: 1, 2: 1, 3: 16}  # none, RLE, ZIPS, ZIP


def _text(data, at):
    end = data.index(0, at)
    return data[at:end].decode(), end + 1


def _attributes(data, at):
    out = {}
    while data[at] != 0:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size = struct.unpack_from("<i", data, at)[0]
        out[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return out, at + 1


def _channels(packed):
    out, at = [], 0
    while packed[at] != 0:
        name, at = _text(packed, at)
        out.append((name, struct.unpack_from("<i", packed, at)[0]))
        at += 16
    return out


def _run_lengths(data):
    out, at = bytearray(), 0
    while at < len(data):
        count = data[at] - 256 if data[at] > 127 else data[at]
        if count < 0:
            out += data[at + 1:at + 1 - count]
            at += 1 - count
        else:
            out += data[at + 1:at + 2] * (count + 1)
            at += 2
    return bytes(out)


def _unpacked(data, compression, size):
    """Undoes the compression of a block, the differences of neighbouring bytes and the separation of even from odd ones."""
    if compression == 0 or len(data) == size:
        return data
    mixed = bytearray(_run_lengths(data) if compression == 1 else zlib.decompress(data))
    before = mixed[0]
    for i in range(1, len(mixed)):
        before = mixed[i] = (before + mixed[i] - 128) & 255
    out, half = bytearray(len(mixed)), (len(mixed) + 1) // 2
    out[0::2], out[1::2] = mixed[:half], mixed[half:]
    return bytes(out)


class Picture:
    """`path` of the file; `channels`: name to array of width * height numbers, row by row. Raises ValueError for files that `caplet render` does not write."""

    def __init__(self, path):
        self.path = path
        with open(path, "rb") as file:
            data = file.read()
        if data[:4] != b"v/1\x01":
            raise ValueError(f"{path}: no EXR file")
        attributes, at = _attributes(data, 8)
        compression = attributes["compression"][0]
        x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
        kinds = _channels(attributes["channels"])
        if compression not in ROWS_A_BLOCK or any(kind not in (0, 2) for _, kind in kinds):
            raise ValueError(f"{path}: a compression or a kind of channels that Caplet does not write")
        self.width, self.height = x1 - x0 + 1, y1 - y0 + 1
        self.channels = {name: array.array("f" if kind == 2 else "I") for name, kind in kinds}
        rows = ROWS_A_BLOCK[compression]
        for offset in struct.unpack_from(f"<{(self.height + rows - 1) // rows}Q", data, at):
            y, size = struct.unpack_from("<ii", data, offset)
            count = min(rows, y1 + 1 - y)
            block = _unpacked(data[offset + 8:offset + 8 + size], compression, count * self.width * 4 * len(kinds))
            place = 0
            for _ in range(count):
                for name, _ in kinds:
                    self.channels[name].frombytes(block[place:place + 4 * self.width])
                    place += 4 * self.width
        if sys.byteorder != "little":
            for values in self.channels.values():
                values.byteswap()


def difference(one, other):
    """None where all channels are equal to the bit; else a dictionary:

    rms: of the differences of R, G, B, in units of the mean of `other`; noise: that in units of the noise that both pictures state
    (variance.R ...; independent pictures have 1); shift: the difference of the means in units of its standard error; pixels: with
    another object.id or primitive.id; of: pixels in all.
    """
    if one.channels.keys() != other.channels.keys() or (one.width, one.height) != (other.width, other.height):
        raise ValueError("pictures of different channels or sizes")
    if all(one.channels[name].tobytes() == other.channels[name].tobytes() for name in one.channels):
        return None
    squares = variance = total = shift = 0.0
    count = 3 * one.width * one.height
    for name in "RGB":
        for a, b, va, vb in zip(one.channels[name], other.channels[name], one.channels["variance." + name],
                                other.channels["variance." + name]):
            squares += (a - b) * (a - b)
            shift += a - b
            variance += va + vb
            total += b
    ids = zip(*(zip(one.channels[name], other.channels[name]) for name in ("object.id", "primitive.id")))
    return {
        "rms": math.sqrt(squares / count) / (total / count) if total else math.sqrt(squares / count),
        "noise": math.sqrt(squares / variance) if variance else (math.inf if squares else 0.0),
        "shift": abs(shift) / math.sqrt(variance) if variance else (math.inf if shift else 0.0),
        "pixels": sum(a[0] != a[1] or b[0] != b[1] for a, b in ids),
        "of": one.width * one.height,
    }


def mattes(picture, kind):
    """Coverage by the hash of a name, a dictionary for each pixel: `kind` is CryptoObject, CryptoMaterial or CryptoAsset."""
    found = [{} for _ in range(picture.width * picture.height)]
    for level in range(100):
        name = f"{kind}{level:02d}"
        if name + ".R" not in picture.channels:
            break
        for hashes, coverage in ("RG", "BA"):
            bits = array.array("I", picture.channels[f"{name}.{hashes}"].tobytes())
            for pixel, (key, share) in enumerate(zip(bits, picture.channels[f"{name}.{coverage}"])):
                if share > 0:
                    found[pixel][key] = found[pixel].get(key, 0.0) + share
    if not any(found):
        raise ValueError(f"{picture.path}: no {kind}")
    return found


def compare_mattes(one, other, kind):
    """names: hashes in the pictures; other: hashes that only one of them has; worst: the greatest difference of a coverage; equal:
    pixels whose coverages all are equal to the bit; of: pixels in all."""
    a, b = mattes(one, kind), mattes(other, kind)
    names = [set().union(*each) for each in (a, b)]
    worst = max(abs(x.get(key, 0.0) - y.get(key, 0.0)) for x, y in zip(a, b) for key in (x.keys() | y.keys() | {0}))
    return {"names": len(names[0] | names[1]), "other": len(names[0] ^ names[1]), "worst": worst,
            "equal": sum(x == y for x, y in zip(a, b)), "of": len(a)}


def within_noise(found):
    """Independent renders of one picture have a noise of 1 (0.9 to 1.1) and a shift below 3: at equal seeds both are less."""
    return found is None or (found["noise"] <= 1.0 and found["shift"] <= 3.0)
