// SPDX-License-Identifier: Apache-2.0
// The formulas for the surface at a hit.
#ifndef LAMBENT_RAYTRACING_SURFACE_MATH_H
#define LAMBENT_RAYTRACING_SURFACE_MATH_H

#include "shared/thin_film.h"

LAMBENT_BEGIN

// Values of Transmission::kind
const uint kCrossesPane = 0u;   ///< The surface is thin: light goes straight on.
const uint kEntersVolume = 1u;  ///< The ray comes from outside a volume, whose surface refracts it.
const uint kLeavesVolume = 2u;  ///< From inside, where the only reflection is inner reflection.

/// Below this GGX width, that of roughness 0.05, transmitted light stays sharp: such lobes are a
/// sixth of a degree wide.
const float kStraightAlpha = 0.0025f;

/// How a surface transmits light.
struct Transmission {
  vec3 tint;        ///< Share of the entering light that is transmitted, by color; 0: opaque.
  uint kind;        ///< kCrossesPane, ...
  vec3 absorption;  ///< Absorption of the volume that the ray came through [1/m].
  float eta;        ///< Index of refraction of the ray's side over that of the other one.
  float alpha;      ///< GGX width of the surface.
};

/// A point of a surface as seen along a ray. Surfaces are two-sided: normals face the ray's origin.
struct Surface {
  vec3 position_ws;          ///< On the triangle [m].
  vec3 normal_ws;            ///< Shading normal: interpolated, normal-mapped; unit.
  vec3 geometric_normal_ws;  ///< Normal of the triangle; unit.
  Reflectance reflectance;   ///< 0 where the ray comes from inside a volume.
  Transmission transmission;
  vec3 emission;  ///< Emitted radiance along the ray, through a clearcoat [W/(m^2 sr)].
  uint material;  ///< Index into Scene::materials.
  /// Share of the field's irradiance that it receives, 0 to 1; see horizon_share(). 0: it receives
  /// direct light alone.
  float gi_share;
};

// A shading normal that faces away from the viewer is bent back until this cosine is left, so that
// smooth silhouettes and steep normal maps neither turn black nor divide by zero.
const float kMinViewCosine = 1e-3f;
// Vectors of less squared length have no direction.
const float kMinSquaredLength = 1e-30f;

LAMBENT_FN vec3 normalize_or(vec3 v, vec3 fallback) {
  float squared = dot(v, v);
  return squared > kMinSquaredLength ? v * (1.0f / sqrt(squared)) : fallback;
}

/// The part of a surface that a ray covers, which selects MIP levels.
struct Footprint {
  float width;   ///< Width across the ray [m]; 0: textures are read at full resolution.
  uint blended;  ///< See ConeShare.
};

/// Transforms a point from object space.
LAMBENT_FN vec3 transform_point(mat4 world_from_object, vec3 position) {
  return vec3(world_from_object * vec4(position, 1.0f));
}

/// det(M) * inverse(M)^T: transforms normals to world space, except for their length and, in
/// mirrored instances, their sign, which is set later by facing the viewer.
LAMBENT_FN mat3 cofactors(mat4 m) {
  vec3 x = vec3(m[0]);
  vec3 y = vec3(m[1]);
  vec3 z = vec3(m[2]);
  return mat3(cross(y, z), cross(z, x), cross(x, y));
}

/// Tangent and handedness from texture coordinates, for meshes that come without tangents, given
/// the edges from a triangle's first vertex to the others.
LAMBENT_FN vec4 tangent_from_uvs(vec3 edge1, vec3 edge2, vec2 uv1, vec2 uv2) {
  float determinant = uv1.x * uv2.y - uv1.y * uv2.x;
  float orientation = determinant < 0.0f ? -1.0f : 1.0f;
  // glTF's v runs down the image, its bitangent up: hence the sign of the handedness.
  return vec4(orientation * (edge1 * uv2.y - edge2 * uv1.y), -orientation);
}

/// `tangent` made orthogonal to a unit normal; 0 where the two are parallel.
LAMBENT_FN vec3 orthogonal_tangent(vec3 normal, vec3 tangent) {
  return normalize_or(tangent - normal * dot(normal, tangent), vec3(0.0f));
}

