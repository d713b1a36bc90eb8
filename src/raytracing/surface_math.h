// SPDX-License-Identifier: Apache-2.0
// The formulas between a hit and the surface that shading sees.
#ifndef LAMBENT_RAYTRACING_SURFACE_MATH_H
#define LAMBENT_RAYTRACING_SURFACE_MATH_H

#include "shared/brdf.h"

LAMBENT_BEGIN

// Transmission::kind
const uint kCrossesPane = 0u;   ///< The surface is thin: light goes straight on.
const uint kEntersVolume = 1u;  ///< The ray comes from outside of a volume that refracts,
const uint kLeavesVolume = 2u;  ///< and from inside, where reflection is inner reflection alone.

/// How a surface lets light through.
struct Transmission {
  vec3 tint;        ///< Share of the light that enters which passes, by color; 0: none does.
  uint kind;        ///< kCrossesPane, ...
  vec3 absorption;  ///< Of the volume that the ray came through [1/m].
  float eta;        ///< Index of refraction of the ray's side over that of the other one.
  float alpha;      ///< GGX width of the surface.
};

/// A point of a surface as seen along a ray. Surfaces are two-sided: normals face the ray's origin.
struct Surface {
  vec3 position_ws;          ///< On the triangle [m].
  vec3 normal_ws;            ///< Shading normal: interpolated, normal-mapped; unit.
  vec3 geometric_normal_ws;  ///< Of the triangle; unit.
  Reflectance reflectance;   ///< Nothing where the ray comes from inside a volume.
  Transmission transmission;
  vec3 emission;  ///< Radiance along the ray, through a clearcoat [W/(m^2 sr)].
  uint material;  ///< Index into Scene::materials.
  /// Share of the field's irradiance that it receives, 0 to 1: see horizon_share(). 0: it receives
  /// direct light alone.
  float gi_share;
};

// A shading normal turned away from the viewer is bent back to where this cosine is left, so that
// smooth silhouettes and steep normal maps neither go black nor divide by zero.
const float kMinViewCosine = 1e-3f;
// Squared lengths below this are no direction.
const float kMinSquaredLength = 1e-30f;

LAMBENT_FN vec3 normalize_or(vec3 v, vec3 fallback) {
  float squared = dot(v, v);
  return squared > kMinSquaredLength ? v * (1.0f / sqrt(squared)) : fallback;
}

/// What a ray covers of a surface, by which its textures are read.
struct Footprint {
  float width;   ///< Across the ray [m]; 0: textures are read at full resolution.
  uint blended;  ///< As of ConeShare.
};

/// A point given in object space.
LAMBENT_FN vec3 transform_point(mat4 world_from_object, vec3 position) {
  return vec3(world_from_object * vec4(position, 1.0f));
}

/// det(M) * inverse(M)^T: takes normals to the world, but for their length and, in mirrored
/// instances, their sign, which facing the viewer settles anyway.
LAMBENT_FN mat3 cofactors(mat4 m) {
  vec3 x = vec3(m[0]);
  vec3 y = vec3(m[1]);
  vec3 z = vec3(m[2]);
  return mat3(cross(y, z), cross(z, x), cross(x, y));
}

/// Cross section of a cone of this width over a triangle's area, 0 where there is no cone.
LAMBENT_FN float share_of_triangle(float footprint, float double_area) {
  if (footprint <= 0.0f || double_area <= 0.0f) return 0.0f;
  return 2.0f * footprint * footprint / double_area;
}

/// Tangent and handedness that the texture coordinates tell, for meshes that come without tangents;
/// from the edges between a triangle's first vertex and the others.
LAMBENT_FN vec4 tangent_from_uvs(vec3 edge1, vec3 edge2, vec2 uv1, vec2 uv2) {
  float determinant = uv1.x * uv2.y - uv1.y * uv2.x;
  float orientation = determinant < 0.0f ? -1.0f : 1.0f;
  // glTF's v runs down the image, its bitangent up: hence the sign of the handedness.
  return vec4(orientation * (edge1 * uv2.y - edge2 * uv1.y), -orientation);
}

/// `tangent` made orthogonal to a unit normal; 0 where it has no direction of its own.
LAMBENT_FN vec3 orthogonal_tangent(vec3 normal, vec3 tangent) {
  return normalize_or(tangent - normal * dot(normal, tangent), vec3(0.0f));
}

