#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
# Copyright Caplet authors
"""Forms, new and hidden things, other cameras and the reach of all controls in the page of `caplet view`, in a real browser.

usage: page_forms_test.py PROGRAM SCENES FOLDER [NAME...]   as page_test.py
"""
import contextlib
import pathlib
import sys
import time

import page_test
from page_test import PIXELS, RATIO, ActionChains, By, Keys, decoded, mean_difference, page, viewer

SCENE = """
LookAt 4 -5 3  0 0 0.3  0 0 1
Camera "perspective" "float fov" [ 40 ]
Film "rgb" "integer xresolution" [ 64 ] "integer yresolution" [ 48 ]
WorldBegin
LightSource "infinite" "rgb L" [ 0.4 0.45 0.5 ]
LightSource "point" "rgb I" [ 20 18 16 ] "point3 from" [ 3 -3 5 ]
Texture "board" "spectrum" "checkerboard" "rgb tex1" [ 0.8 0.2 0.1 ] "rgb tex2" [ 0.1 0.2 0.8 ]
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.7 0.1 0.1 ]
MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
MakeNamedMaterial "boarded" "string type" "diffuse" "texture reflectance" [ "board" ]
NamedMaterial "white"
Shape "disk" "float radius" [ 6 ] "float height" [ -0.8 ] "string name" "floor"
NamedMaterial "red"
Shape "sphere" "float radius" [ 0.8 ] "string name" "ball"
NamedMaterial "white"
Shape "box" "point3 p0" [ 1 1 -0.8 ] "point3 p1" [ 2 2 0.5 ] "string name" "box"
NamedMaterial "boarded"
Shape "capsule" "point3 p0" [ -1.5 0 0 ] "point3 p1" [ -1.5 1 0.5 ] "float radius" [ 0.3 ] "string name" "pill"
"""


