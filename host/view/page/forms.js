// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Forms of the scene's parts. The program lists each part's fields with kind and range, and checks new values.
import { scrubs, value_of, values_of } from "./numbers.js";
import { texts } from "./texts.js";

const SETTINGS = ["camera", "film", "filter", "sampler", "integrator"];
const node = (name, attributes = {}, ...inside) => {
  const out = Object.assign(document.createElement(name), attributes);
  out.append(...inside);
  return out;
};
// A text that is no number goes to the program as it is, which says why it cannot be.
const number_or_text = (text) => { const value = value_of(text); return Number.isFinite(value) ? value : text; };
const short = (v) => String(+v.toPrecision(7));
// Convert linear values to sRGB (IEC 61966-2-1), and back.
const encoded = (v) => Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * Math.max(0, Math.min(1, v)) ** (1 / 2.4) - 0.055));
const decoded = (b) => { const v = b / 255; return v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4; };
const hex = (rgb) => "#" + rgb.map((v) => Math.min(255, Math.max(0, encoded(v))).toString(16).padStart(2, "0")).join("");
const linear = (text) => [1, 3, 5].map((i) => +decoded(parseInt(text.slice(i, i + 2), 16)).toPrecision(5));
export const swatch = (material) => hex(material.color);

const options = (list, chosen) => list.map(([value, text]) => new Option(text, value, false, String(value) === String(chosen)));

// The form of one part in a <details>, requested while it is open.
class Form {
  constructor(forms, of, box) {
    Object.assign(this, { forms, of, box, part: null, key: "", errors: new Map(), last: "" });
    this.body = box.appendChild(node("div", { className: "form" }));
    box.dataset.form = of;
    box.addEventListener("toggle", () => this.refresh());
  }
  show(part) {
    if (part !== this.part) { this.errors.clear(); this.last = ""; }
    this.part = part;
    this.box.hidden = part === null;
    this.refresh();
  }
  refresh() {
    if (this.part === null || !this.box.open) return;
    const part = this.part;
    this.forms.ask({ of: this.of, part }, (form) => { if (part === this.part) this.fill(form); });
  }
  set(field, to, goes_on = false) {
    this.errors.delete(field);
    const same = this.last === field && goes_on;
    this.last = field;
    this.forms.edit({ what: "set", of: this.of, part: this.part, field, to }, same, (result) => {
      if (result.error) { this.errors.set(field, result.error.replace(/^[^:]*: /, "")); this.refresh(); }
    });
  }

  fill(form) {
    if (!form) return this.body.replaceChildren();
    const active = document.activeElement, inside = this.body.contains(active);
    const key = JSON.stringify([this.part, form.fields.map((f) => [f.name, f.type, f.options, f.texture === undefined || f.texture === null, f.value && typeof f.value === "object" ? Object.keys(f.value)[0] : ""]), this.forms.key()]);
    if (key !== this.key) {
      const name = inside && active.name;
      this.key = key;
      this.rows = new Map(form.fields.map((field) => [field.name, this.row(field)]));
      this.body.replaceChildren(...[...this.rows.values()].map((row) => row.box));
      if (name) this.body.querySelector(`[name="${CSS.escape(name)}"]`)?.focus();
    }
    for (const field of form.fields) {
      const row = this.rows.get(field.name), error = this.errors.get(field.name) ?? "";
      row.error.textContent = error;
      row.error.hidden = !error;
      for (const input of row.box.querySelectorAll("input, select")) {
        if (error) input.setAttribute("aria-invalid", "true"); else input.removeAttribute("aria-invalid");
      }
      if (!error) row.put(field);
    }
    this.body.dataset.filled = (+this.body.dataset.filled || 0) + 1;
  }

  row(field) {
    const label = texts.fields[field.name] ?? field.name, id = `${this.of}-${field.name.replace(/[^a-z0-9]/gi, "-")}`;
    const error = node("small", { id: `${id}-error`, className: "error", hidden: true });
    error.setAttribute("role", "alert");
    const holder = node("span", { className: "inputs" }), box = node("div", { className: "field" }, node("span", { textContent: label, title: field.name }), holder, error);
    box.dataset.field = field.name;
    const named = (input, suffix = "") => {
      input.name = field.name + suffix;
      input.id = id + suffix.replace(/[^a-z0-9]/gi, "-");
      input.setAttribute("aria-label", suffix ? `${label}, ${texts.parts_of_fields[suffix] ?? suffix}` : label);
      input.setAttribute("aria-describedby", error.id);
      return input;
    };
    const put = (this[`row_${field.type}`] ?? this.row_file).call(this, field, holder, named);
    const number = holder.querySelector("input[inputmode=decimal]");
    if (number) scrubs(box.firstChild, number);
    return { box, error, put };
  }
  // Sets an input, unless the user is typing there or drags it.
  static put(input, value) { if (input.dataset.moving) return; if (document.activeElement !== input || input.type === "range" || input.type === "checkbox") input.value = value; }

