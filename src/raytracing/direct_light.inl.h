// SPDX-License-Identifier: Apache-2.0
// Candidates of direct light at a point, in the common subset of C++ and GLSL. They come in slots:
// one for each light that every point samples ("asked" lights), then one for each sample of the
// light tree. The tree holds emissive triangles or pieces of them and, where they are many, point
// and spot lights. The includer provides the types
//   LitPointRef  a point with position_ws and, on its lit side, normal_ws and geometric_normal_ws,
//                which are 0 for points in the air, lit from all around; and with albedo_shape
//                where it will reflect by an albedo towards the viewer, else 0; and with
//                mean_normal_length, see bumpy_cosine()
//   ReceiverRef  what light is drawn for: its member `point` is such a point
//   DrawsRef     the lights to draw from
// and
//   bool emitters_alone(DrawsRef draws)                    leaves out the tree's other lights
//   uint enumerated_lights(DrawsRef draws)                      number of asked lights
//   uint fetch_enumerated(DrawsRef draws, uint slot)            index of a slot's light
//   LightRecord fetch_light(DrawsRef draws, uint light)
//   uint tree_samples(DrawsRef draws)                      0: the tree is empty
//   uint tree_candidates(DrawsRef draws)                   <= kMostPicks; see candidates_per_sample
//   PickLobe bounded_lobe(DrawsRef draws, vec3 position_ws, vec3 normal_ws, PickLobe lobe)
//   void pick_lights(DrawsRef draws, vec3 position_ws, vec3 normal_ws, PickLobe lobe, uint count,
//                    inout LightPicks picks)
//   uint emitter_count(DrawsRef draws)                     these come first among the tree's lights
//   EmitterRecord fetch_emitter(DrawsRef draws, uint emitter)
//   vec3 emitted_radiance(DrawsRef draws, EmitterRecord emitter, vec2 barycentrics,
//                         vec3 direction_ws)
//   emitter_material(DrawsRef draws, EmitterRecord emitter)     for emission_luminance()

/// Luminance of the light that a receiver would send on of an unoccluded candidate: the target
/// function of resampling. The includer defines it after this file.
LAMBENT_FN float target_of(ReceiverRef receiver, LightCandidate light);

/// The lobe in which a receiver sends light on, which guides the choice of lights. The includer
/// defines it after this file.
LAMBENT_FN PickLobe lobe_of(ReceiverRef receiver);

/// The shape of a point's albedo as its viewer sees it.
LAMBENT_FN SeenShape seen_shape(LitPointRef point) {
  return seen_shape(point.albedo_shape, point.normal_ws, point.to_viewer_ws);
}

/// Irradiance of an unoccluded candidate at a point [W/m^2]. For points with an albedo_shape, it is
/// weighted by the share that is reflected to the viewer over the albedo. `shape`: seen_shape() of
/// the point.
LAMBENT_FN vec3 unoccluded_irradiance(LitPointRef point, SeenShape shape, LightCandidate light) {
  float received = bumpy_cosine(dot(point.normal_ws, light.to_light), point.mean_normal_length);
  float side = dot(point.geometric_normal_ws, light.to_light);
  if (received <= 0.0f || side <= 0.0f) return vec3(0.0f);
  return light.perpendicular_irradiance *
         reflected_cosine(shape, point.normal_ws, point.to_viewer_ws, light.to_light, received);
}

/// Radiance that a surface reflects of an unoccluded candidate to a viewer [W/(m^2 sr)]. `frame` is
/// that of the point's normal, in which `to_viewer` is given. The share of emitters' light that
/// rays of coats supply is left out; `density_scale`: see emitter_density_scale().
LAMBENT_FN ReflectedPair sampled_reflection(Reflectance reflectance, Frame frame, vec3 to_viewer,
                                            LitPointRef point, LightCandidate light,
                                            CoatShares shares, float density_scale) {
  ReflectedPair reflected = {vec3(0.0f), vec3(0.0f)};
  if (dot(point.geometric_normal_ws, light.to_light) <= 0.0f) return reflected;
  vec3 to_light = to_local(frame, light.to_light);
  ReflectedLobes lobes = evaluate_lobes(reflectance, to_viewer, to_light);
  reflected.diffuse = lobes.diffuse * light.perpendicular_irradiance;
  reflected.specular = lobes.specular * light.perpendicular_irradiance;
  bool of_emitter = light.emission_luminance > 0.0f;
  float density = light.emission_luminance * density_scale;
  if (of_emitter) {
    reflected.specular *=
        sampled_emitter_weight(reflectance, to_viewer, to_light, shares.coat, density);
  }
  if (lobes.clearcoat > 0.0f) {
    float weight = of_emitter ? sampled_emitter_weight(reflectance.layers, to_viewer, to_light,
                                                       shares.clearcoat, density)
                              : 1.0f;
    reflected.specular += lobes.clearcoat * weight * light.perpendicular_irradiance;
  }
  return reflected;
}

