// SPDX-License-Identifier: Apache-2.0
// Direct light at a point: one candidate for each light that every point samples, and some samples
// of the light tree.
#pragma once

#include "lambent/world.h"
#include "raytracing/coat_share.h"
#include "raytracing/emitter_sampling.h"
#include "raytracing/glass/transmitter.h"
#include "raytracing/raytracer.h"
#include "raytracing/world_access.h"
#include "scene/attributes.h"
#include "scene/light_sampling.h"
#include "scene/light_tree/light_tree.h"
#include "scene/light_tree/pick_lobe.h"
#include "scene/media/media.h"
#include "shared/albedo_shape.h"
#include "shared/brdf.h"
#include "shared/color.h"
#include "shared/rays.h"

namespace lambent {

/// The shadow ray to a candidate; the geometric normal is on the lit side.
inline Ray shadow_ray(const glm::vec3& position_ws, const glm::vec3& geometric_normal_ws,
                      const LightCandidate& light) {
  const RayRecord ray = shadow_ray_record(position_ws, geometric_normal_ws, light);
  return {ray.origin_ws, ray.t_min, ray.direction_ws, ray.t_max, ray.mask};
}

/// A point on a surface that receives direct light, with both its normals on the lit side; unit. A
/// point in the air has normals of 0.
struct LitPoint {
  glm::vec3 position_ws;
  glm::vec3 normal_ws;
  glm::vec3 geometric_normal_ws;
  /// encode_albedo_shape() where the light will be reflected to the viewer by an albedo; else 0.
  uint albedo_shape = 0;
  glm::vec3 to_viewer_ws{0.0f};     ///< Unit; read where there is a shape, and by lookups.
  float viewer_distance = 0.0f;     ///< Length of the unoccluded segment towards the viewer [m].
  float mean_normal_length = 1.0f;  ///< See Reflectance.
};

/// How a surface reflects light to a viewer.
struct Reflector {
  const Reflectance& reflectance;
  Frame frame;          ///< Frame of the shading normal.
  glm::vec3 to_viewer;  ///< Unit, in the frame.
  /// Shares of the coats' light that come from rays of their own, and the scale of densities of
  /// samples of emitters; see sampled_reflection().
  CoatShares shares{};
  float density_scale = 0.0f;
};

/// How fog scatters light to a viewer.
struct FogReceiver {
  const Media& media;
  glm::vec3 view_direction_ws;  ///< Unit; direction of the ray from the viewer.
};

/// How a rough surface transmits light to a viewer, and the scale of densities of samples of
/// emitters; see sampled_transmission().
struct ThroughReceiver {
  const Transmitter& transmitter;
  float density_scale = 0.0f;
};

/// What candidates are drawn for: irradiance at a point, or the light that a reflector, fog or a
/// transmitter there sends to the viewer. The normals of a point of a transmitter face away from
/// the viewer.
struct LightReceiver {
  LitPoint point;
  /// Null: for irradiance, unless there is one of the others.
  const Reflector* reflector = nullptr;
  const FogReceiver* fog = nullptr;
  const ThroughReceiver* through = nullptr;
  SeenShape shape{};  ///< seen_shape() of the point, where it has an albedo_shape.
};

/// How a point's candidates are drawn.
struct LightDraws {
  const World& world;
  int tree_samples;  ///< Samples of the light tree, >= 1.
  /// Leaves out directional, point and spot lights.
  bool emitters_alone = false;
  /// Total number of candidates from which the samples of the tree are resampled, 1 to kMostPicks.
  /// Each costs a pick and a point on a light, but no ray; more make less noise. See
  /// candidates_per_sample().
  uint candidates = kCandidates;
};

// What direct_light.inl.h requires of its includer.
using LitPointRef = const LitPoint&;
using ReceiverRef = const LightReceiver&;
using DrawsRef = const LightDraws&;

inline bool emitters_alone(const LightDraws& draws) {
  return draws.emitters_alone;
}
inline uint enumerated_lights(const LightDraws& draws) {
  return draws.emitters_alone ? 0u : static_cast<uint>(lights_of(draws.world).asked().size());
}
inline uint fetch_enumerated(const LightDraws& draws, uint slot) {
  return lights_of(draws.world).asked()[slot];
}
inline LightRecord fetch_light(const LightDraws& draws, uint light) {
  return lights_of(draws.world).lights()[light];
}
inline uint tree_samples(const LightDraws& draws) {
  const bool empty = draws.emitters_alone ? emissive_of(draws.world).empty()
                                          : lights_of(draws.world).nodes().empty();
  return empty ? 0u : static_cast<uint>(draws.tree_samples);
}
inline PickLobe bounded_lobe(const LightDraws& draws, const vec3& position_ws,
                             const vec3& normal_ws, const PickLobe& lobe) {
  return lights_of(draws.world).bounded(position_ws, normal_ws, lobe);
}
inline uint tree_candidates(const LightDraws& draws) {
  return draws.candidates;
}
inline void pick_lights(const LightDraws& draws, const vec3& position_ws, const vec3& normal_ws,
                        const PickLobe& lobe, uint count, LightPicks& picks) {
  lights_of(draws.world).pick(position_ws, normal_ws, lobe, count, picks);
}
inline uint emitter_count(const LightDraws& draws) {
  return static_cast<uint>(emissive_of(draws.world).size());
}
inline const EmitterRecord& fetch_emitter(const LightDraws& draws, uint emitter) {
  return emissive_of(draws.world).entries()[emitter];
}
inline vec3 emitted_radiance(const LightDraws& draws, const EmitterRecord& emitter,
                             const vec2& barycentrics, const vec3& direction_ws) {
  return emissive_of(draws.world).radiance(emitter, barycentrics, direction_ws);
}

inline const Material& emitter_material(const LightDraws& draws, const EmitterRecord& emitter) {
  return material_of(draws.world.scene(), emitter.instance);
}

#include "raytracing/direct_light.inl.h"

/// The scale of densities, see emitter_density_scale(), of a number of samples of emitters at a
/// point.
inline float emitter_density_scale(const World& world, int samples, const vec3& position_ws) {
  return emitter_density_scale(static_cast<uint>(samples), lights_of(world).fluence(position_ws));
}

/// Radiance that fog scatters of a candidate's light, divided by its extinction.
inline vec3 scattered_light(const FogReceiver& fog, const vec3& position_ws,
                            const LightCandidate& light) {
  return light.perpendicular_irradiance *
         scattering(fog.media, position_ws, fog.view_direction_ws, light.to_light);
}

inline float target_of(const LightReceiver& receiver, LightCandidate light) {
  if (receiver.fog != nullptr) {
    return luminance(scattered_light(*receiver.fog, receiver.point.position_ws, light));
  }
  if (receiver.through != nullptr) {
    return luminance(sampled_transmission(receiver.through->transmitter, light,
                                          receiver.through->density_scale));
  }
  if (receiver.reflector == nullptr) {
    return luminance(unoccluded_irradiance(receiver.point, receiver.shape, light));
  }
  const Reflector& to = *receiver.reflector;
  const ReflectedPair pair = sampled_reflection(to.reflectance, to.frame, to.to_viewer,
                                                receiver.point, light, to.shares, to.density_scale);
  return luminance(pair.diffuse + pair.specular);
}

inline PickLobe lobe_of(const LightReceiver& receiver) {
  if (receiver.through != nullptr) return pick_lobe(receiver.through->transmitter);
  if (receiver.reflector == nullptr) return no_pick_lobe();
  const Reflector& to = *receiver.reflector;
  return pick_lobe(to.reflectance, to.frame, to.to_viewer);
}

/// Calls visit(LightCandidate) for every light that all points sample and whose light the receiver
/// would reflect, and for each sample of the light tree. The expected sum of the latter is the
/// light of all lights in the tree. Occlusion is not tested.
template <class Visit>
void for_each_light(const LightDraws& draws, const LightReceiver& receiver, RandomStream& random,
                    Visit visit) {
  const uint slots = slot_count(draws);
  LightPicks picks;
  for (uint slot = 0; slot < slots; ++slot) {
    const LightCandidate light = candidate_of_slot(draws, receiver, slot, picks, random);
    if (light.perpendicular_irradiance != vec3(0.0f)) visit(light);
  }
}

}  // namespace lambent
