// SPDX-License-Identifier: MIT
//
// A scene on the page: summary, what is selected, the list, and the controls under the picture.

import * as THREE from "three";
import { brief, byId, counted, cssColour, make, shortest } from "./dom";
import { DetailsWriter, Selection } from "./details";
import { Label, Labels } from "./labels";
import {
  allRows,
  columnsOf,
  deepestContact,
  distinctResults,
  elementName,
  featureName,
  firstImpact,
  firstTouch,
  marksOf,
  measureOf,
  noun,
  partnersOf,
  Place,
  rowsWith,
  timeOf,
  timeText,
  titleOf,
} from "./results";
import { featuresOf, greatest, hasPlaces, Result, Role, Scene } from "./scene";
import { Mark } from "./marks";
import { Bodies, Palette, Picked, Stage } from "./stage";
import { View } from "./view";
import { VirtualList } from "./virtual_list";

export class SceneMode {
  stage: Stage | undefined;
  scene: Scene | undefined;
  selection: Selection | undefined;
  private shown = -1; // the result in the list
  private playing = 0;
  private readonly list: VirtualList;
  private readonly summary = byId("summary");
  private readonly details = byId("details");
  private readonly search = byId<HTMLInputElement>("search");
  private readonly which = byId<HTMLSelectElement>("which-result");
  private readonly time = byId<HTMLInputElement>("time");

  constructor(
    private readonly view: View,
    private readonly labels: Labels,
  ) {
    this.list = new VirtualList(byId("list"), (row) => this.select({ kind: "row", result: this.shown, row }, true));
    this.which.addEventListener("change", () => this.showResult(Number(this.which.value)));
    this.search.addEventListener("input", () => this.filter());
    this.time.addEventListener("input", () => this.setTime(Number(this.time.value)));
    byId("play").addEventListener("click", () => this.play());
    byId("first-impact").addEventListener("click", () => this.headline());
    byId("fit").addEventListener("click", () => this.fit());
    byId("hits-only").addEventListener("change", () => this.setBodies());
    byId("solid").addEventListener("change", () => this.setBodies());
    byId("z-up").addEventListener("change", () => this.turnUp());
    byId("explode").addEventListener("input", () => this.setExplode());
    byId("arrows").addEventListener("input", () => this.setArrows());
    new ResizeObserver(() => this.drawTimeMarks()).observe(byId("time-track"));
  }

  open(scene: Scene): void {
    this.stage?.dispose();
    this.stop();
    this.scene = scene;
    this.stage = new Stage(scene, this.view);
    this.selection = undefined;
    this.paint();
    byId("file-name").textContent = scene.title;
    byId("time-tools").hidden = scene.duration === 0;
    this.time.max = String(scene.duration || 1);
    byId("first-impact").hidden = this.first === undefined;
    byId("arrow-tools").hidden = !scene.results.some((r) => hasPlaces(r) && r.count > 0);
    byId<HTMLInputElement>("hits-only").checked = false;
    byId<HTMLInputElement>("solid").checked = scene.sets.every((set) => set.hits === 0);
    this.setBodies();
    byId<HTMLInputElement>("z-up").checked = fallsAlongZ(scene);
    this.stage.zUp = this.checked("z-up");
    byId<HTMLInputElement>("explode").value = "0";
    this.time.value = "0";
    this.setTime(0);
    this.setArrows();
    this.writeSummary();
    this.writeDetails();
    const isList = (result: Result) => result.kind !== "safe_step";
    this.which.replaceChildren(
      ...scene.results.flatMap((r, i) => (isList(r) ? [make("option", { value: String(i) }, titleOf(scene, r))] : [])),
    );
    byId("rows").hidden = !scene.results.some(isList);
    if (scene.results.some(isList)) this.showResult(this.headlineResult());
    this.fit(true);
    this.firstSight();
  }

  show(): void {
    if (this.stage === undefined) return;
    this.view.show(this.stage);
    this.refreshLabels();
  }