  textured(field, holder, named) {
    const list = this.forms.textures(field);
    if (!list.length) return null;
    const select = named(node("select"), " texture");
    select.append(...options([["", texts.no_texture], ...list], field.texture ?? ""));
    select.onchange = () => {
      if (select.value !== "") return this.set(field.name, { texture: +select.value });
      this.set(field.name, field.type === "spectrum" ? this.plain(field) : field.type === "texture" ? null : field.value);
    };
    holder.append(select);
    return (now) => { select.value = now.texture ?? ""; };
  }
  plain(field) { const { samples, space, ...value } = field.value; return Object.keys(value).length ? value : { constant: 0.5 }; }

  // A field for a number, with arithmetic; its name can be dragged.
  number(field, named) {
    const input = named(node("input", { type: "text", inputMode: "decimal", autocomplete: "off" }));
    if (field.low !== undefined) input.dataset.low = field.low;
    if (field.high !== undefined) input.dataset.high = field.high;
    input.onchange = () => this.set(field.name, input.value.trim() === "" ? null : number_or_text(input.value), input.dataset.moving === "1");
    return input;
  }
  row_number(field, holder, named) {
    const input = this.number(field, named), puts = [];
    if (field.texture === undefined || field.texture === null) {
      holder.append(input);
      puts.push((now) => Form.put(input, short(now.value)));
      if (field.type === "number" && field.low !== undefined && field.high !== undefined && field.high - field.low <= 400) {
        const slider = named(node("input", { type: "range", min: field.low, max: field.high, step: (field.high - field.low) / 200 }), " slider");
        slider.oninput = () => { input.value = short(+slider.value); this.set(field.name, +slider.value, slider.dataset.moving === "1"); slider.dataset.moving = "1"; };
        slider.onchange = () => { slider.dataset.moving = ""; };
        holder.append(slider);
        puts.push((now) => { if (!slider.dataset.moving) slider.value = now.value; });
      }
    }
    if (field.texture !== undefined) puts.push(this.textured(field, holder, named) ?? (() => {}));
    return (now) => puts.forEach((put) => put(now));
  }
  row_whole(field, holder, named) { const put = this.row_number(field, holder, named); holder.querySelector("input").dataset.whole = "1"; return put; }
  row_option(field, holder, named) {
    const input = this.number({ low: 0, ...field }, named);
    input.placeholder = texts.none;
    holder.append(input);
    return (now) => Form.put(input, now.value === null ? "" : short(now.value));
  }
  row_choice(field, holder, named) {
    const select = named(node("select"));
    select.append(...options(field.options.map((name) => [name, texts.fields[name] ?? name]), field.value));
    select.onchange = () => this.set(field.name, select.value);
    holder.append(select);
    return (now) => { select.value = now.value; };
  }
  row_flag(field, holder, named) {
    const input = named(node("input", { type: "checkbox" }));
    input.onchange = () => this.set(field.name, input.checked);
    holder.append(input);
    return (now) => { input.checked = now.value; };
  }
  row_text(field, holder, named) {
    const input = named(node("input", { type: "text", autocomplete: "off", maxLength: 100 }));
    input.onchange = () => this.set(field.name, input.value);
    holder.append(input);
    return (now) => Form.put(input, now.value);
  }
  row_point(field, holder, named) {
    const input = named(node("input", { type: "text", autocomplete: "off" }));
    input.onchange = () => this.set(field.name, values_of(input.value));
    holder.append(input);
    return (now) => Form.put(input, now.value.map(short).join(" "));
  }
  row_direction(field, holder, named) { return this.row_point(field, holder, named); }
  row_file(field, holder) { holder.append(node("small", { textContent: field.value })); return () => {}; }
  row_material(field, holder, named) {
    const select = named(node("select"));
    select.append(...options(this.forms.materials(), field.value));
    select.onchange = () => this.set(field.name, +select.value);
    holder.append(select);
    return (now) => { select.value = now.value; };
  }
  row_texture(field, holder, named) {
    return this.textured(field, holder, named) ?? (holder.append(node("small", { textContent: texts.no_texture })), () => {});
  }
  row_spectrum(field, holder, named) {
    const put = field.texture !== undefined ? this.textured(field, holder, named) : null;
    if (field.texture !== undefined && field.texture !== null) return put ?? (() => {});
    const kinds = ["rgb", "constant", "name", "blackbody"], kind = Object.keys(field.value)[0], mode = named(node("select"), " kind");
    mode.append(...options([...kinds, ...(kinds.includes(kind) ? [] : [kind])].map((name) => [name, texts.spectra[name] ?? name]), kind));
    mode.onchange = () => {
      const to = { rgb: { rgb: [0.5, 0.5, 0.5] }, constant: { constant: 0.5 }, blackbody: { blackbody: 6500 }, name: { name: this.forms.spectra()[0] } }[mode.value];
      if (to) this.set(field.name, to);
    };
    holder.prepend(mode);
    let own = () => {};
    if (kind === "rgb") {
      const color = named(node("input", { type: "color" }), " colour"), text = named(node("input", { type: "text", autocomplete: "off" }));
      color.oninput = () => { this.set(field.name, { rgb: linear(color.value) }, color.dataset.moving === "1"); color.dataset.moving = "1"; };
      color.onchange = () => { color.dataset.moving = ""; };
      text.onchange = () => this.set(field.name, { rgb: values_of(text.value) });
      mode.after(color, text);
      own = (now) => { if (!color.dataset.moving) color.value = hex(now.value.rgb); Form.put(text, now.value.rgb.map((v) => +v.toPrecision(4)).join(" ")); };
    } else if (kind === "constant" || kind === "blackbody") {
      const input = named(node("input", { type: "text", inputMode: "decimal", autocomplete: "off" }));
      input.dataset.low = 0;
      input.onchange = () => this.set(field.name, { [kind]: number_or_text(input.value) }, input.dataset.moving === "1");
      mode.after(input);
      own = (now) => Form.put(input, short(now.value[kind]));
    } else if (kind === "name") {
      const select = named(node("select"));
      select.append(...options(this.forms.spectra().map((name) => [name, name]), field.value.name));
      select.onchange = () => this.set(field.name, { name: select.value });
      mode.after(select);
      own = (now) => { select.value = now.value.name; };
    } else {
      mode.after(node("small", { textContent: texts.samples(field.value.samples) }));
    }
    return (now) => { put?.(now); mode.value = Object.keys(now.value)[0]; own(now); };
  }
}

