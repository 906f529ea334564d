// SPDX-License-Identifier: MIT
//
// What a ray through a pixel meets first, by trying every triangle (Moeller and Trumbore 1997), in the page's double numbers.

/** `clear`: no edge, no other triangle and no arrow is so near that a pixel could show either. */
export async function firstMet(page, at, meshes) {
  const [matrices, place] = await page.evaluate(() => {
    const { view, scenes } = window.abutViewer;
    view.camera.updateMatrixWorld();
    return [
      [view.camera.matrixWorld.elements, view.camera.projectionMatrixInverse.elements, view.width, view.height],
      [scenes.stage.origin.toArray(), scenes.stage.scale],
    ];
  });
  const [world, unproject, width, height] = matrices;
  const [origin, scale] = place;
  const times = (m, [x, y, z, w]) => [0, 1, 2, 3].map((i) => m[i] * x + m[4 + i] * y + m[8 + i] * z + m[12 + i] * w);
  const met = (x, y) => {
    const ndc = [(2 * x) / width - 1, 1 - (2 * y) / height, 0.5, 1];
    const inView = times(unproject, ndc);
    const far = times(
      world,
      inView.map((c) => c / inView[3]),
    ).slice(0, 3);
    const eye = world.slice(12, 15);
    const way = far.map((c, k) => c - eye[k]);
    let best = { t: Infinity };
    meshes.forEach((mesh, set) =>
      mesh.faces.forEach((face, element) => {
        const [p, q, r] = face.map((v) => mesh.vertices[v].map((c, k) => (c - origin[k]) * scale));
        const t = hit(eye, way, p, q, r);
        if (t !== undefined && t < best.t) best = { t, set, element };
      }),
    );
    return best;
  };
  // picking looks at the pixel's middle
  const [x, y] = [Math.floor(at.x) + 0.5, Math.floor(at.y) + 0.5];
  const best = met(x, y);
  if (best.t === Infinity) return undefined;
  const around = [
    [-1, 0],
    [1, 0],
    [0, -1],
    [0, 1],
  ].map(([dx, dy]) => met(x + 0.7 * dx, y + 0.7 * dy));
  const arrow = await page.evaluate(
    ([px, py]) => "result" in (window.abutViewer.scenes.stage.pick(px, py) ?? {}),
    [at.x, at.y],
  );
  const clear = !arrow && around.every((m) => m.set === best.set && m.element === best.element);
  return { set: best.set, element: best.element, clear };
}

function hit(eye, way, p, q, r) {
  const minus = (a, b) => a.map((c, k) => c - b[k]);
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const [e, f] = [minus(q, p), minus(r, p)];
  const n = cross(way, f);
  const det = dot(e, n);
  if (Math.abs(det) < 1e-14) return undefined;
  const s = minus(eye, p);
  const u = dot(s, n) / det;
  const m = cross(s, e);
  const v = dot(way, m) / det;
  const t = dot(f, m) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : undefined;
}
