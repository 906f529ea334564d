// SPDX-License-Identifier: MIT
//
// Special cases on the page: the configurations of the tests one after another, what the library answers, and corners to move.

import { byId, cssColour, make, shortest } from "./dom";
import { CaseStage } from "./case_stage";
import { Labels } from "./labels";
import { Pattern, patternsOf, placeOf } from "./patterns";
import { Configuration, Predicate } from "./predicate";
import { View } from "./view";

const partNames = ["nothing", "a point", "a segment"];
const signs: { [side: number]: string } = { [-1]: "−", 0: "0", 1: "+", 2: "·" };

export class CaseMode {
  readonly stage: CaseStage;
  corners: number[] = [];
  index = 0;
  private readonly configurations: Configuration[];
  private patterns: Map<string, Pattern> | undefined;
  private readonly chooser = make("select", { id: "case-chooser", "aria-label": "Configuration" });
  private readonly answer = make("section", { id: "case-answer", "aria-live": "polite", "aria-label": "Answer" });
  private readonly fields: HTMLInputElement[] = [];
  private readonly signCells: HTMLElement[] = [];
  private readonly patternCanvas = make("canvas", { id: "patterns", width: "270", height: "270", role: "img" });
  private readonly patternText = make("p", { class: "quiet", id: "pattern-text" });
  private readonly groupText = make("p", { class: "quiet", id: "case-group" });
  private started = false;

  constructor(
    private readonly view: View,
    labels: Labels,
    readonly predicate: Predicate,
  ) {
    this.stage = new CaseStage(view, labels, (corner, to) => this.moveCorner(corner, to.toArray()));
    this.configurations = predicate.configurations();
    byId("case-previous").addEventListener("click", () => this.step(-1));
    byId("case-next").addEventListener("click", () => this.step(1));
    byId("case-reset").addEventListener("click", () => this.open(this.index));
    byId("case-planes").addEventListener("change", (event) => {
      this.stage.planes = (event.target as HTMLInputElement).checked;
      this.refresh();
    });
    this.build();
  }

  get count(): number {
    return this.configurations.length;
  }

  private build(): void {
    let group: HTMLOptGroupElement | undefined;
    this.configurations.forEach((c, i) => {
      if (group?.label !== c.group) this.chooser.append((group = make("optgroup", { label: c.group })));
      group.append(make("option", { value: String(i) }, `${i + 1}. ${c.name}`));
    });
    this.chooser.addEventListener("change", () => this.open(Number(this.chooser.value)));
    const right = this.configurations.filter((c) => {
      const answers = (["float", "double"] as const).flatMap((scalar) =>
        Object.values(this.predicate.answers(c.corners, scalar)),
      );
      return answers.every((answer) => answer === c.hit);
    }).length;
    const intro = make(
      "p",
      { class: "quiet" },
      `Two triangles can meet in few ways. Here are ${this.count} pairs, which the tests ask about; the library's own code, in WebAssembly, decides them as you look. `,
      make(
        "span",
        { id: "case-check" },
        `${right} of ${this.count} came out as written down, by all three arithmetics in float and double.`,
      ),
    );
    const corners = make("section", { "aria-label": "Corners" });
    for (const side of [0, 1]) {
      corners.append(make("h3", { class: side === 0 ? "side-reference" : "" }, side === 0 ? "Reference" : "Other"));
      for (let i = 3 * side; i < 3 * side + 3; ++i) corners.append(this.cornerFields(i));
    }
    corners.append(
      make(
        "p",
        { class: "quiet" },
        "Drag a corner in the picture, or type. +, 0, −: above, on or below the other's plane, in rational numbers; ·: the other spans no plane. Arrow keys in a field go by one; with Alt, by the smallest step of a float.",
      ),
    );
    const patterns = make(
      "details",
      { id: "pattern-box", ontoggle: () => this.drawPatterns() },
      make("summary", {}, "All patterns of sides"),
      this.patternCanvas,
      this.patternText,
    );
    this.patternCanvas.addEventListener("click", (event) => this.openPattern(event));
    byId("case-panel").replaceChildren(
      make("section", {}, intro, this.chooser, this.groupText),
      this.answer,
      corners,
      make("section", {}, patterns),
    );
  }

  private cornerFields(i: number): HTMLElement {
    const sign = make("span", { class: "sign" });
    this.signCells[i] = sign;
    const row = make("div", { class: "corner-fields" }, make("span", {}, `${"ABC"[i % 3]}${i < 3 ? "" : "′"} `, sign));
    for (let k = 0; k < 3; ++k) {
      const label = `${i < 3 ? "Reference" : "Other"}, corner ${"ABC"[i % 3]}, ${"xyz"[k]}`;
      const field = make("input", { type: "number", step: "1", "aria-label": label });
      field.addEventListener("input", () => this.typed(3 * i + k));
      field.addEventListener("keydown", (event) => this.nudge(event, 3 * i + k));
      this.fields[3 * i + k] = field;
      row.append(field);
    }
    return row;
  }

  show(): void {
    this.stage.active = true;
    this.view.show(this.stage);
    if (!this.started) {
      this.started = true;
      this.stage.look(true);
      this.open(this.index);
    } else {
      this.refresh();
    }
  }

  hide(): void {
    this.stage.active = false;
    this.view.canvas.style.cursor = "";
  }

  step(by: number): void {
    this.open((this.index + by + this.count) % this.count);
  }

  open(index: number): void {
    this.index = index;
    this.chooser.value = String(index);
    byId("case-number").textContent = `${index + 1} of ${this.count}`;
    this.groupText.textContent = this.configurations[index]!.group;
    this.set([...this.configurations[index]!.corners], true);
  }

