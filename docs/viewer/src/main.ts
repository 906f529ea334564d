// SPDX-License-Identifier: MIT
//
// The page: files in, modes, theme, keyboard, and messages.

import * as THREE from "three";
import { CaseMode } from "./case_mode";
import { byId, cssColour, make } from "./dom";
import { Labels } from "./labels";
import { Predicate } from "./predicate";
import { FileError, readScene } from "./scene";
import { SceneMode } from "./scene_mode";
import { View } from "./view";

THREE.ColorManagement.enabled = false;

const largest = 2 ** 31 - 1; // bytes of a file

function say(text: string): void {
  byId("message-text").textContent = text;
  byId("message").hidden = false;
}

class Page {
  readonly view: View;
  readonly scenes: SceneMode;
  cases: CaseMode | undefined;
  mode: "scene" | "cases" = "scene";
  readonly labels: Labels;
  private theme: "light" | "dark";
  private starting: Promise<Predicate> | undefined;
  private readonly keys: [string, string, () => void][];

  constructor() {
    this.view = new View(byId<HTMLCanvasElement>("canvas"));
    this.view.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.labels = new Labels(byId("labels"), this.view);
    this.scenes = new SceneMode(this.view, this.labels);
    const dark = window.matchMedia("(prefers-color-scheme: dark)");
    this.theme = dark.matches ? "dark" : "light";
    dark.addEventListener("change", () => this.setTheme(dark.matches ? "dark" : "light"));
    this.keys = this.bindings();
    this.listen();
    this.setTheme(this.theme);
  }

  // --- files --------------------------------------------------------------------------------------------------------------------

  open(bytes: Uint8Array, title: string): void {
    byId("message").hidden = true;
    try {
      const scene = readScene(bytes, title);
      this.setMode("scene");
      byId("welcome").hidden = true;
      byId("scene-tools").hidden = false;
      this.scenes.open(scene);
      document.title = `${title} – abut viewer`;
    } catch (error) {
      say(error instanceof FileError ? `${title}: ${error.message}` : `${title}: cannot be shown: ${String(error)}`);
      if (!(error instanceof FileError)) console.warn(error);
    }
  }

  async openFile(file: File): Promise<void> {
    if (file.size > largest) return say(`${file.name}: ${file.size} bytes; this page reads up to ${largest}`);
    this.open(new Uint8Array(await file.arrayBuffer()), file.name);
  }

  async openUrl(url: string): Promise<void> {
    try {
      const answer = await fetch(url);
      if (!answer.ok) throw new Error(`status ${answer.status}`);
      this.open(new Uint8Array(await answer.arrayBuffer()), decodeURIComponent(url.split("/").pop() ?? url));
    } catch (error) {
      const local =
        location.protocol === "file:"
          ? " A page opened from a file may not read others by itself: drop the file here instead."
          : "";
      say(`${url}: cannot be fetched (${error instanceof Error ? error.message : String(error)}).${local}`);
    }
  }

  /** A scene that was put into the page. */
  openEmbedded(): boolean {
    const holder = byId("abut-scene");
    const text = (holder.textContent ?? "").trim();
    if (text === "") return false;
    const title = holder.dataset.name ?? decodeURIComponent(location.pathname.split("/").pop() || "scene in this page");
    try {
      this.open(fromBase64(text), title);
    } catch (error) {
      say(`${title}: it is no base64: ${String(error)}`);
    }
    holder.textContent = "";
    return true;
  }

  // --- modes, theme ---------------------------------------------------------------------------------------------------------------

  /** Special cases; the predicate is started the first time. */
  async openCases(): Promise<void> {
    if (!Predicate.isHere) return say("This page was built without the predicate: cmake/view.sh says what it needs.");
    try {
      this.starting ??= Predicate.load();
      const predicate = await this.starting;
      this.cases ??= new CaseMode(this.view, this.labels, predicate);
    } catch (error) {
      return say(`The predicate cannot be started: ${String(error)}`);
    }
    this.setMode("cases");
  }

  showScene(): void {
    this.setMode("scene");
  }

