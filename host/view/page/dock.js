// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
// The panel beside the picture with its pages, menus, and icons of buttons.
import { icon } from "./icons.js";
import { texts } from "./texts.js";

const $ = (id) => document.getElementById(id);
export const PAGES = ["object", "material", "light", "camera", "render"];
const wide = window.matchMedia("(min-width: 1100px)");
// A browser may refuse to remember (private windows); the page then begins as a new one.
const recall = (name) => { try { return localStorage.getItem(`caplet.${name}`); } catch { return null; } };
const remember = (name, value) => { try { localStorage.setItem(`caplet.${name}`, value); } catch { /* nothing is lost */ } };

/// Gives buttons their icons, names and tooltips with keys.
export function dress() {
  for (const node of document.querySelectorAll("[data-text]")) node.textContent = texts[node.dataset.text];
  for (const node of document.querySelectorAll("[data-icon]")) node.prepend(icon(node.dataset.icon));
  for (const node of document.querySelectorAll("[data-title]")) {
    const text = texts[node.dataset.title];
    node.setAttribute("aria-label", text);
    node.title = node.dataset.keys ? `${text} (${node.dataset.keys})` : text;
  }
}

export class Panel {
  constructor() {
    this.box = $("panel");
    this.box.setAttribute("aria-label", texts.panel);
    $("tabs").setAttribute("aria-label", texts.pages);
    for (const page of PAGES) {
      const tab = Object.assign(document.createElement("button"), { id: `tab-${page}`, textContent: texts.page_names[page], onclick: () => this.open(page) });
      tab.role = "tab";
      tab.setAttribute("aria-controls", `page-${page}`);
      if (page === "material" || page === "light") tab.classList.add("edits");
      $(`page-${page}`).setAttribute("aria-labelledby", tab.id);
      $("tabs").append(tab);
    }
    $("tabs").onkeydown = (event) => {
      const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!way) return;
      const tabs = [...$("tabs").children].filter((tab) => tab.offsetParent), next = tabs[(tabs.indexOf(document.activeElement) + way + tabs.length) % tabs.length];
      next.focus();
      next.click();
    };
    this.open("object");
    const folded = recall("folded");
    this.fold(wide.matches ? folded === "true" : true);
    wide.addEventListener("change", () => this.fold(!wide.matches));
    this.width = +(recall("width") ?? 320);
    this.resize(this.width);
    const edge = $("edge");
    edge.setAttribute("aria-label", texts.edge);
    edge.addEventListener("pointerdown", (start) => {
      edge.setPointerCapture(start.pointerId);
      const go = (move) => this.resize(window.innerWidth - move.clientX);
      edge.addEventListener("pointermove", go);
      edge.addEventListener("pointerup", () => edge.removeEventListener("pointermove", go), { once: true });
    });
    edge.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: 16, ArrowRight: -16 }[event.key];
      if (way) this.resize(this.width + way);
    });
    this.sheet();
  }
  open(page) {
    this.page = page;
    for (const one of PAGES) {
      $(`page-${one}`).hidden = one !== page;
      $(`tab-${one}`).setAttribute("aria-selected", String(one === page));
      $(`tab-${one}`).tabIndex = one === page ? 0 : -1;
    }
  }
  fold(is_folded) {
    document.body.classList.toggle("folded", is_folded);
    $("panel-button").setAttribute("aria-expanded", String(!is_folded));
    if (wide.matches) remember("folded", is_folded);
  }
  toggle() { this.fold(!document.body.classList.contains("folded")); }
  resize(width) {
    this.width = Math.round(Math.max(256, Math.min(640, window.innerWidth / 2, width)));
    document.documentElement.style.setProperty("--panel-width", `${this.width}px`);
    for (const [name, value] of [["valuenow", this.width], ["valuemin", 256], ["valuemax", 640]]) $("edge").setAttribute(`aria-${name}`, value);
    remember("width", this.width);
  }
  // On phones the panel is a sheet of a third, two thirds or all of the height: its grip is tapped or pulled.
  sheet() {
    const grip = $("grip"), to = (height) => {
      if (height < 1) { this.box.dataset.height = 1; return this.fold(true); }
      this.box.dataset.height = Math.min(3, height);
    };
    let from = null;
    grip.addEventListener("pointerdown", (event) => { from = event.clientY; grip.setPointerCapture(event.pointerId); });
    grip.addEventListener("pointerup", (event) => {
      const pulled = Math.round((from - event.clientY) / (window.innerHeight / 3)), height = +(this.box.dataset.height ?? 1);
      to(Math.abs(from - event.clientY) < 8 ? height % 3 + 1 : height + pulled);
    });
    grip.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); to(+(this.box.dataset.height ?? 1) % 3 + 1); } });
  }
}

/// Makes a button open a menu, whose items are buttons. Escape and clicks elsewhere close it.
export function menu(button, box) {
  const items = () => [...box.querySelectorAll("button")].filter((item) => item.offsetParent && !item.disabled);
  const close = () => { box.hidden = true; button.setAttribute("aria-expanded", "false"); };
  const open = () => {
    box.hidden = false;
    button.setAttribute("aria-expanded", "true");
    const { left, right, bottom } = button.getBoundingClientRect(), { width } = box.getBoundingClientRect();
    box.style.left = `${Math.max(8, left + width > window.innerWidth ? right - width : left)}px`;
    box.style.top = `${bottom + 6}px`;
    items()[0]?.focus();
  };
  box.setAttribute("aria-label", button.getAttribute("aria-label"));
  button.addEventListener("click", () => box.hidden ? open() : close());
  box.addEventListener("click", (event) => { if (event.target.closest("button")) close(); });
  document.addEventListener("pointerdown", (event) => { if (!box.contains(event.target) && !button.contains(event.target)) close(); });
  box.addEventListener("keydown", (event) => {
    const all = items(), way = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (way) { event.preventDefault(); all[(all.indexOf(document.activeElement) + way + all.length) % all.length]?.focus(); }
    if (event.key === "Escape") { event.stopPropagation(); close(); button.focus(); }
    if (event.key === "Tab") close();
  });
  return { open, close };
}
