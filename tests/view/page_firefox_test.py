#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The page of `caplet view` in headless Firefox, which Debian brings without a WebDriver program: spoken to by WebDriver BiDi itself.

usage: page_firefox_test.py PROGRAM SCENES FOLDER [NAME...]   pictures of the page go to FOLDER. Exit status 77: no Firefox here.
"""
import base64
import contextlib
import itertools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import time

from page_test import PATIENCE, PIXELS, RATIO, SKIPPED, decoded, editable, main, mean_difference, viewer

try:
    import websocket
except ImportError:
    print("SKIPPED: no WebSocket for Python (python3-websocket)")
    sys.exit(SKIPPED)

ENTER, CONTROL, LEFT = "\ue007", "\ue009", "\ue012"  # https://www.w3.org/TR/webdriver/#keyboard-actions


class Page:
    """A tab of a Firefox of its own."""

    def __init__(self, address, folder):
        (pathlib.Path(folder) / "user.js").write_text(f'user_pref("layout.css.devPixelsPerPx", "{RATIO}");')
        self.process = subprocess.Popen(["firefox-esr", "--headless", "--no-remote", "--profile", folder, "--width", "1104", "--height", "640", "--remote-debugging-port", "0"],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        for line in self.process.stderr:
            where = re.search(r"WebDriver BiDi listening on (ws://\S+)", line)
            if where:
                break
        else:
            raise AssertionError("Firefox does not say where it listens")
        self.socket = websocket.create_connection(where.group(1) + "/session", timeout=PATIENCE, suppress_origin=True)
        self.numbers = itertools.count(1)
        self.errors = []
        self.ask("session.new", capabilities={})
        self.ask("session.subscribe", events=["log.entryAdded"])
        self.context = self.ask("browsingContext.getTree")["contexts"][0]["context"]
        self.ask("browsingContext.navigate", context=self.context, url=address, wait="complete")

    def ask(self, method, **parameters):
        number = next(self.numbers)
        self.socket.send(json.dumps({"id": number, "method": method, "params": parameters}))
        while True:
            message = json.loads(self.socket.recv())
            if message["type"] == "event" and message["params"].get("level") == "error":
                self.errors.append(message["params"]["text"])
            if message.get("id") == number:
                assert message["type"] == "success", (method, message)
                return message["result"]

    def script(self, text, *given):
        """The value of a function's body, through JSON."""
        wanted = f"JSON.stringify(((...given) => {{ {text} }})(...{json.dumps(given)})) ?? 'null'"
        told = self.ask("script.evaluate", expression=wanted, target={"context": self.context}, awaitPromise=False)
        assert told["type"] == "success", told
        return json.loads(told["result"]["value"])

    def until(self, what, holds, patience=PATIENCE):
        end = time.monotonic() + patience
        while time.monotonic() < end:
            value = holds()
            if value:
                return value
            time.sleep(0.02)
        raise AssertionError(f"not within {patience} s: {what}; the page says: {self.text('state')}")

    def text(self, name):
        return self.script("return document.getElementById(given[0]).innerText", name)

    def data(self, name):
        """One of the numbers that the page keeps for its readers; none is -1."""
        return int(self.script("return document.getElementById('stage').dataset[given[0]] || -1", name))

    def until_samples(self, count):
        self.until(f"{count} samples", lambda: self.data("samples") >= count)

    def pixels(self):
        """(width, height, RGBA) of what is shown."""
        return decoded(*self.script(f"return {PIXELS}"))

    def apart(self, other, count):
        """The mean difference to another picture as soon as there are so many samples of every pixel; before that, -1."""
        now = self.script(f"return +document.getElementById('stage').dataset.samples >= given[0] ? {PIXELS} : null", count)
        return mean_difference(other, decoded(*now)) if now else -1

    def middle(self, which):
        return self.script("const e = document.querySelector(given[0]); e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect(); return [b.x + b.width / 2, b.y + b.height / 2]", which)

    def mouse(self, *steps):
        """Steps: (x, y) of the page from the stage's top left, "down" or "up"."""
        left, top = self.script("const b = document.getElementById('stage').getBoundingClientRect(); return [b.x, b.y]")
        actions = [{"type": f"pointer{one.capitalize()}", "button": 0} if isinstance(one, str) else
                   {"type": "pointerMove", "x": round(left + one[0]), "y": round(top + one[1]), "duration": 20} for one in steps]
        self.ask("input.performActions", context=self.context, actions=[{"type": "pointer", "id": "mouse", "actions": actions}])

    def click(self, which):
        x, y = self.middle(which)
        left, top = self.script("const b = document.getElementById('stage').getBoundingClientRect(); return [b.x, b.y]")
        self.mouse((x - left, y - top), "down", "up")

    def keys(self, *pressed, held=()):
        actions = [{"type": "keyDown", "value": key} for key in held]
        actions += [{"type": f"key{way}", "value": key} for key in pressed for way in ("Down", "Up")]
        actions += [{"type": "keyUp", "value": key} for key in held]
        self.ask("input.performActions", context=self.context, actions=[{"type": "key", "id": "keyboard", "actions": actions}])

    def typed(self, name, words):
        edits = self.data("edits")
        self.click(f"#{name}")
        self.keys("a", held=[CONTROL])
        self.keys(*words, ENTER)  # a headless window has no focus that TAB could take
        self.until(f"{words} in {name}: the program's word", lambda: self.data("edits") > edits)

    def picture(self, path):
        path.write_bytes(base64.b64decode(self.ask("browsingContext.captureScreenshot", context=self.context)["data"]))

    def end(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait(PATIENCE)


@contextlib.contextmanager
def page(address):
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        out = Page(address, folder)
        try:
            yield out
            assert not out.errors, out.errors
        finally:
            out.end()


# --- Cases: of the program, the folder of scenes and that of pictures ---

def converges(program, scenes, out):
    """The first picture is coarse; then there are samples of every pixel, and another exposure asks for none."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "4") as served, page(served.address) as shown:
        shown.until_samples(4)
        width, height, pixels = shown.pixels()
        stage = shown.script("const b = document.getElementById('stage').getBoundingClientRect(); return [Math.round(b.width), Math.round(b.height)]")
        assert [width, height] == [round(RATIO * side) for side in stage] and 60 < sum(pixels) / len(pixels) < 220
        shown.script("const e = document.getElementById('exposure'); e.value = 2; e.dispatchEvent(new Event('input'))")
        assert sum(shown.pixels()[2]) > 1.2 * sum(pixels) and shown.data("samples") == 4
        shown.picture(out / "firefox.png")


def camera(program, scenes, out):
    """Orbit by mouse and by key; all taken back, the first picture is there to the bit."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "2") as served, page(served.address) as shown:
        shown.until_samples(2)
        first = shown.pixels()
        shown.mouse((300, 200), "down", (340, 205), (380, 210), "up")
        shown.until("another picture", lambda: shown.apart(first, 2) > 5)
        turned = shown.pixels()
        shown.script("document.getElementById('stage').focus()")
        shown.keys("+", "+", LEFT)
        shown.until("a third", lambda: shown.apart(turned, 2) > 3)
        while not shown.script("return document.getElementById('undo').disabled"):
            shown.click("#undo")
        shown.until("the first again", lambda: shown.apart(first, 2) == 0)


def inspects(program, scenes, out):
    """What is under the cursor has its name, and a click tells every crossing as `caplet pick` does."""
    scene = scenes / "gallery.pbrt"
    with viewer(program, scene, "--spp", "1") as served, page(served.address) as shown:
        shown.until_samples(1)
        width, height, _ = shown.pixels()
        solids = 0
        shown.script("document.getElementById('tool-inspect').click()")
        for k in range(8):
            x, y = int((0.1 + 0.1 * k) * width), int((0.4 + 0.05 * (k % 5)) * height)
            before = shown.script("return document.getElementById('table').dataset.pixel ?? ''")
            shown.mouse(((x + 0.5) / RATIO, (y + 0.5) / RATIO))
            shown.mouse("down", "up")
            pixel = shown.until("the crossings", lambda: shown.script("const p = document.getElementById('table').dataset.pixel; return p !== given[0] && p", before))
            said = subprocess.run([program, "pick", scene, "--pixel", pixel, "--size", f"{width}x{height}", "--all", "--json"], check=True, capture_output=True, text=True)
            crossings = json.loads(said.stdout)["crossings"]
            wanted = str(crossings[0]["object"]) if crossings else "nothing"
            shown.until(f"the name at {pixel}: {wanted}", lambda: shown.text("under").split(" · ")[0] == wanted)
            rows = shown.script("return [...document.querySelectorAll('#table tbody tr')].map((r) => [...r.cells].map((c) => c.textContent))")
            assert [(row[1], row[2]) for row in rows] == [("enters" if c["entering"] else "leaves", str(c["object"])) for c in crossings], (rows, crossings)
            assert all(abs(float(row[0]) - c["t"]) <= 1e-6 * c["t"] for row, c in zip(rows, crossings)), (rows, crossings)
            solids += wanted not in ("nothing", "floor")
            if k == 4:
                shown.picture(out / "firefox-inspected.png")
            shown.script("document.getElementById('close-ray').click()")  # it is where the next pixel may be
        assert solids >= 2, "too few of these pixels show more than the floor"


def edits(program, scenes, out):
    """Select, move, paint, duplicate, delete, take back: the first picture is there to the bit."""
    scene = editable(scenes / "gallery.pbrt", out)
    with viewer(program, scene, "--spp", "2") as served, page(served.address) as shown:
        shown.until_samples(2)
        first = shown.pixels()
        chosen = "const i = [...document.querySelectorAll('#tree li')].find((e) => e.innerText.trim().startsWith(given[0])); i?.scrollIntoView({block: 'center'}); i?.click(); return Boolean(i)"
        shown.until("capsule 5", lambda: shown.script(chosen, "capsule 5"))
        shown.until("what it is", lambda: shown.script("return document.getElementById('move').offsetParent && document.querySelectorAll('#surface option').length > 1"))
        shown.typed("move", "0 -1 0.5")
        shown.until("moved", lambda: shown.apart(first, 2) > 0)
        moved = shown.pixels()
        edits = shown.data("edits")
        shown.script("const s = document.getElementById('material'); s.selectedIndex = 3; s.dispatchEvent(new Event('change'))")
        shown.until("painted", lambda: shown.data("edits") > edits and shown.apart(moved, 2) > 0)
        things = int(shown.text("more").split(" of ")[1])
        shown.click("#duplicate")
        shown.until("one more", lambda: shown.text("more").endswith(f" of {things + 1}"))
        shown.click("#back")
        shown.until("one less", lambda: shown.text("more").endswith(f" of {things}"))
        shown.picture(out / "firefox-edited.png")
        while not shown.script("return document.getElementById('back').disabled"):
            edits = shown.data("edits")
            shown.click("#back")
            shown.until("the program's word", lambda: shown.data("edits") > edits)
        shown.until("the first picture again", lambda: shown.apart(first, 2) == 0)


CASES = [converges, camera, inspects, edits]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], __doc__, CASES, browser="firefox-esr", package="firefox-esr"))
