#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""How long `caplet view` takes to answer: a client without a browser, which measures what a page waits for.

usage: view_latency.py PROGRAM [--capsules N] [--runs N] [--size WxH] [--seconds S] [-- OPTIONS OF view]

Starts the program on N capsules of a random walk (made here), and prints medians: from its start to the address, to the first
picture (and the processor time of that, which other work on the machine does not prolong) and to the first picture of all pixels; from the move of one capsule, of its object and of the camera to the first new
picture; answers for what is under the cursor, while pictures come; bytes a second while the picture converges and while the camera
turns. The first start, which may have kernels to compile, is not counted.
"""
import argparse
import base64
import json
import math
import os
import pathlib
import random
import signal
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import time
import urllib.parse


class Client:
    """A WebSocket (RFC 6455) of JSON texts and pictures (docs/viewer.md)."""

    def __init__(self, address):
        parts = urllib.parse.urlsplit(address)
        self.socket = socket.create_connection((parts.hostname, parts.port))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET {parts.path}socket HTTP/1.1\r\nHost: {parts.netloc}\r\nOrigin: http://{parts.netloc}\r\nConnection: Upgrade\r\n"
                             f"Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n").encode())
        self.buffer, self.bytes, self.ready = b"", 0, []
        while b"\r\n\r\n" not in self.buffer:
            self.buffer += self.socket.recv(65536)
        head, self.buffer = self.buffer.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n")[0]:
            raise RuntimeError(head.decode())

    def frame(self, opcode, data):
        length = struct.pack("!B", 128 | len(data)) if len(data) < 126 else struct.pack("!BH", 254, len(data))
        self.socket.sendall(bytes([128 | opcode]) + length + bytes(4) + data)

    def say(self, **message):
        self.frame(1, json.dumps(message).encode())

    def take(self, count):
        while len(self.buffer) < count:
            more = self.socket.recv(1 << 20)
            if not more:
                raise ConnectionError("the program has closed")
            self.buffer += more
        out, self.buffer = self.buffer[:count], self.buffer[count:]
        self.bytes += count
        return out

    def next(self):
        """A text as an object, or (view, width, scale, samples) of a picture."""
        while True:
            first, length = self.take(2)
            if length == 126:
                (length,) = struct.unpack("!H", self.take(2))
            elif length == 127:
                (length,) = struct.unpack("!Q", self.take(8))
            data = self.take(length)
            if first & 15 == 9:
                self.frame(10, data)
            elif first & 15 == 1:
                return json.loads(data)
            elif first & 15 == 2 and data[:4] == b"CPLF":
                view, width, _, scale, samples = struct.unpack("<5I", data[4:24])
                return view, width, scale, samples
            elif first & 15 == 8:
                raise ConnectionError("the program has closed")

    def until(self, holds):
        while True:
            got = self.next()
            if holds(got):
                return got


def is_picture(got, after=0, scale=1 << 30):
    return isinstance(got, tuple) and got[0] > after and got[2] <= scale


def walk(path, count):
    """Capsules of a random walk within a ball: ends as FORMATS of the shared data has them."""
    draw, at = random.Random(15), [0.0, 0.0, 0.0]
    step, radius = 1.5 * count ** (-1 / 3), 0.12 * count ** (-1 / 3)
    with open(path, "w", encoding="ascii") as out:
        for _ in range(count):
            to = [a + draw.gauss(0, step / 2) for a in at]
            if math.hypot(*to) > 1:
                to = [0.9 * a for a in at]
            out.write("<%.6g, %.6g, %.6g> <%.6g, %.6g, %.6g> %.6g\n" % (*at, *to, radius))
            at = to


SCENE = """LookAt 0 -3 1  0 0 0  0 0 1
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 1000 "integer yresolution" 640
Sampler "zsobol" "integer pixelsamples" 64
Integrator "path" "integer maxdepth" 5
WorldBegin
LightSource "infinite" "rgb L" [ 0.6 0.7 0.8 ]
LightSource "distant" "point3 from" [ 1 -1 2 ] "rgb L" [ 2 1.8 1.6 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.5 ]
Shape "capsules" "string filename" "walk.capsules"
"""


class Served:
    def __init__(self, program, scene, options):
        self.begin = time.monotonic()
        self.process = subprocess.Popen([program, "view", scene, "--no-browser", "-q", *options], stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        if not self.address:
            raise RuntimeError("the program has ended")

    def processor_seconds(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(") ", 1)[1].split()
        return sum(int(v) for v in fields[11:13]) / os.sysconf("SC_CLK_TCK")

    def end(self):
        self.process.send_signal(signal.SIGINT)
        if self.process.wait(60) != 0:
            raise RuntimeError("the program has failed")


def look(client, camera, size, by=0.0):
    matrix = list(camera["world_from_camera"])
    matrix[3] += by
    client.say(type="look", width=size[0], height=size[1], world_from_camera=matrix, fov=camera["fov"],
               lens_radius=camera["lens_radius"], focal_distance=camera["focal_distance"])


def start(program, scene, options, size):
    served = Served(program, scene, options)
    times = {"start to address": time.monotonic() - served.begin}
    client = Client(served.address)
    hello = client.until(lambda got: isinstance(got, dict) and got["type"] == "scene")
    look(client, hello["camera"], size)
    first = client.until(is_picture)
    times["start to first picture"] = time.monotonic() - served.begin
    times["processor time of it"] = served.processor_seconds()
    if first[2] > 1:
        client.until(lambda got: is_picture(got, scale=1))
    times["start to all pixels"] = time.monotonic() - served.begin
    return served, client, hello, times


def measure(program, scene, options, size, seconds, has_capsules):
    """One start, and all that is measured of it, in seconds (lists), bytes a second, and pixels across one of the first picture."""
    served, client, hello, times = start(program, scene, options, size)
    out = {name: [value] for name, value in times.items()}
    view = client.until(lambda got: is_picture(got, scale=1))[0]

    def until_new(name, say):
        nonlocal view
        begin = time.monotonic()
        say()
        got = client.until(lambda got: is_picture(got, after=view))
        out.setdefault(name, []).append(time.monotonic() - begin)
        out.setdefault("scale of that picture", []).append(got[2])
        view = got[0]
        client.until(lambda got: is_picture(got, after=view - 1, scale=1))

    shift = [1, 0, 0, 0.001, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    draw = random.Random(7)
    for _ in range(7 if has_capsules else 0):
        at = [draw.uniform(-0.5, 0.5) for _ in range(3)]
        until_new("a capsule moved", lambda: client.say(type="edit", what="reshape", goes_on=False, id=0, capsule=draw.randrange(1000),
                                                        p0=at, p1=[a + 0.01 for a in at], radius0=0.01, radius1=0.01))
    for _ in range(2 if has_capsules else 0):
        until_new("all capsules moved", lambda: client.say(type="edit", what="move", goes_on=False, ids=[0], matrix=shift))
    for i in range(7):
        until_new("the camera moved", lambda: look(client, hello["camera"], size, 0.01 * (i + 1)))
    for i in range(200):
        begin = time.monotonic()
        client.say(type="ask", number=i, x=draw.randrange(size[0]), y=draw.randrange(size[1]), all=False, reference=False)
        client.until(lambda got: isinstance(got, dict) and got.get("number") == i)
        out.setdefault("hover", []).append(time.monotonic() - begin)
    for name, turns in (("bytes a second, converging", False), ("bytes a second, turning", True)):
        look(client, hello["camera"], size, -0.01)
        before, begin = client.bytes, time.monotonic()
        while time.monotonic() < begin + seconds:
            if turns:
                look(client, hello["camera"], size, 0.01 * (time.monotonic() - begin))
                client.until(is_picture)
            else:
                client.next()
        out[name] = [(client.bytes - before) / (time.monotonic() - begin)]
    served.end()
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("program")
    parser.add_argument("--capsules", type=int, default=100000)
    parser.add_argument("--scene", help="a file in place of the capsules: then only the camera moves")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--size", default="1000x640")
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("options", nargs="*")
    chosen = parser.parse_args()
    size = [int(v) for v in chosen.size.split("x")]
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(chosen.scene or pathlib.Path(folder) / "scene.pbrt")
        if not chosen.scene:
            scene.write_text(SCENE, encoding="ascii")
            walk(scene.with_name("walk.capsules"), chosen.capsules)
        start(chosen.program, scene, chosen.options, size)[0].end()
        runs = [measure(chosen.program, scene, chosen.options, size, chosen.seconds, not chosen.scene) for _ in range(chosen.runs)]
    print(f"{chosen.scene or f'{chosen.capsules} capsules'}, {chosen.size}, medians of {chosen.runs} runs; load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    for name in runs[0]:
        values = sorted(value for run in runs for value in run[name])
        if name.startswith("bytes"):
            print(f"{name:28} {statistics.median(values) / 1e6:8.2f} MB")
        elif name.startswith("scale"):
            print(f"{name:28} {statistics.median(values):8.0f}     greatest {values[-1]}")
        else:
            last = values[min(len(values) - 1, math.ceil(0.99 * len(values)) - 1)]
            print(f"{name:28} {statistics.median(values):8.3f} s   {'99 % below' if len(values) >= 100 else 'longest'} {last:.3f} s")


if __name__ == "__main__":
    sys.exit(main())