/// The vector in a normal map's texel, in tangent space, of any length. In MIPs it is a mean of
/// unit normals: the more these scatter, the shorter.
LAMBENT_FN vec3 map_vector(vec3 texel, float normal_scale) {
  vec3 n = texel * 2.0f - 1.0f;
  return vec3(n.x * normal_scale, n.y * normal_scale, n.z);
}

// The square of a GGX width, over the variance of normally distributed slopes, half of which are
// within the same distance: 2 ln 2. Where their peaks are equal it is 2, and where three quarters
// of them are, 0.9. The 2 ln 2 in normal_mips.cpp is the median of squared distances, a figure of
// the measurement.
const float kGgxOverVariance = 1.3862944f;

/// GGX width of a coat over bumps of which most deviate from their mean by `spread` along each
/// axis, see build_normal_mips(): a few steep ones widen no lobe. The squares of widths add up:
/// Toksvig, "Mipmapping Normal Maps", 2004; Kaplanyan et al., "Filtering Distributions of Normals
/// for Shading Antialiasing", HPG 2016, Eq. 6.
LAMBENT_FN float widened_alpha(float alpha, float spread) {
  if (spread == 0.0f) return alpha;
  return min(sqrt(alpha * alpha + kGgxOverVariance * spread * spread), max(alpha, 1.0f));
}

// Least length of a mean of normals. That of normals all over a hemisphere is 0.5, so only maps of
// other vectors have shorter ones.
const float kLeastMeanLength = 0.1f;
// Least cosine between a shading and a geometric normal from which mean_length_of_share() can tell
// the length: rounding of packed normals is 1e-4.
const float kLeastTellingCosine = 0.1f;

/// Length of the mean of unit normals that a map scales, from the length of that of unscaled ones:
/// scaling multiplies the tangents of the angles between normals and mean. At least
/// kLeastMeanLength.
LAMBENT_FN float scaled_mean_length(float unscaled, float normal_scale) {
  float bounded = clamp(unscaled, kLeastMeanLength, 1.0f);
  float squared = bounded * bounded;
  float scaled = sqrt(squared / (squared + normal_scale * normal_scale * (1.0f - squared)));
  return max(scaled, kLeastMeanLength);
}

/// The normal for a normal map's vector, in the space of the unit vectors normal and tangent.
LAMBENT_FN vec3 mapped_normal(vec3 normal, vec3 tangent, float handedness, vec3 n) {
  vec3 b = cross(normal, tangent) * (handedness < 0.0f ? -1.0f : 1.0f);
  return normalize_or(tangent * n.x + b * n.y + normal * n.z, normal);
}

/// A shading normal on the viewer's side. `along_winding`: it points to the side from which the
/// vertices run counter-clockwise; `from_front`: the ray comes from that side. `geometric_normal`
/// faces the viewer already.
LAMBENT_FN vec3 normal_towards_viewer(vec3 normal, bool along_winding, bool from_front,
                                      vec3 direction, vec3 geometric_normal) {
  vec3 n = along_winding != from_front ? -normal : normal;
  float view_cosine = -dot(n, direction);
  if (view_cosine >= kMinViewCosine) return n;
  return normalize_or(n + (view_cosine - kMinViewCosine) * direction, geometric_normal);
}

// Mirror directions of smooth surfaces leave the triangle at least at this cosine, or at this share
// of the viewer's own where that is less.
const float kMinMirrorCosine = 0.01f;
const float kMinMirrorShare = 0.9f;

/// The interpolated normal, bent towards the triangle's where the mirror direction of a ray that
/// arrives along `direction` would be below the triangle: nothing is reflected from there, and
/// smooth shapes would have dark rims. `normal` and `geometric_normal` face the ray's origin, unit.
/// The mirror direction and the geometric normal then have a cosine of just kMinMirrorCosine: with
/// the viewer's direction (g, u) in the plane of the two normals, and the normal at an angle t to
/// the geometric one, it is g cos 2t + u sin 2t.
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

/// Sets a clearcoat's normal, in the frame of the shading normal, for a ray along `direction_ws`.
LAMBENT_FN void place_clearcoat(LAMBENT_INOUT(SurfaceLayers) layers, vec3 normal_ws,
                                vec3 clearcoat_normal_ws, vec3 direction_ws) {
  if (clearcoat_normal_ws != normal_ws) {
    layers.clearcoat_normal = to_local(make_frame(normal_ws), clearcoat_normal_ws);
  }
  layers.clearcoat_cosine = -dot(clearcoat_normal_ws, direction_ws);
}