class Work:
    """A page with the scene, and what one does with it."""

    def __init__(self, shown):
        self.shown = shown
        self.first = self.before = shown.until("a picture of the page's size", self.whole)

    def whole(self):
        """What is shown, once it is of the page's size and done; before that nothing."""
        now = self.shown.script(f"""const c = document.getElementById('picture'), s = document.getElementById('stage');
            return +s.dataset.samples >= 2 && Math.abs(c.width - {RATIO} * s.clientWidth) <= 2 ? {PIXELS} : null""")
        return decoded(*now) if now else None

    def edits(self):
        return int(self.shown.find("stage").get_attribute("data-edits") or 0)

    def changed(self, what):
        self.before = self.shown.until(f"{what}: another picture", lambda: (now := self.whole()) and mean_difference(self.before, now) > 0 and now)

    def choose(self, name):
        self.shown.click("#tree li", name)
        self.shown.until(f"what {name} is", lambda: self.shown.find("edit").is_displayed() and len(self.shown.driver.find_elements(By.CSS_SELECTOR, "#surface option")) > 1)

    def open(self, form):
        self.shown.script("const d = document.getElementById('form-' + arguments[0]); d.open = true; d.scrollIntoView({block: 'center'})", form)

    def field(self, form, name):
        """The input of a form's field, as soon as it is there."""
        find = f"#form-{form} [name='{name}']"
        self.shown.until(f"the field {name} of {form}", lambda: self.shown.driver.find_elements(By.CSS_SELECTOR, find))
        return self.shown.driver.find_element(By.CSS_SELECTOR, find)

    def put(self, form, name, value):
        self.field(form, name)
        self.shown.script("const n = document.querySelector(`#form-${arguments[0]} [name='${arguments[1]}']`); n.value = arguments[2]; n.dispatchEvent(new Event('change'))", form, name, value)

    def pick(self, name, value):
        self.shown.script("const s = document.getElementById(arguments[0]); s.value = arguments[1]; s.dispatchEvent(new Event('change'))", name, value)

    def undo_all(self):
        while self.shown.find("back").is_enabled():
            before = self.edits()
            self.shown.script("document.getElementById('back').click()")
            self.shown.until("the program's word", lambda: self.edits() > before)
        try:
            self.shown.until("the first picture again", lambda: self.shown.apart(self.first, 2) == 0)
        except AssertionError as error:
            width, _, then = self.first
            now = self.shown.pixels()[2]
            other = sorted({i // 4 for i, (a, b) in enumerate(zip(then, now)) if a != b})
            raise AssertionError(f"{error}; {len(other)} pixels differ, columns {min(i % width for i in other)} to {max(i % width for i in other)}, "
                                 f"rows {other[0] // width} to {other[-1] // width}; the first: {then[4 * other[0]:][:3]}, {now[4 * other[0]:][:3]}") from error


@contextlib.contextmanager
def work(program, out, *options, text=SCENE):
    scene = out / "forms.pbrt"
    scene.write_text(text)
    for left in out.glob(".forms.*"):  # unsaved changes of a case that failed
        left.unlink()
    with viewer(program, scene, "--spp", "2", *options) as served, page(served.address) as shown:
        one = Work(shown)
        one.address = served.address
        yield one


# --- Cases ---

def forms(program, scenes, out):
    """Parameters of a material, of a surface's, of a light and of the film; what is wrong is said at its field; all is taken back."""
    with work(program, out) as at:
        shown = at.shown
        at.choose("ball")
        at.put("material", "reflectance", "0.1 0.6 0.2")
        at.changed("a colour")
        at.put("material", "reflectance", "0.1 1.6 0.2")
        shown.until("a refusal at the field", lambda: "between" in shown.text("material-reflectance-error"))
        assert at.field("material", "reflectance").get_attribute("aria-invalid")
        assert mean_difference(at.before, shown.pixels()) == 0
        at.put("material", "kind", "conductor")
        at.changed("a metal")
        at.put("material", "alpha_u", "0.3")
        at.changed("a rough metal")
        at.put("material", "k kind", "name")
        at.put("material", "k", "metal-Ag-k")
        at.changed("a spectrum by name")
        at.pick("new-material", "dielectric")
        at.changed("glass of one's own")
        at.put("material", "name", "my glass")
        shown.tab("material")
        shown.until("its name", lambda: "my glass" in shown.words("#palette button"))
        shown.picture(out / "materials.png")
        shown.tab("object")
        at.choose("box")
        at.pick("surface", "5")
        shown.script("document.querySelector('#palette [data-material=\"0\"]').click()")
        at.changed("a surface painted from the palette")
        at.pick("light", "1")
        at.put("light", "scale", "3")
        at.changed("a brighter light")
        at.put("light", "kind", "spot")
        at.changed("a spot")
        with page(at.address) as other:
            other.until_samples(2)
            other.script("document.getElementById('light').value = '1'; document.getElementById('light').dispatchEvent(new Event('change'))")
            other.until("the other's light", lambda: other.driver.find_elements(By.CSS_SELECTOR, "#form-light [name=coneangle]"))
            kind = other.driver.find_element(By.CSS_SELECTOR, "#form-light [name=kind]").get_attribute("value")
            assert kind == "spot", kind
        at.pick("new-light", "distant")
        at.changed("a light of one's own")
        at.open("integrator")
        at.put("integrator", "maxdepth", "1")
        at.changed("shorter paths")
        at.open("film")
        at.put("film", "xresolution", "123")
        at.put("film", "iso", "50")
        at.changed("a darker film")
        shown.until("its width", lambda: at.field("film", "xresolution").get_attribute("value") == "123")
        shown.picture(out / "forms.png")
        at.undo_all()


def shapes(program, scenes, out):
    """New shapes come where the camera looks, selected."""
    with work(program, out) as at:
        shown = at.shown
        count = int(shown.find("more").text.split(" of ")[1])
        for i, button in enumerate(shown.driver.find_elements(By.CSS_SELECTOR, "#shapes button")):
            name = button.get_attribute("data-shape")
            shown.script("arguments[0].click()", button)
            shown.until(f"a new {name}", lambda: shown.find("more").text.endswith(f" of {count + i + 1}"))
            shown.until(f"{name} is selected", lambda: [t.split()[0] for t in shown.words("#tree [aria-selected=true]")] == [name.split(" ")[0]])
        at.changed("new shapes")
        width, height, _ = shown.pixels()
        shown.mouse(int(0.3 * width), int(0.8 * height)).perform()
        shown.until("what is under the cursor", lambda: "floor" in shown.find("under").text)
        shown.press(Keys.SHIFT, "a")
        at.changed("one under the cursor")
        shown.picture(out / "shapes.png")
        at.undo_all()


def hides(program, scenes, out):
    """What is hidden is neither seen nor met; all but what is selected likewise."""
    with work(program, out) as at:
        shown = at.shown
        width, height, _ = shown.pixels()
        shown.mouse(width // 2, height // 2).perform()
        shown.until("the ball", lambda: shown.find("under").text.startswith("ball"))
        at.choose("ball")
        shown.script("document.getElementById('hide').click()")
        at.changed("hidden")
        assert shown.find("more").text.endswith(" of 3"), shown.find("more").text
        assert shown.words("#hidden button") == ["Show ball"]
        shown.mouse(width // 2 + 3, height // 2).perform()
        shown.until("what is behind", lambda: shown.find("under").text and not shown.find("under").text.startswith("ball"))
        at.choose("box")
        shown.script("document.getElementById('isolate').click()")
        at.changed("alone")
        shown.until("it is still selected", lambda: [t.split()[0] for t in shown.words("#tree [aria-selected=true]")] == ["box"])
        assert shown.find("hidden-count").text.startswith("3")
        shown.picture(out / "isolated.png")
        shown.script("document.getElementById('show-all').click()")
        shown.until("all again", lambda: shown.apart(at.first, 2) == 0)
        assert not shown.find("hidden-box").is_displayed()
        at.undo_all()


def cameras(program, scenes, out):
    """Parallel rays and back; two eyes, each the camera moved by hand."""
    with work(program, out) as at:
        shown = at.shown
        shown.find("parallel").click()
        at.changed("parallel rays")
        assert shown.find("parallel").get_attribute("aria-pressed") == "true"
        shown.picture(out / "orthographic.png")
        shown.press(",")
        shown.until("the first view", lambda: shown.apart(at.first, 2) == 0)
        at.pick("stereo", "sbs")
        shown.until("both eyes", lambda: int(shown.find("stage").get_attribute("data-right") or 0) >= 2)
        width, height, both = shown.pixels()
        assert width >= at.first[0] - 2, (width, at.first[0])
        shown.picture(out / "stereo.png")
        half = width // 2
        rows = [both[4 * width * y:4 * width * (y + 1)] for y in range(height)]
        views = [[v for row in rows for v in row[4 * half * eye:4 * half * (eye + 1)]] for eye in (0, 1)]
        assert views[0] != views[1]
        # What is under the cursor is asked of the eye whose view that is.
        shown.script("""window.asked = []; const send = WebSocket.prototype.send;
            WebSocket.prototype.send = function (data) { const said = typeof data === 'string' && JSON.parse(data);
              if (said && said.type === 'ask') window.asked.push(said); return send.call(this, data); };""")
        for eye, x in ((0, half // 3), (1, half + half // 3), (0, half - 2), (1, half + 2)):
            shown.script("window.asked = []")
            shown.mouse(x, height // 2).perform()
            asked = shown.until("a question", lambda: shown.script("return window.asked.at(-1)"))
            assert asked["eye"] == eye and abs(asked["x"] - (x - eye * half)) <= 1, (asked, x, half)
        # The same by a camera that is moved by hand: parallel axes, so that its window stays.
        at.pick("convergence", "0")
        before = both

        def eyes_are_done():
            """Whether both eyes' pictures are new, and stay as they are."""
            now = shown.pixels()[2]
            rows = range(0, 4 * width * height, 4 * width)
            changed = [any(now[r + o:r + o + 4 * half] != before[r + o:r + o + 4 * half] for r in rows) for o in (0, 4 * half)]
            time.sleep(0.5)
            return all(changed) and int(shown.find("stage").get_attribute("data-right") or 0) >= 2 and shown.pixels()[2] == now
        shown.until("parallel axes", eyes_are_done)
        separation = float(shown.find("separation").get_attribute("value"))
        width, height, both = shown.pixels()
        rows = [both[4 * width * y:4 * width * (y + 1)] for y in range(height)]
        shown.script("""const s = new WebSocket(location.href.replace(/^http/, 'ws').replace(/[^/]*$/, '') + 'socket'); window.camera = null;
            s.onmessage = (e) => { if (typeof e.data === 'string' && JSON.parse(e.data).type === 'scene') { window.camera = JSON.parse(e.data).camera; s.close(); } };""")
        camera = shown.until("the camera", lambda: shown.script("return window.camera"))
        for eye, side in ((0, -0.5), (1, 0.5)):
            view = [v for row in rows for v in row[4 * half * eye:4 * half * (eye + 1)]]
            shown.script("""const {Picture} = await import('./picture.js');
                const s = new WebSocket(location.href.replace(/^http/, 'ws').replace(/[^/]*$/, '') + 'socket'); s.binaryType = 'arraybuffer';
                const p = new Picture(); window.by_hand = null; let turn = Promise.resolve(); window.other = s;
                s.onmessage = (e) => { turn = turn.then(async () => {
                  if (typeof e.data === 'string') { const m = JSON.parse(e.data); if (m.type !== 'scene') return;
                    const c = arguments[3], right = [0, 4, 8].map((i) => c.world_from_camera[i]); [3, 7, 11].forEach((i, k) => { c.world_from_camera[i] += arguments[0] * right[k]; });
                    s.send(JSON.stringify({...c, type: 'look', separation: 0, width: arguments[1], height: arguments[2]})); return; }
                  if (new DataView(e.data).getUint32(28, true) & 4) return;
                  await p.take(e.data);
                  if (p.view > arguments[4] && p.scale === 1 && p.samples >= 2 && p.width === arguments[1]) window.by_hand = Array.from(p.shown(0, 'film')); }); };
                s.onopen = () => s.send(JSON.stringify({type: 'seen', seen: true}));""", side * separation, half, height, camera, int(shown.find("stage").get_attribute("data-view")))
            shown.until("the view by hand", lambda: shown.script("return window.by_hand !== null"))
            assert shown.script("return window.by_hand") == view, eye
            shown.script("window.other.close()")


def handles(program, scenes, out):
    """Handles of planes, turns and sizes; in steps with Ctrl."""
    with work(program, out) as at:
        shown = at.shown
        at.choose("box")
        for name in ("plane-z", "turn-z", "scale", "turn-x"):
            shown.until(f"the handle {name}", lambda: shown.driver.find_elements(By.CSS_SELECTOR, f"[data-handle={name}]"))
            before = at.edits()
            # Where it is drawn, by its own first point.
            x, y = shown.script("""const n = document.querySelector(`[data-handle=${arguments[0]}]`), p = n.getPointAtLength(n.getTotalLength() * 0.13), b = n.ownerSVGElement.getBoundingClientRect();
                return [p.x + b.left, p.y + b.top];""", name)
            chain = ActionChains(shown.driver, duration=20)
            chain.w3c_actions.pointer_action.move_to_location(int(x), int(y))
            chain.w3c_actions.pointer_action.click_and_hold()
            chain.key_down(Keys.CONTROL)
            for k in (1, 2, 3):
                chain.w3c_actions.pointer_action.move_to_location(int(x) + 15 * k, int(y) + 9 * k)
            chain.w3c_actions.pointer_action.release()
            chain.key_up(Keys.CONTROL)
            chain.perform()
            shown.until(f"{name}: the program's word", lambda: at.edits() > before)
            at.changed(name)
        shown.picture(out / "all_handles.png")
        at.undo_all()


PAGES = ("object", "material", "light", "camera", "render")
NAMES = """return [...document.querySelectorAll('button, input, select, summary, a[href], [tabindex="0"]')].filter((n) => n.checkVisibility())"""


def within_reach(program, scenes, out):
    """Every control has a name and can be reached by Tab; nothing is cut off at 640 pixels, which is 200 % of 1280."""
    with work(program, out) as at:
        shown = at.shown
        at.choose("pill")
        shown.script("for (const d of document.querySelectorAll('details')) d.open = true")
        at.pick("light", "1")
        at.pick("texture", "0")
        for form in ("material", "light", "texture", "camera", "film", "filter", "sampler", "integrator"):
            shown.until(f"the form {form}", lambda: shown.driver.find_elements(By.CSS_SELECTOR, f"#form-{form} [name]"))
        for page_name in PAGES:
            shown.tab(page_name)
            controls = shown.script(NAMES)
            assert len(controls) > 40, (page_name, len(controls))
            nameless = [n.get_attribute("outerHTML")[:120] for n in controls if not n.accessible_name.strip()]
            assert not nameless, nameless
            # All that Tab comes to, from the first to where it comes round.
            enabled = shown.script(NAMES + ".filter((n) => !n.disabled && n.tabIndex >= 0).length")
            shown.script("document.activeElement.blur(); window.visited = new Set(); document.addEventListener('focusin', (e) => window.visited.add(e.target))")
            chain = ActionChains(shown.driver, duration=0)
            for _ in range(enabled + 4):
                chain.send_keys(Keys.TAB)
            chain.perform()
            missed = shown.script("return (" + NAMES.removeprefix("return ") + ").filter((n) => !n.disabled && n.tabIndex >= 0 && !window.visited.has(n)).map((n) => n.outerHTML.slice(0, 100))")
            assert not missed, missed
        for scheme in ("light", "dark"):
            shown.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
            shown.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": 640, "height": 512, "deviceScaleFactor": 2, "mobile": False})
            shown.until("the panel's fold", lambda: not shown.find("panel").is_displayed())
            for page_name in (None, *PAGES):  # first without the panel
                if page_name:
                    shown.script("document.body.classList.remove('folded'); document.getElementById('panel').dataset.height = 3")
                    shown.tab(page_name)
                cut = shown.script("""return [...document.querySelectorAll('button, input, select, summary, h1, h2, label')].filter((n) => n.checkVisibility()).filter((n) => {
                    const b = n.getBoundingClientRect(); return b.width > 0 && (b.left < -1 || b.right > innerWidth + 1); }).map((n) => n.outerHTML.slice(0, 100))""")
                assert not cut, cut
                assert shown.script("return document.documentElement.scrollWidth <= innerWidth")
                # Text against what is behind it (WCAG 2.1, 1.4.3).
                low = shown.script("""const lum = (c) => { const [r, g, b] = c.match(/[\\d.]+/g).map((v) => v / 255).map((v) => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
                    const behind = (n) => { for (; n; n = n.parentElement) { const c = getComputedStyle(n).backgroundColor; if (!/^rgba.*, 0\\)$/.test(c)) return c; } return 'rgb(255, 255, 255)'; };
                    return [...document.querySelectorAll('button, summary, h1, h2, label span, small, .field span, #tree li span, footer output')].filter((n) => n.checkVisibility() && n.textContent.trim() && !n.disabled).map((n) => {
                      const a = lum(getComputedStyle(n).color), b = lum(behind(n)); return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), n.outerHTML.slice(0, 80)]; }).filter(([ratio]) => ratio < 4.5)""")
                assert not low, low
                shown.picture(out / f"narrow_{scheme}_{page_name}.png")
            shown.driver.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
            shown.until("the panel beside the picture", lambda: shown.find("panel").is_displayed())


def figures(program, scenes, out):
    """The pictures of docs/viewer.md."""
    with viewer(program, page_test.editable(scenes / "gallery.pbrt", out), "--spp", "16") as served, page(served.address) as shown:
        at = Work(shown)
        shown.resize(1280, 800)
        at.choose("capsule 7")
        at.put("material", "kind", "conductor")
        at.put("material", "alpha_u", "0.25")
        at.put("material", "alpha_v", "0.25")
        shown.until("16 samples", lambda: shown.samples() >= 16, 400)
        shown.tab("material")
        shown.picture(out / "viewer-forms.png")


CASES = [forms, shapes, hides, cameras, handles, within_reach]

if __name__ == "__main__":
    sys.exit(page_test.main(sys.argv[1:], __doc__, CASES, figures))
