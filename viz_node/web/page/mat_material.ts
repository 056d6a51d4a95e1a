// viz_node/web/page/mat_material.ts -- the matter: one vertex per MAT, drawn as a sphere by
// intersecting it with the ray of each pixel.
import { paletteOf, sharesOf } from './colours.ts';
import type { Program, Uniforms } from './gl_canvas.ts';
import { MAT_FIXED } from './wire.ts';

const SHOWN_FIXED_POINT = 3;
const SHOWN_TOOL = 4;
const SHOWN_NOTHING = 5;
export const SHOWN_RING = 6;

/** Radius of the hole of a ring, a share of its own. */
const RING_HOLE = 0.76;

const SPEED_COLOUR = /* glsl */ `
  // Dark blue, teal, yellow: readable for colour-blind eyes, and on a projector.
  vec3 speed_colour(float s) {
    s = clamp(s, 0.0, 1.0);
    vec3 slow = vec3(0.20, 0.32, 0.62);
    vec3 middle = vec3(0.13, 0.66, 0.62);
    vec3 fast = vec3(0.99, 0.88, 0.30);
    return s < 0.5 ? mix(slow, middle, 2.0 * s) : mix(middle, fast, 2.0 * s - 1.0);
  }
`;

const DRAWN = /* glsl */ `
  in vec3 reference;           // where it was when motion began to be counted [m]
  uniform float exaggeration;  // of the way from there
  vec3 drawn(vec3 place) { return place + (exaggeration - 1.0) * (place - reference); }
`;

const MAT_VERTEX = /* glsl */ `
  precision highp float;
  in vec3 position;   // [m]
  in vec3 previous;   // one frame before [m]
  in float radius;    // [m]
  in vec3 tint;       // colour of its body
  in float kind;      // 0 mass, 1 fixed ball, 2 port, 3 fixed point, 4 punctual tool, 5 not shown, 6 tool with a radius
  uniform mat4 modelViewMatrix;
  uniform mat4 projectionMatrix;
  uniform float pixels_per_unit;   // of the plane at clip w = 1
  uniform float radius_share;      // balls are drawn so much of their size
  uniform vec4 min_pixels;       // smallest radius on the screen, by kind
  uniform float speed_scale;       // 1 / full scale, per metre moved; 0: colour by body
  out vec3 centre;
  out float size;
  out vec3 colour;
  flat out int shape;
  ${SPEED_COLOUR}
  ${DRAWN}

  void main() {
    int k = int(kind + 0.5);
    vec4 view_position = modelViewMatrix * vec4(drawn(position), 1.0);
    gl_Position = projectionMatrix * view_position;
    float pixels = pixels_per_unit / gl_Position.w;
    float share = k == 6 ? 1.0 : radius_share; // what is held keeps its true size
    size = max(share * radius, min_pixels[k >= 4 ? 0 : k] / pixels);
    // A square where a punctual MAT is fixed; a sphere with a halo where a hand is; a ring, as thimbles are, for what it holds.
    shape = k == 3 ? 1 : (k == 2 ? 2 : (k == 6 ? 3 : 0));
    centre = view_position.xyz;
    gl_PointSize = 2.0 * size * pixels * (shape == 2 ? 1.9 : 1.0) * MARGIN;
    colour = tint;
  #ifndef SPHERES
    // Each gets a brightness of its own: neighbours would run together without shading.
    colour *= 0.7 + 0.3 * float((gl_VertexID * 40503) & 255) / 255.0;
  #endif
    // The halo of a port is seen through everything.
    if (shape == 2) gl_Position.z = -0.999 * gl_Position.w;
    if (speed_scale > 0.0 && k == 0) colour = speed_colour(length(position - previous) * speed_scale);
    if (k == 5) gl_Position = vec4(0.0, 0.0, 2.0, 1.0); // beyond the far plane
  }
`;

const MAT_FRAGMENT = /* glsl */ `
  precision highp float;
  in vec3 centre;
  in float size;
  in vec3 colour;
  flat in int shape;
  uniform mat4 projectionMatrix;
  uniform bool orthographic;
  out vec4 pixel;

  // Lit from above the left shoulder, a little from below.
  vec3 lit(vec3 normal) {
    float key = max(dot(normal, normalize(vec3(-0.45, 0.75, 0.6))), 0.0);
    float fill = 0.5 + 0.5 * normal.y;
    float shine = pow(max(dot(normal, normalize(vec3(-0.3, 0.5, 0.9))), 0.0), 32.0);
    return colour * (0.38 + 0.18 * fill + 0.52 * key) + vec3(0.22 * shine);
  }

  void main() {
    vec2 point = (gl_PointCoord * 2.0 - 1.0) * vec2(1.0, -1.0) * MARGIN;
    if (shape == 1) {
      float edge = max(abs(point.x), abs(point.y));
      if (edge > 1.0) discard;
      pixel = vec4(edge > 0.62 ? colour : colour * 0.35, 1.0);
    #ifdef SPHERES
      gl_FragDepth = gl_FragCoord.z;
    #endif
      return;
    }
    if (shape == 3) {
      float away = length(point);
      if (away > 1.0 || away < RING_HOLE) discard;
      float across = (2.0 * away - 1.0 - RING_HOLE) / (1.0 - RING_HOLE);
      pixel = vec4(lit(vec3(point / away * across, sqrt(max(0.0, 1.0 - across * across)))), 1.0);
    #ifdef SPHERES
      gl_FragDepth = gl_FragCoord.z;
    #endif
      return;
    }
    if (shape == 2) {
      point *= 1.9;
      float away = length(point);
      if (away > 1.9) discard;
      if (away > 1.0) {
        if (away < 1.5) discard;
        pixel = vec4(colour, 1.0);
    #ifdef SPHERES
        gl_FragDepth = gl_FragCoord.z;
    #endif
        return;
      }
    }
    #ifdef SPHERES
      // From the camera through the pixel to the sphere; its distance from the axis of the ray by subtraction of vectors,
      // which stays exact for small spheres far away.
      vec3 on_plane = centre + vec3(point * size, 0.0);
      vec3 along = orthographic ? vec3(0.0, 0.0, -1.0) : normalize(on_plane);
      vec3 from = orthographic ? vec3(on_plane.xy, 0.0) : vec3(0.0);
      float reach = dot(centre - from, along);
      vec3 aside = from + along * reach - centre;
      float inside = size * size - dot(aside, aside);
      if (inside < 0.0) discard;
      vec3 hit = from + along * (reach - sqrt(inside));
      pixel = vec4(lit((hit - centre) / size), 1.0);
      vec4 clip = projectionMatrix * vec4(hit, 1.0);
      gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
    #else
      pixel = vec4(colour, 1.0);
    #endif
  }
`;

