// SPDX-License-Identifier: Apache-2.0
// How a surface reflects light.
//
// Based on: Khronos Group, glTF 2.0 specification, Appendix B, "BRDF Implementation".
#ifndef LAMBENT_SHARED_BRDF_H
#define LAMBENT_SHARED_BRDF_H

#include "shared/bumps.h"
#include "shared/layers.h"

LAMBENT_BEGIN

/// The reflectance of a surface point: a Lambert base under a GGX coat, both with the same Fresnel
/// term, and the layers on top of them.
struct Reflectance {
  vec3 diffuse;  ///< Albedo of the base, 0 to 1: base color * (1 - metallic).
  float alpha;   ///< GGX width, roughness squared; at least kMinGgxAlpha.
  vec3 f0;       ///< Specular reflectance at normal incidence.
  /// Specular reflectance at grazing incidence; 0 with f0 = 0 is an exact Lambert surface.
  float f90;
  SurfaceLayers layers;
  /// Length of the mean of the unit normals that it averages over, kLeastMeanLength to 1; 1: there
  /// are no bumps. Scales what the base receives, see bumpy_cosine().
  float mean_normal_length;
};

/// Schlick 1994: the share reflected by the coat at the angle between direction and half vector.
LAMBENT_FN vec3 fresnel(Reflectance surface, float v_dot_h) {
  return schlick_reflectance(surface.f0, surface.f90, schlick_power(v_dot_h));
}

/// BRDF times cos(theta_l) in two parts: base and sheen, coat and clearcoat.
struct ReflectedPair {
  vec3 diffuse;
  vec3 specular;
};

/// BRDF times cos(theta_l) in three parts: base and sheen, coat, clearcoat.
struct ReflectedLobes {
  vec3 diffuse;
  vec3 specular;
  float clearcoat;
};

/// BRDF times cosine of base and coat, without the layers. The base also receives light from below
/// the horizon where it has bumps.
LAMBENT_FN ReflectedPair evaluate_under_layers(Reflectance surface, vec3 to_viewer, vec3 to_light) {
  ReflectedPair result = {vec3(0.0f), vec3(0.0f)};
  float n_dot_v = to_viewer.z;
  float n_dot_l = to_light.z;
  float received = bumpy_cosine(n_dot_l, surface.mean_normal_length);
  if (n_dot_v <= 0.0f || received <= 0.0f) return result;
  if (surface.f90 <= 0.0f) {
    result.diffuse = surface.diffuse * (kInvPi * received);
    return result;
  }
  vec3 h = normalize(to_viewer + to_light);
  vec3 f = fresnel(surface, dot(to_viewer, h));
  result.diffuse = (vec3(1.0f) - f) * surface.diffuse * (kInvPi * received);
  if (n_dot_l <= 0.0f) return result;
  float d = ggx_distribution(h.z, surface.alpha);
  float g = 1.0f / (1.0f + ggx_lambda(n_dot_v, surface.alpha) + ggx_lambda(n_dot_l, surface.alpha));
  result.specular = f * (d * g / (4.0f * n_dot_v));
  return result;
}