export class Forms {
  // `ask` requests a part's form, `edit` makes a change and receives the result, and `place` returns the place of new things.
  constructor({ ask, edit, find, place, lamp, adds_shape, chosen, paints, under }) {
    Object.assign(this, { asks: ask, edit, find, place, lamp, adds_shape, chosen, paints, under });
    this.queue = new Map();
    this.waits = 0;
    this.parts = { materials: [], textures: [], lights: [], hidden: [] };
    this.lists = { material: [], texture: [], light: [], shape: [], spectra: [] };
    this.forms = {};
    for (const of of ["material", "emission", "shape", "light", "texture", ...SETTINGS]) {
      const box = find(`form-${of}`);
      this.forms[of] = new Form(this, of, box);
      if (SETTINGS.includes(of)) this.forms[of].show(0);
    }
    find("light").onchange = (event) => this.forms.light.show(event.target.value === "" ? null : +event.target.value);
    find("texture").onchange = (event) => this.forms.texture.show(event.target.value === "" ? null : +event.target.value);
    find("dark").onclick = () => { if (find("light").value !== "") this.edit({ what: "remove", of: "light", part: +find("light").value }); };
    const adds = (id, of, more, done) => {
      find(id).onchange = (event) => {
        const kind = event.target.value;
        event.target.value = "";
        if (kind) this.edit({ what: "add", of, ...more(kind) }, false, (made) => { if (made.ids) done(made.ids[0]); });
      };
    };
    adds("new-light", "light", (kind) => ({ kind, ...this.lamp() }), (part) => { find("light").value = part; this.forms.light.box.open = true; this.forms.light.show(part); });
    adds("new-texture", "texture", (kind) => ({ kind: kind.slice(1), of_floats: kind[0] === "f" }), (part) => { find("texture").value = part; this.forms.texture.box.open = true; this.forms.texture.show(part); });
    adds("new-material", "material", (kind) => kind === "*" ? { like: this.forms.material.part ?? 0 } : { kind }, (part) => this.paint(part));
  }
  ask(part, done) {
    this.queue.set(JSON.stringify(part), [part, done]);
    this.go_on();
  }
  go_on() {
    for (const [key, [part, done]] of this.queue) {
      if (this.waits >= 8) return;
      this.queue.delete(key);
      ++this.waits;
      this.asks(part, (form) => { --this.waits; done(form); this.go_on(); });
    }
  }
  // A new connection cancels all pending requests.
  reset() { this.waits = 0; this.queue.clear(); this.refresh(); }
  refresh() { for (const form of Object.values(this.forms)) form.refresh(); }
  key() { return [this.parts.textures.map((t) => t.name + t.of_floats), this.parts.materials.map((m) => m.name)]; }
  spectra() { return this.lists.spectra; }
  materials() { return this.parts.materials.map((material, i) => [i, material.name]); }
  textures(field) { return this.parts.textures.map((t, i) => [i, t.name, t.of_floats]).filter(([i, , floats]) => floats === field.of_floats && i < (field.before ?? Infinity)); }