/// Share of uniform light from all around that a surface receives, as nothing arrives from below
/// its geometric horizon. The integral of dot(n, w) over the directions w above both horizons is
/// pi (1 + dot(n, n_g)) / 2. It is linear in the normal n, so that the mean of many normals, with
/// its length, stands for them: `length` is that of the mean, `cosine` is dot(n, n_g).
LAMBENT_FN float horizon_share(float length, float cosine) {
  return 0.5f + 0.5f * length * cosine;
}

/// The length of which this is the horizon_share(). 1 where it cannot be told: where a surface
/// receives none of the field's light, or its shading normal is nearly at right angles to its
/// triangle's.
LAMBENT_FN float mean_length_of_share(float gi_share, float cosine) {
  if (gi_share <= 0.0f || cosine < kLeastTellingCosine) return 1.0f;
  return clamp((2.0f * gi_share - 1.0f) / cosine, kLeastMeanLength, 1.0f);
}

// Lower bound of the share of the hemisphere about a normal that is above the surface, which bounds
// above_horizon().
const float kLeastAbove = 0.1f;

/// Factor from irradiance of rays above the geometric horizon to what a surface with this share of
/// indirect light receives. Rays about the mean normal of a MIP level leave out less than those
/// about the normals that it averages.
LAMBENT_FN float above_horizon(float gi_share, float cosine_of_normals) {
  return gi_share / max(kLeastAbove, 0.5f + 0.5f * cosine_of_normals);
}

/// The value for opaque surfaces.
LAMBENT_FN Transmission no_transmission() {
  Transmission none = {vec3(0.0f), kCrossesPane, vec3(0.0f), 1.0f, 1.0f};
  return none;
}

LAMBENT_FN bool is_transmissive(Transmission transmission) {
  return transmission.tint != vec3(0.0f);
}

/// Share of light that passes a surface straight on, by color. Shadow rays and rays of probes pass
/// volumes straight: light that enters at this angle also leaves.
LAMBENT_FN vec3 straight_share(vec3 tint, Reflectance from_outside, float cosine) {
  vec3 share = tint * (vec3(1.0f) - fresnel(from_outside, abs(cosine)));
  if (!has_layers(from_outside.layers)) return share;
  return share * layers_transmittance(from_outside.layers, abs(cosine));
}

/// Probability with which a ray that crosses glass passes a surface that transmits this share.
LAMBENT_FN float passing_probability(vec3 share) {
  return clamp(max(share.x, max(share.y, share.z)), 0.0f, 1.0f);
}

/// Least probability of being stopped, in the weight of rays that were stopped although they might
/// have passed. A pane of glass stops few.
const float kLeastStopping = 1e-4f;
LAMBENT_FN float weight_of_stopped(vec3 share) {
  return 1.0f / max(1.0f - passing_probability(share), kLeastStopping);
}

/// An exactly Lambertian reflectance.
LAMBENT_FN Reflectance lambert_reflectance(vec3 diffuse) {
  Reflectance result = {diffuse, 1.0f, vec3(0.0f), 0.0f, no_layers(), 1.0f};
  return result;
}

/// glTF 2.0, Appendix B.3, KHR_materials_ior and KHR_materials_specular, with one Fresnel term for
/// both lobes.
LAMBENT_FN Reflectance coated_reflectance(vec3 base, float metallic, float roughness,
                                          float specular, vec3 specular_color, float ior) {
  float root_f0 = (ior - 1.0f) / (ior + 1.0f);
  vec3 dielectric_f0 = min(specular_color * (root_f0 * root_f0), vec3(1.0f)) * specular;
  Reflectance result = {base * (1.0f - metallic),
                        max(roughness * roughness, kMinGgxAlpha),
                        mix(dielectric_f0, base, metallic),
                        mix(specular, 1.0f, metallic),
                        no_layers(),
                        1.0f};
  return result;
}

/// KHR_materials_sheen and KHR_materials_clearcoat. The clearcoat's normal is set later, and is the
/// shading normal until then.
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
