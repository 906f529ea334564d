// SPDX-License-Identifier: MIT
//
// What stands out in the picture: elements, edges, vertices and points of contacts, in the colours of sides a and b. They are drawn
// twice: where they can be seen, and faintly through what is before them.

import * as THREE from "three";
import { Scene } from "./scene";

/** What is to stand out: elements or vertices of a set, on side a or b. */
export interface Mark {
  set: number;
  side: "a" | "b";
  elements?: number[];
  vertices?: number[]; // of a mesh: one is a point, two an edge, three a face
  contact?: { result: number; row: number }; // its point
}

/** Where things are in the picture, at the present time. */
export interface Places {
  cornersOf(set: number, element: number): THREE.Vector3[];
  radiusOf(set: number, element: number): number;
  vertex(set: number, at: number): THREE.Vector3;
  placed(x: number, y: number, z: number, set: number): THREE.Vector3;
}

/** More elements of a mark are not drawn. */
export const markLimit = 400;
const sphereShape = new THREE.IcosahedronGeometry(1, 2).getAttribute("position").array as Float32Array;

function buffer(values: number[]): THREE.BufferGeometry {
  return new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(new Float32Array(values), 3));
}

export class Marks {
  readonly group = new THREE.Group();

  constructor(
    private readonly scene: Scene,
    private readonly places: Places,
  ) {}

  draw(marks: Mark[], inks: { a: string; b: string }): void {
    for (const child of this.group.children) {
      const drawn = child as THREE.Mesh;
      drawn.geometry.dispose();
      (drawn.material as THREE.Material).dispose();
    }
    this.group.clear();
    for (const side of ["b", "a"] as const) {
      const faces: number[] = [];
      const lines: number[] = [];
      const points: number[] = [];
      for (const mark of marks.filter((m) => m.side === side)) this.collect(mark, faces, lines, points);
      const ink = new THREE.Color(inks[side]);
      for (const through of [true, false]) {
        const look = {
          color: ink,
          transparent: through,
          opacity: through ? 0.3 : 1,
          depthTest: !through,
          depthWrite: false,
        };
        const offset = { polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2, side: THREE.DoubleSide };
        if (faces.length > 0) this.add(new THREE.Mesh(buffer(faces), new THREE.MeshBasicMaterial({ ...look, ...offset })));
        if (lines.length > 0)
          this.add(
            new THREE.LineSegments(buffer(lines), new THREE.LineBasicMaterial({ ...look, opacity: 1, depthTest: false })),
          );
        if (points.length > 0)
          this.add(
            new THREE.Points(
              buffer(points),
              new THREE.PointsMaterial({ ...look, size: 11, sizeAttenuation: false, opacity: 1, depthTest: false }),
            ),
          );
      }
    }
  }

  private add(object: THREE.Object3D): void {
    object.renderOrder = 2;
    object.frustumCulled = false;
    this.group.add(object);
  }

  private collect(mark: Mark, faces: number[], lines: number[], points: number[]): void {
    const set = this.scene.sets[mark.set]!;
    for (const e of (mark.elements ?? []).slice(0, markLimit)) {
      const corners = this.places.cornersOf(mark.set, e);
      if (set.shape === "spheres") {
        const r = this.places.radiusOf(mark.set, e) * 1.005;
        const c = corners[0]!;
        for (let i = 0; i < sphereShape.length; i += 3)
          faces.push(c.x + r * sphereShape[i]!, c.y + r * sphereShape[i + 1]!, c.z + r * sphereShape[i + 2]!);
        continue;
      }
      const into = set.shape === "segments" ? lines : set.shape === "points" ? points : faces;
      for (const p of corners) into.push(p.x, p.y, p.z);
      if (into !== faces) continue;
      for (let i = 0; i < corners.length; i += 3) {
        for (const [k, l] of [
          [0, 1],
          [1, 2],
          [2, 0],
        ] as const) {
          lines.push(...corners[i + k]!.toArray(), ...corners[i + l]!.toArray());
        }
      }
    }
    if (mark.contact !== undefined) {
      const { points: p } = this.scene.results[mark.contact.result]!;
      const at = 3 * mark.contact.row;
      points.push(...this.places.placed(p[at]!, p[at + 1]!, p[at + 2]!, mark.set).toArray());
    }
    const at = (mark.vertices ?? []).map((v) => this.places.vertex(mark.set, set.vertexAt(v)));
    if (at.length === 1) points.push(...at[0]!.toArray());
    if (at.length === 2) lines.push(...at[0]!.toArray(), ...at[1]!.toArray());
    if (at.length === 3) for (const p of at) faces.push(...p.toArray());
  }
}
