// SPDX-License-Identifier: MIT
//
// Two triangles, drawn: both planes and the line in which they meet, what the triangles have in common, and corners to drag.

import * as THREE from "three";
import { cssColour } from "./dom";
import { Label, Labels } from "./labels";
import { View, World } from "./view";

export interface CasePicture {
  corners: number[];
  sides: number[];
  hit: boolean;
  common: number[][];
}

const signs: { [side: number]: string } = { [-1]: "−", 0: "0", 1: "+", 2: "·" };
const unit = 0.11; // one step of the coordinates in the world

type Vector = THREE.Vector3;

export class CaseStage implements World {
  readonly root = new THREE.Scene();
  private readonly content = new THREE.Group();
  private readonly handles: THREE.Mesh[] = [];
  private picture: CasePicture | undefined;
  private readonly middle = new THREE.Vector3();
  private dragged = -1;
  planes = true;

  constructor(
    private readonly view: View,
    private readonly labels: Labels,
    private readonly moved: (corner: number, to: Vector) => void,
  ) {
    // In the tests' picture z is up and the reference lies flat.
    this.root.rotation.x = -Math.PI / 2;
    this.root.add(this.content);
    const canvas = view.canvas;
    canvas.addEventListener("pointerdown", (event) => this.press(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.drag(event));
    for (const end of ["pointerup", "pointercancel"] as const) canvas.addEventListener(end, () => this.release());
  }

  active = false;

  /** Puts the middle of the triangles into the middle of the view. */
  center(corners: number[]): void {
    const box = new THREE.Box3();
    for (let i = 0; i < 6; ++i)
      box.expandByPoint(new THREE.Vector3(...(corners.slice(3 * i, 3 * i + 3) as [number, number, number])));
    box.getCenter(this.middle);
  }

  look(atOnce: boolean): void {
    const away = 3.6 / Math.min(1, this.view.camera.aspect) ** 0.8;
    const direction = new THREE.Vector3(-0.42, 0.5, 0.95).normalize();
    const target = new THREE.Vector3(0, -0.1, 0);
    if (atOnce) this.view.place(target.clone().addScaledVector(direction, away), target);
    else this.view.fly(target, away, direction);
  }

  private at(p: ArrayLike<number>, i = 0): Vector {
    return new THREE.Vector3(p[3 * i]!, p[3 * i + 1]!, p[3 * i + 2]!).sub(this.middle).multiplyScalar(unit);
  }

  draw(picture: CasePicture): void {
    this.picture = picture;
    this.content.traverse((object) => {
      const drawn = object as THREE.Mesh;
      drawn.geometry?.dispose();
      (drawn.material as THREE.Material | undefined)?.dispose();
    });
    this.content.clear();
    this.handles.length = 0;
    const corners = Array.from({ length: 6 }, (_, i) => this.at(picture.corners, i));
    const look = [cssColour("reference"), cssColour(picture.hit ? "hit" : "miss")];
    for (const side of [0, 1]) {
      const own = corners.slice(3 * side, 3 * side + 3);
      this.triangle(own, look[side]!, side === 0 ? 0.42 : 0.72);
      if (this.planes) this.plane(own, look[side]!);
    }
    if (this.planes) this.lineOfPlanes(corners);
    this.commonPart(picture.common.map((p) => this.at(p)));
    corners.forEach((p, i) => this.handle(p, look[i < 3 ? 0 : 1]!, i));
    this.writeLabels(corners);
    this.view.draw();
  }

  private add(object: THREE.Object3D, order: number): void {
    object.renderOrder = order;
    this.content.add(object);
  }

  private triangle(p: Vector[], ink: string, opacity: number): void {
    const face = new THREE.BufferGeometry().setFromPoints(p);
    this.add(
      new THREE.Mesh(
        face,
        new THREE.MeshBasicMaterial({ color: ink, transparent: true, opacity, side: THREE.DoubleSide, depthWrite: false }),
      ),
      1,
    );
    this.add(
      new THREE.LineLoop(new THREE.BufferGeometry().setFromPoints(p), new THREE.LineBasicMaterial({ color: ink })),
      2,
    );
  }

  private normal(p: Vector[]): Vector {
    return p[1]!.clone().sub(p[0]!).cross(p[2]!.clone().sub(p[0]!));
  }

  /** A disc of the plane around the triangle, with rings and spokes so that its tilt can be seen. */
  private plane(p: Vector[], ink: string): void {
    const normal = this.normal(p);
    if (normal.length() < 1e-9) return;
    const middle = p[0]!.clone().add(p[1]!).add(p[2]!).divideScalar(3);
    const reach = 1.5 * Math.max(...p.map((corner) => corner.distanceTo(middle)), 0.4);
    const group = new THREE.Group();
    group.add(
      new THREE.Mesh(
        new THREE.CircleGeometry(reach, 72),
        new THREE.MeshBasicMaterial({
          color: ink,
          transparent: true,
          opacity: 0.07,
          side: THREE.DoubleSide,
          depthWrite: false,
        }),
      ),
    );
    const grid = new THREE.PolarGridHelper(reach, 8, 4, 72, ink, ink);
    grid.rotation.x = Math.PI / 2;
    Object.assign(grid.material, { transparent: true, opacity: 0.13, depthWrite: false });
    group.add(grid);
    group.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal.normalize());
    group.position.copy(middle);
    this.add(group, 0);
  }

