// SPDX-License-Identifier: Apache-2.0
// Candidates of direct light at a point, in the common subset of C++ and GLSL. They come in slots:
// one a light, then one a sample of the emissive triangles. The includer provides the types
//   LitPointRef  a point with position_ws and, on its lit side, normal_ws and geometric_normal_ws
//   DrawsRef     lights and emissive triangles to draw from
// and
//   uint light_count(DrawsRef draws)
//   LightRecord fetch_light(DrawsRef draws, uint light)
//   uint emitter_samples(DrawsRef draws)     samples of emissive triangles; 0: nothing emits
//   EmissiveSample fetch_emissive_sample(DrawsRef draws, vec3 u)
//   EmitterPoint find_emitter(DrawsRef draws, LitPointRef point, uint sample_index, vec3 direction)
//       what the ray of this sample meets; an earlier kernel may have traced it

/// The direction in which a draw by the cosine looks for an emitter; 0 where that is into the
/// surface.
LAMBENT_FN vec3 emitter_direction(LitPointRef point, EmitterDraw draw) {
  vec3 direction = sample_cosine_about(point.normal_ws, vec2(draw.u.y, draw.u.z));
  return dot(point.geometric_normal_ws, direction) > 0.0f ? direction : vec3(0.0f);
}

/// Slots of a point.
LAMBENT_FN uint slot_count(DrawsRef draws) {
  return light_count(draws) + emitter_samples(draws);
}

/// The candidate of a slot; slots are asked in their order. What the samples of emissive triangles
/// bring sums up, on average, to what these send.
LAMBENT_FN LightCandidate candidate_of_slot(DrawsRef draws, LitPointRef point, uint slot,
                                            LAMBENT_INOUT(RandomStream) random) {
  uint lights = light_count(draws);
  if (slot < lights) {
    PunctualSample light = sample_punctual(fetch_light(draws, slot), point.position_ws);
    LightCandidate candidate = {light.to_light, light.distance, light.irradiance};
    return candidate;
  }
  uint sample_index = slot - lights;
  float share = 1.0f / float(emitter_samples(draws));
  EmitterDraw draw = draw_emitter(random, int(sample_index), share);
  EmitterPoint emitter = no_emitter();
  if (draw.by_cosine != 0u) {
    vec3 direction = emitter_direction(point, draw);
    if (direction != vec3(0.0f)) emitter = find_emitter(draws, point, sample_index, direction);
  } else {
    emitter = emitter_seen(fetch_emissive_sample(draws, draw.u), point.position_ws);
  }
  if (emitter.radiance == vec3(0.0f)) return no_candidate();
  return emitter_candidate(emitter, point.normal_ws, share);
}

/// Irradiance that a candidate brings to a point unless something is in the way [W/m^2].
LAMBENT_FN vec3 unoccluded_irradiance(LitPointRef point, LightCandidate light) {
  float cosine = dot(point.normal_ws, light.to_light);
  float side = dot(point.geometric_normal_ws, light.to_light);
  if (cosine <= 0.0f || side <= 0.0f) return vec3(0.0f);
  return light.perpendicular_irradiance * cosine;
}

/// What a surface makes of that for a viewer [W/(m^2 sr)]. `frame` is that of the point's normal,
/// in which `to_viewer` is given.
LAMBENT_FN ReflectedPair unoccluded_reflection(Reflectance reflectance, Frame frame, vec3 to_viewer,
                                               LitPointRef point, LightCandidate light) {
  ReflectedPair reflected = {vec3(0.0f), vec3(0.0f)};
  if (dot(point.geometric_normal_ws, light.to_light) <= 0.0f) return reflected;
  reflected = evaluate_reflectance(reflectance, to_viewer, to_local(frame, light.to_light));
  reflected.diffuse *= light.perpendicular_irradiance;
  reflected.specular *= light.perpendicular_irradiance;
  return reflected;
}
