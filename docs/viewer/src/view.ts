// SPDX-License-Identifier: MIT
//
// The canvas: renderer, camera and its controls. It draws when something changed, and only then.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

export interface World {
  readonly root: THREE.Scene;
  /** Called before each frame. */
  before?(camera: THREE.PerspectiveCamera, width: number, height: number): void;
}

interface Flight {
  from: THREE.Vector3;
  fromTarget: THREE.Vector3;
  to: THREE.Vector3;
  toTarget: THREE.Vector3;
  start: number;
}

const flightTime = 450; // ms

export class View {
  readonly camera = new THREE.PerspectiveCamera(40, 1, 0.001, 100);
  readonly renderer: THREE.WebGLRenderer;
  readonly controls: OrbitControls;
  frames = 0;
  after: () => void = () => {}; // called after each frame
  private world: World | undefined;
  private flight: Flight | undefined;
  private wanted = false;
  private kept = new Map<World, [THREE.Vector3, THREE.Vector3]>();

  constructor(readonly canvas: HTMLCanvasElement) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, powerPreference: "high-performance" });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.rotateSpeed = 0.9;
    this.controls.minDistance = 1e-5;
    this.controls.maxDistance = 60;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.flight = undefined));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement!);
    this.resize();
  }

  get width(): number {
    return this.canvas.clientWidth;
  }
  get height(): number {
    return this.canvas.clientHeight;
  }

  show(world: World): void {
    if (this.world === world) return;
    if (this.world !== undefined) this.kept.set(this.world, [this.camera.position.clone(), this.controls.target.clone()]);
    this.flight = undefined;
    this.world = world;
    const place = this.kept.get(world);
    if (place !== undefined) this.place(place[0], place[1]);
    this.draw();
  }

  background(colour: THREE.Color): void {
    this.renderer.setClearColor(colour);
    this.draw();
  }

  resize(): void {
    const box = this.canvas.parentElement!.getBoundingClientRect();
    const width = Math.max(1, Math.floor(box.width));
    const height = Math.max(1, Math.floor(box.height));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Asks for a frame. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.frame();
    });
  }

  place(position: THREE.Vector3, target: THREE.Vector3): void {
    this.flight = undefined;
    this.camera.position.copy(position);
    this.controls.target.copy(target);
    this.controls.update();
    this.draw();
  }

  /** Looks at a point from a distance, from where the camera is or along a direction. */
  fly(target: THREE.Vector3, distance: number, direction?: THREE.Vector3): void {
    const way = (direction ?? this.camera.position.clone().sub(this.controls.target)).clone().normalize();
    if (way.lengthSq() === 0) way.set(0, 0, 1);
    const to = target.clone().addScaledVector(way, distance);
    if (window.matchMedia("(prefers-reduced-motion: reduce)").matches) return this.place(to, target);
    this.flight = {
      from: this.camera.position.clone(),
      fromTarget: this.controls.target.clone(),
      to,
      toTarget: target.clone(),
      start: performance.now(),
    };
    this.draw();
  }

  get flying(): boolean {
    return this.flight !== undefined;
  }

  /** Draws now; used to measure. */
  frame(): void {
    if (this.world === undefined) return;
    if (this.flight !== undefined) {
      const { from, fromTarget, to, toTarget, start } = this.flight;
      const part = Math.min(1, (performance.now() - start) / flightTime);
      const eased = part * part * (3 - 2 * part);
      this.camera.position.lerpVectors(from, to, eased);
      this.controls.target.lerpVectors(fromTarget, toTarget, eased);
      this.controls.update();
      if (part < 1) this.draw();
      else this.flight = undefined;
    }
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(1e-6, Math.min(0.02, distance / 50));
    this.camera.far = distance + 20;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.world.before?.(this.camera, this.width, this.height);
    this.renderer.render(this.world.root, this.camera);
    this.after();
    ++this.frames;
  }

  /** A point of the world in pixels of the canvas. */
  toScreen(point: THREE.Vector3): { x: number; y: number; inFront: boolean } {
    const p = point.clone().project(this.camera);
    return { x: ((p.x + 1) / 2) * this.width, y: ((1 - p.y) / 2) * this.height, inFront: p.z < 1 };
  }
}
