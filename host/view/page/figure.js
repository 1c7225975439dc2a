// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Figures: the program renders the view at a size of its own, with what is drawn on it; the page shows it before it is saved.
import { make } from "./elements.js";
import { complain, trouble_with, value_of } from "./numbers.js";
import { texts } from "./texts.js";

const words = texts.figure;
const quoted = (text) => /^[\w.,:/#%+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;

/// Returns the command that makes the figure of a file, as a shell takes it.
export function command_of(file, figure) {
  const stem = file.replace(/^.*\//, "").replace(/\.\w+$/, ""), out = ["caplet", "render", quoted(file), "--size", `${figure.width}x${figure.height}`, "--spp", figure.samples];
  if (figure.denoise) out.push("--denoise");
  if (figure.background !== null) out.push("--background", quoted(figure.background));
  if (figure.exposure !== null) out.push(`--exposure=${figure.exposure}`);
  if (figure.clip) out.push(`--clip=${[...figure.clip.normal].map((n) => +n.toPrecision(9)).join(",")}=${figure.clip.offset}`);
  for (const [name, value] of Object.entries(figure.drawn)) out.push(value ? `--${name}=${quoted(value)}` : `--${name}`);
  return [...out, "-o", quoted(`${stem}.png`)].join(" ");
}

export class Figure {
  // `ask(message, done)` sends a message with a number; `stop` ends the figure; `look` returns the view's message; `size` the stage's; `save` a file;
  // `exposure` what the page shows beside the scene's, or null; `labels` the labels in the picture.
  constructor({ ask, stop, look, size, save, file, exposure, labels }) {
    Object.assign(this, { ask, stop, look, size, save, file, exposure, labels });
    this.rows = [];
    this.blob = null;
    this.is_busy = false;
    const number = (id, low, high) => {
      const input = make("input", { id, className: "number", inputMode: "numeric", autocomplete: "off", oninput: () => this.changed() });
      Object.assign(input.dataset, { low, high });
      return input;
    };
    const field = (text, ...inputs) => make("label", { className: "field" }, make("span", { textContent: text }), ...inputs);
    this.width = number("figure-width", 1, 4096);
    this.height = number("figure-height", 1, 4096);
    this.samples = number("figure-samples", 1, 16384);
    this.background = make("input", { id: "figure-background", autocomplete: "off", placeholder: words.own_background, oninput: () => this.changed() });
    this.background.setAttribute("list", "figure-colors");
    this.denoise = make("input", { id: "figure-denoise", type: "checkbox", onchange: () => this.changed() });
    this.denoises = field(words.denoise, this.denoise);
    this.drawn = make("div", { id: "figure-drawn" });
    this.image = make("img", { id: "figure-image", alt: "", hidden: true });
    this.done = make("progress", { id: "figure-done", max: 1, value: 0, hidden: true });
    this.done.setAttribute("aria-label", words.done);
    this.said = make("p", { id: "figure-said" });
    this.said.setAttribute("role", "status");
    this.command = make("code", { id: "figure-command" });
    this.go = make("button", { id: "figure-go", className: "main", textContent: words.render, onclick: () => this.is_busy ? this.end() : this.render() });
    this.keep = make("button", { id: "figure-save", textContent: words.save, disabled: true, onclick: () => this.save(this.blob, `${this.stem()}.png`) });
    this.dialog = make("dialog", { id: "figure", onclose: () => { if (this.is_busy) this.end(); } }, make("h2", { textContent: words.title }),
      make("div", { className: "columns" },
        make("div", { className: "shown" }, this.image, this.done, this.said),
        make("div", { className: "fields" }, field(words.width, this.width), field(words.height, this.height), field(words.samples, this.samples), this.denoises,
          field(words.background, this.background), make("datalist", { id: "figure-colors" }, ...["transparent", "white", "black"].map((value) => make("option", { value }))), this.drawn)),
      make("p", { className: "dim" }, words.command, make("br", {}), this.command),
      make("p", { className: "row" }, make("button", { id: "figure-close", textContent: texts.close, onclick: () => this.dialog.close() }), this.keep, this.go));
    document.body.append(this.dialog);
  }

  stem() { return this.file().replace(/\.\w+$/, ""); }

  // Rows of what can be drawn, as the program lists them: {name, values, help}.
  begin(overlays, denoises, samples) {
    this.denoises.hidden = denoises === undefined;
    if (!this.samples.value) { this.samples.value = Math.min(samples, 256); this.denoise.checked = denoises === true; }
    if (this.rows.length) return;
    this.rows = overlays.map(({ name, values, help }) => {
      const is_on = make("input", { id: `figure-${name}`, type: "checkbox", onchange: () => { value.disabled = !is_on.checked; this.changed(); } });
      const value = make("input", { id: `figure-${name}-value`, autocomplete: "off", disabled: true, hidden: !values, placeholder: values.split("|")[0].toLowerCase(), oninput: () => this.changed() });
      value.setAttribute("aria-label", `${words.drawn[name] ?? name}: ${values.toLowerCase()}`);
      const row = make("div", { className: "field", title: help }, make("label", {}, is_on, " ", make("span", { textContent: words.drawn[name] ?? name })), value);
      return { name, is_on, value, row };
    });
    this.drawn.replaceChildren(...this.rows.map(({ row }) => row));
  }

  open() {
    const [width, height] = this.size();
    if (!this.width.value) this.width.value = 1920;
    if (!this.height.value) this.height.value = Math.max(1, Math.round(this.width.value * height / width));
    const label = this.rows.find(({ name }) => name === "label"), labels = this.labels();
    if (label && labels) { label.is_on.checked = true; label.value.disabled = false; label.value.value = labels; }
    this.changed();
    this.dialog.showModal();
  }

  // Returns what the fields say; null where one of them is wrong, which then says why.
  asked() {
    const out = { samples: 0, denoise: !this.denoises.hidden && this.denoise.checked, background: this.background.value.trim() || null, exposure: this.exposure(), clip: this.look().clip, drawn: {} };
    let is_good = true;
    for (const [name, input] of [["width", this.width], ["height", this.height], ["samples", this.samples]]) {
      const { low, high } = input.dataset, trouble = trouble_with(input.value, 1), value = Math.round(value_of(input.value));
      const why = trouble || (value < +low || value > +high ? texts.between(+low, +high) : "");
      complain(input, why);
      is_good &&= !why;
      out[name] = value;
    }
    for (const { name, is_on, value } of this.rows) if (is_on.checked) out.drawn[name] = value.value.trim();
    return is_good ? out : null;
  }

  // The figure that is shown is not the one that the fields ask for any more.
  changed() {
    const asked = this.asked();
    this.command.textContent = asked ? command_of(this.file(), asked) : "";
    this.image.classList.toggle("stale", this.blob !== null);
    this.keep.disabled = true;
  }

  render() {
    const asked = this.asked();
    if (!asked) return;
    this.busy(true);
    this.said.textContent = words.waits;
    const { width, height, ...rest } = asked;
    this.ask({ ...this.look(), type: "figure", width, height, ...rest }, ({ error }) => { this.busy(false); this.said.textContent = error; });
  }
  end() { this.stop(); this.busy(false); this.said.textContent = words.ended; }
  // The program is another one, or the connection was lost.
  lost() { if (this.is_busy) { this.busy(false); this.said.textContent = words.ended; } }

  busy(is_busy) {
    this.is_busy = is_busy;
    this.done.hidden = !is_busy;
    this.go.textContent = is_busy ? words.stop : words.render;
    for (const input of this.dialog.querySelectorAll("input")) input.readOnly = is_busy;
  }

  // The program tells the share that is done.
  told({ share }) { if (this.is_busy) { this.done.value = share; this.said.textContent = words.share(share); } }

  // The figure as a PNG file; returns whether this is one.
  take(data) {
    if (data.byteLength < 8 || new DataView(data).getUint32(0) !== 0x89504e47) return false;
    if (!this.is_busy) return true;  // it was ended
    this.busy(false);
    URL.revokeObjectURL(this.image.src);
    this.blob = new Blob([data], { type: "image/png" });
    Object.assign(this.image, { src: URL.createObjectURL(this.blob), alt: words.shown, hidden: false });
    this.image.classList.remove("stale");
    this.said.textContent = "";
    this.keep.disabled = false;
    return true;
  }
}
