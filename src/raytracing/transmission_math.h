// SPDX-License-Identifier: Apache-2.0
// Rays through transmissive surfaces: panes, which light crosses straight on, and the boundaries of
// volumes, which refract it.
//
// Based on: Walter, Marschner, Li and Torrance, "Microfacet Models for Refraction through Rough
// Surfaces", EGSR 2007; Khronos Group, KHR_materials_transmission and KHR_materials_volume.
#ifndef LAMBENT_RAYTRACING_TRANSMISSION_MATH_H
#define LAMBENT_RAYTRACING_TRANSMISSION_MATH_H

#include "raytracing/surface_math.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

/// Whether light passes a surface straight on.
LAMBENT_FN bool goes_straight(Transmission through) {
  return through.kind == kCrossesPane && through.alpha <= kStraightAlpha;
}

/// Share of light that the boundary of a volume reflects inwards, given the cosine on the inside
/// and the index of refraction, which is greater than 1 there. Schlick's approximation holds for
/// the angle in the thinner medium; where there is no such angle, all light is reflected.
LAMBENT_FN float inner_reflection(float cosine, float ior) {
  float squared_sine = ior * ior * (1.0f - cosine * cosine);
  if (squared_sine >= 1.0f) return 1.0f;
  float root_f0 = (ior - 1.0f) / (ior + 1.0f);
  float f0 = root_f0 * root_f0;
  float m = 1.0f - sqrt(1.0f - squared_sine);
  return f0 + (1.0f - f0) * m * m * m * m * m;
}

/// The continuation of a ray at a transmissive surface.
struct ThroughDraw {
  vec3 direction_ws;  ///< Unit.
  vec3 weight;        ///< Share of the light from there that the ray carries; 0: none.
  uint crosses;       ///< 1: the ray goes on behind the surface; 0: it is reflected inwards.
  /// Density with which it was drawn [1/sr], where samples of lights can find the direction, too,
  /// see samples_lights_behind(); else 0.
  float pdf;
};

/// Whether light that comes through a surface is sampled: the surface spreads it, and lights behind
/// it can be reached straight on. Light that enters a volume is bent again where it leaves.
LAMBENT_FN bool samples_lights_behind(Transmission through) {
  if (!is_transmissive(through)) return false;
  if (through.kind == kCrossesPane) return through.alpha > kStraightAlpha;
  // A facet that is turned turns refracted light by this factor
  return through.kind == kLeavesVolume && through.alpha * abs(through.eta - 1.0f) > kStraightAlpha;
}

/// How a rough surface transmits the light of one direction.
struct ThroughLobe {
  vec3 value;  ///< BTDF times cosine [1/sr].
  float pdf;   ///< Density with which draw_through() draws the direction [1/sr].
};

/// Walter et al. 2007, Eq. 17 and 21, for the unit directions to the viewer and to the light in a
/// frame whose normal +Z is on the viewer's side, and a surface that samples_lights_behind(). Panes
/// have the lobe of their reflection, mirrored to the other side.
LAMBENT_FN ThroughLobe evaluate_through(Transmission through, Reflectance reflectance,
                                        vec3 to_viewer, vec3 to_light) {
  ThroughLobe lobe = {vec3(0.0f), 0.0f};
  if (to_viewer.z <= 0.0f || to_light.z >= 0.0f) return lobe;
  bool pane = through.kind == kCrossesPane;
  vec3 half_vector = pane ? to_viewer + vec3(to_light.x, to_light.y, -to_light.z)
                          : -(through.eta * to_viewer + to_light);
  vec3 h = normalize(half_vector);
  if (h.z < 0.0f) h = -h;
  float v_dot_h = dot(to_viewer, h);
  float l_dot_h = dot(to_light, h);
  if (v_dot_h <= 0.0f || (!pane && l_dot_h >= 0.0f)) return lobe;

  // Compute the density of h among the visible normals, as a function of h that is exact for narrow
  // lobes, too, and from it that of the direction
  float a2 = through.alpha * through.alpha;
  float d = h.z * h.z * a2 + h.x * h.x + h.y * h.y;
  float lambda_v = ggx_lambda(to_viewer.z, through.alpha);
  float lambda_l = ggx_lambda(-to_light.z, through.alpha);
  float visible = a2 * kInvPi * v_dot_h / (d * d * to_viewer.z * (1.0f + lambda_v));
  if (pane) {
    lobe.pdf = visible / (4.0f * v_dot_h);
    vec3 passes = vec3(1.0f) - fresnel(reflectance, v_dot_h);
    if (has_layers(reflectance.layers)) {
      passes *= layers_transmittance(reflectance.layers, to_viewer.z);
    }
    lobe.value =
        through.tint * passes * (lobe.pdf * ((1.0f + lambda_v) / (1.0f + lambda_v + lambda_l)));
    return lobe;
  }
  float stretch = through.eta * v_dot_h + l_dot_h;
  lobe.pdf =
      visible * (1.0f - inner_reflection(v_dot_h, through.eta)) * -l_dot_h / (stretch * stretch);
  lobe.value = through.tint * (lobe.pdf / (1.0f + lambda_l));
  return lobe;
}

