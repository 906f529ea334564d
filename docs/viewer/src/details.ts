// SPDX-License-Identifier: MIT
//
// What is said beside the picture of what is selected: numbers of a pair, a contact or an impact, or of an element and all that it
// touches.

import { brief, counted, make, shortest } from "./dom";
import {
  deepestContact,
  distinctResults,
  elementName,
  featureName,
  firstImpact,
  measureOf,
  noun,
  partnersOf,
  timeOf,
  timeText,
} from "./results";
import { featuresOf, hasPlaces, kindsOfImpact, placeOf, Result, Scene } from "./scene";

export type Selection = { kind: "element"; set: number; element: number } | { kind: "row"; result: number; row: number };

export interface Details {
  title: string;
  parts: HTMLElement[];
}

const mostPartners = 60;

export class DetailsWriter {
  constructor(
    private readonly scene: Scene,
    private readonly time: () => number,
    private readonly select: (selection: Selection, fly: boolean) => void,
  ) {}

  of(selection: Selection): Details {
    return selection.kind === "row"
      ? this.ofRow(selection.result, selection.row)
      : this.ofElement(selection.set, selection.element);
  }

  private numbers(title: string, values: ArrayLike<number>): HTMLElement {
    return make("tr", {}, make("th", { scope: "row" }, title), ...Array.from(values, (x) => make("td", {}, shortest(x))));
  }

  /** A point of the file, to which the scene's origin is added. */
  private place(title: string, point: ArrayLike<number>): HTMLElement {
    const { origin } = this.scene;
    const text = (x: number, k: number) =>
      origin[k] === 0 ? shortest(Math.fround(x)) : String(Number((x + origin[k]!).toPrecision(12)));
    return make("tr", {}, make("th", { scope: "row" }, title), ...Array.from(point, (x, k) => make("td", {}, text(x, k))));
  }

  private cornersTable(set: number, element: number): HTMLElement {
    const all = this.scene.sets[set]!;
    const { span, corners, radii, shape } = all;
    const table = make("table", { class: "corners" });
    for (const [name, values] of all.numbers) table.append(this.numbers(name, [values[element]!]));
    if (shape === "surfaces") return table;
    for (let i = 0; i < Math.min(span, 3); ++i) {
      const at = element * span + i;
      const title =
        shape === "spheres"
          ? "center"
          : corners !== undefined
            ? `vertex ${corners[at]}`
            : shape === "points"
              ? "point"
              : `corner ${i}`;
      table.append(this.place(title, placeOf(all, at, this.time())));
    }
    if (radii !== undefined) table.append(this.numbers("radius", [radii[element]!]));
    return table;
  }

  private sideTitle(side: "a" | "b", set: number, id: number): HTMLElement {
    const element = this.scene.sets[set]!.elementOf(id);
    return make(
      "h3",
      {},
      make("span", { class: `chip ${side}` }, side),
      make(
        "button",
        { type: "button", title: "Select it", onclick: () => this.select({ kind: "element", set, element }, true) },
        elementName(this.scene, set, id),
      ),
    );
  }

  private ofRow(number: number, row: number): Details {
    const scene = this.scene;
    const result = scene.results[number]!;
    if (result.kind === "impacts") return this.ofImpact(result, row);
    const parts: HTMLElement[] = [];
    if (hasPlaces(result)) {
      const table = make("table", { id: "contact-numbers" });
      table.append(
        result.kind === "contacts"
          ? this.numbers("depth", [result.depths[row]!])
          : this.numbers("of its way", [result.times[row]!]),
        this.place("point", result.points.subarray(3 * row, 3 * row + 3)),
        this.numbers("normal", result.normals.subarray(3 * row, 3 * row + 3)),
      );
      parts.push(table);
    }
    for (const [side, set, ids] of [
      ["a", result.a, result.aIds],
      ["b", result.b, result.bIds],
    ] as const) {
      parts.push(this.sideTitle(side, set, ids[row]!), this.cornersTable(set, scene.sets[set]!.elementOf(ids[row]!)));
    }
    const deepest = deepestContact(scene);
    const isDeepest = deepest?.result === number && deepest.row === row;
    return {
      title: isDeepest
        ? `Deepest contact (number ${row})`
        : `${{ pairs: "Pair", contacts: "Contact", sweeps: "Touch", safe_step: "" }[result.kind]} ${row}`,
      parts,
    };
  }

  private ofImpact(result: Result, row: number): Details {
    const scene = this.scene;
    const table = make(
      "table",
      {},
      make(
        "tr",
        {},
        make("th", { scope: "row" }, "time"),
        make(
          "td",
          { id: "impact-time" },
          timeText(result, row) + (scene.duration > 1 ? ` of step ${result.step}` : ""),
        ),
      ),
      make("tr", {}, make("th", { scope: "row" }, "kind"), make("td", {}, kindsOfImpact[result.kinds[row]!]!)),
    );
    const parts: HTMLElement[] = [table];
    featuresOf(result, row).forEach((feature, i) => {
      const side = i === 0 ? "a" : "b";
      parts.push(
        make(
          "h3",
          {},
          make("span", { class: `chip ${side}` }, side),
          `${featureName(feature.vertices)} of ${scene.sets[feature.set]!.name}`,
        ),
      );
      const set = scene.sets[feature.set]!;
      const places = make("table", { class: "corners" });
      for (const v of feature.vertices) {
        places.append(this.place(`vertex ${v}`, placeOf(set, set.vertexAt(v), timeOf(result, row))));
      }
      parts.push(places);
    });
    const first = firstImpact(scene);
    const isFirst = first !== undefined && scene.results[first.result] === result && first.row === row;
    return { title: isFirst ? `First impact (number ${row})` : `Impact ${row}`, parts };
  }

  private ofElement(set: number, element: number): Details {
    const scene = this.scene;
    const id = scene.sets[set]!.ids[element]!;
    const parts: HTMLElement[] = [
      make(
        "p",
        {},
        make("span", { class: "chip a" }, "a"),
        ` set `,
        make("b", {}, scene.sets[set]!.name),
        `, id `,
        make("b", { id: "picked-id" }, String(id)),
      ),
      this.cornersTable(set, element),
    ];
    for (const number of distinctResults(scene)) {
      const result = scene.results[number]!;
      if (result.a !== set && result.b !== set) continue;
      const partners = partnersOf(scene, result, set, element);
      const what =
        result.kind === "impacts"
          ? counted(partners.length, "impact")
          : counted(partners.length, result.kind === "contacts" ? "contact" : result.kind === "sweeps" ? "touch" : "pair");
      parts.push(make("h3", {}, partners.length === 0 ? `no ${result.kind}` : what));
      const items = partners.slice(0, mostPartners).map((partner) => {
        const text =
          result.kind === "impacts"
            ? `t = ${brief(result.times[partner.row]!)}`
            : `${noun(scene, partner.set)} ${scene.sets[partner.set]!.ids[partner.element]}` +
              (hasPlaces(result) ? `, ${measureOf(result, partner.row)}` : "");
        return make(
          "li",
          {},
          make(
            "button",
            { type: "button", onclick: () => this.select({ kind: "row", result: number, row: partner.row }, true) },
            text,
          ),
        );
      });
      if (items.length > 0) parts.push(make("ul", { class: "partners" }, ...items));
      if (partners.length > mostPartners)
        parts.push(
          make("p", { class: "quiet" }, `and ${partners.length - mostPartners} more; the list finds them by the id.`),
        );
    }
    return { title: elementName(scene, set, id), parts };
  }
}
