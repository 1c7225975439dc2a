#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""The page of `caplet view` in a real browser: headless Chromium, as a user would use it.

usage: page_test.py PROGRAM SCENES FOLDER [NAME...]   pictures of the page go to FOLDER. Exit status 77: no browser here.
"""
import atexit
import base64
import contextlib
import csv
import http.client
import json
import math
import os
import pathlib
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import traceback
import urllib.parse

import numpy as np

try:
    from selenium import webdriver
    from selenium.common.exceptions import StaleElementReferenceException
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
    from selenium.webdriver.common.action_chains import ActionChains
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
except ImportError:
    print("SKIPPED: no Selenium for Python (python3-selenium)")
    sys.exit(77)

# The picture as [width, height, RGBA in base64]: a list of its bytes would take seconds on its way.
PIXELS = """(() => { const c = document.getElementById('picture'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data, parts = [];
    for (let i = 0; i < d.length; i += 32768) parts.push(String.fromCharCode.apply(null, d.subarray(i, i + 32768)));
    return [c.width, c.height, btoa(parts.join(''))]; })()"""


def decoded(width, height, data):
    """A picture of PIXELS with its bytes, four a pixel."""
    return width, height, base64.b64decode(data)


SKIPPED = 77
PATIENCE = 60  # seconds, for what takes one


class Viewer:
    """The program, and where it serves."""

    def __init__(self, program, scene, *options):
        self.process = subprocess.Popen([program, "view", scene, "--no-browser", "-q", *options], stdout=subprocess.PIPE, text=True)
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://127.0.0.1:"), self.address

    def port(self):
        return int(re.match(r"http://127.0.0.1:(\d+)/", self.address).group(1))

    def end(self):
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(PATIENCE)


@contextlib.contextmanager
def viewer(program, scene, *options):
    out = Viewer(program, scene, *options)
    try:
        yield out
    finally:
        if out.process.poll() is None:
            out.process.kill()
            out.process.wait()


SIZE = (1104, 600)  # just wide enough for the panel beside the picture
RATIO = 0.5  # pixels of a picture to one of the page: most of a test's time would go into pictures of the full size
idle = []  # browsers that no page has: to start one takes as long as many a test


def browser():
    if idle:
        return idle.pop()
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--window-size={},{}".format(*SIZE),
                     f"--force-device-scale-factor={RATIO}"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(shutil.which("chromedriver")))
    atexit.register(driver.quit)
    return driver


class Page:
    def __init__(self, address):
        self.driver = browser()
        self.driver.get(address)

    def close(self):
        """Leaves the browser to the next page, with a window that has nothing of this one."""
        windows = self.driver.window_handles
        self.driver.switch_to.new_window("window")
        new = self.driver.current_window_handle
        for window in windows:
            self.driver.switch_to.window(window)
            self.driver.close()
        self.driver.switch_to.window(new)
        self.driver.set_window_size(*SIZE)
        self.driver.get_log("browser")
        idle.append(self.driver)

    def resize(self, width, height):
        """A window with a pixel of the picture to each of its own."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})
        self.until("a picture of this size", lambda: self.script("return document.getElementById('picture').width === document.getElementById('stage').clientWidth"))

    def find(self, name):
        return self.driver.find_element(By.ID, name)

    def until(self, what, holds, patience=PATIENCE):
        end = time.monotonic() + patience
        while time.monotonic() < end:
            value = holds()
            if value:
                return value
            time.sleep(0.02)
        raise AssertionError(f"not within {patience} s: {what}; the page says: {self.find('state').text}")

    def samples(self):
        return int(self.find("stage").get_attribute("data-samples") or -1)

    def until_samples(self, count):
        self.until(f"{count} samples", lambda: self.samples() >= count)

    def pixels(self):
        """(width, height, RGBA) of what is shown."""
        return decoded(*self.script(f"return {PIXELS}"))

    def apart(self, other, count):
        """The mean difference to another picture as soon as there are so many samples of every pixel; before that, -1."""
        now = self.script(f"return +document.getElementById('stage').dataset.samples >= arguments[0] ? {PIXELS} : null", count)
        return mean_difference(other, decoded(*now)) if now else -1

    def words(self, which):
        """The texts of all elements of a selector, of one moment: lists of the page are made anew at any time."""
        return self.script("return [...document.querySelectorAll(arguments[0])].map((e) => e.innerText.trim())", which)

    def click(self, which, name):
        """A click on the element whose text begins so, however often its list is made anew."""
        def clicked():
            try:
                item = self.script("const i = [...document.querySelectorAll(arguments[0])].find((e) => e.innerText.trim().startsWith(arguments[1])); i?.scrollIntoView({block: 'center'}); return i", which, name)
                return item and (item.click() or True)
            except StaleElementReferenceException:
                return False
        self.until(f"{name} to click at", clicked)

    def script(self, text, *arguments):
        return self.driver.execute_script(text, *arguments)

    def mouse(self, x, y):
        """To a pixel of the picture, from the top left."""
        box = self.find("stage").rect
        return ActionChains(self.driver, duration=20).move_to_element_with_offset(self.find("stage"), (x + 0.5) / RATIO - box["width"] / 2, (y + 0.5) / RATIO - box["height"] / 2)

    def choose(self, name):
        """What has that name in the scene's tree, and waits until the page knows what it is."""
        self.click("#tree li", name)
        self.until(f"what {name} is", lambda: self.find("edit").is_displayed() and len(self.driver.find_elements(By.CSS_SELECTOR, "#surface option")) > 1)

    def move(self, words):
        edits = self.edits()
        field = self.find("move")
        field.clear()
        field.send_keys(words, Keys.TAB)
        self.until("the program's word", lambda: self.edits() > edits)

    def edits(self):
        return int(self.find("stage").get_attribute("data-edits") or 0)

    def tab(self, name):
        """Opens a page of the panel."""
        self.script("document.getElementById('tab-' + arguments[0]).click()", name)

    def press(self, *keys):
        """Keys on the picture, with those before the last held down."""
        self.script("document.getElementById('stage').focus()")
        chain = ActionChains(self.driver)
        for key in keys[:-1]:
            chain.key_down(key)
        chain.send_keys(keys[-1])
        for key in keys[:-1]:
            chain.key_up(key)
        chain.perform()

    def text(self, name):
        """The text of an element, shown or not."""
        return self.script("return document.getElementById(arguments[0]).textContent", name)

    def discard(self):
        """Discards changes by the menu; the question is open then."""
        self.find("menu-button").click()
        self.find("discard").click()

    def is_unsaved(self):
        return self.driver.title.startswith("•")

    def answer(self, yes):
        """A question that the page asks; its words."""
        self.until("a question", lambda: self.find("question").is_displayed())
        text = self.text("question-text")
        self.find("question-yes" if yes else "question-no").click()
        self.until("no question more", lambda: not self.find("question").is_displayed())
        return text

    def press_save(self):
        ActionChains(self.driver).key_down(Keys.CONTROL).send_keys("s").key_up(Keys.CONTROL).perform()

    def errors(self):
        return [line for line in self.driver.get_log("browser") if line["level"] == "SEVERE"]

    def picture(self, path):
        self.driver.save_screenshot(str(path))


@contextlib.contextmanager
def page(address):
    out = Page(address)
    try:
        yield out
        errors = out.errors()
        assert not errors, errors
    except BaseException:
        out.driver.quit()
        raise
    out.close()


def editable(scene, out):
    """A copy in a folder of its own: what is kept of unsaved changes stands beside it."""
    folder = out / "scenes" / str(time.monotonic_ns())
    folder.mkdir(parents=True)
    return pathlib.Path(shutil.copy(scene, folder))


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


def status_of(address, **headers):
    parts = urllib.parse.urlsplit(address)
    connection = http.client.HTTPConnection(parts.hostname, parts.port, timeout=PATIENCE)
    connection.request("GET", parts.path, headers=headers)
    return connection.getresponse().status


def mean_difference(a, b):
    assert a[:2] == b[:2], (a[:2], b[:2])
    if a[2] == b[2]:
        return 0
    bytes_a, bytes_b = (np.frombuffer(one[2], np.uint8).astype(np.int16) for one in (a, b))
    return float(np.abs(bytes_a - bytes_b).mean())


# --- Cases: of the program, the folder of scenes and that of pictures ---

def converges(program, scenes, out):
    """The first picture is coarse; then there are samples of every pixel, and the noise falls."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "16") as served, page(served.address) as shown:
        # Every text of the state: what is asked for later may come when the picture is done.
        shown.script("const state = document.getElementById('state'); window.states = [state.textContent]; new MutationObserver(() => "
                     "window.states.push(state.textContent)).observe(state, {childList: true, characterData: true, subtree: true})")
        stage = shown.find("stage").rect
        size = (round(RATIO * stage["width"]), round(RATIO * stage["height"]))
        # Before the first picture of the stage's size there are an empty canvas and, until the server knows the size, smaller ones.
        pictures = []
        shown.until("a picture", lambda: pictures.append(shown.pixels()) or pictures[-1][:2] == size)
        first = pictures[-1]
        shown.until_samples(16)
        shown.until("the last state", lambda: re.search("16 of 16 samples", shown.find("state").text))
        states = shown.script("return window.states")
        noise = [float(found.group(1)) for found in (re.search(r"noise ([\d.e+]+) %", state) for state in states) if found]
        assert noise and noise[-1] < noise[0], states
        width, height, pixels = shown.pixels()
        assert (width, height) == size, (width, height, stage)
        assert 0.1 < mean_difference(first, shown.pixels()) < 40
        assert 60 < sum(pixels) / len(pixels) < 220
        shown.picture(out / "converged.png")
        # Brighter without a new sample.
        shown.script("const e = document.getElementById('exposure'); e.value = 2; e.dispatchEvent(new Event('input'))")
        brighter = shown.pixels()
        assert sum(brighter[2]) > 1.2 * sum(pixels) and shown.samples() == 16


def camera(program, scenes, out):
    """Orbit, dolly, undo all: the first picture comes back to the bit."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "2") as served, page(served.address) as shown:
        shown.until_samples(2)
        first = shown.pixels()
        shown.mouse(150, 100).click_and_hold().move_by_offset(80, 10).release().perform()
        shown.until("another picture", lambda: shown.apart(first, 2) > 5)
        turned = shown.pixels()
        shown.find("stage").send_keys("+", "+", Keys.ARROW_LEFT)
        shown.until("a third", lambda: shown.apart(turned, 2) > 3)
        assert shown.find("undo").is_enabled()
        while shown.find("undo").is_enabled():
            shown.find("undo").click()
        shown.until("the first again", lambda: shown.apart(first, 2) == 0)
        while shown.find("redo").is_enabled():
            shown.find("redo").click()
        shown.until("the third again", lambda: shown.apart(turned, 2) > 3)
        for keys in ("1", "3", "7", (Keys.SHIFT, "3"), (Keys.SHIFT, "7"), (Keys.SHIFT, "1")):
            shown.press(*keys)
            shown.until(f"the view by {keys}", lambda: shown.samples() >= 1)
            _, _, pixels = shown.pixels()
            assert len(set(pixels)) > 20, f"nothing is seen along axis {key}"
        shown.find("fit").click()
        shown.until_samples(1)
        shown.picture(out / "along_z.png")


def picks(program, scenes, out):
    """What is under the cursor and along a ray is what `caplet pick` says of the same pixels."""
    scene = scenes / "gallery.pbrt"
    with viewer(program, scene, "--spp", "2") as served, page(served.address) as shown:
        shown.until_samples(2)
        width, height, _ = shown.pixels()
        named = 0
        shown.press("i")
        for k in range(12):
            x, y = int((0.09 + 0.077 * k) * width), int((0.35 + 0.05 * (k % 6)) * height)
            before = shown.find("table").get_attribute("data-pixel")
            shown.mouse(x, y).click().perform()
            shown.until("the crossings", lambda: shown.find("table").get_attribute("data-pixel") != before, 20)
            pixel = shown.find("table").get_attribute("data-pixel")  # the stage may begin between two pixels
            assert all(abs(int(a) - b) <= 1 for a, b in zip(pixel.split(","), (x, y))), (pixel, x, y)
            rows = shown.script("return [...document.querySelectorAll('#table tbody tr')].map((r) => [...r.cells].map((c) => c.textContent))")
            said = subprocess.run([program, "pick", scene, "--pixel", pixel, "--size", f"{width}x{height}", "--all", "--json"],
                                  check=True, capture_output=True, text=True).stdout
            theirs = json.loads(said)["crossings"]
            wanted = theirs[0]["object"] if theirs else "nothing"
            shown.until(f"the name at {pixel}: {wanted}", lambda: shown.find("under").text.split(" · ")[0] == str(wanted), 10)
            assert len(rows) == len(theirs), (rows, theirs)
            for row, crossing in zip(rows, theirs):
                assert abs(float(row[0]) - crossing["t"]) <= 1e-6 * crossing["t"], (row, crossing)
                assert row[1] == ("enters" if crossing["entering"] else "leaves"), (row, crossing)
                assert [row[2], row[3], row[4]] == [str(crossing["object"]), str(crossing["surface"]), str(crossing["material"])], (row, crossing)
                assert abs(float(row[5].split()[0]) - crossing["t"]) <= 1e-5 * crossing["t"], (row, crossing)
            if theirs:
                shown.until(f"{wanted} selected", lambda: shown.script("return [...document.querySelectorAll('#tree [aria-selected=true]')].map((i) => i.firstChild.textContent)") == [str(wanted)], 10)
                named += wanted != "floor"
            shown.picture(out / "inspected.png") if k == 6 else None
            shown.press(Keys.ESCAPE)  # the inspector is where the next pixel may be
            assert not shown.find("inspector").is_displayed()
        assert named >= 4, "too few of these pixels show more than the floor"
        assert shown.find("tool-inspect").get_attribute("aria-pressed") == "true"
        marked = shown.script("const c = document.getElementById('marks'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.some((v) => v)")
        assert marked, "what is selected has no outline"
        shown.picture(out / "picked.png")
        shown.find("search").send_keys("capsule 7")
        shown.until("one row", lambda: len(shown.driver.find_elements(By.CSS_SELECTOR, "#tree li")) == 1)


ASK = """const [pixels, done] = arguments, told = [];
const socket = new WebSocket(location.href.replace(/^http/, 'ws') + 'socket');
let next = 0;
const ask = () => { if (next < pixels.length) socket.send(JSON.stringify({ type: 'ask', number: next, x: pixels[next][0], y: pixels[next++][1], all: true, reference: false })); };
socket.onmessage = ({ data }) => {
  if (typeof data !== 'string') return;
  const message = JSON.parse(data);
  if (message.type !== 'answer') return;
  told.push([message.number, message.pick]);
  if (told.length === pixels.length) { socket.close(); done(told); } else setTimeout(ask, 8);  // below the rate that is allowed
};
socket.onopen = () => { for (let i = 0; i < 4; ++i) ask(); };"""


def picks_everywhere(program, scenes, out):
    """At 500 pixels of the gallery: the rays are a pinhole camera's, worked out here; what they cross is what `caplet pick` says."""
    scene = scenes / "gallery.pbrt"
    eye, target, up, fov, count = (0, -13, 6.4), (0, -0.3, 0.5), (0, 0, 1), math.radians(25), 500

    def unit(v):
        return [a / math.hypot(*v) for a in v]

    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

    forward = unit([t - e for t, e in zip(target, eye)])
    right = unit(cross(forward, up))  # the file mirrors x, as pbrt's own frame is left-handed
    above = cross(right, forward)
    with viewer(program, scene, "--spp", "1", "--read-only") as served, page(served.address) as shown:
        shown.until_samples(1)
        width, height, _ = shown.pixels()
        draw = random.Random(15)
        pixels = [(draw.randrange(width), draw.randrange(height)) for _ in range(count)]
        shown.driver.set_script_timeout(120)
        told = [pick for _, pick in sorted(shown.driver.execute_async_script(ASK, pixels))]
        per_pixel = 2 * math.tan(fov / 2) / min(width, height)
        worst = 0
        for (x, y), pick in zip(pixels, told):
            wanted = unit([f + per_pixel * ((x + 0.5 - width / 2) * r - (y + 0.5 - height / 2) * a) for f, r, a in zip(forward, right, above)])
            assert pick["pixel"] == [x, y]
            worst = max(worst, *(abs(a - b) for a, b in zip(unit(pick["ray"]["direction"]), wanted)),
                        *(abs(a - b) for a, b in zip(pick["ray"]["origin"], eye)))
        assert worst < 2e-6, worst
        rays, table = out / "rays.txt", out / "crossings.csv"
        rays.write_text("".join(" ".join(repr(v) for v in pick["ray"]["origin"] + pick["ray"]["direction"]) + "\n" for pick in told))
        subprocess.run([program, "pick", scene, "--rays", rays, "--all", "--out", table, "-q"], check=True)
        theirs = [[] for _ in pixels]
        with open(table, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                theirs[int(row["ray"])].append(row)
        seen = set()
        for pixel, pick, rows in zip(pixels, told, theirs):
            assert len(rows) == len(pick["crossings"]), (pixel, rows, pick)
            for row, crossing in zip(rows, pick["crossings"]):
                assert float(row["t"]) == crossing["t"], (pixel, row, crossing)
                for name in ("object", "primitive", "surface", "material"):
                    assert row[name] == str(crossing[name]), (pixel, row, crossing)
                assert (row["entering"] == "1") == crossing["entering"], (pixel, row, crossing)
                seen.add(row["object"])
        assert len(seen) >= 20, f"these pixels show {len(seen)} things alone"


def keeps_strangers_out(program, scenes, out):
    """Without the token, or from another site, nothing is told."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "1") as served:
        root = f"http://127.0.0.1:{served.port()}/"
        assert status_of(served.address) == 200
        assert status_of(root) == 403
        assert status_of(root + 32 * "0" + "/") == 403
        assert status_of(served.address, Host="evil.example") == 403
        assert status_of(served.address + "view.js") == 200
        assert status_of(served.address + "other.js") == 404
        upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="}
        assert status_of(served.address + "socket", Origin="http://evil.example", **upgrade) == 403
        assert status_of(root + 32 * "0" + "/socket", Origin=root[:-1], **upgrade) == 403
        assert served.end() == 0


def comes_back(program, scenes, out):
    """A page whose program is gone says so, and goes on with the next one at its address."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "1") as served, page(served.address) as shown:
        shown.until_samples(1)
        served.process.kill()
        shown.until("a word about it", lambda: shown.find("lost").is_displayed())
        assert "lost" in shown.find("lost").text
        shown.driver.get_log("browser")  # that it could not connect


def edits(program, scenes, out):
    """Select, move, paint, paint a surface, duplicate, delete, each seen; all taken back, the first picture is there to the bit."""
    with viewer(program, editable(scenes / "gallery.pbrt", out), "--spp", "2") as served, page(served.address) as shown:
        shown.until_samples(2)
        first = before = shown.pixels()
        choose = shown.choose
        count = 0

        def changed(what):
            nonlocal before, count
            count += 1
            shown.until(f"{what}: the program's word", lambda: int(shown.find("stage").get_attribute("data-edits") or 0) >= count)
            shown.until(f"{what}: another picture", lambda: shown.apart(before, 2) > 0)
            before = shown.pixels()

        def typed(name, words):
            field = shown.find(name)
            field.clear()
            field.send_keys(words, Keys.TAB)

        choose("capsule 5")
        typed("move", "0 -1 0.5")
        changed("moved")
        typed("scale", "1.5")
        changed("scaled")
        typed("turn", "0 1 0 40")
        changed("turned")
        typed("radius0", "0.6")
        changed("a capsule's radius")
        assert abs(float(shown.find("radius0").get_attribute("value")) - 0.6) < 1e-6
        typed("move", "0 nonsense 0")
        assert shown.find("move").get_attribute("aria-invalid") and "nonsense" in shown.text("move-error")
        shown.script("const s = document.getElementById('material'); s.selectedIndex = 3; s.dispatchEvent(new Event('change'))")
        changed("painted")
        handle = shown.driver.find_element(By.CSS_SELECTOR, "[data-handle=z]")
        ActionChains(shown.driver, duration=20).click_and_hold(handle).move_by_offset(0, -20).move_by_offset(0, -20).release().perform()
        shown.until("moved by a handle", lambda: shown.apart(before, 1) > 0)
        shown.picture(out / "handles.png")
        choose("cylinder")
        shown.script("const s = document.getElementById('surface'); s.value = '0'; s.dispatchEvent(new Event('change'))")
        before = shown.pixels()
        shown.script("const s = document.getElementById('material'); s.selectedIndex = 2; s.dispatchEvent(new Event('change'))")
        shown.until("a surface painted", lambda: shown.apart(before, 2) > 0)
        things = int(shown.find("more").text.split(" of ")[1])
        shown.find("duplicate").click()
        shown.until("one more, selected", lambda: shown.find("more").text.endswith(f" of {things + 1}") and [t.split("\n")[0] for t in shown.words("#tree [aria-selected=true]")] == ["cylinder copy"])
        shown.find("delete").click()
        shown.until("one less", lambda: shown.find("more").text.endswith(f" of {things}") and not shown.words("#tree [aria-selected=true]"))
        with page(served.address) as other:
            other.until("the same things", lambda: other.find("more").text.endswith(f" of {things}"))
            other.until_samples(2)
        while shown.find("back").is_enabled():
            edits_before = int(shown.find("stage").get_attribute("data-edits"))
            shown.find("back").click()
            shown.until("the program's word", lambda: int(shown.find("stage").get_attribute("data-edits")) > edits_before)
        shown.until("the first picture again", lambda: shown.apart(first, 2) == 0)
        assert shown.find("again").is_enabled()


def read_only(program, scenes, out):
    """Whoever may only look finds no tools, and changes nothing by messages of his own."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "1", "--read-only") as served, page(served.address) as shown:
        shown.until_samples(1)
        first = shown.pixels()
        shown.driver.find_elements(By.CSS_SELECTOR, "#tree li")[2].click()
        time.sleep(0.5)
        assert not shown.find("edit").is_displayed()
        assert not any(e.is_displayed() for e in shown.driver.find_elements(By.CSS_SELECTOR, ".edits, #save"))
        shown.press(Keys.DELETE)
        shown.script("""const s = new WebSocket(location.href.replace(/^http/, 'ws') + 'socket'); window.told = [];
            s.onmessage = (e) => { if (typeof e.data === 'string') window.told.push(e.data); };
            s.onopen = () => s.send(JSON.stringify({type: 'edit', what: 'delete', goes_on: false, ids: [2]}))""")
        shown.until("a refusal", lambda: any("read-only" in t for t in shown.script("return window.told")))
        assert mean_difference(first, shown.pixels()) == 0


def two_pages(program, scenes, out):
    """Two pages show one picture."""
    with viewer(program, scenes / "gallery.pbrt", "--spp", "2") as served, page(served.address) as one, page(served.address) as two:
        one.until_samples(2)
        two.until_samples(2)
        before = two.pixels()
        one.mouse(150, 100).click_and_hold().move_by_offset(80, 10).release().perform()
        two.until("the other's camera", lambda: two.apart(before, 2) > 5)
        one.until_samples(2)
        assert mean_difference(one.pixels(), two.pixels()) == 0


def saves(program, scenes, out):
    """Ctrl S asks before words by hand are lost, says what it wrote, and the file gives the picture that is shown, to the bit."""
    scene = editable(scenes / "gallery.pbrt", out)
    by_hand = scene.read_bytes()
    with viewer(program, scene, "--spp", "2") as served, page(served.address) as shown:
        shown.until_samples(2)
        assert not shown.is_unsaved()
        shown.choose("capsule 5")
        before = shown.pixels()
        shown.move("0 -1 0.5")
        shown.until("a moved capsule", lambda: shown.apart(before, 2) > 0)
        before = shown.pixels()
        shown.until("the mark of unsaved changes", shown.is_unsaved)
        shown.press_save()
        assert "comments" in shown.answer(False)
        assert scene.read_bytes() == by_hand and shown.is_unsaved()
        shown.press(Keys.CONTROL, Keys.SHIFT, "s")
        field = shown.find("save_name")
        for name in ("../other", "/tmp/other", ".other"):
            field.clear()
            field.send_keys(name, Keys.ENTER)
            shown.until(f"a refusal of {name}", lambda: shown.find("save_name").get_attribute("aria-invalid"))
            assert "plain name" in shown.text("save_said"), shown.text("save_said")
            shown.script("document.getElementById('save_name').dispatchEvent(new Event('input'))")
        assert sorted(f.name for f in scene.parent.iterdir()) == [".gallery.pbrt.unsaved", "gallery.pbrt"]
        field.clear()
        field.send_keys("moved", Keys.ENTER)
        shown.until("what was written", lambda: shown.find("said").text.endswith("moved.pbrt") and not shown.find("keeping").is_displayed())
        shown.until("no mark", lambda: not shown.is_unsaved())
        assert sorted(f.name for f in scene.parent.iterdir()) == ["gallery.pbrt", "moved.pbrt"]
        shown.move("0 0 0.25")
        shown.find("menu-button").click()
        shown.find("menu-save").click()
        field = shown.find("save_name")
        field.clear()
        field.send_keys("gallery")
        shown.picture(out / "saving.png")
        shown.find("save_now").click()
        shown.picture(out / "question.png")
        shown.answer(True)
        shown.until("what was written", lambda: shown.find("said").text.endswith("gallery.pbrt"))
        shown.until("another picture", lambda: shown.apart(before, 2) > 0)
        last = shown.pixels()
        shown.picture(out / "saved.png")
        with page(served.address) as other:
            assert not other.is_unsaved()
    assert b"Caplet" in scene.read_bytes()[:60]
    with viewer(program, scene, "--spp", "2") as served, page(served.address) as shown:
        shown.until("the same picture", lambda: shown.apart(last, 2) == 0)
        assert served.end() == 0
        shown.driver.get_log("browser")
    assert sorted(f.name for f in scene.parent.iterdir()) == ["gallery.pbrt", "moved.pbrt"]


def keeps(program, scenes, out):
    """Unsaved changes are there after a reload of the page, after the program ended, and after it was killed; undo still works."""
    scene, port = editable(scenes / "gallery.pbrt", out), free_port()
    options = ("--spp", "2", "--port", str(port))
    with contextlib.ExitStack() as stack:
        served = stack.enter_context(viewer(program, scene, *options))
        shown = stack.enter_context(page(served.address))
        shown.until_samples(2)
        first = shown.pixels()
        shown.choose("capsule 5")
        shown.move("0 -1 0.5")
        shown.until("another picture", lambda: shown.apart(first, 2) > 0)
        once = shown.pixels()
        shown.choose("capsule 7")
        shown.move("0 0 1")
        shown.until("a third picture", lambda: shown.apart(once, 2) > 0)
        moved = shown.pixels()
        shown.driver.refresh()
        shown.until("the changes after a reload", lambda: shown.is_unsaved() and shown.apart(moved, 2) == 0)
        for kill in (False, True):
            # A page that stays open goes on with the next program at its address, and looks where it looked.
            shown.find("stage").send_keys("+")
            shown.until("the mark of a picture", lambda: shown.apart(moved, 2) > 0)
            near = shown.pixels()
            address = served.address
            if kill:
                served.process.kill()
                served.process.wait()
            else:
                assert served.end() == 0
            shown.until("a word about it", lambda: shown.find("lost").is_displayed() and "lost" in shown.find("lost").text)
            if kill:
                shown.picture(out / "lost.png")
            served = stack.enter_context(viewer(program, scene, *options))
            assert served.address == address
            shown.until("the connection", lambda: not shown.find("lost").is_displayed())
            shown.until("the changes after a restart", lambda: shown.is_unsaved() and shown.apart(near, 2) == 0)
            assert "earlier session (2)" in shown.find("kept_note").text, shown.find("kept_note").text
            if not kill:
                shown.picture(out / "kept.png")
                shown.find("close_note").click()
                assert not shown.find("kept_note").is_displayed()
            shown.press(",")
            shown.until("the view before", lambda: shown.apart(moved, 2) == 0)
            shown.driver.get_log("browser")  # that it could not connect
        shown.find("back").click()
        shown.until("one change less", lambda: shown.apart(moved, 2) > 0)
        shown.find("back").click()
        shown.until("the first picture", lambda: shown.apart(first, 2) == 0)
        shown.until("no mark", lambda: not shown.is_unsaved())
        shown.find("again").click()
        shown.until("the mark again", shown.is_unsaved)
        shown.discard()
        shown.answer(True)
        shown.until("the first picture", lambda: shown.apart(first, 2) == 0)
        assert [f.name for f in scene.parent.iterdir()] == ["gallery.pbrt"]


def asks_about_older_changes(program, scenes, out):
    """Changes of a file that is another one since are made again, or forgotten, when one says so."""
    scene = editable(scenes / "gallery.pbrt", out)
    with viewer(program, scene, "--spp", "1") as served, page(served.address) as shown:
        shown.until_samples(1)
        shown.choose("capsule 5")
        shown.move("0 -1 0.5")
        served.process.kill()
        served.process.wait()
        shown.until("a word about it", lambda: shown.find("lost").is_displayed())
        shown.driver.get_log("browser")
    with open(scene, "a", encoding="utf-8") as file:
        file.write("# another one\n")
    with viewer(program, scene, "--spp", "1") as served, page(served.address) as shown:
        shown.until_samples(1)
        assert not shown.is_unsaved() and "another one" in shown.find("kept_note").text
        shown.picture(out / "older.png")
        shown.find("forget_old").click()
        shown.answer(False)
        assert shown.find("kept_note").is_displayed()
        shown.find("restore_old").click()
        shown.until("the change", shown.is_unsaved)
        shown.until("no question more", lambda: not shown.find("kept_note").is_displayed())
        assert shown.find("back").is_enabled()


def asks_before_changes_are_lost(program, scenes, out):
    """Where changes cannot be kept, the page says so and does not go without a question; where they are, it does."""
    scene = editable(scenes / "gallery.pbrt", out)
    with viewer(program, scene, "--spp", "1") as served, viewer(program, scene, "--spp", "1") as second:
        for address, is_kept in ((served.address, True), (second.address, False)):
            with page(address) as shown:
                shown.until_samples(1)
                shown.choose("capsule 5")
                shown.move("0 -1 0.5")
                shown.until("the mark", shown.is_unsaved)
                assert ("end with the program" in shown.text("save_said")) != is_kept, shown.text("save_said")
                # WebDriver answers the question itself, so the page alone is asked.
                asks = shown.script("const e = new Event('beforeunload', { cancelable: true }); window.dispatchEvent(e); return e.defaultPrevented")
                assert asks != is_kept
                shown.discard()
                shown.answer(True)
                shown.until("no mark", lambda: not shown.is_unsaved())
                assert not shown.script("const e = new Event('beforeunload', { cancelable: true }); window.dispatchEvent(e); return e.defaultPrevented")


def figures(program, scenes, out):
    """The pictures of docs/viewer.md."""
    def shot(name):
        shown.picture(out / f"{name}.png")

    def choose(name):
        shown.click("#tree li", name)
        shown.until(f"what {name} is", lambda: shown.find("edit").is_displayed() and shown.script("return document.getElementById('material').value"))

    with viewer(program, editable(scenes / "gallery.pbrt", out), "--spp", "64") as served, page(served.address) as shown:
        shown.resize(1280, 800)
        choose("capsule 7")
        shown.until("64 samples", lambda: shown.samples() >= 64, 600)
        shot("viewer")
        width, height, _ = shown.pixels()
        shown.press("i")
        ActionChains(shown.driver).move_to_element_with_offset(shown.find("stage"), int(0.2 * width), int(0.12 * height)).click().perform()  # through the glass lens
        shown.until("the crossings", lambda: len(shown.driver.find_elements(By.CSS_SELECTOR, "#table tbody tr")) > 2)
        shot("viewer-inspector")
        shown.press("?")
        shot("viewer-help")
    with viewer(program, scenes / "neuron.swc", "--spp", "64") as served, page(served.address) as shown:
        shown.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "light"}]})
        shown.resize(1280, 800)
        shown.until("64 samples", lambda: shown.samples() >= 64, 300)
        shot("viewer-neuron")
        shown.find("export-button").click()
        shown.find("figure-open").click()
        shown.script("for (const [id, text] of Object.entries({ background: 'white', width: 1200, height: 900 })) document.getElementById(`figure-${id}`).value = text")
        for name in ("scale-bar", "color-bar"):
            shown.find(f"figure-{name}").click()
        shown.find("figure-go").click()
        shown.until("the figure", lambda: shown.find("figure-save").is_enabled(), 300)
        shot("viewer-figure")


CASES = [converges, camera, picks, picks_everywhere, edits, saves, keeps, asks_about_older_changes, asks_before_changes_are_lost, read_only, keeps_strangers_out, comes_back, two_pages]


def main(arguments, usage, cases, *others, browser="chromedriver", package="chromium-driver"):
    """Runs the cases, or of them and the others those that are named."""
    if len(arguments) < 3:
        print(usage)
        return 2
    program, scenes, out = arguments[0], pathlib.Path(arguments[1]), pathlib.Path(arguments[2])
    if not shutil.which(browser):
        print(f"SKIPPED: no {browser} ({package})")
        return SKIPPED
    out.mkdir(parents=True, exist_ok=True)
    failed = []
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        os.environ["TMPDIR"] = folder  # browsers leave theirs behind
        for case in cases if len(arguments) == 3 else [case for case in [*cases, *others] if case.__name__ in arguments[3:]]:
            start = time.monotonic()
            try:
                case(program, scenes, out)
            except Exception:  # the next cases shall run too
                traceback.print_exc()
                failed.append(case.__name__)
            print(f"{case.__name__}: {'FAILED' if case.__name__ in failed else 'passed'}, {time.monotonic() - start:.1f} s", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], __doc__, CASES, figures))