  paint(): void {
    const palette: Palette = {
      background: cssColour("scene"),
      ink: cssColour("ink"),
      struck: cssColour("struck"),
      shallow: cssColour("shallow"),
      deepest: cssColour("deepest"),
      a: cssColour("a"),
      b: cssColour("b"),
      roles: { curves: cssColour("curve"), patches: cssColour("patch"), move: cssColour("move"), ways: cssColour("move") },
      sets: [0, 1, 2, 3].map((i) => cssColour(`set-${i}`)),
    };
    this.stage?.paint(palette);
    if ((this.scene?.duration ?? 0) > 0) this.drawTimeMarks();
  }

  private checked(id: string): boolean {
    return byId<HTMLInputElement>(id).checked;
  }

  // --- summary ------------------------------------------------------------------------------------------------------------------

  private get first(): Place | undefined {
    return this.scene && firstImpact(this.scene);
  }
  private get deepest(): Place | undefined {
    return this.scene && deepestContact(this.scene);
  }

  private headlineResult(): number {
    return this.headlinePlace()?.result ?? this.scene!.results.findIndex((r) => r.kind !== "safe_step");
  }

  /** What matters most: the deepest contact, or the first impact, or what sweeps and touches first, or the first pair. */
  private headlinePlace(): Place | undefined {
    const pairs = this.scene!.results.findIndex((r) => r.count > 0);
    return this.deepest ?? this.first ?? firstTouch(this.scene!) ?? (pairs >= 0 ? { result: pairs, row: 0 } : undefined);
  }

  /** Goes there. */
  headline(): void {
    const place = this.scene && this.headlinePlace();
    if (place !== undefined) this.select({ kind: "row", ...place }, true);
  }

  /** A scene opens with what matters most selected, in view on the side that looks at the eye, and all the rest around it. */
  private firstSight(): void {
    const place = this.headlinePlace();
    if (place === undefined) return;
    this.select({ kind: "row", ...place }, false);
    const marks = this.marks();
    const at = this.placeOfSelection(marks);
    const away = 0.8 * this.wholeAway;
    const target = at.multiplyScalar(0.5).add(this.lowered(away));
    this.view.place(target.clone().addScaledVector(this.wayTo(marks, firstWay), away), target);
  }

