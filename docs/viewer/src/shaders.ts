// SPDX-License-Identifier: MIT
//
// Shaders of shapes and of contacts. One vertex shader places an element, for the eye and for picking alike. A vertex knows
// its element by its number, so that no attribute is spent on it.

export const placeShape = /* glsl */ `
#ifdef MOVES
in vec3 moveFrom;
in vec3 moveTo;
uniform float part;
#endif
#ifdef SPHERES
in vec3 center;
in float radius;
#endif
in float hit;
uniform int which; // 0 all elements, 1 those that are hit, 2 the others
uniform float pointSize;
out vec3 viewed;
out vec3 smoothNormal;
out vec3 corner;
flat out float isHit;
#ifdef PICK
uniform uint base;
flat out uint code;
#endif

void main() {
#ifdef SPHERES
  vec3 p = center + radius * position;
  smoothNormal = normalMatrix * position;
#else
  vec3 p = position;
  smoothNormal = vec3(0.0);
#endif
#ifdef MOVES
  p += mix(moveFrom, moveTo, part);
#endif
  vec4 at = modelViewMatrix * vec4(p, 1.0);
  viewed = at.xyz;
  isHit = hit;
  int k = gl_VertexID % 3;
  corner = vec3(float(k == 0), float(k == 1), float(k == 2));
  gl_Position = projectionMatrix * at;
  gl_PointSize = pointSize;
  if (which == (hit < 0.5 ? 1 : 2)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#ifdef PICK
#ifdef SPHERES
  code = base + uint(gl_InstanceID);
#else
  code = base + uint(gl_VertexID / SPAN);
#endif
#endif
}`;

/** A segment of a width in pixels, as four corners; a little before the surface that it lies on. */
export const placeSegment = /* glsl */ `
in vec3 from;
in vec3 to;
in float hit;
uniform int which;
uniform vec2 screen;
uniform float width;
out vec3 viewed;
out vec3 smoothNormal;
out vec3 corner;
flat out float isHit;
#ifdef PICK
uniform uint base;
flat out uint code;
#endif

void main() {
  vec4 p = modelViewMatrix * vec4(from, 1.0);
  vec4 q = modelViewMatrix * vec4(to, 1.0);
  vec4 own = position.x < 0.5 ? p : q;
  viewed = own.xyz;
  smoothNormal = vec3(0.0);
  corner = vec3(0.0);
  isHit = hit;
  vec4 at = projectionMatrix * vec4(own.xyz * 0.998, 1.0);
  vec4 a = projectionMatrix * p, b = projectionMatrix * q;
  vec2 way = b.xy / b.w * screen - a.xy / a.w * screen;
  way = dot(way, way) > 1e-6 ? normalize(way) : vec2(1.0, 0.0);
  // The ends are half a width longer, so that the next segment of a curve goes on without a gap.
  vec2 off = 0.5 * width * (vec2(-way.y, way.x) * position.y + way * (position.x < 0.5 ? -1.0 : 1.0));
  gl_Position = vec4(at.xy + off / screen * at.w, at.z, at.w);
  if (a.w <= 0.0 || b.w <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (which == (hit < 0.5 ? 1 : 2)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#ifdef PICK
  code = base + uint(gl_InstanceID);
#endif
}`;

/**
 * Flat shading from the surface itself, which also holds in motion. Edges are drawn where triangles are large enough. A ghost is
 * faint where it is seen from the front, and stronger towards its outline.
 */
export const shadeShape = /* glsl */ `
precision highp float;
in vec3 viewed;
in vec3 smoothNormal;
in vec3 corner;
flat in float isHit;
uniform vec3 plain;
uniform vec3 struck;
uniform vec3 ink;
uniform float contrast;
#ifdef GHOST
uniform float veil;
#endif
out vec4 colour;

void main() {
  vec3 own = mix(plain, struck, isHit);
  float opacity = 1.0;
#ifdef SURFACE
#ifdef SPHERES
  vec3 normal = normalize(smoothNormal);
#else
  vec3 normal = normalize(cross(dFdx(viewed), dFdy(viewed)));
#endif
  float sun = max(dot(normal, normalize(vec3(-0.35, 0.55, 0.75))), 0.0);
  float fill = max(dot(normal, normalize(vec3(0.8, -0.2, 0.5))), 0.0);
  float light = mix(0.46, 0.66, isHit) + 0.52 * sun * mix(1.0, 0.6, isHit) + 0.16 * fill;
#ifdef GHOST
  float facing = abs(dot(normal, normalize(viewed)));
  opacity = veil * (0.25 + 0.75 * (1.0 - facing) * (1.0 - facing));
#endif
  own *= mix(1.0, light, contrast);
#ifndef SPHERES
  vec3 width = fwidth(corner);
  float across = max(width.x, max(width.y, width.z));
  vec3 near = smoothstep(vec3(0.0), width * 1.15, corner);
  float edge = 1.0 - min(near.x, min(near.y, near.z));
  edge *= 0.5 * (1.0 - smoothstep(0.02, 0.09, across));
  own = mix(own, ink, edge);
#ifdef GHOST
  opacity = max(opacity, 0.45 * veil * edge);
#endif
#endif
#endif
  colour = vec4(own, opacity);
}`;

export const writeCode = /* glsl */ `
precision highp float;
precision highp int;
flat in uint code;
out vec4 colour;

void main() {
  colour = vec4(float(code & 255u), float((code >> 8) & 255u), float((code >> 16) & 255u), float(code >> 24)) / 255.0;
}`;

/** An arrow in the plane of the screen, of a constant width in pixels: a shaft and a head, three triangles a contact. */
export const placeArrow = /* glsl */ `
in vec3 foot;
in vec3 normal_;
in float depth;
uniform float reach;
uniform vec2 screen;
uniform float thickness;
uniform float only;
out float deep;
#ifdef PICK
uniform uint base;
flat out uint code;
#endif

void main() {
  vec4 from = projectionMatrix * modelViewMatrix * vec4(foot, 1.0);
  vec4 to = projectionMatrix * modelViewMatrix * vec4(foot + reach * normal_, 1.0);
  vec2 p = from.xy / from.w * screen, q = to.xy / to.w * screen;
  vec2 way = q - p;
  float size = length(way);
  way = size > 1e-3 ? way / size : vec2(0.0, 1.0);
  vec2 aside = vec2(-way.y, way.x);
  float head = min(thickness * 4.5, size * 0.5);
  // position.x: 0 foot, 1 where the head begins, 2 tip; position.y: to the left or right.
  float along = position.x < 0.5 ? 0.0 : position.x < 1.5 ? size - head : size;
  vec2 at = p + way * along + aside * position.y * (position.z > 0.5 ? max(thickness * 1.9, 1.0) * head / (thickness * 4.5) : thickness * 0.5);
  float part = size > 1e-3 ? along / size : 0.0;
  vec4 clip = mix(from, to, part);
  gl_Position = vec4(at / screen * clip.w, clip.z, clip.w);
  deep = depth;
  if (from.w <= 0.0 || to.w <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (only >= 0.0 && float(gl_InstanceID) != only) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
#ifdef PICK
  code = base + uint(gl_InstanceID);
#endif
}`;

export const shadeArrow = /* glsl */ `
precision highp float;
in float deep;
uniform vec3 shallow;
uniform vec3 deepest;
out vec4 colour;

void main() {
  colour = vec4(mix(shallow, deepest, deep), 1.0);
}`;
