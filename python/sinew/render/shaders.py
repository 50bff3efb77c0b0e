"""Programs of the graphics card, in GLSL 3.30. Colours are sRGB outside of them and linear inside."""

_LIGHT = """
uniform vec3 eye, up, sun;
vec3 linear(vec3 c) { return pow(c, vec3(2.2)); }
vec3 encoded(vec3 c) { return pow(clamp(c, 0.0, 1.0), vec3(1.0 / 2.2)); }
// Sky and ground, a sun, a weak lamp at the camera; a highlight, and an edge that is a little lighter.
vec3 shaded(vec3 base, vec3 normal, vec3 at) {
  vec3 view = normalize(eye - at);
  vec3 n = length(normal) > 0.0 ? normalize(normal) : view;
  if (dot(n, view) < 0.0 && !gl_FrontFacing) n = -n;
  vec3 light = mix(vec3(0.27, 0.25, 0.24), vec3(0.52, 0.55, 0.60), 0.5 + 0.5 * dot(n, up));
  light += 0.58 * max(dot(n, sun), 0.0) * vec3(1.0, 0.97, 0.92) + 0.14 * max(dot(n, view), 0.0);
  float gloss = 0.10 * pow(max(dot(n, normalize(sun + view)), 0.0), 32.0);
  float edge = 0.05 * pow(1.0 - max(dot(n, view), 0.0), 3.0);
  return encoded(linear(base) * light + gloss + edge);
}
"""

#: Surfaces of bodies: coloured by the value of each vertex, or by its own colour if the value is negative.
BODY = (
    """
#version 330
uniform mat4 matrix;
in vec3 position, normal, colour;
in float value;
out vec3 at, across, paint;
out float amount;
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  at = position; across = normal; paint = colour; amount = value;
}
""",
    "#version 330" + _LIGHT + """
uniform sampler2D palette;
uniform bool lit;
in vec3 at, across, paint;
in float amount;
out vec4 result;
void main() {
  // The middles of the first and the last texel are the ends of the range.
  vec3 base = amount < -0.5 ? paint : texture(palette, vec2((clamp(amount, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  result = vec4(lit ? shaded(base, across, at) : base, 1.0);
}
""",
)

#: The same points in one colour, for mesh edges, which are drawn slightly in front of the surface, and for the shadow.
PLAIN = (
    """
#version 330
uniform mat4 matrix;
uniform float nearer;
in vec3 position;
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  gl_Position.z -= nearer * gl_Position.w;
}
""",
    """
#version 330
uniform vec4 colour;
out vec4 result;
void main() { result = colour; }
""",
)

#: Round objects, each in its colour.
MARK = (
    """
#version 330
uniform mat4 matrix;
in vec3 position, normal, colour;
out vec3 at, across, paint;
void main() {
  gl_Position = matrix * vec4(position, 1.0);
  at = position; across = normal; paint = colour;
}
""",
    "#version 330" + _LIGHT + """
uniform float opacity;
in vec3 at, across, paint;
out vec4 result;
void main() { result = vec4(shaded(paint, across, at), opacity); }
""",
)

#: Patch of a plane with tint, grid lines and the shadow of the bodies, fading towards its rim.
PLANE = (
    """
#version 330
uniform mat4 matrix, shadow_matrix;
uniform vec3 middle, origin, first_axis, second_axis;
uniform float reach;
in vec2 corner;
out vec2 place, away;
out vec2 shadow_place;
void main() {
  vec3 at = middle + reach * (corner.x * first_axis + corner.y * second_axis);
  place = vec2(dot(at - origin, first_axis), dot(at - origin, second_axis));
  away = corner;
  shadow_place = (shadow_matrix * vec4(at, 1.0)).xy;
  gl_Position = matrix * vec4(at, 1.0);
}
""",
    """
#version 330
uniform sampler2D shadow;
uniform vec3 ink, tint;
uniform float cell, solid, visible, shade;
in vec2 place, away, shadow_place;
out vec4 result;
float line(float x) {
  float width = fwidth(x);
  float near = abs(fract(x - 0.5) - 0.5);
  return (1.0 - smoothstep(0.5 * width, 1.3 * width, near)) * (1.0 - smoothstep(0.15, 0.5, width));
}
void main() {
  float lines = 0.22 * max(line(place.x / cell), line(place.y / cell));
  float dark = 0.0;
  if (all(lessThan(abs(shadow_place - 0.5), vec2(0.5)))) {
    dark = shade * mix(textureLod(shadow, shadow_place, 2.0).r, textureLod(shadow, shadow_place, 3.0).r, 0.5);
  }
  float cover = 1.0 - (1.0 - solid) * (1.0 - lines) * (1.0 - dark);
  vec3 colour = mix(mix(tint, ink, lines), vec3(0.08, 0.10, 0.14), dark / max(cover, 1e-3) * (1.0 - 0.5 * lines));
  if (solid < 0.01) colour = mix(ink, vec3(0.08, 0.10, 0.14), dark / max(dark + lines, 1e-3));
  result = vec4(colour, cover * visible * (1.0 - smoothstep(0.45, 1.0, length(away))));
}
""",
)