  private lineOfPlanes(corners: Vector[]): void {
    const [n, m] = [this.normal(corners.slice(0, 3)), this.normal(corners.slice(3))];
    const along = n.clone().cross(m);
    if (along.length() < 1e-7 * n.length() * m.length() || along.lengthSq() === 0) return;
    const square = along.lengthSq();
    const base = m
      .clone()
      .multiplyScalar(n.dot(corners[0]!))
      .sub(n.clone().multiplyScalar(m.dot(corners[3]!)))
      .cross(along)
      .divideScalar(square);
    const ends = corners.map((p) => p.clone().sub(base).dot(along) / square);
    const [low, high] = [Math.min(...ends), Math.max(...ends)];
    const more = (high - low) * 0.15;
    const line = new THREE.Line(
      new THREE.BufferGeometry().setFromPoints([low - more, high + more].map((t) => base.clone().addScaledVector(along, t))),
      new THREE.LineDashedMaterial({ color: cssColour("quiet"), dashSize: 0.05, gapSize: 0.035 }),
    );
    line.computeLineDistances();
    this.add(line, 2);
  }

  private commonPart(p: Vector[]): void {
    const ink = cssColour("part");
    const solid = (geometry: THREE.BufferGeometry) =>
      this.add(
        new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ color: ink, depthTest: false, transparent: true })),
        4,
      );
    for (const q of p) solid(new THREE.SphereGeometry(p.length === 1 ? 0.032 : 0.018, 20, 14).translate(q.x, q.y, q.z));
    const edges = p.length === 2 ? 1 : p.length > 2 ? p.length : 0;
    for (let i = 0; i < edges; ++i) {
      const [from, to] = [p[i]!, p[(i + 1) % p.length]!];
      solid(new THREE.TubeGeometry(new THREE.LineCurve3(from, to), 1, 0.011, 10));
    }
    if (p.length > 2) {
      const fan = p.slice(2).flatMap((_, i) => [p[0]!, p[i + 1]!, p[i + 2]!]);
      this.add(
        new THREE.Mesh(
          new THREE.BufferGeometry().setFromPoints(fan),
          new THREE.MeshBasicMaterial({
            color: ink,
            transparent: true,
            opacity: 0.45,
            side: THREE.DoubleSide,
            depthTest: false,
          }),
        ),
        3,
      );
    }
  }

  private handle(p: Vector, ink: string, number: number): void {
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.024, 20, 14), new THREE.MeshBasicMaterial({ color: ink }));
    ball.position.copy(p);
    ball.userData.number = number;
    this.handles.push(ball);
    this.add(ball, 2);
  }

  private writeLabels(corners: Vector[]): void {
    this.root.updateMatrixWorld(true);
    if (!this.active) return;
    const words: Label[] = corners.map((p, i) => ({
      at: p.clone().applyMatrix4(this.root.matrixWorld),
      text: `${"ABC"[i % 3]}${i < 3 ? "" : "′"} ${signs[this.picture!.sides[i]!]}`,
      look: i < 3 ? "sign reference" : "sign other",
    }));
    this.labels.set(words);
  }

  // --- dragging ---------------------------------------------------------------------------------------------------------------

  private nearest(event: PointerEvent): number {
    const box = this.view.canvas.getBoundingClientRect();
    let best = 18; // pixels
    let found = -1;
    for (const handle of this.handles) {
      const at = this.view.toScreen(handle.position.clone().applyMatrix4(this.root.matrixWorld));
      const far = Math.hypot(at.x - (event.clientX - box.left), at.y - (event.clientY - box.top));
      if (far < best) [best, found] = [far, handle.userData.number as number];
    }
    return found;
  }

  screenOfCorner(i: number): { x: number; y: number } {
    return this.view.toScreen(this.handles[i]!.position.clone().applyMatrix4(this.root.matrixWorld));
  }

  private press(event: PointerEvent): void {
    if (!this.active || event.button !== 0) return;
    this.dragged = this.nearest(event);
    if (this.dragged < 0) return;
    this.view.controls.enabled = false;
    this.view.canvas.setPointerCapture(event.pointerId);
  }

  private drag(event: PointerEvent): void {
    if (!this.active) return;
    if (this.dragged < 0) {
      this.view.canvas.style.cursor = event.buttons === 0 && this.nearest(event) >= 0 ? "grab" : "";
      return;
    }
    const box = this.view.canvas.getBoundingClientRect();
    const pointer = new THREE.Vector2(
      ((event.clientX - box.left) / box.width) * 2 - 1,
      1 - ((event.clientY - box.top) / box.height) * 2,
    );
    const ray = new THREE.Raycaster();
    ray.setFromCamera(pointer, this.view.camera);
    const at = this.handles[this.dragged]!.position.clone().applyMatrix4(this.root.matrixWorld);
    const facing = new THREE.Plane().setFromNormalAndCoplanarPoint(
      this.view.camera.getWorldDirection(new THREE.Vector3()),
      at,
    );
    const hit = ray.ray.intersectPlane(facing, new THREE.Vector3());
    if (hit === null) return;
    const local = this.root.worldToLocal(hit).divideScalar(unit).add(this.middle);
    this.moved(this.dragged, local);
  }

  private release(): void {
    if (this.dragged < 0) return;
    this.dragged = -1;
    this.view.controls.enabled = true;
  }
}
