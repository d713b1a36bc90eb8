// SPDX-License-Identifier: Apache-2.0
// The layers of a surface, a sheen and above it a clearcoat, and the light that passes through
// them.
//
// A layer of directional albedo E transmits T(v) = 1 - E(v) of the light towards a viewer at v, and
// T(l) of light from l. Under it, the reflection of a Lambert base is multiplied by
//   T(v) T(l) / (mean of T)
// which is reciprocal, and whose mean over light from a uniform sky is T(v), so that layer and base
// together reflect all light where the base is white (Kelemen and Szirmay-Kalos, "A Microfacet
// Based Coupled Specular-Matte BRDF Model with Importance Sampling", 2001). The reflection of a GGX
// coat is multiplied by
//   min(T(v), T(l)),
// as in KHR_materials_sheen, which is reciprocal, equals T for a mirror, and is never more than
// T(v).
#ifndef LAMBENT_SHARED_LAYERS_H
#define LAMBENT_SHARED_LAYERS_H

#include "shared/sheen.h"

LAMBENT_BEGIN

struct SurfaceLayers {
  vec3 sheen;              ///< Factor on the sheen's lobe, by channel, 0 to 1; 0: no sheen.
  float sheen_roughness;   ///< kMinSheenRoughness to 1.
  float clearcoat;         ///< Share of the surface that is covered, 0 to 1; 0: no clearcoat.
  float clearcoat_alpha;   ///< GGX width; at least kMinGgxAlpha.
  vec3 clearcoat_normal;   ///< In the frame of the shading normal; unit.
  float clearcoat_cosine;  ///< Cosine of that normal to the viewer.
};

// KHR_materials_clearcoat: reflectance of ior 1.5 at normal incidence.
const float kClearcoatF0 = 0.04f;

LAMBENT_FN SurfaceLayers no_layers() {
  SurfaceLayers none = {vec3(0.0f), 1.0f, 0.0f, 1.0f, vec3(0.0f, 0.0f, 1.0f), 1.0f};
  return none;
}

LAMBENT_FN bool has_sheen(SurfaceLayers layers) {
  return layers.sheen != vec3(0.0f);
}
LAMBENT_FN bool has_clearcoat(SurfaceLayers layers) {
  return layers.clearcoat > 0.0f;
}
LAMBENT_FN bool has_layers(SurfaceLayers layers) {
  return has_clearcoat(layers) || has_sheen(layers);
}

/// Reflectance of a full clearcoat, for a value of Schlick's (1 - cos)^5.
LAMBENT_FN float clearcoat_fresnel(float schlick) {
  return kClearcoatF0 + (1.0f - kClearcoatF0) * schlick;
}

/// Transmittance of each layer by the cosine to its normal, and their means over light from a
/// uniform sky.
LAMBENT_FN float clearcoat_transmittance(float clearcoat, float cosine) {
  return 1.0f - clearcoat * clearcoat_fresnel(schlick_power(cosine));
}
LAMBENT_FN float clearcoat_transmittance(SurfaceLayers layers, float cosine) {
  return clearcoat_transmittance(layers.clearcoat, cosine);
}
LAMBENT_FN float mean_clearcoat_transmittance(SurfaceLayers layers) {
  return 1.0f - layers.clearcoat * clearcoat_fresnel(1.0f / 21.0f);
}
LAMBENT_FN float sheen_strength(SurfaceLayers layers) {
  return max(layers.sheen.x, max(layers.sheen.y, layers.sheen.z));
}
LAMBENT_FN float sheen_transmittance(SurfaceLayers layers, float cosine) {
  return 1.0f - sheen_strength(layers) * sheen_albedo(cosine, layers.sheen_roughness);
}
LAMBENT_FN float mean_sheen_transmittance(SurfaceLayers layers) {
  return 1.0f - sheen_strength(layers) * mean_sheen_albedo(layers.sheen_roughness);
}

/// Transmittance of both layers for light that passes them once, at this cosine to the normal.
LAMBENT_FN float layers_transmittance(SurfaceLayers layers, float cosine) {
  float share = 1.0f;
  if (has_sheen(layers)) share *= sheen_transmittance(layers, cosine);
  if (has_clearcoat(layers)) share *= clearcoat_transmittance(layers, cosine);
  return share;
}

/// Factor of the clearcoat on the reflection of a Lambert surface under it. Directions are in the
/// frame of the shading normal, here and below.
LAMBENT_FN float even_share_under_clearcoat(SurfaceLayers layers, vec3 to_viewer, vec3 to_light) {
  if (!has_clearcoat(layers)) return 1.0f;
  return clearcoat_transmittance(layers, dot(layers.clearcoat_normal, to_viewer)) *
         clearcoat_transmittance(layers, dot(layers.clearcoat_normal, to_light)) /
         mean_clearcoat_transmittance(layers);
}

/// Factor of both layers on the reflection of a Lambert surface under them.
LAMBENT_FN float even_share_under_layers(SurfaceLayers layers, vec3 to_viewer, vec3 to_light) {
  float share = even_share_under_clearcoat(layers, to_viewer, to_light);
  if (!has_sheen(layers)) return share;
  return share * sheen_transmittance(layers, to_viewer.z) *
         sheen_transmittance(layers, to_light.z) / mean_sheen_transmittance(layers);
}

