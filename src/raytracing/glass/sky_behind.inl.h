// SPDX-License-Identifier: Apache-2.0
// The bright part of the sky behind rough surfaces, in the common subset of C++ and GLSL. The
// includer provides what bright_sky.inl.h requires, and includes it first.

/// A direction to the sky, and the radiance that a surface transmits of it to the viewer if nothing
/// is in the way [W/(m^2 sr)].
struct SkyBehind {
  vec3 direction_ws;  ///< Unit.
  vec3 light;
};

/// One sample of the sky's bright part, drawn as sample_reflected_sky() draws it.
LAMBENT_FN SkyBehind sample_sky_behind(SkyRef sky, Transmitter at,
                                       LAMBENT_INOUT(RandomStream) random) {
  SkyBehind chosen = {vec3(0.0f), vec3(0.0f)};
  if (bright_cell_count(sky) == 0u) return chosen;
  Reservoir reservoir = begin_reservoir(next_uniform(random));
  for (uint i = 0u; i < kSkyCandidates; ++i) {
    float u = (float(i) + next_uniform(random)) / float(kSkyCandidates);
    BrightSkySample drawn = sample_bright_sky(sky, u, next_uniform2(random));
    if (drawn.pdf <= 0.0f) continue;
    ThroughLobe lobe = through_lobe(at, drawn.direction_ws);
    float sampled = 1.0f - found_light_weight(lobe.pdf, float(kSkyCandidates) * drawn.pdf);
    vec3 light = lobe.value * drawn.radiance * (sampled / drawn.pdf);
    if (!accepts(reservoir, luminance(light))) continue;
    chosen.direction_ws = drawn.direction_ws;
    chosen.light = light;
  }
  chosen.light *= resampling_weight(reservoir) / float(kSkyCandidates);
  return chosen;
}