/// The vector that a normal map's texel holds, in tangent space. A mean over many texels is shorter
/// than 1, the shorter the more their normals scatter.
LAMBENT_FN vec3 map_vector(vec3 texel, float normal_scale) {
  vec3 n = texel * 2.0f - 1.0f;
  return vec3(n.x * normal_scale, n.y * normal_scale, n.z);
}

// Vectors of maps are of 8 bits a component: their means are shorter than 1 by up to so much where
// all normals are the same.
const float kLengthRounding = 1.0f / 255.0f;

/// Variance of the slopes, along each axis, of the bumps whose mean map_vector() is this. Of small
/// slopes p the normals' mean is shorter than 1 by their mean of |p|^2 / 2.
LAMBENT_FN float slope_variance(vec3 mean, float normal_scale) {
  float scale = max(abs(normal_scale), kLengthRounding);
  float mean_length = length(vec3(mean.x / scale, mean.y / scale, mean.z));
  return max(1.0f - kLengthRounding - mean_length, 0.0f) * normal_scale * normal_scale;
}

/// GGX width of a coat over bumps whose slopes have this variance. Toksvig, "Mipmapping Normal
/// Maps", 2004; Kaplanyan et al., "Filtering Distributions of Normals for Shading Antialiasing",
/// HPG 2016, Eq. 6: lobes of slopes add up by their squares.
LAMBENT_FN float widened_alpha(float alpha, float slope_variance) {
  if (slope_variance <= 0.0f) return alpha;
  return min(sqrt(alpha * alpha + 2.0f * slope_variance), max(alpha, 1.0f));
}

/// The normal that a map's vector says, in the space of the unit vectors normal and tangent.
LAMBENT_FN vec3 mapped_normal(vec3 normal, vec3 tangent, float handedness, vec3 n) {
  vec3 b = cross(normal, tangent) * (handedness < 0.0f ? -1.0f : 1.0f);
  return normalize_or(tangent * n.x + b * n.y + normal * n.z, normal);
}

/// A shading normal on the viewer's side. `along_winding`: it points to where the vertices run
/// counter-clockwise; `from_front`: that is where the ray comes from. `geometric_normal` is on the
/// viewer's side already.
LAMBENT_FN vec3 normal_towards_viewer(vec3 normal, bool along_winding, bool from_front,
                                      vec3 direction, vec3 geometric_normal) {
  vec3 n = along_winding != from_front ? -normal : normal;
  float view_cosine = -dot(n, direction);
  if (view_cosine >= kMinViewCosine) return n;
  return normalize_or(n + (view_cosine - kMinViewCosine) * direction, geometric_normal);
}

// Mirror directions of smooth surfaces leave the triangle at least at this cosine, or at so much of
// the viewer's own where that is less.
const float kMinMirrorCosine = 0.01f;
const float kMinMirrorShare = 0.9f;

/// The normal that vertices interpolate, bent towards the triangle's where the mirror direction of
/// a ray that arrives along `direction` would run below the triangle: nothing is reflected from
/// there, and smooth shapes would have dark rims. `normal` and `geometric_normal` face the ray's
/// origin, unit. The mirror direction and the geometric normal then have a cosine of just
/// kMinMirrorCosine: with the viewer's direction (g, u) in the plane of the two normals, and the
/// normal at an angle t to the geometric one, it is g cos 2t + u sin 2t.
LAMBENT_FN vec3 reflecting_normal(vec3 normal, vec3 direction, vec3 geometric_normal) {
  float viewer_cosine = -dot(geometric_normal, direction);
  float least = min(kMinMirrorShare * viewer_cosine, kMinMirrorCosine);
  if (dot(geometric_normal, reflect(direction, normal)) >= least) return normal;
  vec3 beside = normalize_or(normal - dot(normal, geometric_normal) * geometric_normal, vec3(0.0f));
  float along = -dot(beside, direction);
  float squared = viewer_cosine * viewer_cosine + along * along;
  if (squared <= least * least || least <= 0.0f) return normal;
  float rest = sqrt(squared - least * least);
  float cos_2t = (least * viewer_cosine - along * rest) / squared;
  float sin_2t = (least * along + viewer_cosine * rest) / squared;
  return normalize_or((1.0f + cos_2t) * geometric_normal + sin_2t * beside, geometric_normal);
}