  private writeSummary(): void {
    const scene = this.scene!;
    const parts: HTMLElement[] = [];
    const card = (what: string, value: string, more: string, action: string, act: () => void) =>
      make(
        "button",
        { class: "headline", type: "button", onclick: act },
        make("b", {}, `${what}: `, make("i", { class: "value" }, value)),
        make("span", {}, more),
        make("span", { class: "go" }, action),
      );
    const button = (what: string, value: string, more: string, place: Place) =>
      card(what, value, more, "Go there →", () => this.select({ kind: "row", ...place }, true));
    const deep = this.deepest;
    if (deep !== undefined) {
      const r = scene.results[deep.result]!;
      const more = `${elementName(scene, r.a, r.aIds[deep.row]!)} and ${elementName(scene, r.b, r.bIds[deep.row]!)}`;
      parts.push(button("Deepest contact", shortest(r.depths[deep.row]!), more, deep));
    }
    const first = this.first;
    if (first !== undefined) {
      const r = scene.results[first.result]!;
      const more = featuresOf(r, first.row)
        .map((f) => `${featureName(f.vertices)} of ${scene.sets[f.set]!.name}`)
        .join(" and ");
      parts.push(
        button(
          "First impact",
          `t = ${timeText(r, first.row)}`,
          more + (scene.duration > 1 ? `, in step ${r.step} of ${scene.duration}` : ""),
          first,
        ),
      );
    }
    const touch = firstTouch(scene);
    if (touch !== undefined) {
      const r = scene.results[touch.result]!;
      const more = `${elementName(scene, r.a, r.aIds[touch.row]!)} touches ${elementName(scene, r.b, r.bIds[touch.row]!)}`;
      parts.push(button("First touch", measureOf(r, touch.row), more, touch));
    }
    const pairs = scene.results.findIndex((r) => r.kind === "pairs" && r.count > 0);
    if (parts.length === 0 && pairs >= 0) {
      const r = scene.results[pairs]!;
      const more = `first: ${elementName(scene, r.a, r.aIds[0]!)} and ${elementName(scene, r.b, r.bIds[0]!)}`;
      parts.push(
        button(r.count === 1 ? "Pair that touches" : "Pairs that touch", r.count.toLocaleString("en"), more, {
          result: pairs,
          row: 0,
        }),
      );
    }
    scene.sets.forEach((set, i) => {
      const depths = set.role === "patches" ? set.numbers.find(([name]) => name === "depth")?.[1] : undefined;
      if (depths === undefined) return;
      const deepest = greatest(depths);
      const more = [`deepest of ${counted(set.count, "patch")}`, ...set.numbers.map(([name, of]) => `${name} ${brief(of[deepest]!)}`)];
      parts.push(
        card(set.name, `${shortest(depths[deepest]!)} deep`, more.join(", "), "Go there →", () =>
          this.select({ kind: "element", set: i, element: deepest }, true),
        ),
      );
    });
    if (parts.length === 0 && scene.sets.every((set) => set.hits === 0))
      parts.push(make("p", { class: "answer no" }, "Nothing touches."));
    for (const { kind, part, step } of scene.results) {
      if (kind !== "safe_step") continue;
      const more = scene.duration > 1 ? `of step ${step} of ${scene.duration} is free` : "of the way is free";
      parts.push(card("Safe step", String(part), more, "Show it →", () => this.setTime(step + part, step, part)));
    }
    for (const { name, move } of scene.sets) {
      if (move === undefined || scene.duration === 0) continue;
      const more = `a move by ${move.map(brief).join(", ")}`;
      parts.push(card(name, `${brief(Math.hypot(...move))} long`, more, "Play it ▶", () => this.play(0)));
    }
    const table = make("table", { class: "sets" });
    scene.sets.forEach((set, i) => {
      const toggle = make("input", {
        type: "checkbox",
        checked: true,
        "aria-label": `Show ${set.name}`,
        onchange: (event) => this.stage!.showSet(i, (event.target as HTMLInputElement).checked),
      });
      const swatch = make("span", { class: "swatch", style: `background: var(--${swatchOf(set.role, i)})` });
      const hits = set.hits > 0 ? `${set.hits.toLocaleString("en")} hit` : "no hit";
      table.append(
        make(
          "tr",
          {},
          make("td", {}, make("label", {}, toggle, swatch, set.name)),
          make(
            "td",
            {},
            (set.of > set.count ? `${set.count.toLocaleString("en")} of ` : "") + counted(set.of, noun(scene, i)),
          ),
          make("td", { class: "quiet" }, hits),
        ),
      );
    });
    const notes = scene.notes.map((note) => make("p", { class: "quiet note" }, note));
    this.summary.replaceChildren(...parts, table, ...notes);
  }

  // --- list ---------------------------------------------------------------------------------------------------------------------

  showResult(number: number): void {
    this.shown = number;
    this.which.value = String(number);
    this.search.value = "";
    this.filter();
    const result = this.scene!.results[number]!;
    if (result.kind === "impacts" || hasPlaces(result)) this.list.sort(1, result.kind === "contacts");
    this.arrowsOfSelection();
  }

  private filter(): void {
    const result = this.scene?.results[this.shown];
    if (result === undefined) return;
    const { column, descending } = this.list.sorting;
    const asked = this.search.value.trim();
    const found = asked === "" ? allRows(result) : rowsWith(result, asked);
    byId("row-count").textContent =
      found === undefined
        ? "Type an id: 7, or a 7, or b 7."
        : asked === ""
          ? (result.of > result.count ? `${result.count.toLocaleString("en")} of ` : "") + counted(result.of, "row")
          : `${found.length.toLocaleString("en")} of ${counted(result.count, "row")}`;
    this.list.show(columnsOf(result), found ?? new Uint32Array(0));
    if (column >= 0) this.list.sort(column, descending);
  }

  /** The impact after or before the present time. */
  stepImpact(forward: boolean): void {
    const first = this.first;
    if (first === undefined) return;
    const result = this.scene!.results[first.result]!;
    const now = this.selection?.kind === "row" && this.selection.result === first.result ? this.selection.row : -1;
    const order = Array.from(allRows(result)).sort((i, j) => result.times[i]! - result.times[j]! || i - j);
    const place = now < 0 ? (forward ? 0 : order.length - 1) : order.indexOf(now) + (forward ? 1 : -1);
    if (place >= 0 && place < order.length) this.select({ kind: "row", result: first.result, row: order[place]! }, true);
  }

