// SPDX-License-Identifier: Apache-2.0
// The bright part of the sky as a light of coats, in the common subset of C++ and GLSL. The
// includer provides what bright_sky.inl.h requires, and includes it first.

/// A surface whose coat and clearcoat reflect the sky.
struct SkyReflector {
  Reflectance reflectance;
  Frame frame;     ///< Frame of the shading normal.
  vec3 to_viewer;  ///< Unit, in the frame.
  vec3 geometric_normal_ws;
  CoatShares shares;  ///< Shares of their light that come from rays of their own.
};

/// Radiance that a surface's coat and clearcoat reflect to the viewer [W/(m^2 sr)].
struct ReflectedSky {
  vec3 coat;
  vec3 clearcoat;
};

/// A direction to the sky, and the light that it brings if nothing is in the way.
struct SkyCandidate {
  vec3 direction_ws;  ///< Unit.
  ReflectedSky light;
};

/// What coats reflect of a drawn direction. Their rays find the sky, too: multiple importance
/// sampling gives the samples what found_light_weight() leaves. Coats' light that does not come
/// from rays is looked up in the field, which has the sky's.
LAMBENT_FN ReflectedSky reflected_sky(SkyReflector at, BrightSkySample drawn) {
  ReflectedSky light = {vec3(0.0f), vec3(0.0f)};
  if (drawn.pdf <= 0.0f || dot(at.geometric_normal_ws, drawn.direction_ws) <= 0.0f) return light;
  vec3 to_light = to_local(at.frame, drawn.direction_ws);
  ReflectedLobes lobes = evaluate_lobes(at.reflectance, at.to_viewer, to_light);
  vec3 irradiance = drawn.radiance / drawn.pdf;
  float density = float(kSkyCandidates) * drawn.pdf;
  if (at.shares.coat > 0.0f) {
    float pdf = pdf_ggx_reflection(at.to_viewer, to_light, at.reflectance.alpha);
    light.coat =
        lobes.specular * irradiance * (at.shares.coat * (1.0f - found_light_weight(pdf, density)));
  }
  if (at.shares.clearcoat > 0.0f && lobes.clearcoat > 0.0f) {
    float pdf = pdf_clearcoat(at.reflectance.layers, at.to_viewer, to_light);
    light.clearcoat = irradiance * (lobes.clearcoat * at.shares.clearcoat *
                                    (1.0f - found_light_weight(pdf, density)));
  }
  return light;
}

/// One sample of the sky's bright part: of several directions, which are spread evenly over it, one
/// is chosen by the light that it would bring. The sample's expected light is that of all.
LAMBENT_FN SkyCandidate sample_reflected_sky(SkyRef sky, SkyReflector at,
                                             LAMBENT_INOUT(RandomStream) random) {
  SkyCandidate chosen = {vec3(0.0f), {vec3(0.0f), vec3(0.0f)}};
  if (bright_cell_count(sky) == 0u) return chosen;
  if (at.shares.coat <= 0.0f && at.shares.clearcoat <= 0.0f) return chosen;
  Reservoir reservoir = begin_reservoir(next_uniform(random));
  for (uint i = 0u; i < kSkyCandidates; ++i) {
    float u = (float(i) + next_uniform(random)) / float(kSkyCandidates);
    BrightSkySample drawn = sample_bright_sky(sky, u, next_uniform2(random));
    ReflectedSky light = reflected_sky(at, drawn);
    if (!accepts(reservoir, luminance(light.coat + light.clearcoat))) continue;
    chosen.direction_ws = drawn.direction_ws;
    chosen.light = light;
  }
  float scale = resampling_weight(reservoir) / float(kSkyCandidates);
  chosen.light.coat *= scale;
  chosen.light.clearcoat *= scale;
  return chosen;
}
