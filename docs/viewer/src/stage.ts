// SPDX-License-Identifier: MIT
//
// A scene, drawn: one buffer and one draw call a set, however many elements it has. Coordinates on the screen are those of
// the file, moved and scaled so that the scene fits into a ball of radius 1: scenes that are huge, tiny or far away look alike.

import * as THREE from "three";
import { Mark, markLimit, Marks } from "./marks";
import { greatest, hasPlaces, hitsAt, placeOf, Result, Role, Scene, ShapeSet, stretchOf } from "./scene";
import { placeArrow, placeSegment, placeShape, shadeArrow, shadeShape, writeCode } from "./shaders";
import { View, World } from "./view";

export interface Palette {
  background: string;
  ink: string;
  struck: string;
  sets: string[];
  shallow: string;
  deepest: string;
  a: string;
  b: string;
  roles: { [role in Role]: string };
}

/** How shapes are drawn that touch nothing. */
export type Bodies = "solid" | "ghost" | "faint";
const veils = { solid: 1, ghost: 0.75, faint: 0.3 };

/** What lies under the pointer: an element of a set, or a contact. */
export type Picked = { set: number; element: number } | { result: number; row: number };

interface Part {
  group: THREE.Group;
  object: THREE.Object3D;
  ghost: THREE.Object3D | undefined; // of a surface: its elements that are not hit, where bodies are ghosts
  seen: THREE.ShaderMaterial;
  code: THREE.ShaderMaterial;
  part: { value: number }; // of the way from one frame to the next
  stretch: number; // which frames are on the way now
  away: THREE.Vector3;
  base: number;
  count: number;
}

function colour(text: string): THREE.Color {
  return new THREE.Color(text);
}

export class Stage implements World {
  readonly root = new THREE.Scene();
  readonly origin: THREE.Vector3;
  readonly scale: number;
  private readonly content = new THREE.Group();
  private readonly parts: Part[] = [];
  private readonly arrows: (Part & { result: number })[] = [];
  private readonly marks: Marks;
  private readonly shared = {
    seen: { value: 0 }, // which elements are drawn: placeShape
    picked: { value: 0 },
    others: { value: 2 },
    veil: { value: 0.5 },
    pointSize: { value: 7 },
    screen: { value: new THREE.Vector2(1, 1) },
    ink: { value: colour("#000") },
  };
  private readonly target = new THREE.WebGLRenderTarget(9, 9, {
    minFilter: THREE.NearestFilter,
    magFilter: THREE.NearestFilter,
  });
  private marked: Mark[] = [];
  private palette: Palette | undefined;
  private explosion = 0;
  private reach = 0.06;
  private now = 0;
  private shownStep = -1;

  constructor(
    readonly scene: Scene,
    private readonly view: View,
  ) {
    const box = new THREE.Box3();
    for (const set of scene.sets) grow(box, set);
    const radius = box.isEmpty() ? 1 : box.getSize(new THREE.Vector3()).length() / 2;
    this.origin = box.isEmpty() ? new THREE.Vector3() : box.getCenter(new THREE.Vector3());
    this.scale = radius > 0 && Number.isFinite(radius) ? 1 / radius : 1;
    let base = 1;
    scene.sets.forEach((set, number) => {
      const part = this.shapes(set, base, number);
      this.parts.push(part);
      base += set.count;
    });
    scene.results.forEach((result, number) => {
      if (!hasPlaces(result) || result.count === 0) return;
      this.arrows.push({ ...this.contacts(result, base), result: number });
      base += result.count;
    });
    this.marks = new Marks(scene, this);
    this.content.add(this.marks.group);
    this.root.add(this.content);
    this.step = 0;
  }

  // --- buffers ------------------------------------------------------------------------------------------------------------

  private scaled(values: Float32Array, isPoint: boolean): Float32Array {
    const { origin: o, scale: s } = this;
    const out = new Float32Array(values.length);
    const [x, y, z] = isPoint ? [o.x, o.y, o.z] : [0, 0, 0];
    for (let i = 0; i < values.length; i += 3) {
      out[i] = (values[i]! - x) * s;
      out[i + 1] = (values[i + 1]! - y) * s;
      out[i + 2] = (values[i + 2]! - z) * s;
    }
    return out;
  }

  private material(
    vertex: string,
    fragment: string,
    defines: { [name: string]: string | number },
    uniforms: object,
  ): THREE.ShaderMaterial {
    return new THREE.ShaderMaterial({
      glslVersion: THREE.GLSL3,
      vertexShader: vertex,
      fragmentShader: fragment,
      defines,
      side: THREE.DoubleSide,
      uniforms: uniforms as { [name: string]: THREE.IUniform },
    });
  }