/// Number of slots at a point.
LAMBENT_FN uint slot_count(DrawsRef draws) {
  return enumerated_lights(draws) + tree_samples(draws);
}

/// The candidate for a light without extent.
LAMBENT_FN LightCandidate punctual_candidate(LightRecord light, LitPointRef point) {
  PunctualSample sampled = sample_punctual(light, point.position_ws);
  LightCandidate candidate = {sampled.to_light, sampled.distance, sampled.irradiance, 0.0f};
  return candidate;
}

/// The candidate for a picked light of the tree, at a random point on it; `second` is uniform.
LAMBENT_FN LightCandidate drawn_candidate(DrawsRef draws, LitPointRef point, LightPick pick,
                                          float second) {
  if (pick.probability <= 0.0f) return no_candidate();
  uint emitters = emitter_count(draws);
  if (pick.light >= emitters) {
    if (emitters_alone(draws)) return no_candidate();
    LightRecord light = fetch_light(draws, pick.light - emitters);
    LightCandidate punctual = punctual_candidate(light, point);
    punctual.perpendicular_irradiance /= pick.probability;
    return punctual;
  }
  EmitterRecord emitter = fetch_emitter(draws, pick.light);
  TrianglePointSeen seen = draw_on_triangle(emitter.corner_ws - point.position_ws, emitter.edge1_ws,
                                            emitter.edge2_ws, vec2(pick.rest, second));
  if (seen.pdf <= 0.0f || dot(point.geometric_normal_ws, seen.to_point) < 0.0f) {
    return no_candidate();
  }
  if (lies_on_triangle(point.position_ws, emitter.corner_ws, emitter.edge1_ws, emitter.edge2_ws,
                       seen)) {
    return no_candidate();
  }
  vec3 radiance = emitted_radiance(draws, emitter, seen.barycentrics, seen.to_point);
  LightCandidate candidate = {seen.to_point, seen.distance,
                              radiance / (seen.pdf * pick.probability),
                              emission_luminance(emitter_material(draws, emitter))};
  return candidate;
}

/// A sample of the tree: one of several candidates, resampled by the receiver's target function.
/// The expected sum of all samples of a point is the light of all lights in the tree.
LAMBENT_FN LightCandidate resampled_candidate(DrawsRef draws, ReceiverRef receiver,
                                              uint sample_index, LAMBENT_INOUT(LightPicks) picks,
                                              LAMBENT_INOUT(RandomStream) random) {
  uint samples = tree_samples(draws);
  uint count = candidates_per_sample(tree_candidates(draws), samples);
  // Each candidate of each sample has a stratum of the pick of its own; the second coordinate is
  // spread evenly over the candidates of a sample
  float share = 1.0f / float(samples * count);
  uint per_descent = max(kMostPicks / count, 1u);
  if (sample_index % per_descent == 0u) {
    uint together = min(per_descent, samples - sample_index) * count;
    for (uint i = 0u; i < together; ++i) {
      float place = (float(sample_index * count + i) + next_uniform(random)) * share;
      picks.at[i].rest = min(place, kLargestUniform);
    }
    vec3 position_ws = receiver.point.position_ws;
    vec3 normal_ws = receiver.point.normal_ws;
    PickLobe lobe = bounded_lobe(draws, position_ws, normal_ws, lobe_of(receiver));
    pick_lights(draws, position_ws, normal_ws, lobe, together, picks);
  }
  uint first = (sample_index % per_descent) * count;
  float shift = next_uniform(random);
  Resampling resampling = begin_resampling(next_uniform(random));
  for (uint i = 0u; i < count; ++i) {
    float second = fract(shift + float(i) * (kGoldenRatio - 1.0f));
    LightCandidate candidate = drawn_candidate(draws, receiver.point, picks.at[first + i], second);
    offer(resampling, candidate, picks.at[first + i].visibility * target_of(receiver, candidate));
  }
  return resampled(resampling, share);
}

/// The candidate of a slot. Call it for all slots in order, with the same `picks`, which it fills
/// in.
LAMBENT_FN LightCandidate candidate_of_slot(DrawsRef draws, ReceiverRef receiver, uint slot,
                                            LAMBENT_INOUT(LightPicks) picks,
                                            LAMBENT_INOUT(RandomStream) random) {
  uint asked = enumerated_lights(draws);
  if (slot >= asked) return resampled_candidate(draws, receiver, slot - asked, picks, random);
  return punctual_candidate(fetch_light(draws, fetch_enumerated(draws, slot)), receiver.point);
}