  private switchMode(): void {
    if (this.mode === "scene") void this.openCases();
    else this.setMode("scene");
  }

  private setMode(mode: "scene" | "cases"): void {
    this.mode = mode;
    for (const name of ["scene", "cases"] as const) {
      const tab = byId(`mode-${name}`);
      tab.setAttribute("aria-selected", String(name === mode));
      tab.tabIndex = name === mode ? 0 : -1;
    }
    byId("scene-panel").hidden = mode !== "scene";
    byId("case-panel").hidden = mode !== "cases";
    byId("case-tools").hidden = mode !== "cases";
    byId("scene-tools").hidden = mode !== "scene" || this.scenes.scene === undefined;
    byId("welcome").hidden = mode === "cases" || this.scenes.scene !== undefined;
    this.labels.set([]);
    if (mode === "cases") this.cases!.show();
    else {
      this.cases?.hide();
      this.view.controls.enabled = true;
      if (this.scenes.stage === undefined) this.view.show({ root: new THREE.Scene() });
      this.scenes.show();
    }
  }

  setTheme(theme: "light" | "dark"): void {
    this.theme = theme;
    document.documentElement.dataset.theme = theme;
    this.view.background(new THREE.Color(cssColour("scene")));
    this.scenes.paint();
    if (this.mode === "cases") this.cases?.refresh();
  }

  // --- events -------------------------------------------------------------------------------------------------------------------

  private bindings(): [string, string, () => void][] {
    const scenes = this.scenes;
    const inScene = (act: () => void) => () => this.mode === "scene" && act();
    const toggle = (id: string) => inScene(() => byId(id).click());
    const step = (by: number) => () => (this.mode === "cases" ? this.cases?.step(by) : scenes.stepImpact(by > 0));
    return [
      ["d", "deepest contact, or first impact", inScene(() => scenes.headline())],
      ["f", "show all", () => (this.mode === "cases" ? this.cases?.stage.look(false) : scenes.fit())],
      ["h", "hits only", toggle("hits-only")],
      ["s", "solid bodies, and ghosts again", toggle("solid")],
      [
        "e",
        "sets apart, and together again",
        inScene(() => scenes.setExplode(Number(byId<HTMLInputElement>("explode").value) > 0 ? 0 : 0.6)),
      ],
      ["z", "z up instead of y", toggle("z-up")],
      [" ", "play the motion", inScene(() => scenes.play())],
      ["[", "impact before", step(-1)],
      ["]", "impact after", step(1)],
      ["/", "find an id in the list", inScene(() => byId("search").focus())],
      ["o", "open a file", () => byId("file").click()],
      ["c", "special cases, and back", () => this.switchMode()],
      ["t", "dark or light", () => this.setTheme(this.theme === "dark" ? "light" : "dark")],
      ["?", "this help", () => byId<HTMLDialogElement>("help").showModal()],
    ];
  }