/// Factor of both layers on the reflection of a GGX coat under them.
LAMBENT_FN float coat_share_under_layers(SurfaceLayers layers, vec3 to_viewer, vec3 to_light) {
  float share = 1.0f;
  if (has_sheen(layers)) share = sheen_transmittance(layers, min(to_viewer.z, to_light.z));
  if (!has_clearcoat(layers)) return share;
  float cosine =
      min(dot(layers.clearcoat_normal, to_viewer), dot(layers.clearcoat_normal, to_light));
  return share * clearcoat_transmittance(layers, cosine);
}

/// Mean of max((1 - n_dot_v)^5, (1 - n_dot_l)^5) over the light from a uniform sky that a GGX coat
/// reflects: fitted to integrals for roughness 0.03 to 1 and cosines 0.01 to 1, largest error
/// 0.007.
LAMBENT_FN float mean_greater_schlick(float n_dot_v, float alpha) {
  float r = sqrt(alpha);
  float s = 1.0f - clamp(n_dot_v, 0.0f, 1.0f);
  float s2 = s * s;
  float s5 = s2 * s2 * s;
  float t = n_dot_v / (n_dot_v + alpha);
  float mean = cubic(vec4(0.00734827f, -0.0449965f, 0.193223f, -0.098902f), r);
  mean += cubic(vec4(-0.0350082f, -0.42751f, 1.26515f, -0.706749f), r) * s;
  mean += cubic(vec4(0.993613f, -2.56738f, 0.973991f, 0.0737305f), r) * s2;
  mean += cubic(vec4(0.00450925f, 3.10698f, -2.3748f, 0.627454f), r) * s5;
  mean += cubic(vec4(1.03313f, -4.00064f, 1.10416f, 2.27251f), r) * s5 * t;
  mean += cubic(vec4(-0.99591f, 4.11739f, -3.65413f, 1.31804f), r) * s2 * t;
  return clamp(mean, s5, 1.0f);
}

/// Means of even_share_under_layers() and of coat_share_under_layers() over light from a uniform
/// sky; the latter's for a coat of this width. Under a sheen, whose albedo changes slowly, a coat's
/// mean lies between that of a mirror and that of a Lambert surface.
LAMBENT_FN float mean_even_share(SurfaceLayers layers, float n_dot_v) {
  float share = has_sheen(layers) ? sheen_transmittance(layers, n_dot_v) : 1.0f;
  return has_clearcoat(layers) ? share * clearcoat_transmittance(layers, layers.clearcoat_cosine)
                               : share;
}
LAMBENT_FN float mean_coat_share(SurfaceLayers layers, float n_dot_v, float alpha) {
  float share = 1.0f;
  if (has_sheen(layers)) {
    float passes = sheen_transmittance(layers, n_dot_v);
    share = min(passes, mix(passes, mean_sheen_transmittance(layers), alpha));
  }
  if (!has_clearcoat(layers)) return share;
  float greater = mean_greater_schlick(max(layers.clearcoat_cosine, 0.0f), alpha);
  return share * (1.0f - layers.clearcoat * clearcoat_fresnel(greater));
}

/// BRDF times cosine of the clearcoat [1/sr].
LAMBENT_FN float clearcoat_lobe(SurfaceLayers layers, vec3 to_viewer, vec3 to_light) {
  float n_dot_v = dot(layers.clearcoat_normal, to_viewer);
  float n_dot_l = dot(layers.clearcoat_normal, to_light);
  if (n_dot_v <= 0.0f || n_dot_l <= 0.0f) return 0.0f;
  vec3 h = normalize(to_viewer + to_light);
  float alpha = layers.clearcoat_alpha;
  float g = 1.0f / (1.0f + ggx_lambda(n_dot_v, alpha) + ggx_lambda(n_dot_l, alpha));
  float d = ggx_distribution(dot(layers.clearcoat_normal, h), alpha);
  return layers.clearcoat * clearcoat_fresnel(schlick_power(dot(to_viewer, h))) *
         (d * g / (4.0f * n_dot_v));
}

/// Samples a direction of the clearcoat's lobe, which may point below the surface; pdf_clearcoat is
/// its density [1/sr].
LAMBENT_FN vec3 sample_clearcoat(SurfaceLayers layers, vec3 to_viewer, vec2 u) {
  Frame frame = make_frame(layers.clearcoat_normal);
  vec3 v = to_local(frame, to_viewer);
  return to_world(frame, reflect(-v, sample_ggx_visible_normal(v, layers.clearcoat_alpha, u)));
}
LAMBENT_FN float pdf_clearcoat(SurfaceLayers layers, vec3 to_viewer, vec3 to_light) {
  Frame frame = make_frame(layers.clearcoat_normal);
  return pdf_ggx_reflection(to_local(frame, to_viewer), to_local(frame, to_light),
                            layers.clearcoat_alpha);
}

/// Directional albedos of the layers themselves.
LAMBENT_FN float clearcoat_albedo(SurfaceLayers layers) {
  if (!has_clearcoat(layers)) return 0.0f;
  float cosine = max(layers.clearcoat_cosine, 0.0f);
  return layers.clearcoat * clearcoat_fresnel(mean_schlick(cosine, layers.clearcoat_alpha)) *
         ggx_albedo(cosine, layers.clearcoat_alpha);
}
LAMBENT_FN vec3 layered_sheen_albedo(SurfaceLayers layers, float n_dot_v) {
  if (!has_sheen(layers)) return vec3(0.0f);
  float share = sheen_albedo(n_dot_v, layers.sheen_roughness);
  if (has_clearcoat(layers)) share *= clearcoat_transmittance(layers, layers.clearcoat_cosine);
  return layers.sheen * share;
}

LAMBENT_END
#endif