  // --- selection ------------------------------------------------------------------------------------------------------------------

  select(selection: Selection | undefined, fly: boolean): void {
    if (this.scene === undefined || this.stage === undefined) return;
    this.selection = selection;
    if (selection?.kind === "row") {
      if (selection.result !== this.shown) this.showResult(selection.result);
      const result = this.scene.results[selection.result]!;
      if (result.kind === "impacts") this.setTime(timeOf(result, selection.row), result.step, result.times[selection.row]!);
      if (result.kind === "sweeps") this.setTime(this.scene.duration); // each has stopped where it touches
    }
    this.stage.mark(this.marks());
    this.arrowsOfSelection();
    this.writeDetails();
    this.list.mark(selection?.kind === "row" ? selection.row : -1); // after the details, which take room from the list
    this.refreshLabels();
    if (fly && selection !== undefined) this.flyThere();
  }

  private arrowsOfSelection(): void {
    const s = this.selection;
    this.stage?.showArrows(this.shown, s?.kind === "row" && s.result === this.shown ? s.row : -1, true);
  }

  picked(picked: Picked | undefined): void {
    if (picked === undefined) this.select(undefined, false);
    else if ("result" in picked) this.select({ kind: "row", ...picked }, false);
    else this.select({ kind: "element", ...picked }, false);
  }

  private marks(): Mark[] {
    const s = this.selection;
    const scene = this.scene!;
    if (s === undefined) return [];
    if (s.kind === "row") {
      const result = scene.results[s.result]!;
      const marks = marksOf(scene, result, s.row);
      if (hasPlaces(result)) marks[0]!.contact = { result: s.result, row: s.row };
      return marks;
    }
    const marks: Mark[] = [{ set: s.set, side: "a", elements: [s.element] }];
    for (const number of distinctResults(scene)) {
      const result = scene.results[number]!;
      for (const partner of partnersOf(scene, result, s.set, s.element)) {
        if (partner.set >= 0) marks.push({ set: partner.set, side: "b", elements: [partner.element] });
        else
          marks.push(
            ...marksOf(scene, result, partner.row)
              .filter((m) => m.set !== s.set)
              .map((m): Mark => ({ ...m, side: "b" })),
          );
      }
    }
    return marks;
  }

  private flyThere(): void {
    const marks = this.marks();
    const ball = this.stage!.ballOf(this.selection!.kind === "row" ? marks : marks.slice(0, 1));
    const way = this.wayTo(marks, this.view.camera.position.clone().sub(this.view.controls.target));
    this.view.fly(this.placeOfSelection(marks), Math.min(3.2, Math.max(6 * ball.radius, 0.004)), way);
  }

  private placeOfSelection(marks: Mark[]): THREE.Vector3 {
    const s = this.selection!;
    if (s.kind === "row" && this.contactOf(s) !== undefined && byId<HTMLInputElement>("explode").value === "0")
      return this.stage!.pointOfContact(s.result, s.row);
    return this.stage!.ballOf(s.kind === "row" ? marks : marks.slice(0, 1)).center;
  }

  private contactOf(s: Selection): Result | undefined {
    const result = s.kind === "row" ? this.scene!.results[s.result]! : undefined;
    return result !== undefined && hasPlaces(result) ? result : undefined;
  }

