// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// Options of the scene's files, such as the style of a molecule: the program draws the files anew.
import { make } from "./elements.js";
import { complain } from "./numbers.js";
import { texts } from "./texts.js";

// Returns what may be typed as it is: alternatives without capitals, which stand for something.
export const choices_of = (values) => values.split("|").map((one) => one.replace(/^'|'$/g, "")).filter((one) => one && !/[A-Z]/.test(one));
const are_all = (values) => values.includes("|") && choices_of(values).length === values.split("|").length;

export class Redraw {
  // `edit(what, done)` sends a change, and `done` gets the error of one that is refused.
  constructor({ edit }) {
    this.box = document.getElementById("redraw");
    this.rows = document.getElementById("redraw-rows");
    this.edit = edit;
  }
  told(options) {
    this.box.hidden = !options?.length;
    const names = JSON.stringify((options ?? []).map(({ name }) => name));
    if (names !== this.names) this.rows.replaceChildren(...(options ?? []).map((option) => this.row(option)));
    this.names = names;
    for (const { name, now } of options ?? []) {
      const input = document.getElementById(`option-${name}`);
      if (document.activeElement !== input || input.tagName === "SELECT") input.value = now.replaceAll("\n", "; ");
      complain(input, "");
    }
  }
  row({ name, values, help }) {
    const id = `option-${name}`, choices = choices_of(values), label = make("label", {}, make("span", { textContent: texts.file_options[name] ?? name }), " ");
    const input = are_all(values) ? make("select", { id }, new Option(texts.as_usual, ""), ...choices.map((choice) => new Option(choice))) : make("input", { id, autocomplete: "off", placeholder: texts.as_usual });
    label.append(input);
    if (choices.length && input.tagName === "INPUT") {
      label.append(make("datalist", { id: `${id}-choices` }, ...choices.map((choice) => new Option(choice))));
      input.setAttribute("list", `${id}-choices`);
    }
    label.title = help;
    input.onchange = () => this.edit({ what: "redraw", options: { [name]: input.value.trim() } }, (answer) => complain(input, answer?.error ?? ""));
    return label;
  }
}
