#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Tools, keys, the panel and actions that do not wait in the page of `caplet view`, in a real browser.

usage: page_tools_test.py PROGRAM SCENES FOLDER [NAME...]   as page_test.py
"""
import base64
import json
import math
import pathlib
import random
import subprocess
import sys

import page_forms_test
import page_test
from page_forms_test import PAGES, SCENE, work
from page_test import RATIO, ActionChains, By, Keys, page

HANDLES = "return [...document.querySelectorAll('#handles [data-handle]')].map((n) => n.dataset.handle)"
KINDS = {"move": {"x", "y", "z", "plane", "plane-x", "plane-y", "plane-z"}, "turn": {"turn-x", "turn-y", "turn-z"}, "scale": {"scale"}}


def tools(program, scenes, out):
    """Each tool has its key and shows its own handles; Escape selects nothing and takes the first tool."""
    with work(program, out) as at:
        shown = at.shown
        at.choose("box")
        for key, name in (("g", "move"), ("r", "turn"), ("s", "scale"), ("v", "select"), ("m", "measure"), ("i", "inspect")):
            shown.press(key)
            pressed = shown.script("return [...document.querySelectorAll('#rail [aria-pressed=true]')].map((b) => b.id)")
            assert pressed == [f"tool-{name}"], (key, pressed)
            wanted = KINDS.get(name, set().union(*KINDS.values()) if name == "select" else set())
            assert set(shown.script(HANDLES)) == wanted, (name, shown.script(HANDLES))
            assert shown.find("hint").is_displayed() == (name in ("measure", "inspect"))
        shown.press(Keys.ESCAPE)
        assert not shown.find("edit").is_displayed() and shown.find("nothing-chosen").is_displayed()
        assert shown.find("tool-select").get_attribute("aria-pressed") == "true"
        # Letters that are typed in a field or a dialog are no keys of tools.
        shown.press("?")
        shown.until("the help", lambda: shown.find("keys").is_displayed())
        ActionChains(shown.driver).send_keys("g", Keys.ESCAPE).perform()
        shown.until("no help", lambda: not shown.find("keys").is_displayed())
        assert shown.find("tool-select").get_attribute("aria-pressed") == "true"
        shown.find("search").send_keys("ri")
        assert shown.find("tool-select").get_attribute("aria-pressed") == "true"
        assert shown.words("#tree li") == [], shown.words("#tree li")


def measures(program, scenes, out):
    """A distance and an angle between points of surfaces, which `caplet pick` gives for the same pixels."""
    with work(program, out) as at:
        shown = at.shown
        width, height, _ = shown.pixels()
        pixels = [(int(x * width), int(y * height)) for x, y in ((0.3, 0.8), (0.5, 0.5), (0.6, 0.75))]
        points = []
        for x, y in pixels:
            said = subprocess.run([program, "pick", out / "forms.pbrt", "--pixel", f"{x},{y}", "--size", f"{width}x{height}", "--all", "--json"], check=True, capture_output=True, text=True).stdout
            points.append(json.loads(said)["crossings"][0]["point"])
        shown.press("m")
        for x, y in pixels[:2]:
            shown.mouse(x, y).click().perform()
        number = shown.until("a distance", lambda: shown.script("return document.querySelector('#notes text')?.textContent"))
        assert abs(float(number) - math.dist(*points[:2])) <= 6e-4 * float(number), (number, points)
        assert not shown.words("#tree [aria-selected=true]"), "a measure selects nothing"
        shown.mouse(*pixels[2]).key_down(Keys.SHIFT).click().key_up(Keys.SHIFT).perform()
        angle = shown.until("an angle", lambda: (t := shown.script("return document.querySelector('#notes text')?.textContent")) and t.endswith("°") and t)
        a, b = ([p - q for p, q in zip(points[i], points[1])] for i in (0, 2))
        wanted = math.degrees(math.acos(sum(p * q for p, q in zip(a, b)) / math.hypot(*a) / math.hypot(*b)))
        assert abs(float(angle[:-1]) - wanted) < 0.06, (angle, wanted)
        shown.picture(out / "measured.png")
        # Notes stay at their points when the camera moves.
        before = shown.script("const c = document.querySelector('#notes circle'); return [c.getAttribute('cx'), c.getAttribute('cy')]")
        shown.press(Keys.ARROW_LEFT)
        after = shown.script("const c = document.querySelector('#notes circle'); return [c.getAttribute('cx'), c.getAttribute('cy')]")
        assert math.dist([float(v) for v in before], [float(v) for v in after]) > 5
        shown.find("forget-measures").click()
        assert not shown.script("return document.querySelectorAll('#notes circle').length")


def inspects(program, scenes, out):
    """The inspector opens beside the cursor, stays where it is dragged to, and leaves its ray in the picture."""
    with work(program, out) as at:
        shown = at.shown
        width, height, _ = shown.pixels()
        shown.press("i")
        shown.mouse(width // 2, height // 2).click().perform()
        box = shown.until("the inspector", lambda: shown.find("inspector").is_displayed() and shown.find("inspector").rect)
        assert box["x"] > width / 2 / RATIO and box["x"] < width / 2 / RATIO + 80, box
        assert len(shown.script("return [...document.querySelectorAll('#notes circle.ray-in')]")) == len(shown.words("#table tbody tr")) > 2
        shown.press(Keys.ARROW_LEFT)  # along the ray itself it is a point
        ends = shown.script("const l = document.querySelector('#notes line.ray'); return ['x1', 'x2', 'y1', 'y2'].map((n) => +l.getAttribute(n))")
        assert math.hypot(ends[0] - ends[1], ends[2] - ends[3]) > 10, ends
        shown.picture(out / "ray.png")
        ActionChains(shown.driver, duration=20).click_and_hold(shown.driver.find_element(By.CSS_SELECTOR, "#inspector h2")).move_by_offset(-80, -40).release().perform()
        moved = shown.find("inspector").rect
        assert abs(moved["x"] - box["x"] + 80) < 3 and abs(moved["y"] - box["y"] + 40) < 3, (box, moved)
        told = shown.text("asked")
        shown.mouse(int(0.3 * width), int(0.8 * height)).click().perform()
        shown.until("another ray", lambda: shown.text("asked") != told)
        assert shown.find("inspector").rect["x"] == moved["x"], "it stays where it was put"
        shown.script("Object.defineProperty(navigator, 'clipboard', { value: { writeText: async (text) => { window.copied = text; } } })")
        shown.find("copy-ray").click()
        copied = json.loads(shown.until("the copy", lambda: shown.script("return window.copied")))
        rows = shown.script("return [...document.querySelectorAll('#table tbody tr')].map((r) => [r.cells[1].textContent, r.cells[2].textContent])")
        assert [["enters" if c["entering"] else "leaves", c["object"]] for c in copied["crossings"]] == rows and rows, (copied, rows)
        shown.press(Keys.ESCAPE)
        assert not shown.find("inspector").is_displayed() and not shown.script("return document.querySelectorAll('#notes line').length")


def numbers(program, scenes, out):
    """Numbers take arithmetic, say in words what is wrong, and change when their name is dragged; Escape takes the drag back."""
    with work(program, out) as at:
        shown = at.shown
        at.choose("pill")

        def typed(name, words):
            field = shown.find(name)
            field.clear()
            field.send_keys(words, Keys.TAB)

        def radius():
            return float(shown.find("radius0").get_attribute("value"))

        typed("radius0", "2 * 0.175")
        at.changed("a radius by arithmetic")
        assert abs(radius() - 0.35) < 1e-6
        for words, why in (("0.3.1", "0.3.1"), ("(1", "(1"), ("", "")):
            typed("radius0", words)
            assert bool(shown.find("radius0").get_attribute("aria-invalid")) == bool(why)
            assert not why or why in shown.text("radius0-error"), shown.text("radius0-error")
        shown.press(Keys.ESCAPE)
        at.choose("pill")
        shown.until("the radius", lambda: shown.find("radius0").get_attribute("value") == "0.35")
        label, edits = shown.driver.find_element(By.CSS_SELECTOR, "#capsule .scrubs"), at.edits()
        ActionChains(shown.driver, duration=20).click_and_hold(label).move_by_offset(20, 0).move_by_offset(20, 0).release().perform()
        shown.until("the program's word", lambda: at.edits() > edits)
        at.changed("a radius by dragging its name")
        shown.until("40 steps of a 200th", lambda: abs(radius() - 0.35 * 1.2) < 1e-5, 5)
        ActionChains(shown.driver, duration=20).click_and_hold(label).move_by_offset(30, 0).send_keys(Keys.ESCAPE).release().perform()
        shown.until("the radius before", lambda: abs(radius() - 0.42) < 1e-5)
        assert shown.find("edit").is_displayed(), "Escape ended the drag, not the selection"
        shown.tab("camera")
        typed("fov", "500")
        assert "170" in shown.text("fov-error"), shown.text("fov-error")
        typed("fov", "40/2")
        at.changed("half the field of view")
        shown.press(",")  # the view before
        at.undo_all()


# An instance has a number behind those of all shapes, also of new ones.
WITH_INSTANCE = SCENE + """
ObjectBegin "cone"
Shape "sphere" "float radius" [ 0.4 ]
ObjectEnd
Translate 1.5 -1.5 -0.8
ObjectInstance "cone"
"""


def never_waits(program, scenes, out):
    """Fifty actions at once, and fifty with pauses of some milliseconds: each does what it was asked to, to what was selected."""
    for seed, pause in ((3, 0), (4, 0), (5, 12)):
        draw = random.Random(seed)
        with work(program, out, text=WITH_INSTANCE) as at:
            shown = at.shown
            known = ["floor", "ball", "box", "pill", "cone"]
            things, selected, steps, copies = [*known], None, [], 0
            for _ in range(50):
                what = draw.choice(["select", "select", "duplicate", "duplicate", "delete", "hide", "add", "move"])
                if what == "delete" and draw.random() < 0.5:
                    what = "duplicate"
                name = draw.choice(known)
                steps.append([what, name])
                # The same on the list of names; things are known by their place in a list of lists.
                if what == "select":
                    selected = next((t for t in things if t is name or t == name), None)
                elif what == "add":
                    things.append(selected := f"sphere#add {len(steps)}")
                elif selected is not None and what == "duplicate":
                    copies += 1
                    name = selected.split("#")[0]  # a new shape has no name, and copies of instances are of the same object
                    things.append(selected := f"{name}#{copies}" if name in ("cone", "sphere") else f"{name} copy#{copies}")
                elif selected is not None and what in ("delete", "hide"):
                    things = [t for t in things if t is not selected]
                    selected = None
            wanted = sorted(t.split("#")[0] for t in things if not t.startswith("sphere"))
            spheres = sum(t.startswith("sphere") for t in things)
            shown.driver.set_script_timeout(60)
            shown.driver.execute_async_script("""const [steps, pause, done] = arguments, $ = (id) => document.getElementById(id);
                const key = (key, more = {}) => document.getElementById('stage').dispatchEvent(new KeyboardEvent('keydown', { key, code: '', bubbles: true, ...more }));
                (async () => {
                  for (const [what, name] of steps) {
                    if (what === 'select') {
                      const item = [...$('tree').children].find((i) => i.firstChild.textContent === name);
                      item ? item.click() : key('Escape');
                    } else if (what === 'duplicate') key('d', { ctrlKey: true });
                    else if (what === 'delete') key('Delete');
                    else if (what === 'hide') key('h');
                    else if (what === 'add') document.querySelector('[data-shape=sphere]').click();
                    else { $('move').value = '0 0 0.01'; $('move').dispatchEvent(new Event('change')); }
                    if (pause) await new Promise((r) => setTimeout(r, pause));
                  }
                  done();
                })();""", steps, pause)

            def names():
                return shown.script("return [...document.querySelectorAll('#tree li')].map((i) => i.firstChild.textContent)")

            def is_right():
                now = names()
                known = sorted(n for n in now if not n.startswith("sphere"))
                return known == wanted and len(now) - len(known) == spheres
            try:
                shown.until("what fifty actions make", is_right, 30)
            except AssertionError as error:
                raise AssertionError(f"{error}; seed {seed}: {sorted(names())}, wanted {wanted} and {spheres} spheres; {steps}") from error
            chosen = shown.words("#tree [aria-selected=true] > :first-child")
            assert len(chosen) == (selected is not None), (chosen, selected)
            at.undo_all()


def links(program, scenes, out):
    """A link holds a view: another page that opens it shows it."""
    with work(program, out) as at:
        shown = at.shown
        shown.script("Object.defineProperty(navigator, 'clipboard', { value: { writeText: async (text) => { window.copied = text; } } })")
        shown.press(Keys.ARROW_LEFT)
        shown.press("5")
        at.changed("another view")
        turned = at.before
        shown.find("menu-button").click()
        shown.find("menu-link").click()
        link = shown.until("the link", lambda: shown.script("return window.copied"))
        shown.press("0")
        shown.until("the scene's camera", lambda: shown.apart(at.first, 2) == 0)
        with page(link) as other:
            other.until("the link's view", lambda: other.pixels()[:2] == turned[:2] and other.apart(turned, 2) == 0)
        shown.tab("camera")
        shown.find("keep").click()
        shown.press("7")
        shown.until("from above", lambda: shown.apart(turned, 2) > 5)
        shown.driver.find_element(By.CSS_SELECTOR, "#kept button").click()
        shown.until("the view that was saved", lambda: shown.apart(turned, 2) == 0)


PNG = """const done = arguments[1]; const image = new Image(); image.onload = () => { const canvas = document.createElement('canvas'); canvas.width = image.naturalWidth; canvas.height = image.naturalHeight; const brush = canvas.getContext('2d'); brush.drawImage(image, 0, 0); done([canvas.width, canvas.height, [...brush.getImageData(0, 0, canvas.width, canvas.height).data]]); }; image.src = arguments[0]"""


def png_pixels(shown, file):
    """Width, height and RGBA of a PNG, as the browser decodes it."""
    width, height, values = shown.driver.execute_async_script(PNG, "data:image/png;base64," + base64.b64encode(file.read_bytes()).decode())
    return width, height, bytes(values)


PATH = """const done = arguments[0];
Promise.all(['./path.js', './camera.js'].map((name) => import(name))).then(([{ camera_at, point_at }, { Camera }]) => {
  const line = { towards: (a, b) => b.map((v, i) => v - a[i]), moved: (a, by, f) => a.map((v, i) => v + f * by[i]) };
  // Views from a circle around [1, 2, 3], 80 degrees apart, ever nearer; the camera's right is the picture's left in the second list.
  const views = (hand) => [0, 1, 2].map((k) => {
    const a = 80 * k * Math.PI / 180, s = Math.sin(a), c = Math.cos(a), r = 10 * 2 ** -k;
    const camera = new Camera({ world_from_camera: [hand * c, 0, -s, 1 + r * s, 0, 1, 0, 2, -hand * s, 0, -c, 3 + r * c], fov: 0.5 + 0.1 * k, lens_radius: 0, focal_distance: 1 });
    return Object.assign(camera, { target: [1, 2, 3] });
  });
  done({
    line: [1, 1.25, 2, 5].map((t) => point_at(line, [[2], [2], [6]], t)[0]),
    at: [1, -1].map((hand) => [0, 0.5, 1, 1.75, 2, 3].map((t) => { const camera = camera_at(views(hand), t); return [camera.matrix(), camera.fov, camera.target].flat(); })),
  });
});"""


def paths(program, scenes, out):
    """Saved views are played as a camera path and saved as poses, which the program renders to the same views."""
    with work(program, out) as at:
        shown = at.shown
        got = shown.driver.execute_async_script(PATH)
        u = 0.25  # Hermite's polynomials: the velocity is 0 at the key that is given twice, and 4 at the last
        assert all(abs(a - b) < 1e-12 for a, b in zip(got["line"], [2, 2 + 4 * (3 * u**2 - 2 * u**3) + 4 * (u**3 - u**2), 6, 6])), got["line"]
        for hand, cameras in zip((1, -1), got["at"]):
            for t, is_at in zip((0, 0.5, 1, 1.75, 2, 2), cameras):
                a, r = math.radians(80 * t), 10 * 2**-t
                s, c = math.sin(a), math.cos(a)
                wanted = [hand * c, 0, -s, 1 + r * s, 0, 1, 0, 2, -hand * s, 0, -c, 3 + r * c, 0, 0, 0, 1, 0.5 + 0.1 * t, 1, 2, 3]
                assert all(abs(x - y) < 1e-9 for x, y in zip(is_at, wanted)), (hand, t, is_at, wanted)

        shown.tab("camera")
        shown.find("keep").click()
        assert not shown.find("path").is_displayed(), "one view makes no path"
        shown.press("7")
        at.changed("from above")
        above = at.before
        shown.find("keep").click()
        assert shown.find("path").is_displayed()
        shown.press("0")
        shown.until("the scene's camera", lambda: shown.apart(at.first, 2) == 0)
        shown.script("const input = document.getElementById('path-seconds'); input.value = '0.5'")
        shown.find("play").click()
        assert shown.text("play") == "Stop"
        shown.until("the end of the path", lambda: shown.text("play") == "Play")
        shown.until("the last view", lambda: shown.apart(above, 2) == 0)
        # Whoever touches the picture goes on alone.
        shown.script("document.getElementById('path-seconds').value = '600'")
        shown.find("play").click()
        shown.press("0")
        assert shown.text("play") == "Play"
        shown.until("the scene's camera again", lambda: shown.apart(at.first, 2) == 0)

        shown.script("document.getElementById('path-seconds').value = '1.5'; window.saved = []; const make = URL.createObjectURL; URL.createObjectURL = (blob) => { blob.text().then((text) => window.saved.push(text)); return make.call(URL, blob); }")
        shown.find("save-path").click()
        text = shown.until("the path's file", lambda: shown.script("return window.saved[0]"))
        assert [json.loads(line)["time"] for line in text.splitlines()] == [0, 1.5], text
        keys = out / "forms.path.jsonl"
        keys.write_text(text)
        width, height, _ = shown.pixels()
        subprocess.run([program, "render", out / "forms.pbrt", "--poses", keys, "--fps", "2", "--size", f"{width}x{height}", "--spp", "2", "-q", "-o", out / "path.#.exr", "-o", out / "path.#.png"], check=True)
        assert sorted(p.name for p in out.glob("path.*.png")) == [f"path.{i}.png" for i in (1, 2, 3, 4)]
        views = {}
        for number in (1, 4):
            views[number] = png_pixels(shown, out / f"path.{number}.png")
        # The same views, at two samples a pixel each: nearer to the page's than to one another's.
        for number, page_picture in ((1, at.first), (4, above)):
            same, other = (page_test.mean_difference(page_picture, views[n]) for n in (number, 5 - number))
            assert same < other / 3, (number, same, other)


def clips(program, scenes, out):
    """The scene is cut away from a side, as the program's --clip cuts it; undo, saved views and links know the plane."""
    with work(program, out) as at:
        shown = at.shown
        got = shown.driver.execute_async_script("""const done = arguments[0]; import('./clip.js').then(({ extent, name_of, plane, share_of }) => {
            const box = [[-1, 0, 2], [3, 1, 4]];
            done({ extent: [extent(box, [1, 0, 0]), extent(box, [0, 0, -1]), extent(box, [0.6, 0.8, 0])], names: [null, { normal: [0, -1, 0] }, { normal: [0.6, 0.8, 0] }].map(name_of),
                   planes: [plane("off", 0.5, box), plane("x", 0.25, box), plane("-z", 0, box), plane("view", 1, box, [0, -2, 0])], share: [share_of({ normal: [1, 0, 0], offset: 1 }, box), share_of({ normal: [1, 0, 0], offset: 9 }, box)] }); });""")
        assert got["extent"][:2] == [[-1, 3], [-4, -2]] and all(abs(a - b) < 1e-12 for a, b in zip(got["extent"][2], (-0.6, 2.6))), got
        assert got["names"] == ["off", "-y", "view"] and got["share"] == [0.5, 1], got
        assert got["planes"] == [None, {"normal": [1, 0, 0], "offset": 0}, {"normal": [0, 0, -1], "offset": -4}, {"normal": [0, 1, 0], "offset": 1}], got

        shown.tab("camera")
        assert not shown.find("clip-box").is_displayed()
        at.pick("clip", "z")
        at.changed("half of it")
        half = at.before
        assert shown.find("clip-box").is_displayed() and shown.find("clip-share").get_attribute("value") == "50"
        place = shown.text("clip-told").split(" = ")
        width, height, _ = shown.pixels()
        assert place[0] == "z", place
        shown.picture(out / "cut.png")
        # A click on a face finds the face: the middle of what is red and flat.
        shown.press("t")
        shown.mouse(width // 2, int(height * 0.55)).click().perform()
        shown.until("the field for words", lambda: shown.driver.find_elements(By.ID, "label-words"))[0].send_keys("face", Keys.ENTER)
        shown.script("document.getElementById('figure-open').click()")
        point = shown.until("the label", lambda: shown.find("figure-label-value").get_attribute("value")).split(" ")[0]
        assert abs(float(point.split(",")[2]) - float(place[1])) < 1e-3, (point, place)
        shown.find("figure-close").click()
        shown.find("forget-measures").click()
        shown.press("v")
        width, height, _ = shown.pixels()
        subprocess.run([program, "render", out / "forms.pbrt", f"--clip=z={place[1]}", "--size", f"{width}x{height}", "--spp", "2", "-q", "-o", out / "cut.exr", "-o", out / "cut-there.png"], check=True)
        there = png_pixels(shown, out / "cut-there.png")
        same, other = page_test.mean_difference(half, there), page_test.mean_difference(at.first, there)
        assert same < 0.65 * other, (same, other)  # both have the noise of two samples
        shown.script("const s = document.getElementById('clip-share'); for (const v of [40, 30, 20]) { s.value = v; s.dispatchEvent(new Event('input')); } s.dispatchEvent(new Event('change'))")
        at.changed("less of it")
        less = at.before
        shown.find("keep").click()
        # One gesture is one step.
        shown.find("undo").click()
        shown.until("half of it again", lambda: shown.apart(half, 2) == 0)
        shown.find("undo").click()
        shown.until("all of it", lambda: shown.apart(at.first, 2) == 0)
        assert shown.find("clip").get_attribute("value") == "off"
        shown.driver.find_element(By.CSS_SELECTOR, "#kept button").click()
        shown.until("the saved view's plane", lambda: shown.apart(less, 2) == 0)
        shown.press("0")
        shown.until("the scene's own", lambda: shown.apart(at.first, 2) == 0)


def labels(program, scenes, out):
    """A click with the tool asks for words, which stay at their point and stand in the figure."""
    with work(program, out) as at:
        shown = at.shown
        width, height, _ = shown.pixels()
        told = lambda: shown.script("return [...document.querySelectorAll('#notes text.label')].map((t) => t.textContent)")
        shown.press("t")
        shown.mouse(width // 2, height // 2).click().perform()
        field = shown.until("the field for words", lambda: shown.driver.find_elements(By.ID, "label-words"))[0]
        field.send_keys("the ball; red", Keys.ENTER)
        assert shown.until("the label", lambda: told()) == ["the ball; red"]
        spot = shown.script("const c = document.querySelector('#notes circle'); return [+c.getAttribute('cx'), +c.getAttribute('cy')]")
        assert math.dist([v * RATIO for v in spot], (width / 2, height / 2)) < 3, (spot, width, height)
        shown.mouse(width // 3, height * 3 // 4).click().perform()
        shown.until("another field", lambda: shown.driver.find_elements(By.ID, "label-words"))[0].send_keys("none", Keys.ESCAPE)
        shown.until("no field", lambda: not shown.driver.find_elements(By.ID, "label-words"))
        assert told() == ["the ball; red"]
        assert not shown.words("#tree [aria-selected=true]"), "a label selects nothing"
        shown.press(Keys.ARROW_LEFT)
        shown.until("it moves with the scene", lambda: shown.script("return +document.querySelector('#notes circle').getAttribute('cx')") != spot[0] or None)
        shown.script("document.getElementById('figure-open').click()")
        value = shown.until("the figure's labels", lambda: shown.find("figure-label-value").get_attribute("value"))
        point, words = value.split(" ", 1)
        assert words == "the ball, red" and len(point.split(",")) == 3 and shown.find("figure-label").is_selected(), value
        assert "--label=" in shown.script("return document.querySelector('dialog[open]').textContent")
        shown.find("figure-close").click()
        place = "const b = document.getElementById('forget-measures').getBoundingClientRect(); return [b.x, b.y]"
        for words in ("", "words " * 10, "words " * 100):
            shown.script("document.getElementById('under').textContent = arguments[0]", words)
            first = shown.script(place)
            shown.script("document.getElementById('state').textContent += arguments[0]", words)
            assert shown.script(place) == first, "the button stays under the pointer"
        shown.script("document.getElementById('under').textContent = ''")
        shown.find("forget-measures").click()
        assert not told()


def times(program, scenes, out):
    """A scene that moves has a slider for the time at which the shutter opens; one gesture is one change."""
    scene = page_test.editable(pathlib.Path(scenes) / "motion.pbrt", out)
    with page_test.viewer(program, scene, "--spp", "2") as served, page(served.address) as shown:
        at = page_forms_test.Work(shown)
        shown.tab("render")
        assert shown.find("time-box").is_displayed()
        low, high, now = (float(shown.find("time").get_attribute(name)) for name in ("min", "max", "value"))
        assert low < high and low <= now <= high, (low, high, now)
        shown.script("const s = document.getElementById('time'), to = (+s.min + 3 * +s.max) / 4; for (const v of [(+s.min + +s.max) / 2, to]) { s.value = v; s.dispatchEvent(new Event('input')); } s.dispatchEvent(new Event('change'))")
        at.changed("a later time")
        shown.until("the time", lambda: abs(float(shown.text("time-told")) - (low + 3 * high) / 4) < 1e-3 * (high - low))
        at.undo_all()
        assert abs(float(shown.find("time").get_attribute("value")) - now) < 1e-9
    with work(program, out) as at:
        at.shown.tab("render")
        assert not at.shown.find("time-box").is_displayed()


def controls(program, scenes, out):
    """Lists and sliders are drawn by the page, in its colours, and obey the keyboard; a list opens over the panel."""
    with work(program, out) as at:
        shown = at.shown
        shown.tab("camera")
        stereo = shown.find("stereo")
        drawn = shown.script("return CSS.supports('appearance: base-select')")
        assert drawn == (shown.script("return getComputedStyle(document.getElementById('stereo')).appearance") == "base-select")
        stereo.send_keys(Keys.ENTER if drawn else Keys.NULL)
        if drawn:
            shown.until("an open list", lambda: shown.script("return document.querySelector('#stereo:open') !== null"))
            boxes = shown.script("return [...document.querySelectorAll('#stereo option')].map((o) => o.getBoundingClientRect()).map((b) => [b.width, b.height])")
            assert len(boxes) == 4 and all(width > 60 and height >= 28 for width, height in boxes), boxes
            shown.picture(out / "list.png")
            shown.driver.switch_to.active_element.send_keys(Keys.ESCAPE)
            shown.until("a closed list", lambda: shown.script("return document.querySelector('#stereo:open') === null"))
            assert stereo.get_attribute("value") == "off"
            stereo.send_keys(Keys.ENTER)
            shown.driver.switch_to.active_element.send_keys("g", Keys.ARROW_DOWN, Keys.ENTER)  # no tool's key there
            assert shown.find("tool-select").get_attribute("aria-pressed") == "true"
        else:
            stereo.send_keys(Keys.ARROW_DOWN)
        at.changed("two eyes")
        assert stereo.get_attribute("value") == "sbs"
        shown.tab("render")
        exposure = shown.find("exposure")
        assert shown.script("return getComputedStyle(document.getElementById('exposure')).appearance") == "none"
        exposure.send_keys(Keys.ARROW_RIGHT)
        assert shown.text("stops") == "0.1", shown.text("stops")


def redraws(program, scenes, out):
    """A neuron is drawn in other colours; what is wrong is said at its field, and undo leads back."""
    scene = page_test.editable(pathlib.Path(scenes) / "neuron.swc", out)
    with page_test.viewer(program, scene, "--spp", "2") as served, page(served.address) as shown:
        at = page_forms_test.Work(shown)
        shown.tab("object")
        assert shown.find("redraw").is_displayed()
        field = shown.find("option-color")
        assert field.get_attribute("list") == "option-color-choices" and "order" in shown.words("#option-color-choices option")
        at.pick("option-color", "order")
        at.changed("colours by branch order")
        by_order = at.before
        at.pick("option-color", "nothing")
        note = shown.until("the error", lambda: shown.driver.find_elements(By.CSS_SELECTOR, "#option-color-error"))
        assert "nothing" in note[0].text, note[0].text
        assert shown.apart(by_order, 2) == 0
        at.pick("option-color", "depth")
        at.changed("colours by depth")
        shown.find("back").click()
        shown.until("by order again", lambda: shown.apart(by_order, 2) == 0)
        shown.until("what it is", lambda: shown.find("option-color").get_attribute("value") == "order")
        at.undo_all()
        assert shown.find("option-color").get_attribute("value") == ""


def wholes(program, scenes, out):
    """A file without a camera is seen whole in windows of any sides: its camera was made for a wide picture."""
    folder = out / "whole"
    folder.mkdir(exist_ok=True)
    (folder / "row.xyz").write_text("5\n\n" + "".join(f"C {2 * i} 0 0\n" for i in range(5)))
    with page_test.viewer(program, folder / "row.xyz", "--spp", "2") as served, page(served.address) as shown:
        def share():
            """Of the width, how much the row takes; 0 where it reaches an edge."""
            width, height, rgba = shown.pixels()
            seen = [x for x in range(width) if max(rgba[4 * x::4 * width]) > 100]
            return 0 if not seen or seen[0] == 0 or seen[-1] == width - 1 else (seen[-1] - seen[0]) / width
        # Of the program's picture the row takes 0.95; here its bounds, which are larger, take the width.
        shown.until("the whole row", lambda: shown.samples() >= 2 and 0.7 < share() < 0.97)
        shown.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": True})
        shown.until("less than the row", lambda: share() == 0 and shown.samples() >= 2)
        shown.press("0")
        shown.until("the whole row on a phone", lambda: shown.samples() >= 2 and 0.7 < share() < 0.97)
        shown.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


LAYOUT = """const box = (id) => document.getElementById(id).getBoundingClientRect(), tops = [...document.querySelectorAll('#bar button')].filter((b) => b.checkVisibility()).map((b) => b.getBoundingClientRect().top);
    const stage = box('stage'), covered = ['file-tools', 'view-tools', 'rail', 'line', 'under', 'hint'].map(box).reduce((sum, b) => sum + b.width * b.height, 0);
    return { rows: new Set(tops.map(Math.round)).size, share: covered / stage.width / stage.height, panel: document.getElementById('panel').checkVisibility(), stage: stage.width, tops: tops.length };"""


FIGURE = """const done = arguments[0], image = document.getElementById('figure-image'), canvas = document.createElement('canvas');
image.decode().then(() => {
  canvas.width = image.naturalWidth; canvas.height = image.naturalHeight;
  const brush = canvas.getContext('2d');
  brush.drawImage(image, 0, 0);
  done([canvas.width, canvas.height, [...brush.getImageData(0, 0, canvas.width, canvas.height).data]]);
});"""


def figure(program, scenes, out):
    """A figure is the picture that the command beside it makes of the saved scene; it can be ended; fields say what is wrong."""
    with work(program, out) as at:
        shown = at.shown
        shown.press(Keys.ARROW_LEFT)  # a view that is not the file's

        def fill(name, words):
            field = shown.find(name)
            field.clear()
            field.send_keys(words)

        # The figure has the exposure that is shown; the slider's comes after the automatic one.
        slide = "const slider = document.getElementById('exposure'); slider.value = arguments[0]; slider.oninput()"
        tick = "document.getElementById('auto-exposure').click()"
        asked = []
        for stops, ticks in ((0, True), (-1, True), (0, False), (-1, False)):
            shown.script(slide, stops)
            if shown.script("return document.getElementById('auto-exposure').checked") != ticks:
                shown.script(tick)
            shown.find("export-button").click()
            shown.find("figure-open").click()
            shown.until("the dialog", lambda: shown.find("figure").is_displayed())
            asked += [[word[len("--exposure="):] for word in shown.text("figure-command").split() if word.startswith("--exposure=")]]
            if (stops, ticks) != (-1, False):
                shown.find("figure-close").click()
        metered = float(asked[1][0])
        assert asked == [["auto"], [f"{metered:.2f}"], [], ["-1.00"]] and abs(metered + 1) > 0.01, asked
        box = shown.find("stage").rect
        assert abs(int(shown.find("figure-width").get_property("value")) / int(shown.find("figure-height").get_property("value")) - box["width"] / box["height"]) < 0.01
        fill("figure-width", "0")
        assert "from 1 to 4096" in shown.text("figure-width-error") and shown.text("figure-command") == ""
        fill("figure-width", "192")
        fill("figure-height", "2*54")
        fill("figure-samples", "16384")
        shown.find("figure-go").click()
        shown.until("progress", lambda: "Rendering, " in shown.text("figure-said"))
        shown.find("figure-go").click()
        assert shown.text("figure-said") == "Ended." and not shown.find("figure-save").is_enabled()
        fill("figure-samples", "4")
        fill("figure-background", "nowhere.png")
        shown.find("figure-go").click()
        shown.until("a refusal", lambda: "nowhere.png" in shown.text("figure-said"))
        fill("figure-background", "white")
        for name, value in (("axes", None), ("outline", "2"), ("depth-cue", None)):
            shown.find(f"figure-{name}").click()
            if value:
                fill(f"figure-{name}-value", value)
        shown.find("figure-go").click()
        shown.until("the figure", lambda: shown.find("figure-save").is_enabled())
        width, height, made = shown.driver.execute_async_script(FIGURE)
        shown.picture(out / "figure.png")
        command = shown.text("figure-command").split()
        assert command == f"caplet render forms.pbrt --size 192x108 --spp 4 --background white --exposure=-1.00 --outline=2 --depth-cue --axes -o forms.png".split(), command
        shown.find("figure-close").click()
        shown.find("menu-button").click()
        shown.find("menu-save").click()
        shown.until("the saving dialog", lambda: shown.find("keeping").is_displayed())
        shown.find("save_camera").click()
        fill("save_name", "figured.pbrt")
        shown.find("save_now").click()
        shown.until("the file", lambda: (out / "figured.pbrt").exists())
        subprocess.run([program, *command[1:2], out / "figured.pbrt", *command[3:-1], out / "figured.png", "-q"], check=True)
        again = shown.driver.execute_async_script("""const done = arguments[1], image = new Image();
image.src = arguments[0];
image.decode().then(() => {
  const canvas = document.createElement('canvas');
  canvas.width = image.naturalWidth; canvas.height = image.naturalHeight;
  const brush = canvas.getContext('2d');
  brush.drawImage(image, 0, 0);
  done([...brush.getImageData(0, 0, canvas.width, canvas.height).data]);
});""", "data:image/png;base64," + base64.b64encode((out / "figured.png").read_bytes()).decode())
        assert (width, height) == (192, 108) and len(again) == len(made)
        apart = [abs(a - b) for a, b in zip(made, again)]
        # The file has the camera in decimal numbers, so that single samples may pass an edge on the other side.
        assert sum(d > 0 for d in apart) <= 0.001 * len(apart), (sum(d > 0 for d in apart), max(apart))
        assert made[:4] == [255, 255, 255, 255], made[:4]


def screens(program, scenes, out):
    """Wide, middle and phone, dark and light: one row of buttons, the panel beside, over or below the picture; axe-core finds nothing."""
    found = sorted(pathlib.Path(program).resolve().parents[2].glob("python-env/lib/*/site-packages/axe_core_python/axe.min.js"))
    if not found:
        print("SKIPPED: axe-core (PyPI: axe-core-python) is not in python-env")
    with work(program, out) as at:
        shown = at.shown
        at.choose("pill")
        for scheme in ("dark", "light"):
            shown.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            for width, height in ((1440, 900), (1008, 700), (390, 844)):
                shown.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 700})
                shown.until("a picture of this width", lambda: shown.script("return document.getElementById('picture').width === Math.round(document.getElementById('stage').clientWidth)"))
                shown.until_samples(1)
                shown.picture(out / f"{width}_{scheme}.png")
                now = shown.script(LAYOUT)
                assert now["rows"] == 1 and now["tops"] >= 8, now
                assert now["panel"] == (width >= 1100) and now["share"] < 0.15, now
                assert now["stage"] == (width - 320 if width >= 1100 else width), now
                if width < 1100:
                    shown.press("n")
                    assert shown.script(LAYOUT)["panel"] and shown.script(LAYOUT)["stage"] == width
                    shown.picture(out / f"{width}_{scheme}_panel.png")
                for name in PAGES if found else ():
                    shown.tab(name)
                    shown.script(found[0].read_text(encoding="utf-8"))
                    wrong = shown.driver.execute_async_script("const done = arguments[0]; axe.run(document, { resultTypes: ['violations'] }).then((r) => done(r.violations.map((v) => [v.id, v.nodes.slice(0, 3).map((n) => n.html.slice(0, 160))])))")
                    assert not wrong, (width, scheme, name, wrong)
                shown.tab("object")
                if width < 700:
                    for part in (1 / 3, 2 / 3, (height - 52) / height):
                        shown.until(f"a sheet of {part}", lambda: abs(shown.find("panel").rect["height"] / height - part) < 0.01, 5)
                        shown.find("grip").send_keys(Keys.ENTER)
                if width < 1100:
                    shown.press("n")
        shown.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        shown.until("the panel", lambda: shown.find("panel").is_displayed())
        edge = shown.find("edge")
        for _ in range(3):
            edge.send_keys(Keys.ARROW_LEFT)
        assert shown.find("panel").rect["width"] == 368, shown.find("panel").rect
        shown.press("n")
        assert not shown.find("panel").is_displayed()
        shown.driver.refresh()
        shown.until("the page again", lambda: shown.samples() >= 1)
        assert not shown.find("panel").is_displayed(), "the fold is remembered"
        shown.press("n")
        assert shown.find("panel").rect["width"] == 368, "so is the width"
        shown.script("localStorage.clear()")


MODULES = """const done = arguments[0], out = {};
(async () => {
  const [{ value_of }, { Progress }, { Picture }, { KEYS, action_of }, { texts }] = await Promise.all(['numbers', 'progress', 'picture', 'keys', 'texts'].map((name) => import(`./${name}.js`)));
  out.values = ['2*0.35', '-(1+2)/4', '1-2-3', '12/4/3', '2+3*4', '(2+3)*4', '1e-3', '.5', '--1', '', '1 2', '3-', '(1', 'x', '2**3'].map((text) => String(value_of(text)));
  // 64 samples wanted: 4 at the time 10, 20 at 14 are 16 in 4 seconds, so that 44 more take 11.
  const progress = new Progress(), seen = (view, samples, now, noise = 0, wanted = 0, scale = 1) => progress.sees({ view, samples, noise, scale }, 64, wanted, now);
  out.times = [seen(1, 4, 10), seen(1, 20, 14), seen(1, 64, 30), seen(2, 1, 31), seen(2, 1, 31, 0, 0, 4)];
  // A noise of 1 % wanted: 4 % are a sixteenth, 2 % a quarter.
  out.noises = [seen(3, 1, 0, 0.04, 0.01), seen(3, 4, 3, 0.02, 0.01)];
  const picture = new Picture(), half = { 0.5: 0x3800, 1: 0x3c00, 0: 0 };
  Object.assign(picture, { width: 9, height: 7, samples: 1, color: new Uint16Array(3 * 63) });
  for (let i = 0; i < 63; ++i) picture.color.set([half[1], half[i % 2 ? 1 : 0], half[0]], 3 * i);
  out.soft = [...picture.linear()];
  picture.samples = 2;
  out.hard = [...picture.linear()];
  const covered = new Picture(), light = { 0.25: 0x3400, 3: 0x4200 };
  Object.assign(covered, { width: 4, height: 1, samples: 2, color: new Uint16Array(12), alpha: Uint16Array.of(half[0.5], half[0], half[1], half[0.5]) });
  covered.color.set([light[0.25], light[0.25], 0, 0, 0, 0, half[1], 0, 0, light[3], light[3], light[3]]);
  out.under = [[0, "film", [1, 1, 1]], [1, "srgb", [1, 1, 1]], [0, "film", [0.25, 0.5, 1]], [0, "srgb", "transparent"]].map((how) => [...covered.shown(...how)]);
  // 94 of 100 pixels are dark, and 6 have a green of 0.25; of the second picture these are not of an object.
  const metered = (more) => { const it = new Picture(); Object.assign(it, { width: 10, height: 10, samples: 2, color: new Uint16Array(300) }, more); for (let i = 0; i < 100; ++i) it.color.set([0x1400, i < 94 ? 0 : light[0.25], 0], 3 * i); return it.metered(); };
  out.metered = [metered({}), metered({ objects: Uint32Array.from({ length: 100 }, (_, i) => i < 94 ? 7 : 0xffffffff) }), metered({ alpha: new Uint16Array(100).fill(half[0.5]) }), metered({ alpha: new Uint16Array(100) })];
  const all = KEYS.flatMap(([, ...keys]) => keys);
  out.twice = all.filter((key, i) => all.indexOf(key) !== i);
  out.unnamed = KEYS.map(([action]) => action).filter((action) => !texts.actions[action]);
  out.wrong = KEYS.flatMap(([action, ...keys]) => keys.map((name) => [action, name])).filter(([action, name]) => {
    const parts = name.split(' '), key = parts.pop(), is = (held) => parts.includes(held), letter = /^[A-Z]$/.test(key);
    const event = { key: letter && !is('Shift') ? key.toLowerCase() : key, code: /^[0-9]$/.test(key) ? `Numpad${key}` : '', ctrlKey: is('Ctrl'), altKey: is('Alt'), shiftKey: is('Shift') || key === '?', metaKey: false };
    return action_of(event) !== action;
  });
  out.free = [{ key: 'v', ctrlKey: true }, { key: 'c', ctrlKey: true }, { key: 'q' }, { key: 'F5' }].map((event) => action_of(event) ?? null);
  done(out);
})();"""


def modules(program, scenes, out):
    """Arithmetic, time left, keys and the hues of one sample by closed forms; the corner's axes by the camera of the file."""
    with work(program, out) as at:
        shown = at.shown
        got = shown.driver.execute_async_script(MODULES)
        assert got["values"] == ["0.7", "-0.75", "-4", "1", "14", "20", "0.001", "0.5", "1"] + 6 * ["NaN"], got["values"]
        assert [t["seconds"] for t in got["times"]] == [None, 11, None, None, None], got["times"]
        assert [t["share"] for t in got["times"]] == [4 / 64, 20 / 64, 1, 1 / 64, 0], got["times"]
        # A sixteenth, and 3 seconds later a quarter: 3 / (3 / 16) seconds for one, three quarters of it left.
        assert got["noises"] == [{"share": 1 / 16, "seconds": None}, {"share": 1 / 4, "seconds": 12}], got["noises"]
        def film(v):  # docs/output.md, "Previews"
            m = max(v)
            to = 1 - math.exp(-(2 * m - 1)) / 2
            white = 1 - 1 / (1 + (m - to) / 8)
            return v if m <= 0.5 else [c * to / m * (1 - white) + to * white for c in v]

        def bytes_of(v):
            return [round(255 * (12.92 * c if c <= 0.0031308 else 1.055 * c**(1 / 2.4) - 0.055)) for c in v]

        # Coverage 1/2, 0, 1 and 1/2; light of shapes, multiplied by it; a checker's first square is dark.
        pixels = [(0.5, [0.25, 0.25, 0]), (0, [0, 0, 0]), (1, [1, 0, 0]), (0.5, [3, 3, 3])]
        for shown_as, (stops, curve, under) in zip(got["under"], [(0, film, [1, 1, 1]), (1, list, [1, 1, 1]), (0, film, [0.25, 0.5, 1]), (0, list, [0.32] * 3)]):
            for i, (a, light) in enumerate(pixels):
                shapes = curve([2**stops * c / a for c in light]) if a else light
                wanted = bytes_of([a * min(1, s) + (1 - a) * u for s, u in zip(shapes, under)])
                now = shown_as[4 * i:4 * i + 4]
                assert max(abs(p - q) for p, q in zip(now, wanted)) <= 1 and now[3] == 255, (stops, curve, i, now, wanted)  # steps of 1/4096
        # The light that a twentieth exceeds becomes 0.8, to within a 32nd of a stop: 1/4, 2^-10, and 1/2 of half a pixel.
        for now, wanted in zip(got["metered"], [math.log2(0.8 * 4), math.log2(0.8 * 1024), math.log2(0.8 * 2)]):
            assert abs(now - wanted) <= 1 / 32 + 1e-6, (now, wanted)
        assert got["metered"][3] == 0, got["metered"]
        hard, soft = got["hard"], got["soft"]
        assert hard == [v for i in range(63) for v in (1, i % 2, 0)], hard[:12]
        for i in range(63):
            pixels = [9 * y + x for y in range(max(0, i // 9 - 2), min(7, i // 9 + 3)) for x in range(max(0, i % 9 - 2), min(9, i % 9 + 3))]
            near = [sum(hard[3 * k + c] for k in pixels) for c in range(3)]
            own, sums = (0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2] for v in (hard[3 * i:3 * i + 3], near))
            assert all(abs(soft[3 * i + c] - own * near[c] / sums) < 1e-6 for c in range(3)), (i, soft[3 * i:3 * i + 3])
        assert not got["twice"] and not got["unnamed"] and not got["wrong"], got
        assert got["free"] == [None, None, None, None], got["free"]
        # The file's camera: LookAt 4 -5 3  0 0 0.3  0 0 1, mirrored along x as pbrt's are.
        forward = [v / math.hypot(4, 5, 2.7) for v in (-4, 5, -2.7)]
        right = [v / math.hypot(forward[0], forward[1]) for v in (forward[1], -forward[0], 0)]
        up = [right[1] * forward[2] - right[2] * forward[1], right[2] * forward[0] - right[0] * forward[2], right[0] * forward[1] - right[1] * forward[0]]
        for i, name in enumerate("xyz"):
            x, y = shown.script("const c = document.querySelector(`#gizmo [aria-label='from +${arguments[0]}'] circle`); return [+c.getAttribute('cx'), +c.getAttribute('cy')]", name)
            assert abs(x + 28 * right[i]) < 1e-3 and abs(y + 28 * up[i]) < 1e-3, (name, x, y, right, up)
        shown.press("7")
        at.changed("from above by its key")
        above = at.before
        shown.press("0")
        shown.until("the scene's camera", lambda: shown.apart(at.first, 2) == 0)
        shown.driver.find_element(By.CSS_SELECTOR, "#gizmo [aria-label='from +z']").click()
        shown.until("from above by the corner's axis", lambda: shown.apart(above, 2) == 0)
        for keys, tip in ((("1",), "−y"), (("3",), "+x"), ((Keys.SHIFT, "1"), "+y"), ((Keys.SHIFT, "3"), "−x"), ((Keys.SHIFT, "7"), "−z")):
            at.before = above
            shown.press(*keys)
            at.changed(f"the view by {keys}")
            seen = at.before
            shown.press("7")
            shown.until("from above", lambda: shown.apart(above, 2) == 0)
            shown.script("document.querySelector(`#gizmo [aria-label='from ${arguments[0]}']`).dispatchEvent(new MouseEvent('click'))", tip)
            shown.until(f"the same from {tip}", lambda: shown.apart(seen, 2) == 0)
            shown.press("7")
            shown.until("from above", lambda: shown.apart(above, 2) == 0)
        at.choose("pill")
        shown.press("f")
        box, (x, y) = shown.find("stage").rect, shown.until("the pill in the middle", lambda: shown.script("const c = document.querySelector('[data-handle=plane]'); return c && [+c.getAttribute('cx'), +c.getAttribute('cy')]"))
        assert abs(x - box["width"] / 2) < 1 and abs(y - box["height"] / 2) < 1, (x, y, box)


CASES = [modules, tools, measures, inspects, numbers, never_waits, links, paths, clips, times, controls, redraws, wholes, labels, figure, screens]


if __name__ == "__main__":
    sys.exit(page_test.main(sys.argv[1:], __doc__, CASES))