  /**
   * The direction from which to look at marks: that of `now`, turned only as far as the first face, and the others that can be, are
   * seen from their front. Not straight on: an arrow along the normal would be a point.
   */
  private wayTo(marks: Mark[], now: THREE.Vector3): THREE.Vector3 {
    const way = now.clone().normalize();
    const isRow = this.selection!.kind === "row";
    const fronts = (isRow ? marks : marks.slice(0, 1)).flatMap((mark) => this.stage!.frontOf(mark) ?? []);
    const first = fronts[0];
    if (first === undefined) return way;
    const all = fronts.reduce((sum, n) => sum.add(n), new THREE.Vector3()).normalize();
    const together = fronts.every((n) => n.dot(all) > 0.75);
    const seen = (together ? fronts : [first]).map((n) => way.dot(n));
    if (Math.min(...seen) > 0.4 && Math.max(...seen) < 0.95) return way;
    const front = together ? all : first;
    const aside = way.addScaledVector(front, -way.dot(front));
    if (aside.lengthSq() < 1e-6) aside.set(front.y, front.z, front.x).addScaledVector(front, -front.dot(aside));
    return aside.normalize().multiplyScalar(0.45).addScaledVector(front, 0.9).normalize();
  }

  refreshLabels(): void {
    const s = this.selection;
    if (s === undefined || this.stage === undefined) return this.labels.set([]);
    const words: Label[] = [];
    const scene = this.scene!;
    const marks = this.marks();
    for (const mark of s.kind === "row" ? marks : marks.slice(0, 1)) {
      const name =
        mark.vertices !== undefined
          ? featureName(mark.vertices)
          : `${noun(scene, mark.set)} ${scene.sets[mark.set]!.ids[mark.elements![0]!]}`;
      words.push({ at: this.stage.ballOf([mark]).center, text: `${mark.side} · ${name}`, look: mark.side });
    }
    const contact = this.contactOf(s);
    if (s.kind === "row" && contact !== undefined)
      words.push({ at: this.stage.pointOfContact(s.result, s.row), text: measureOf(contact, s.row), look: "depth" });
    this.labels.set(words);
  }

  // --- details --------------------------------------------------------------------------------------------------------------------

  private writeDetails(): void {
    const s = this.selection;
    this.details.hidden = s === undefined;
    if (s === undefined) return this.details.replaceChildren();
    const close = make(
      "button",
      {
        type: "button",
        "aria-label": "Clear the selection",
        title: "Clear (Esc)",
        onclick: () => this.select(undefined, false),
      },
      "✕",
    );
    const body = new DetailsWriter(
      this.scene!,
      () => this.stage!.time,
      (selection, fly) => this.select(selection, fly),
    ).of(s);
    this.details.replaceChildren(make("h2", {}, body.title, close), ...body.parts);
    this.details.scrollTop = 0;
  }

  // --- controls -------------------------------------------------------------------------------------------------------------------

  fit(atOnce = false): void {
    if (this.stage === undefined) return;
    const away = this.wholeAway;
    const middle = this.lowered(away);
    if (atOnce) this.view.show(this.stage);
    if (atOnce) this.view.place(middle.clone().addScaledVector(firstWay, away), middle);
    else this.view.fly(middle, away, firstWay);
  }

  /** How far from the middle all can be seen. */
  private get wholeAway(): number {
    return 3.1 / Math.min(1, this.view.camera.aspect) ** 0.9;
  }

  /** Below the middle of the scene as far as that has to be above the picture's middle, for the controls cover its lower edge. */
  private lowered(away: number): THREE.Vector3 {
    const covered = byId("scene-tools").offsetHeight / Math.max(1, this.view.height);
    return new THREE.Vector3(0, -covered * away * Math.tan(THREE.MathUtils.degToRad(this.view.camera.fov / 2)), 0);
  }

  private setBodies(): void {
    const how: Bodies = this.checked("hits-only") ? "faint" : this.checked("solid") ? "solid" : "ghost";
    if (this.stage !== undefined) this.stage.bodies = how;
  }

  private turnUp(): void {
    if (this.stage === undefined) return;
    this.stage.zUp = this.checked("z-up");
    this.refreshLabels();
  }

  setExplode(value?: number): void {
    if (this.stage === undefined) return;
    const slider = byId<HTMLInputElement>("explode");
    if (value !== undefined) slider.value = String(value);
    this.stage.explode = Number(slider.value);
    this.refreshLabels();
  }

  private setArrows(): void {
    if (this.stage !== undefined) this.stage.arrowLength = 0.6 * Number(byId<HTMLInputElement>("arrows").value) ** 2;
  }