  private listen(): void {
    const file = byId<HTMLInputElement>("file");
    for (const id of ["open", "open-first"]) byId(id).addEventListener("click", () => file.click());
    file.addEventListener("change", () => {
      if (file.files?.[0] !== undefined) void this.openFile(file.files[0]);
      file.value = "";
    });
    byId("cases-first").addEventListener("click", () => void this.openCases());
    byId("mode-scene").addEventListener("click", () => this.setMode("scene"));
    byId("mode-cases").addEventListener("click", () => void this.openCases());
    byId("modes").addEventListener("keydown", (event) => {
      if (event.key !== "ArrowLeft" && event.key !== "ArrowRight") return;
      event.stopPropagation();
      const next = this.mode === "scene" ? "cases" : "scene";
      if (next === "scene") this.setMode("scene");
      else void this.openCases();
      byId(`mode-${next}`).focus();
    });
    byId("theme").addEventListener("click", () => this.setTheme(this.theme === "dark" ? "light" : "dark"));
    byId("help-open").addEventListener("click", () => byId<HTMLDialogElement>("help").showModal());
    byId("message-close").addEventListener("click", () => (byId("message").hidden = true));
    for (const [key, what] of this.keys)
      byId("keys").append(make("dt", {}, make("kbd", {}, key === " " ? "space" : key)), make("dd", {}, what));
    byId("keys").append(
      make("dt", {}, make("kbd", {}, "Esc")),
      make("dd", {}, "clear the selection"),
      make("dt", {}, make("kbd", {}, "↑"), " ", make("kbd", {}, "↓")),
      make("dd", {}, "step through the list"),
      make("dt", {}, make("kbd", {}, "←"), " ", make("kbd", {}, "→")),
      make("dd", {}, "special case before and after"),
    );
    window.addEventListener("keydown", (event) => this.key(event));
    this.listenToDrops();
    this.listenToClicks();
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || byId<HTMLDialogElement>("help").open) return;
    if (event.key === "Escape") {
      byId("message").hidden = true;
      if (target.id === "search") target.blur();
      if (this.mode === "scene") this.scenes.select(undefined, false);
      return;
    }
    const typing =
      target instanceof HTMLSelectElement ||
      (target instanceof HTMLInputElement && !["checkbox", "range"].includes(target.type));
    const pressing =
      event.key === " " &&
      (target instanceof HTMLButtonElement || target instanceof HTMLInputElement || target.tagName === "SUMMARY");
    if (typing || pressing) return;
    const sliding = target instanceof HTMLInputElement && target.type === "range";
    if (this.mode === "cases" && !sliding && (event.key === "ArrowLeft" || event.key === "ArrowRight")) {
      event.preventDefault();
      return this.cases?.step(event.key === "ArrowLeft" ? -1 : 1);
    }
    const found = this.keys.find(([key]) => key === event.key);
    if (found === undefined) return;
    event.preventDefault();
    found[2]();
  }

  private listenToDrops(): void {
    const shade = byId("dropping");
    let depth = 0;
    window.addEventListener("dragenter", (event) => {
      event.preventDefault();
      ++depth;
      shade.hidden = false;
    });
    window.addEventListener("dragleave", () => (shade.hidden = --depth <= 0));
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      depth = 0;
      shade.hidden = true;
      const file = event.dataTransfer?.files[0];
      if (file !== undefined) void this.openFile(file);
      else say("No file was dropped.");
    });
  }

  private listenToClicks(): void {
    const canvas = this.view.canvas;
    let from = { x: 0, y: 0 };
    canvas.addEventListener("pointerdown", (event) => (from = { x: event.clientX, y: event.clientY }));
    canvas.addEventListener("click", (event) => {
      if (this.mode !== "scene" || this.scenes.stage === undefined) return;
      if (Math.hypot(event.clientX - from.x, event.clientY - from.y) > 4) return;
      const box = canvas.getBoundingClientRect();
      this.scenes.picked(this.scenes.stage.pick(event.clientX - box.left, event.clientY - box.top));
    });
    canvas.addEventListener("webglcontextlost", () => say("The browser took the graphics away; reload the page."));
    this.view.after = () => this.labels.place();
  }
}

function fromBase64(text: string): Uint8Array {
  const modern = Uint8Array as unknown as { fromBase64?: (text: string) => Uint8Array };
  if (modern.fromBase64 !== undefined) return modern.fromBase64(text);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

async function begin(): Promise<void> {
  let page: Page;
  try {
    page = new Page();
  } catch (error) {
    byId("welcome").hidden = true;
    return say(`This page needs WebGL 2, and the browser gave none: ${String(error)}`);
  }
  // For tests and for the browser's console.
  Object.assign(window, { abutViewer: page });
  byId<HTMLButtonElement>("mode-cases").disabled = !Predicate.isHere;
  byId("cases-first").hidden = !Predicate.isHere;
  page.showScene();
  const url = new URLSearchParams(location.search).get("scene");
  const embedded = page.openEmbedded();
  if (!embedded && url !== null) await page.openUrl(url);
  if (location.hash === "#cases") await page.openCases();
  document.documentElement.dataset.ready = "true";
}

void begin();
