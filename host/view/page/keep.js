// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Saving and unsaved changes: the program keeps them; the page shows them, and asks before anything is lost.
import { question, tell } from "./dialog.js";
import { make } from "./elements.js";
import { texts } from "./texts.js";

const words = texts.keeping;

export class Keep {
  // `say` sends a message; `button` saves; `title` shows the mark of unsaved changes.
  constructor({ say, button, banners, title }) {
    Object.assign(this, { say, title, button });
    this.now = { unsaved: false, kept: true };
    this.read_only = true;
    this.asked = false;
    button.onclick = () => this.save();
    this.name = make("input", { id: "save_name", autocomplete: "off", maxLength: 200, oninput: () => this.name.removeAttribute("aria-invalid") });
    this.name.addEventListener("keydown", (event) => { if (event.key === "Enter") { event.preventDefault(); this.save(); } });
    this.camera = make("input", { id: "save_camera", type: "checkbox" });
    this.said = make("p", { id: "save_said" });
    this.said.setAttribute("role", "status");
    this.dialog = make("dialog", { id: "keeping" }, make("h2", { textContent: words.title }),
      make("p", {}, make("label", {}, make("span", { textContent: words.name }), " ", this.name)),
      make("p", {}, make("label", {}, this.camera, " ", make("span", { textContent: words.camera }))), this.said,
      make("p", { className: "row" }, make("button", { textContent: texts.close, onclick: () => this.dialog.close() }), make("button", { id: "save_now", className: "main", textContent: words.save, onclick: () => this.save() })));
    document.body.append(this.dialog);
    this.note = make("div", { id: "kept_note", hidden: true });
    this.note.setAttribute("role", "alert");
    banners.append(this.note);
    document.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.key.toLowerCase() !== "s") return;
      event.preventDefault();
      if (!this.read_only) event.shiftKey ? this.open() : this.save();
    });
    // Changes that are kept are not lost with the page.
    window.addEventListener("beforeunload", (event) => { if (this.now.unsaved && !this.now.kept) event.preventDefault(); });
  }

  open() { if (!this.read_only && !this.dialog.open) this.dialog.showModal(); }

  begin(scene) {
    this.read_only = scene.read_only;
    this.button.hidden = scene.read_only;
    this.asked = false;
    this.closed = null;
    if (scene.keep) this.told(scene.keep);
  }

  told(keep) {
    const before = this.now.name;
    this.now = keep;
    if (keep.name !== before) this.name.value = keep.name ?? "";  // an empty field is one that somebody is filling
    this.title(keep.unsaved);
    const is = keep.unsaved ? keep.kept ? "unsaved" : "not kept" : "saved";
    if (is !== this.is) {  // otherwise the text may say why saving failed
      if (keep.unsaved) this.said.textContent = keep.kept ? words.unsaved : words.not_kept(keep.why);
      else if (!this.just_saved) this.said.textContent = "";
    }
    this.is = is;
    this.just_saved = false;
    this.notice();
  }

  // Shows the changes of an earlier session.
  notice() {
    const { old, restored } = this.now, what = this.read_only ? "" : old ? `old ${old}` : restored ? `restored ${restored}` : "";
    this.note.hidden = !what || what === this.closed;
    if (this.note.hidden || this.note.dataset.what === what) return;
    this.note.dataset.what = what;
    const button = (id, text, onclick) => make("button", { id, textContent: text, onclick });
    if (old) this.note.replaceChildren(words.old(old), " ", button("restore_old", words.restore, () => this.say({ type: "kept", restore: true })), " ",
      button("forget_old", words.forget, async () => { if (await question(words.forget_asks(old), words.forget, texts.cancel)) this.say({ type: "kept", restore: false }); }));
    else this.note.replaceChildren(words.restored(restored), " ", button("drop_restored", words.discard, () => this.drop()), " ",
      button("close_note", texts.close, () => { this.closed = what; this.notice(); }));
  }

  save(name = this.name.value.trim(), replace = false, camera = this.camera.checked) {
    if (this.read_only) return;
    this.asked = true;
    this.say({ type: "save", name: name || null, camera, replace });
  }
  async drop() { if (this.now.unsaved && await question(words.discard_asks, words.discard, texts.cancel)) this.say({ type: "discard" }); }

  async asks({ name, camera, why }) {
    this.asked = false;
    if (await question(words.replace_asks(name, why), words.replace, texts.cancel)) this.save(name, true, camera);
  }
  saved({ name, file }) {
    this.asked = false;
    this.said.textContent = words.saved(file);
    tell(words.saved(file));
    this.dialog.close();
    this.just_saved = true;
    this.name.value = name;
    this.name.removeAttribute("aria-invalid");
  }
  // Shows why the program could not save; returns whether it was asked to.
  failed(text) {
    if (!this.asked) return false;
    this.asked = false;
    this.said.textContent = text;
    if (!this.dialog.open) this.dialog.showModal();
    if (text.startsWith("name")) this.name.setAttribute("aria-invalid", "true");
    return true;
  }
}
