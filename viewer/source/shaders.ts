import { ROD } from "./messages";

/**
 * Spheres as squares that face the eye: each pixel meets the sphere by its equation, so that they are round at any size and
 * cut one another exactly.
 */
export const VERTEX = /* glsl */ `
precision highp float;
in vec3 position;
in vec3 centre;
in float radius;
in float value;
uniform mat4 modelViewMatrix, projectionMatrix;
uniform float reach, shrink;
uniform int side, picked;
uniform vec3 eye;
out vec3 place;
out vec3 sphere;
out float size;
out float shade;
flat out float tone;
flat out int marked;

void main() {
  bool front = dot(centre.yz, eye.yz) > 0.0;
  tone = value;
  size = shrink * radius;
  marked = gl_InstanceID == picked ? 1 : 0;
  shade = smoothstep(-1.0, 0.7, dot(centre.yz, normalize(eye.yz + vec2(0.4, 0.0))) / reach);
  if ((side == 1 && front) || (side == 2 && !front)) {
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    return;
  }
  sphere = (modelViewMatrix * vec4(centre, 1.0)).xyz;
  float distance = length(sphere);
  vec3 ahead = sphere / distance;
  vec3 right = normalize(cross(ahead, vec3(0.0, 1.0, 0.0)));
  vec3 up = cross(right, ahead);
  float halo = marked == 1 ? 1.25 : 1.0;
  float half_side = halo * size * distance / sqrt(max(distance * distance - size * size, 1e-6));
  place = sphere + half_side * (position.x * right + position.y * up);
  gl_Position = projectionMatrix * vec4(place, 1.0);
}`;

export const FRAGMENT = /* glsl */ `
precision highp float;
precision highp int;
in vec3 place;
in vec3 sphere;
in float size;
in float shade;
flat in float tone;
flat in int marked;
uniform mat4 projectionMatrix;
uniform sampler2D scale;
uniform vec3 plain, rim;
uniform int kind, marks;
uniform float glass;
out vec4 colour;

vec3 linear(vec3 c) { return pow(c, vec3(2.2)); }

void main() {
  vec3 ray = normalize(place);
  float along = dot(ray, sphere);
  float miss = dot(sphere, sphere) - along * along;
  float room = size * size - miss;
  if (room < 0.0) {
    // A ring round the grain that was picked.
    if (marked == 1 && room > -0.56 * size * size && room < -0.12 * size * size) {
      colour = vec4(rim, 1.0);
      vec4 clip = projectionMatrix * vec4(sphere * (1.0 - size / length(sphere)), 1.0);
      gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
      return;
    }
    discard;
  }
  float edge = sqrt(miss) / size;
  vec3 hit = ray * (along - sqrt(room));
  vec3 normal = (hit - sphere) / size;
  float facing = max(0.0, -dot(normal, ray));

  vec3 base = plain;
  if (kind == 0) {
    bool unknown = tone != tone;
    base = unknown ? vec3(0.59) : texture(scale, vec2(clamp(tone, 0.0, 1.0) * 0.99609375 + 0.001953125, 0.5)).rgb;
    if (marks == 1 && !unknown) {
      // Against the wave: a dark dot. Along it: a light ring.
      if (tone < 0.44 && edge < 0.3) base *= 0.25;
      if (tone > 0.56 && edge > 0.42 && edge < 0.6) base = mix(base, vec3(1.0), 0.75);
    }
  }
  base = linear(base);
  vec3 key = normalize(vec3(-0.35, 0.75, 0.62));
  vec3 fill = normalize(vec3(0.7, -0.1, 0.55));
  float light = max(0.0, dot(normal, key));
  float sky = 0.5 + 0.5 * normal.y;
  vec3 lit = base * (0.24 + 0.26 * sky + 0.62 * light + 0.12 * max(0.0, dot(normal, fill)));
  lit *= mix(0.55, 1.0, shade) * mix(0.62, 1.0, smoothstep(0.0, 0.6, facing));
  float gloss = pow(max(0.0, dot(reflect(ray, normal), key)), 40.0);
  lit += 0.16 * gloss;
  float cover = 1.0;
  if (glass > 0.0) {
    cover = smoothstep(1.0, 0.96, edge) * glass * (0.2 + 1.3 * pow(1.0 - facing, 2.0)) + 0.3 * gloss;
    lit = base * (0.55 + 0.45 * sky) + 0.5 * gloss;
  }
  colour = vec4(pow(lit, vec3(1.0 / 2.2)), clamp(cover, 0.0, 1.0));
  vec4 clip = projectionMatrix * vec4(hit, 1.0);
  gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
}`;

/** Contacts as bands between two places, as wide as their force, that face the eye. */
export const BAND_VERTEX = /* glsl */ `
precision highp float;
in vec3 position;
in vec3 from, to;
in float force;
uniform mat4 modelViewMatrix, projectionMatrix;
out float part;
out float across;

void main() {
  vec3 begin = (modelViewMatrix * vec4(from, 1.0)).xyz;
  vec3 end = (modelViewMatrix * vec4(to, 1.0)).xyz;
  vec3 middle = mix(begin, end, position.x);
  vec3 side = normalize(cross(end - begin, middle));
  part = clamp(force, 0.0, 1.0);
  across = position.y;
  gl_Position = projectionMatrix * vec4(middle + position.y * (${ROD[0]} + ${ROD[1]} * part) * side, 1.0);
}`;

export const BAND_FRAGMENT = /* glsl */ `
precision highp float;
in float part;
in float across;
uniform sampler2D scale;
out vec4 colour;

void main() {
  vec3 base = texture(scale, vec2(0.04 + 0.92 * part, 0.5)).rgb;
  colour = vec4(base * (1.0 - 0.45 * across * across), 1.0);
}`;