/// Gives a clearcoat its normal, in the frame of the shading normal, for a ray along a direction.
LAMBENT_FN void place_clearcoat(LAMBENT_INOUT(SurfaceLayers) layers, vec3 normal_ws,
                                vec3 clearcoat_normal_ws, vec3 direction_ws) {
  if (clearcoat_normal_ws != normal_ws) {
    layers.clearcoat_normal = to_local(make_frame(normal_ws), clearcoat_normal_ws);
  }
  layers.clearcoat_cosine = -dot(clearcoat_normal_ws, direction_ws);
}

/// Share of uniform light from all around that a surface receives although nothing arrives from
/// below its geometric horizon: over the directions above both horizons, the integral of
/// dot(n, w) is pi (1 + dot(n, n_g)) / 2. It is linear in the normal n, so that for many normals
/// their mean does, with its length: `length` is that of the mean, `cosine` dot(n, n_g).
LAMBENT_FN float horizon_share(float length, float cosine) {
  return 0.5f + 0.5f * min(length, 1.0f) * cosine;
}

// The share of the hemisphere about a normal that is above the surface is taken to be at least
// this, which bounds above_horizon().
const float kLeastAbove = 0.1f;

/// By how much irradiance from rays above the geometric horizon exceeds what a surface with this
/// share of indirect light receives. Rays about a MIP's mean normal leave out less than those about
/// the normals that it is the mean of.
LAMBENT_FN float above_horizon(float gi_share, float cosine_of_normals) {
  return gi_share / max(kLeastAbove, 0.5f + 0.5f * cosine_of_normals);
}

/// Of a surface that lets no light through.
LAMBENT_FN Transmission no_transmission() {
  Transmission none = {vec3(0.0f), kCrossesPane, vec3(0.0f), 1.0f, 1.0f};
  return none;
}

LAMBENT_FN bool lets_light_through(Transmission transmission) {
  return transmission.tint != vec3(0.0f);
}

/// Share of light that crosses a surface straight on, by color. Volumes are crossed straight by
/// shadow rays and rays of probes: where light enters at this angle, it also leaves.
LAMBENT_FN vec3 straight_share(vec3 tint, Reflectance from_outside, float cosine) {
  vec3 share = tint * (vec3(1.0f) - fresnel(from_outside, abs(cosine)));
  if (!has_layers(from_outside.layers)) return share;
  return share * passes_layers(from_outside.layers, abs(cosine));
}

/// Probability with which a ray that crosses glass passes what lets this share through.
LAMBENT_FN float passing_probability(vec3 share) {
  return clamp(max(share.x, max(share.y, share.z)), 0.0f, 1.0f);
}

/// Weight of rays that were stopped although they might have passed. A pane of glass stops few.
const float kLeastStopping = 1e-4f;
LAMBENT_FN float weight_of_stopped(vec3 share) {
  return 1.0f / max(1.0f - passing_probability(share), kLeastStopping);
}

/// What reflects as Lambert says, exactly.
LAMBENT_FN Reflectance lambert_reflectance(vec3 diffuse) {
  Reflectance result = {diffuse, 1.0f, vec3(0.0f), 0.0f, no_layers()};
  return result;
}

/// glTF 2.0, Appendix B.3, KHR_materials_ior and KHR_materials_specular, with one Fresnel term for
/// both lobes.
LAMBENT_FN Reflectance coated_reflectance(vec3 base, float metallic, float roughness,
                                          float specular, vec3 specular_color, float ior) {
  float root_f0 = (ior - 1.0f) / (ior + 1.0f);
  vec3 dielectric_f0 = min(specular_color * (root_f0 * root_f0), vec3(1.0f)) * specular;
  Reflectance result = {base * (1.0f - metallic), max(roughness * roughness, kMinGgxAlpha),
                        mix(dielectric_f0, base, metallic), mix(specular, 1.0f, metallic),
                        no_layers()};
  return result;
}

/// KHR_materials_sheen and KHR_materials_clearcoat, whose normal is the shading normal for now.
LAMBENT_FN SurfaceLayers layers_of(vec3 sheen, float sheen_roughness, float clearcoat,
                                   float clearcoat_roughness) {
  SurfaceLayers layers = no_layers();
  layers.sheen = min(sheen, vec3(1.0f)) * narrow_sheen_factor(sheen_roughness);
  layers.sheen_roughness = clamp(sheen_roughness, kMinSheenRoughness, 1.0f);
  layers.clearcoat = clearcoat;
  layers.clearcoat_alpha = max(clearcoat_roughness * clearcoat_roughness, kMinGgxAlpha);
  return layers;
}

LAMBENT_END
#endif
