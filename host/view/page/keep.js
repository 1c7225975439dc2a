// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Saving and unsaved changes: the program keeps them; the page shows them, and asks before anything is lost.
import { texts } from "./texts.js";

const words = texts.keeping;
const make = (name, properties, ...children) => {
  const out = Object.assign(document.createElement(name), properties);
  out.append(...children);
  return out;
};

export class Keep {
  // `say` sends a message; `title` shows the mark of unsaved changes.
  constructor({ say, stage, tools, aside, title }) {
    Object.assign(this, { say, title });
    this.now = { unsaved: false, kept: true };
    this.read_only = true;
    this.asked = false;
    this.button = make("button", { id: "save", textContent: words.save, title: words.keys, onclick: () => this.save() });
    tools.prepend(this.button);
    this.name = make("input", { id: "save_name", autocomplete: "off", maxLength: 200, oninput: () => this.name.removeAttribute("aria-invalid") });
    this.name.addEventListener("keydown", (event) => { if (event.key === "Enter") this.save(); });
    this.camera = make("input", { id: "save_camera", type: "checkbox" });
    this.said = make("p", { id: "save_said" });
    this.said.setAttribute("role", "status");
    this.discard = make("button", { id: "discard", textContent: words.discard, disabled: true, onclick: () => this.drop() });
    this.section = make("section", { id: "keeping", hidden: true }, make("h2", { textContent: words.title }),
      make("label", {}, make("span", { textContent: words.name }), " ", this.name),
      make("label", {}, make("span", { textContent: words.camera }), " ", this.camera),
      make("p", { className: "row" }, this.discard), this.said);
    aside.append(this.section);
    this.note = make("div", { id: "kept_note", hidden: true });
    this.note.setAttribute("role", "alert");
    for (const type of ["pointerdown", "dblclick", "keydown", "wheel"]) this.note.addEventListener(type, (event) => event.stopPropagation());
    stage.append(this.note);
    document.addEventListener("keydown", (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || event.shiftKey || event.key.toLowerCase() !== "s") return;
      event.preventDefault();
      if (!this.read_only) this.save();
    });
    // Changes that are kept are not lost with the page.
    window.addEventListener("beforeunload", (event) => { if (this.now.unsaved && !this.now.kept) event.preventDefault(); });
  }

  begin(scene) {
    this.read_only = scene.read_only;
    this.section.hidden = this.button.hidden = scene.read_only;
    this.asked = false;
    this.closed = null;
    if (scene.keep) this.told(scene.keep);
  }

  told(keep) {
    const before = this.now.name;
    this.now = keep;
    if (keep.name !== before) this.name.value = keep.name ?? "";  // an empty field is one that somebody is filling
    this.discard.disabled = !keep.unsaved;
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
      button("forget_old", words.forget, () => { if (window.confirm(words.forget_asks(old))) this.say({ type: "kept", restore: false }); }));
    else this.note.replaceChildren(words.restored(restored), " ", button("drop_restored", words.discard, () => this.drop()), " ",
      button("close_note", texts.close, () => { this.closed = what; this.notice(); }));
  }

  save(name = this.name.value.trim(), replace = false, camera = this.camera.checked) {
    if (this.read_only) return;
    this.asked = true;
    this.say({ type: "save", name: name || null, camera, replace });
  }
  drop() { if (window.confirm(words.discard_asks)) this.say({ type: "discard" }); }

  asks({ name, camera, why }) {
    this.asked = false;
    if (window.confirm(words.replace_asks(name, why))) this.save(name, true, camera);
  }
  saved({ name, file }) {
    this.asked = false;
    this.said.textContent = words.saved(file);
    this.just_saved = true;
    this.name.value = name;
    this.name.removeAttribute("aria-invalid");
  }
  // Shows why the program could not save.
  failed(text) {
    if (!this.asked) return;
    this.asked = false;
    this.said.textContent = text;
    if (text.startsWith("name")) this.name.setAttribute("aria-invalid", "true");
  }
}