  private shapes(set: ShapeSet, base: number, number: number): Part {
    const points = this.scaled(set.positions, true);
    const isSurface = set.shape === "triangles" || set.shape === "boxes" || set.shape === "surfaces" || set.shape === "spheres";
    const defines: { [name: string]: string | number } = { SPAN: set.span };
    if (isSurface) defines.SURFACE = 1;
    // Segments that stand still are as wide as they are looked at; others are lines of one pixel.
    const isWide = set.shape === "segments" && set.frames.length === 0;
    let geometry: THREE.BufferGeometry;
    if (isWide) {
      const instanced = new THREE.InstancedBufferGeometry();
      const quad = new Float32Array([0, 1, 0, 0, -1, 0, 1, -1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0]);
      instanced.setAttribute("position", new THREE.BufferAttribute(quad, 3));
      const ends = new THREE.InstancedInterleavedBuffer(points, 6);
      instanced.setAttribute("from", new THREE.InterleavedBufferAttribute(ends, 3, 0));
      instanced.setAttribute("to", new THREE.InterleavedBufferAttribute(ends, 3, 3));
      instanced.setAttribute("hit", new THREE.InstancedBufferAttribute(set.hit.slice(), 1));
      instanced.instanceCount = set.count;
      geometry = instanced;
    } else if (set.shape === "spheres") {
      defines.SPHERES = 1;
      const rings = set.count <= 500 ? 24 : set.count <= 20000 ? 12 : 7;
      const ball = new THREE.SphereGeometry(1, 2 * rings, rings);
      const instanced = new THREE.InstancedBufferGeometry();
      instanced.setIndex(ball.getIndex());
      instanced.setAttribute("position", ball.getAttribute("position"));
      instanced.setAttribute("center", new THREE.InstancedBufferAttribute(points, 3));
      instanced.setAttribute(
        "radius",
        new THREE.InstancedBufferAttribute(
          set.radii!.map((r) => r * this.scale),
          1,
        ),
      );
      instanced.setAttribute("hit", new THREE.InstancedBufferAttribute(set.hit.slice(), 1));
      instanced.instanceCount = set.count;
      geometry = instanced;
    } else {
      geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(points, 3));
      geometry.setAttribute("hit", new THREE.BufferAttribute(new Uint8Array(points.length / 3), 1));
      if (set.frames.length > 0) {
        defines.MOVES = 1;
        geometry.setAttribute("moveFrom", new THREE.BufferAttribute(new Float32Array(points.length), 3));
        geometry.setAttribute("moveTo", new THREE.BufferAttribute(this.scaled(set.frames[0]!, false), 3));
      }
    }
    const { pointSize, ink, screen, veil } = this.shared;
    const part = { value: 0 };
    const width = { value: set.role === "" ? 2 : 3.5 };
    const placed = { part, pointSize, screen, width };
    const place = isWide ? placeSegment : placeShape;
    const look = {
      ...placed,
      ink,
      plain: { value: colour("#888") },
      struck: { value: colour("#e80") },
      contrast: { value: 1 },
    };
    // What is no surface is thin, and hides nothing: it is no ghost.
    const which = isSurface ? this.shared.seen : this.shared.picked;
    const seen = this.material(place, shadeShape, defines, { ...look, which });
    const coded = { ...placed, which: this.shared.picked, base: { value: base } };
    const code = this.material(place, writeCode, { ...defines, PICK: 1 }, coded);
    if (set.role === "patches") Object.assign(seen, { polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4 });
    const object =
      isSurface || isWide
        ? new THREE.Mesh(geometry, seen)
        : set.shape === "segments"
          ? new THREE.LineSegments(geometry, seen)
          : new THREE.Points(geometry, seen);
    const made = { ...this.part(object, seen, code, base, set.count, this.wayOut(set, number)), part };
    if (isSurface) {
      const faint = this.material(place, shadeShape, { ...defines, GHOST: 1 }, { ...look, which: this.shared.others, veil });
      Object.assign(faint, { transparent: true, depthWrite: false });
      made.ghost = new THREE.Mesh(geometry, faint);
      made.ghost.frustumCulled = false;
      made.ghost.visible = false;
      made.group.add(made.ghost);
    }
    return made;
  }

  private part(
    object: THREE.Object3D,
    seen: THREE.ShaderMaterial,
    code: THREE.ShaderMaterial,
    base: number,
    count: number,
    away: THREE.Vector3,
  ): Part {
    object.frustumCulled = false;
    const group = new THREE.Group();
    group.add(object);
    this.content.add(group);
    return { group, object, ghost: undefined, seen, code, away, base, count, part: { value: 0 }, stretch: 0 };
  }

  /** Where a set goes when sets are moved apart: away from the middle, or along x, which is as good as any. */
  private wayOut(set: ShapeSet, number: number): THREE.Vector3 {
    const count = this.scene.sets.length;
    if (count < 2) return new THREE.Vector3();
    const box = new THREE.Box3();
    grow(box, set);
    const way = box.isEmpty()
      ? new THREE.Vector3()
      : box.getCenter(new THREE.Vector3()).sub(this.origin).multiplyScalar(this.scale);
    if (way.length() < 0.1 || count === 2) {
      const first = way.clone();
      if (count === 2 && first.length() > 0.02) return first.normalize();
      return new THREE.Vector3((2 * number) / (count - 1) - 1, 0, 0);
    }
    return way.normalize();
  }

  private contacts(result: Result, base: number): Part {
    const geometry = new THREE.InstancedBufferGeometry();
    const shaft = [0, 1, 0, 0, -1, 0, 1, -1, 0, 0, 1, 0, 1, -1, 0, 1, 1, 0];
    const head = [1, 1, 1, 1, -1, 1, 2, 0, 1];
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([...shaft, ...head]), 3));
    geometry.setAttribute("foot", new THREE.InstancedBufferAttribute(this.scaled(result.points, true), 3));
    geometry.setAttribute("normal_", new THREE.InstancedBufferAttribute(result.normals, 3));
    const depths = result.kind === "contacts" ? result.depths : new Float32Array(result.count).fill(1);
    const most = depths[greatest(depths)]! || 1;
    geometry.setAttribute(
      "depth",
      new THREE.InstancedBufferAttribute(
        depths.map((d) => d / most),
        1,
      ),
    );
    geometry.instanceCount = result.count;
    const placed = { screen: this.shared.screen, reach: { value: 0.06 }, thickness: { value: 2 }, only: { value: -1 } };
    const seen = this.material(
      placeArrow,
      shadeArrow,
      {},
      { ...placed, shallow: { value: colour("#000") }, deepest: { value: colour("#000") } },
    );
    const code = this.material(placeArrow, writeCode, { PICK: 1 }, { ...placed, base: { value: base } });
    const part = this.part(new THREE.Mesh(geometry, seen), seen, code, base, result.count, new THREE.Vector3());
    part.object.renderOrder = 1;
    return part;
  }

  // --- what the controls set ----------------------------------------------------------------------------------------------

  paint(palette: Palette): void {
    this.palette = palette;
    this.shared.ink.value.set(palette.ink);
    this.parts.forEach((part, i) => {
      part.seen.uniforms.plain!.value.set(palette.sets[i % palette.sets.length]!);
      const { role } = this.scene.sets[i]!;
      part.seen.uniforms.struck!.value.set(role === "" ? palette.struck : palette.roles[role]);
    });
    for (const { seen } of this.arrows) {
      seen.uniforms.shallow!.value.set(palette.shallow);
      seen.uniforms.deepest!.value.set(palette.deepest);
    }
    this.redrawMarks();
  }

  get time(): number {
    return this.now;
  }
  set time(value: number) {
    this.now = value;
    this.scene.sets.forEach((set, i) => {
      if (set.frames.length === 0) return;
      const part = this.parts[i]!;
      const [from, passed] = stretchOf(set, value);
      part.part.value = passed;
      if (part.stretch === from) return;
      part.stretch = from;
      const geometry = (part.object as THREE.Mesh).geometry;
      for (const [name, frame] of [
        ["moveFrom", set.frames[from - 1]],
        ["moveTo", set.frames[from]],
      ] as const) {
        const attribute = geometry.getAttribute(name) as THREE.BufferAttribute;
        if (frame === undefined) (attribute.array as Float32Array).fill(0);
        else (attribute.array as Float32Array).set(this.scaled(frame, false));
        attribute.needsUpdate = true;
      }
    });
    this.redrawMarks();
  }

  /** Which step of a motion is shown: what is hit in another one is not marked. */
  set step(value: number) {
    if (value === this.shownStep) return;
    this.shownStep = value;
    this.scene.sets.forEach((set, i) => {
      const attribute = (this.parts[i]!.object as THREE.Mesh).geometry.getAttribute("hit") as THREE.BufferAttribute;
      const hit = hitsAt(set, value);
      const copies = attribute.count / Math.max(1, set.count); // vertices of an element
      for (let e = 0; e < set.count; ++e) attribute.array.fill(hit[e]!, e * copies, (e + 1) * copies);
      attribute.needsUpdate = true;
    });
    this.view.draw();
  }
  get step(): number {
    return this.shownStep;
  }

  set bodies(value: Bodies) {
    const { seen, picked, veil } = this.shared;
    seen.value = value === "solid" ? 0 : 1;
    picked.value = value === "faint" ? 1 : 0; // a click goes through what is left out
    veil.value = veils[value];
    for (const { ghost } of this.parts) if (ghost !== undefined) ghost.visible = value !== "solid";
    this.view.draw();
  }

  set explode(value: number) {
    this.explosion = value;
    for (const part of this.parts) part.group.position.copy(part.away).multiplyScalar(value);
    for (const arrow of this.arrows)
      arrow.group.position.copy(this.parts[this.scene.results[arrow.result]!.a]!.group.position);
    this.redrawMarks();
  }

  set zUp(value: boolean) {
    this.content.rotation.x = value ? -Math.PI / 2 : 0;
    this.content.updateMatrixWorld(true);
    this.view.draw();
  }

  set arrowLength(value: number) {
    this.reach = value;
    this.view.draw();
  }

  showSet(number: number, visible: boolean): void {
    this.parts[number]!.group.visible = visible;
    this.view.draw();
  }

  /** Arrows of one result, of one contact of it, or of none. */
  showArrows(result: number, row: number, visible: boolean): void {
    for (const arrow of this.arrows) {
      arrow.object.visible = visible && arrow.result === result;
      arrow.seen.uniforms.only!.value = row;
      arrow.seen.depthTest = row < 0; // the one that is asked for is seen through what is before it
    }
    this.view.draw();
  }

  // --- places ---------------------------------------------------------------------------------------------------------------

  /** A point of the file, at the present time, as a point of the world. `set` is the one it moves with. */
  placed(x: number, y: number, z: number, set: number): THREE.Vector3 {
    const p = new THREE.Vector3(
      (x - this.origin.x) * this.scale,
      (y - this.origin.y) * this.scale,
      (z - this.origin.z) * this.scale,
    );
    return p.addScaledVector(this.parts[set]!.away, this.explosion);
  }

  vertex(set: number, at: number): THREE.Vector3 {
    return this.placed(...placeOf(this.scene.sets[set]!, at, this.now), set);
  }

  /** The corners of an element in the world, without the rotation of `zUp`. */
  cornersOf(set: number, element: number): THREE.Vector3[] {
    const { span } = this.scene.sets[set]!;
    return Array.from({ length: span }, (_, i) => this.vertex(set, element * span + i));
  }

  radiusOf(set: number, element: number): number {
    return (this.scene.sets[set]!.radii?.[element] ?? 0) * this.scale;
  }

  /** A ball around elements: where to look. */
  ballOf(marks: Mark[]): THREE.Sphere {
    const points: THREE.Vector3[] = [];
    let radius = 0;
    for (const mark of marks) {
      for (const e of (mark.elements ?? []).slice(0, markLimit)) {
        points.push(...this.cornersOf(mark.set, e));
        radius = Math.max(radius, this.radiusOf(mark.set, e));
      }
      for (const v of mark.vertices ?? []) points.push(this.vertex(mark.set, this.scene.sets[mark.set]!.vertexAt(v)));
    }
    const ball = points.length > 0 ? new THREE.Sphere().setFromPoints(points) : new THREE.Sphere(new THREE.Vector3(), 1);
    ball.radius += radius;
    return ball.applyMatrix4(this.content.matrixWorld);
  }

  /** The direction, in the world, from which the faces of a mark are seen from their front; none of what has no front. */
  frontOf(mark: Mark): THREE.Vector3 | undefined {
    const set = this.scene.sets[mark.set]!;
    if (set.shape !== "triangles") return undefined;
    const faces = [...(mark.elements ?? []).map((e) => this.cornersOf(mark.set, e))];
    if (mark.vertices?.length === 3) faces.push(mark.vertices.map((v) => this.vertex(mark.set, set.vertexAt(v))));
    const front = new THREE.Vector3();
    for (const [p, q, r] of faces) front.add(q!.clone().sub(p!).cross(r!.clone().sub(p!)));
    if (!(front.lengthSq() > 0)) return undefined;
    return front.normalize().applyQuaternion(this.content.quaternion);
  }

  /** The middle of an element on the screen. */
  screenOf(set: number, element: number): { x: number; y: number; inFront: boolean } {
    const corners = this.cornersOf(set, element);
    const middle = corners.reduce((sum, p) => sum.add(p), new THREE.Vector3()).divideScalar(corners.length);
    return this.view.toScreen(middle.applyMatrix4(this.content.matrixWorld));
  }

  pointOfContact(result: number, row: number): THREE.Vector3 {
    const { points: p, a } = this.scene.results[result]!;
    return this.placed(p[3 * row]!, p[3 * row + 1]!, p[3 * row + 2]!, a).applyMatrix4(this.content.matrixWorld);
  }

  // --- what stands out --------------------------------------------------------------------------------------------------------

  mark(marks: Mark[]): void {
    this.marked = marks;
    this.redrawMarks();
  }

  private redrawMarks(): void {
    this.view.draw();
    if (this.palette !== undefined) this.marks.draw(this.marked, { a: this.palette.a, b: this.palette.b });
  }

  // --- picking ------------------------------------------------------------------------------------------------------------------

  /** The element or contact at a pixel, or within 4 pixels of it. */
  pick(x: number, y: number): Picked | undefined {
    const { renderer, camera, width, height } = this.view;
    const size = 9;
    const drawn = [...this.parts, ...this.arrows];
    const background = renderer.getClearColor(new THREE.Color());
    camera.setViewOffset(width, height, Math.floor(x) - 4, Math.floor(y) - 4, size, size);
    const screen = this.shared.screen.value.clone();
    this.shared.screen.value.set(size / 2, size / 2);
    this.marks.group.visible = false;
    const ghosts = this.parts.flatMap(({ ghost }) => (ghost?.visible === true ? [ghost] : []));
    for (const ghost of ghosts) ghost.visible = false;
    for (const part of drawn) (part.object as THREE.Mesh).material = part.code;
    renderer.setRenderTarget(this.target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(this.root, camera);
    const pixels = new Uint8Array(4 * size * size);
    renderer.readRenderTargetPixels(this.target, 0, 0, size, size, pixels);
    renderer.setRenderTarget(null);
    renderer.setClearColor(background, 1);
    for (const part of drawn) (part.object as THREE.Mesh).material = part.seen;
    this.marks.group.visible = true;
    for (const ghost of ghosts) ghost.visible = true;
    this.shared.screen.value.copy(screen);
    camera.clearViewOffset();
    let best = Infinity;
    let code = 0;
    for (let i = 0; i < size * size; ++i) {
      const value = pixels[4 * i]! + pixels[4 * i + 1]! * 256 + pixels[4 * i + 2]! * 65536 + pixels[4 * i + 3]! * 16777216;
      const far = ((i % size) - 4) ** 2 + (Math.floor(i / size) - 4) ** 2;
      if (value !== 0 && far < best) [best, code] = [far, value];
    }
    if (code === 0) return undefined;
    const set = this.parts.findIndex((part) => code >= part.base && code < part.base + part.count);
    if (set >= 0) return { set, element: code - this.parts[set]!.base };
    const arrow = this.arrows.find((part) => code >= part.base && code < part.base + part.count);
    return arrow && { result: arrow.result, row: code - arrow.base };
  }

  before(camera: THREE.PerspectiveCamera, width: number, height: number): void {
    this.shared.screen.value.set(width / 2, height / 2);
    for (const { seen } of this.arrows) {
      // One arrow alone stays within the picture, however near that is. `code` has the same uniform.
      const most = seen.uniforms.only!.value < 0 ? Infinity : 0.2 * camera.position.distanceTo(this.view.controls.target);
      seen.uniforms.reach!.value = Math.min(this.reach, most);
    }
  }

  dispose(): void {
    for (const part of [...this.parts, ...this.arrows]) {
      (part.object as THREE.Mesh).geometry.dispose();
      ((part.ghost as THREE.Mesh | undefined)?.material as THREE.Material | undefined)?.dispose();
      part.seen.dispose();
      part.code.dispose();
    }
    this.mark([]);
    this.target.dispose();
  }
}

function grow(box: THREE.Box3, set: ShapeSet): void {
  const { positions: p, radii } = set;
  if (p.length === 0) return;
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const frame of [undefined, ...set.frames]) {
    for (let i = 0; i < p.length; ++i) {
      const axis = i % 3;
      const r = radii?.[Math.floor(i / 3)] ?? 0;
      const x = p[i]! + (frame?.[i] ?? 0);
      if (x - r < low[axis]!) low[axis] = x - r;
      if (x + r > high[axis]!) high[axis] = x + r;
    }
  }
  box.union(new THREE.Box3(new THREE.Vector3(...low), new THREE.Vector3(...high)));
}