/// BRDF times cosine, for unit directions to the viewer and to the light in the frame whose normal
/// is +Z. Zero where either is below the surface, except for light on bumps.
LAMBENT_FN ReflectedLobes evaluate_lobes(Reflectance surface, vec3 to_viewer, vec3 to_light) {
  ReflectedPair under = evaluate_under_layers(surface, to_viewer, to_light);
  ReflectedLobes lobes = {under.diffuse, under.specular, 0.0f};
  SurfaceLayers layers = surface.layers;
  if (!has_layers(layers)) return lobes;
  if (to_light.z <= 0.0f) lobes.diffuse = vec3(0.0f);  // it would pass flat layers
  lobes.diffuse *= even_share_under_layers(layers, to_viewer, to_light);
  lobes.specular *= coat_share_under_layers(layers, to_viewer, to_light);
  if (has_sheen(layers)) {
    lobes.diffuse += layers.sheen * (sheen_lobe(to_viewer, to_light, layers.sheen_roughness) *
                                     even_share_under_clearcoat(layers, to_viewer, to_light));
  }
  if (has_clearcoat(layers)) lobes.clearcoat = clearcoat_lobe(layers, to_viewer, to_light);
  return lobes;
}
LAMBENT_FN ReflectedPair evaluate_reflectance(Reflectance surface, vec3 to_viewer, vec3 to_light) {
  ReflectedLobes lobes = evaluate_lobes(surface, to_viewer, to_light);
  ReflectedPair pair = {lobes.diffuse, lobes.specular};
  if (has_clearcoat(surface.layers)) pair.specular += vec3(lobes.clearcoat);
  return pair;
}

/// Share of light from a uniform sky that the coat reflects: its directional albedo.
LAMBENT_FN vec3 specular_albedo(Reflectance surface, float n_dot_v) {
  float cosine = max(n_dot_v, 0.0f);
  vec3 f = surface.f0 + (vec3(surface.f90) - surface.f0) * mean_schlick(cosine, surface.alpha);
  vec3 albedo = f * ggx_albedo(cosine, surface.alpha);
  if (!has_layers(surface.layers)) return albedo;
  return albedo * mean_coat_share(surface.layers, cosine, surface.alpha);
}

/// Mean of Schlick's (1 - v_dot_h)^5 over light from a uniform sky, in proportion to the cosine to
/// the normal: a polynomial fitted to integrals for 25 cosines, largest error 0.0001. It does not
/// depend on the roughness, since the base has no microfacets.
LAMBENT_FN float mean_base_schlick(float n_dot_v) {
  float s = 1.0f - clamp(n_dot_v, 0.0f, 1.0f);
  return s * cubic(vec4(0.00431124f, -0.00181278f, 0.0255616f, 0.0f), s);
}

/// Share of light from a uniform sky that the base reflects through the coat, and a sheen: the
/// directional albedo of both.
LAMBENT_FN vec3 base_albedo(Reflectance surface, float n_dot_v) {
  vec3 reflected = surface.f0 + (vec3(surface.f90) - surface.f0) * mean_base_schlick(n_dot_v);
  vec3 albedo = surface.diffuse * (vec3(1.0f) - reflected);
  if (!has_layers(surface.layers)) return albedo;
  return albedo * mean_even_share(surface.layers, n_dot_v) +
         layered_sheen_albedo(surface.layers, n_dot_v);
}

/// Whether a surface reflects light only by its coat and clearcoat.
LAMBENT_FN bool has_no_base(Reflectance surface) {
  return surface.diffuse == vec3(0.0f) && !has_sheen(surface.layers);
}

/// Whether a surface has no specular reflection, neither by a coat nor by a clearcoat.
LAMBENT_FN bool has_no_coat(Reflectance surface) {
  return surface.f90 <= 0.0f && !has_clearcoat(surface.layers);
}

/// The reflectance of a surface's clearcoat alone, as a GGX coat in the frame of the clearcoat's
/// normal.
LAMBENT_FN Reflectance clearcoat_alone(SurfaceLayers layers) {
  Reflectance coat = {vec3(0.0f),
                      layers.clearcoat_alpha,
                      vec3(kClearcoatF0 * layers.clearcoat),
                      layers.clearcoat,
                      no_layers(),
                      1.0f};
  return coat;
}

/// The directional albedo of a surface, which treats all of its reflection as diffuse: its Lambert
/// base under the coat, the coat itself, so that metals bounce light, too, and the layers.
LAMBENT_FN vec3 effective_albedo(Reflectance surface, float n_dot_v) {
  if (has_layers(surface.layers)) {
    return base_albedo(surface, n_dot_v) + specular_albedo(surface, n_dot_v) +
           vec3(clearcoat_albedo(surface.layers));
  }
  if (surface.f90 <= 0.0f) return surface.diffuse;
  return base_albedo(surface, n_dot_v) + specular_albedo(surface, n_dot_v);
}