  /** A moment at which one step ends and the next begins is of the next, unless it is said to be of the other. */
  setTime(value: number, step = Math.min(Math.floor(value), Math.max(0, this.scene!.duration - 1)), exact?: number): void {
    if (this.stage === undefined) return;
    this.stage.time = value;
    this.stage.step = step;
    this.time.value = String(value);
    const { duration } = this.scene!;
    byId("time-value").textContent =
      (duration > 1 ? `step ${step} of ${duration}, ` : "") +
      `t = ${exact === undefined ? (value - step).toFixed(3) : Number(exact.toPrecision(3))}`;
    this.refreshLabels();
    if (this.selection?.kind === "element" && this.playing === 0) this.writeDetails(); // its corners have moved
  }

  /** Plays the motion from where it is, or from a moment; or stops it. */
  play(from?: number): void {
    const wasPlaying = this.playing !== 0;
    if (wasPlaying) this.stop();
    if (wasPlaying && from === undefined) return;
    if (from !== undefined) this.setTime(from);
    this.run();
  }

  private run(): void {
    const duration = this.scene?.duration ?? 0;
    if (duration === 0) return;
    if (Number(this.time.value) >= duration) this.setTime(0);
    const length = Math.min(8000, 2500 + 60 * duration); // ms
    const begin = performance.now() - (length * Number(this.time.value)) / duration;
    const step = () => {
      const t = Math.min(1, (performance.now() - begin) / length);
      this.setTime(t * duration);
      if (t < 1) this.playing = requestAnimationFrame(step);
      else this.stop();
    };
    byId("play").textContent = "❚❚";
    this.playing = requestAnimationFrame(step);
  }

  private stop(): void {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    byId("play").textContent = "▶";
  }

  /** A stroke over the slider at each moment of impact. */
  private drawTimeMarks(): void {
    const canvas = byId<HTMLCanvasElement>("time-marks");
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (width === 0) return;
    canvas.width = width * devicePixelRatio;
    canvas.height = height * devicePixelRatio;
    const pen = canvas.getContext("2d")!;
    pen.scale(devicePixelRatio, devicePixelRatio);
    const impacts = (this.scene?.results ?? []).filter((r) => r.kind === "impacts");
    const bins = new Float64Array(Math.max(1, Math.floor(width)));
    const { duration } = this.scene!;
    for (const result of impacts) {
      for (let i = 0; i < result.count; ++i)
        ++bins[Math.min(bins.length - 1, Math.floor((timeOf(result, i) / duration) * bins.length))]!;
    }
    const most = bins.reduce((x, y) => Math.max(x, y), 1);
    pen.fillStyle = cssColour("good");
    for (const { kind, part, step } of this.scene?.results ?? []) {
      if (kind === "safe_step") pen.fillRect((step / duration) * width, height - 4, Math.max(2, (part / duration) * width), 4);
    }
    pen.fillStyle = cssColour("mark");
    bins.forEach((n, x) => {
      const tall = n === 0 ? 0 : 3 + (height - 4) * Math.sqrt(n / most);
      pen.fillRect(x, height - tall, 1.2, tall);
    });
    const first = this.first;
    if (first === undefined) return;
    const x = (timeOf(this.scene!.results[first.result]!, first.row) / duration) * width;
    pen.beginPath();
    pen.moveTo(x - 5, 0);
    pen.lineTo(x + 5, 0);
    pen.lineTo(x, 7);
    pen.fill();
  }
}

/** The name of a set's colour. */
function swatchOf(role: Role | "", number: number): string {
  return { "": `set-${number % 4}`, curves: "curve", patches: "patch", move: "move", ways: "move" }[role];
}

/** From which scenes are looked at first. */
const firstWay = new THREE.Vector3(0.55, 0.42, 0.9).normalize();

/** Whether what moves goes along z more than along x and y, as things fall where z is up. */
function fallsAlongZ(scene: Scene): boolean {
  const way = [0, 0, 0];
  for (const set of scene.sets) set.frames.at(-1)?.forEach((x, i) => (way[i % 3]! += x));
  return Math.abs(way[2]!) > 2 * Math.max(Math.abs(way[0]!), Math.abs(way[1]!));
}