const LINK_VERTEX = /* glsl */ `
  precision highp float;
  in vec3 position;
  in vec3 previous;
#ifdef BEFORE_BALLS
  in float radius;
  uniform float radius_share;
  uniform bool orthographic;
#endif
  uniform mat4 modelViewMatrix;
  uniform mat4 projectionMatrix;
  uniform float speed_scale;
  uniform vec3 link_colour;
  uniform float view_width;   // [pixels of the canvas]
  uniform float view_height;
  out vec3 colour;
  flat out vec2 end;          // of the link, on the canvas
  ${SPEED_COLOUR}
  ${DRAWN}

  void main() {
    vec4 view_position = modelViewMatrix * vec4(drawn(position), 1.0);
  #ifdef BEFORE_BALLS
    // Towards the viewer: it ends on the nearest point of each ball.
    vec3 towards = orthographic ? vec3(0.0, 0.0, 1.0) : -normalize(view_position.xyz);
    view_position.xyz += 1.02 * radius_share * radius * towards;
  #endif
    gl_Position = projectionMatrix * view_position;
    end = (0.5 + 0.5 * gl_Position.xy / gl_Position.w) * vec2(view_width, view_height);
    colour = speed_scale > 0.0 ? 0.8 * speed_colour(length(position - previous) * speed_scale) : link_colour;
  }
`;

const LINK_FRAGMENT = /* glsl */ `
  precision highp float;
  in vec3 colour;
  flat in vec2 end;
  uniform float pattern;      // 0 solid, 1 dashed, 2 dotted
  uniform float pixel_ratio;
  out vec4 pixel;
  void main() {
    float along = distance(gl_FragCoord.xy, end) / pixel_ratio;
    if (pattern > 1.5 ? mod(along, 4.0) > 1.7 : pattern > 0.5 && mod(along, 9.0) > 5.5) discard;
    pixel = vec4(colour, 1.0);
  }
`;

/** How many colours of links there are, in either theme. */
const LINK_COLOURS = paletteOf('dark').link_states.length;

/** Which of linkUniforms() a link in this state is drawn with. */
export const colourOfState = (state: number): number => state % LINK_COLOURS;

/** Uniforms that matter and links share. */
export interface SceneUniforms extends Uniforms {
  pixels_per_unit: number;
  min_pixels: number[];
  speed_scale: number;
  orthographic: boolean;
  radius_share: number;
  exaggeration: number;
  view_width: number;
  view_height: number;
  pixel_ratio: number;
}

export function sceneUniforms(): SceneUniforms {
  return { pixels_per_unit: 1, min_pixels: [3, 3, 6, 5], speed_scale: 0, orthographic: false, radius_share: 1, exaggeration: 1, view_width: 1, view_height: 1, pixel_ratio: 1 };
}

/** Kinds as the shader distinguishes them: a fixed point without a radius is no ball, and what has a shape of its own is not shown. */
export function shownKinds(kinds: Uint8Array, radii: Float32Array, tools: number[], shapes: number[]): Uint8Array {
  const shown = kinds.map((kind, i) => (kind === MAT_FIXED && radii[i] === 0 ? SHOWN_FIXED_POINT : kind));
  for (const tool of tools) shown[tool] = radii[tool] === 0 ? SHOWN_TOOL : SHOWN_RING;
  for (const mat of shapes) shown[mat] = SHOWN_NOTHING;
  return shown;
}

export function matProgram(spheres: boolean): Program {
  // In perspective the outline of a sphere is a little larger than its radius.
  const defines = `#define MARGIN ${spheres ? '1.08' : '1.0'}\n#define RING_HOLE ${RING_HOLE}\n${spheres ? '#define SPHERES\n' : ''}`;
  return { vertex: defines + MAT_VERTEX, fragment: defines + MAT_FRAGMENT };
}

export const LINK_PROGRAM: Program = { vertex: LINK_VERTEX, fragment: LINK_FRAGMENT };
/** Lines before the balls that they join. */
export const BOND_PROGRAM: Program = { vertex: `#define BEFORE_BALLS\n${LINK_VERTEX}`, fragment: LINK_FRAGMENT };

/** What a part of the links is drawn with. */
export const linkUniforms = (colour: string, pattern: number): Uniforms => ({ link_colour: sharesOf(colour), pattern });