  begin(lists) {
    this.lists = lists;
    const { find } = this;
    find("shapes").replaceChildren(...lists.shape.map((kind) => node("button", { role: "menuitem", textContent: texts.shapes[kind] ?? kind, onclick: () => this.add_shape(kind, this.under()) })));
    for (const [i, button] of [...find("shapes").children].entries()) { button.dataset.shape = lists.shape[i]; button.setAttribute("aria-label", texts.add_shape(button.textContent)); }
    find("new-light").replaceChildren(new Option(texts.new_light, ""), ...options(lists.light.map((kind) => [kind, kind]), ""));
    find("new-texture").replaceChildren(new Option(texts.new_texture, ""), ...options(lists.texture.flatMap((kind) => [["f" + kind, `${kind}, ${texts.of_floats}`], ["s" + kind, `${kind}, ${texts.of_spectra}`]]), ""));
    find("new-material").replaceChildren(new Option(texts.new_material, ""), new Option(texts.copy_material, "*"), ...options(lists.material.map((kind) => [kind, kind]), ""));
  }
  // New things appear at the point under the cursor, or else where the camera looks.
  add_shape(kind, hit) {
    this.last_shape = kind;
    const place = this.place(hit), material = Math.max(0, this.forms.material.part ?? this.parts.materials.length - 1);
    this.adds_shape({ what: "add", of: "shape", kind, material, ...place });
  }
  // Paints what is selected; without a selection the material's form is shown.
  paint(material) {
    const surface = this.find("surface").value;
    if (this.chosen().length) return this.paints(surface === "" ? null : +surface, material);
    this.forms.material.show(material);
    this.mark();
  }

  // Takes the present lists.
  told(parts) {
    this.parts = parts;
    const { find } = this, fill = (id, none, list) => {
      const before = find(id).value;
      find(id).replaceChildren(new Option(none, ""), ...options(list, before));
      if (find(id).selectedIndex < 0) find(id).value = "";
    };
    fill("light", texts.no_light, parts.lights.map((kind, i) => [i, `${i}: ${kind}`]));
    fill("texture", texts.pick_texture, parts.textures.map((t, i) => [i, `${t.name} (${t.of_floats ? texts.of_floats : texts.of_spectra})`]));
    for (const of of ["light", "texture"]) this.forms[of].show(find(of).value === "" ? null : +find(of).value);
    const names = JSON.stringify(this.key());
    if (names !== this.names) {
      this.names = names;
      find("palette").replaceChildren(...parts.materials.slice(0, 200).map((material, i) => {
        const button = node("button", { title: material.name, onclick: () => this.paint(i) }, node("span", { className: "swatch" }), node("span", { textContent: material.name }));
        button.dataset.material = i;
        button.setAttribute("aria-label", texts.paint(material.name));
        return button;
      }));
    }
    for (const [i, button] of [...find("palette").children].entries()) button.firstChild.style.background = swatch(parts.materials[i]);
    find("material").replaceChildren(new Option(texts.mixed, ""), ...options(this.materials(), ""));
    find("hidden").replaceChildren(...parts.hidden.map((name, i) => node("li", {}, node("button", { textContent: texts.show(name), onclick: () => this.edit({ what: "show", hidden: i }) }))));
    find("hidden-box").hidden = !parts.hidden.length;
    find("hidden-count").textContent = texts.hidden(parts.hidden.length);
    this.mark();
    this.refresh();
  }
  // Sets the selection: a thing, and the material of it that is shown.
  thing(id, material, is_shape) {
    this.forms.material.show(material === "" || material === undefined ? null : +material);
    this.forms.emission.show(is_shape ? id : null);
    this.forms.shape.show(is_shape ? id : null);
    this.mark();
  }
  mark() { for (const button of this.find("palette").children) button.setAttribute("aria-pressed", String(+button.dataset.material === this.forms.material.part)); }
}