  private set(corners: number[], center: boolean): void {
    this.corners = corners;
    if (center) this.stage.center(corners);
    this.refresh();
  }

  private moveCorner(corner: number, to: number[]): void {
    const snap = byId<HTMLInputElement>("case-snap").checked;
    const moved = to.map((x) => Math.fround(snap ? Math.round(x) : x));
    for (let k = 0; k < 3; ++k) this.corners[3 * corner + k] = moved[k]!;
    this.refresh();
  }

  private typed(at: number): void {
    const value = this.fields[at]!.valueAsNumber;
    this.fields[at]!.setAttribute("aria-invalid", String(!Number.isFinite(value)));
    if (!Number.isFinite(value) || Math.abs(value) > 1e6) return;
    this.corners[at] = Math.fround(value);
    this.refresh(at);
  }

  /** Alt and an arrow: the next float. */
  private nudge(event: KeyboardEvent, at: number): void {
    if (!event.altKey || (event.key !== "ArrowUp" && event.key !== "ArrowDown")) return;
    event.preventDefault();
    this.corners[at] = nextFloat(this.corners[at]!, event.key === "ArrowUp");
    this.refresh();
  }

  refresh(typing = -1): void {
    const { corners, predicate } = this;
    const float = predicate.answers(corners, "float");
    const double = predicate.answers(corners, "double");
    const common = predicate.commonPart(corners);
    const sides = predicate.sides(corners);
    if (this.stage.active) this.stage.draw({ corners, sides, hit: float.exact, common });
    this.fields.forEach((field, i) => {
      if (i !== typing) field.value = shortest(corners[i]!);
    });
    sides.forEach((side, i) => (this.signCells[i]!.textContent = signs[side]!));
    const answers = make(
      "table",
      { class: "answers" },
      make(
        "tr",
        {},
        make("td", {}),
        make("th", { scope: "col" }, "exact"),
        make("th", { scope: "col" }, "filtered"),
        make("th", { scope: "col" }, "fast"),
      ),
    );
    for (const [name, got] of [
      ["float", float],
      ["double", double],
    ] as const) {
      const cell = (hit: boolean) => make("td", { class: hit === got.exact ? "" : "differs" }, hit ? "yes" : "no");
      answers.append(
        make("tr", {}, make("th", { scope: "row" }, name), cell(got.exact), cell(got.filtered), cell(got.fast)),
      );
    }
    const contact = predicate.contact(corners, "float");
    const numbers = make("table", {});
    if (contact !== undefined) {
      for (const [name, values] of [
        ["point", contact.point],
        ["normal", contact.normal],
        ["depth", [contact.depth]],
      ] as const)
        numbers.append(
          make("tr", {}, make("th", { scope: "row" }, name), ...values.map((x) => make("td", {}, shortest(x)))),
        );
    }
    const part = partNames[common.length] ?? `an area of ${common.length} corners`;
    const isOriginal = corners.every((x, i) => x === this.configurations[this.index]!.corners[i]);
    byId<HTMLButtonElement>("case-reset").disabled = isOriginal;
    this.answer.replaceChildren(
      make(
        "p",
        { class: `answer ${float.exact ? "yes" : "no"}`, id: "case-touch" },
        float.exact ? "They touch" : "They do not touch",
      ),
      make("p", { id: "case-part" }, `In common: ${part}.`),
      answers,
      numbers,
    );
    if (this.patterns !== undefined) this.drawPatterns();
  }

  // --- patterns -----------------------------------------------------------------------------------------------------------------

  private drawPatterns(): void {
    if (!(byId("pattern-box") as HTMLDetailsElement).open) return;
    this.patterns ??= patternsOf(this.configurations, this.predicate);
    const pen = this.patternCanvas.getContext("2d")!;
    pen.clearRect(0, 0, 270, 270);
    const now = this.predicate.sides(this.corners).join();
    for (const [key, pattern] of this.patterns) {
      const [x, y] = [placeOf(pattern.sides.slice(3)) * 10, placeOf(pattern.sides) * 10];
      pen.fillStyle = cssColour(pattern.hits === 0 ? "miss" : pattern.hits === pattern.pairs ? "hit" : "reference");
      pen.globalAlpha = 0.75;
      pen.fillRect(x + 1, y + 1, 8, 8);
      pen.globalAlpha = 1;
      if (key === now) {
        pen.strokeStyle = cssColour("text");
        pen.lineWidth = 2;
        pen.strokeRect(x, y, 10, 10);
      }
    }
    this.patternText.textContent = `${this.patterns.size} patterns: rows are the sides of the reference's three corners, columns the other's, from −−− to +++. Orange: those of the pairs here all touch; grey: none do; blue: it depends on where. Click one to see it.`;
    this.patternCanvas.setAttribute("aria-label", `${this.patterns.size} patterns of sides`);
  }

  private openPattern(event: MouseEvent): void {
    const box = this.patternCanvas.getBoundingClientRect();
    const column = Math.floor(((event.clientX - box.left) / box.width) * 27);
    const row = Math.floor(((event.clientY - box.top) / box.height) * 27);
    for (const pattern of this.patterns?.values() ?? []) {
      if (placeOf(pattern.sides.slice(3)) !== column || placeOf(pattern.sides) !== row) continue;
      this.open(pattern.configuration);
      this.set([...pattern.corners], true);
    }
  }
}

export function nextFloat(x: number, up: boolean): number {
  const bits = new DataView(new ArrayBuffer(4));
  bits.setFloat32(0, x);
  if (bits.getFloat32(0) === 0) {
    bits.setUint32(0, up ? 1 : 0x80000001);
  } else {
    const away = bits.getFloat32(0) > 0 === up;
    bits.setUint32(0, bits.getUint32(0) + (away ? 1 : -1));
  }
  return bits.getFloat32(0);
}