/// Draws a direction from which light is transmitted. From outside, reflection is not included;
/// from inside, one of transmission and inner reflection is drawn at random.
LAMBENT_FN ThroughDraw draw_through(Transmission through, Reflectance reflectance, vec3 normal_ws,
                                    vec3 to_viewer_ws, vec3 u) {
  ThroughDraw drawn = {-to_viewer_ws, vec3(0.0f), 1u, 0.0f};
  Frame frame = make_frame(normal_ws);
  vec3 v = to_local(frame, to_viewer_ws);
  if (v.z <= 0.0f) return drawn;
  bool rough = through.alpha > kStraightAlpha;
  vec3 h = vec3(0.0f, 0.0f, 1.0f);
  if (rough) h = sample_ggx_visible_normal(v, through.alpha, vec2(u.x, u.y));
  float cosine = dot(v, h);
  drawn.weight = through.tint;
  if (through.kind == kLeavesVolume) {
    if (u.z < inner_reflection(cosine, through.eta)) {
      drawn.weight = vec3(1.0f);
      drawn.crosses = 0u;
    }
  } else {
    drawn.weight *= vec3(1.0f) - fresnel(reflectance, cosine);
    if (has_layers(reflectance.layers))
      drawn.weight *= layers_transmittance(reflectance.layers, v.z);
  }
  if (goes_straight(through)) return drawn;

  vec3 l = through.kind == kCrossesPane || drawn.crosses == 0u ? reflect(-v, h)
                                                               : refract(-v, h, through.eta);
  // The lobe of a rough pane is that of its reflection, mirrored to the other side
  if (through.kind == kCrossesPane) l.z = -l.z;
  bool is_behind = l.z < 0.0f;
  if (is_behind != (drawn.crosses != 0u)) drawn.weight = vec3(0.0f);
  if (rough) {
    // Apply Smith's shadowing of the outgoing direction, which sampling visible normals leaves out
    float lambda_l = ggx_lambda(abs(l.z), through.alpha);
    float lambda_v = ggx_lambda(v.z, through.alpha);
    bool same_side = through.kind == kCrossesPane || drawn.crosses == 0u;
    drawn.weight *=
        same_side ? (1.0f + lambda_v) / (1.0f + lambda_v + lambda_l) : 1.0f / (1.0f + lambda_l);
  }
  drawn.direction_ws = normalize(to_world(frame, l));
  if (drawn.crosses != 0u && is_behind && samples_lights_behind(through)) {
    drawn.pdf = evaluate_through(through, reflectance, v, l).pdf;
  }
  return drawn;
}

/// Probability of transmission at a surface that transmits and reflects these shares of light.
LAMBENT_FN float crossing_probability(vec3 passing, vec3 reflected) {
  float passes = max(passing.x, max(passing.y, passing.z));
  float turns = max(reflected.x, max(reflected.y, reflected.z));
  return passes > 0.0f ? passes / (passes + max(turns, 0.0f)) : 0.0f;
}

/// The transmitted share that crossing_probability() takes, as seen from a direction.
LAMBENT_FN vec3 passing_share(Transmission through, Reflectance reflectance, float n_dot_v) {
  if (through.kind == kLeavesVolume) return vec3(1.0f);
  return straight_share(through.tint, reflectance, n_dot_v);
}

LAMBENT_END
#endif