/// Probabilities with which importance sampling picks the coat and the clearcoat; otherwise it
/// samples the cosine lobe.
struct LobeShares {
  float specular;
  float clearcoat;
};

LAMBENT_FN LobeShares lobe_shares(Reflectance surface, float n_dot_v) {
  LobeShares shares = {0.0f, 0.0f};
  if (has_no_coat(surface)) return shares;
  float specular = luminance(specular_albedo(surface, n_dot_v));
  float diffuse = luminance(surface.diffuse + surface.layers.sheen);
  if (!has_clearcoat(surface.layers)) {
    shares.specular = clamp(specular / max(specular + diffuse, 1e-6f), 0.1f, 1.0f);
    return shares;
  }
  // Coat and clearcoat each get at least a quarter of their sum, since a light may be in either
  // lobe alone
  float clearcoat = clearcoat_albedo(surface.layers);
  float coats = specular + clearcoat;
  float both = clamp(coats / max(coats + diffuse, 1e-6f), 0.1f, 1.0f);
  shares.clearcoat = both;
  if (surface.f90 > 0.0f) {
    shares.clearcoat = both * clamp(clearcoat / max(coats, 1e-6f), 0.25f, 0.75f);
  }
  shares.specular = both - shares.clearcoat;
  return shares;
}

/// The same probabilities, with the sum of coat and clearcoat limited to this share.
LAMBENT_FN LobeShares limited_shares(LobeShares shares, float most) {
  float both = shares.specular + shares.clearcoat;
  if (both <= most) return shares;
  if (shares.clearcoat <= 0.0f) {
    shares.specular = most;
    return shares;
  }
  shares.specular *= most / both;
  shares.clearcoat *= most / both;
  return shares;
}

/// A direction to reflect from: of the coat's lobe or the clearcoat's with their probabilities (u.z
/// decides), else of the cosine lobe. May point below the surface, where the density is 0.
LAMBENT_FN vec3 sample_lobes(Reflectance surface, vec3 to_viewer, LobeShares shares, vec3 u) {
  vec2 point = vec2(u.x, u.y);
  if (u.z < shares.clearcoat) return sample_clearcoat(surface.layers, to_viewer, point);
  if (u.z >= shares.specular + shares.clearcoat) return sample_cosine_hemisphere(point);
  vec3 h = sample_ggx_visible_normal(to_viewer, surface.alpha, point);
  return reflect(-to_viewer, h);
}

/// Density of sample_lobes [1/sr].
LAMBENT_FN float pdf_lobes(Reflectance surface, vec3 to_viewer, LobeShares shares, vec3 to_light) {
  float pdf = (1.0f - (shares.specular + shares.clearcoat)) * pdf_cosine_hemisphere(to_light.z);
  if (shares.specular > 0.0f) {
    pdf += shares.specular * pdf_ggx_reflection(to_viewer, to_light, surface.alpha);
  }
  if (shares.clearcoat > 0.0f) {
    pdf += shares.clearcoat * pdf_clearcoat(surface.layers, to_viewer, to_light);
  }
  return pdf;
}

/// A direction to reflect from, drawn from the mix of lobes that suits the surface.
LAMBENT_FN vec3 sample_reflectance(Reflectance surface, vec3 to_viewer, vec3 u) {
  return sample_lobes(surface, to_viewer, lobe_shares(surface, to_viewer.z), u);
}

/// Density of sample_reflectance [1/sr].
LAMBENT_FN float pdf_reflectance(Reflectance surface, vec3 to_viewer, vec3 to_light) {
  return pdf_lobes(surface, to_viewer, lobe_shares(surface, to_viewer.z), to_light);
}

LAMBENT_END
#endif
