// SPDX-License-Identifier: Apache-2.0
// Candidates of direct light: raytracing/direct_light.h on the device. Where sampling asks for a
// ray of its own, an earlier kernel wrote it and its hit is read.
#ifndef LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL
#define LAMBENT_RAYTRACING_SHADERS_DIRECT_LIGHT_GLSL

#include "raytracing/emitter_sampling.h"
#include "raytracing/shaders/scene_fetch.glsl"
#include "raytracing/surface_math.h"
#include "raytracing/vulkan/shading_records.h"

/// A ray that is not traced.
RayRecord no_ray() {
  return RayRecord(vec3(0.0f), 0.0f, vec3(0.0f, 0.0f, 1.0f), 0.0f, 0u);
}

/// The ray that asks whether a candidate reaches a point.
RayRecord shadow_ray(LitPointRecord point, LightCandidate light) {
  return RayRecord(offset_ray_origin(point.position_ws, point.geometric_normal_ws), 0.0f,
                   light.to_light, shadow_ray_length(light.distance), kRayMeetsAll);
}

/// The emitter whose interval of the cumulative distribution holds `u`.
uint emitter_at(SceneArray scene, float u) {
  FloatArray cumulative = scene.at[0].emitter_cumulative;
  uint first = 0u;
  uint count = scene.at[0].emitter_count;
  while (count > 0u) {
    uint half_count = count / 2u;
    bool above = cumulative.at[first + half_count] > u;
    first = above ? first : first + half_count + 1u;
    count = above ? half_count : count - half_count - 1u;
  }
  return min(first, scene.at[0].emitter_count - 1u);
}

vec3 world_edge_product(InstanceRecord instance, MeshRecord mesh, uvec3 v) {
  vec3 p0 = mesh.positions.at[v.x];
  return edge_product(instance.world_from_object, mesh.positions.at[v.y] - p0,
                      mesh.positions.at[v.z] - p0);
}

/// A point drawn by power: `u.x` picks the triangle, the others the point on it.
EmissiveSample sample_emissive(SceneArray scene, vec3 u) {
  EmitterRecord entry = scene.at[0].emitters.at[emitter_at(scene, u.x)];
  InstanceRecord instance = scene.at[0].instances.at[entry.instance];
  MeshRecord mesh = scene.at[0].meshes.at[instance.mesh];
  MaterialRecord material = scene.at[0].materials.at[mesh.material];
  TrianglePoint p = triangle_point(mesh, entry.triangle, sample_uniform_triangle(vec2(u.y, u.z)));

  EmissiveSample drawn;
  drawn.position_ws = transform_point(instance.world_from_object, position_at(mesh, p));
  drawn.normal_ws = world_edge_product(instance, mesh, p.vertices) / (2.0f * entry.area);
  drawn.radiance = emission_at(scene, mesh, material, p, 0.0f);
  if (material.alpha_mode != kAlphaOpaque) {
    drawn.radiance *= stopping_probability(material.alpha_mode, material.alpha_cutoff,
                                           coverage_at(scene, mesh, material, p));
  }
  drawn.pdf_area = entry.probability / entry.area;
  return drawn;
}

/// What a ray drawn by the cosine met.
EmitterPoint emitter_of_hit(SceneArray scene, RayRecord ray, HitRecord hit) {
  if (ray.mask == 0u || missed(hit)) return no_emitter();
  InstanceRecord instance = scene.at[0].instances.at[hit.instance];
  if (instance.first_emitter_pdf == kEmitsNothing) return no_emitter();
  float pdf_area = scene.at[0].emitter_pdfs.at[instance.first_emitter_pdf + hit.triangle];
  if (pdf_area <= 0.0f) return no_emitter();
  MeshRecord mesh = scene.at[0].meshes.at[instance.mesh];
  MaterialRecord material = scene.at[0].materials.at[mesh.material];
  TrianglePoint p = triangle_point(mesh, hit.triangle, hit.barycentrics);
  vec3 normal = normalize(world_edge_product(instance, mesh, p.vertices));
  return emitter_met(ray.direction_ws, hit.distance, emission_at(scene, mesh, material, p, 0.0f), normal,
                     pdf_area);
}

/// A candidate that brings nothing.
LightCandidate no_candidate() {
  return LightCandidate(vec3(0.0f), 0.0f, vec3(0.0f));
}

/// The candidate of a slot of a point: of a light, or of a sample of emitters, for which slots are
/// asked in their order.
LightCandidate candidate_of_slot(LightDrawsArguments args, LitPointRecord point, uint i, uint slot,
                                 inout RandomStream random) {
  uint lights = args.scene.at[0].light_count;
  if (slot < lights) {
    PunctualSample light = sample_punctual(args.scene.at[0].lights.at[slot], point.position_ws);
    return LightCandidate(light.to_light, light.distance, light.irradiance);
  }
  uint n = slot - lights;
  float share = 1.0f / float(args.emissive_samples);
  EmitterDraw draw = draw_emitter(random, int(n), share);
  EmitterPoint emitter;
  if (draw.by_cosine != 0u) {
    uint at = n * args.count + i;
    emitter = emitter_of_hit(args.scene, args.emitter_rays.at[at], args.emitter_hits.at[at]);
  } else {
    emitter = emitter_drawn(sample_emissive(args.scene, draw.u), point.position_ws);
  }
  if (emitter.radiance == vec3(0.0f)) return no_candidate();
  return emitter_candidate(emitter, point.normal_ws, share);
}

/// Slots of a point.
uint slot_count(LightDrawsArguments args) {
  uint samples = args.scene.at[0].emitter_count > 0u ? args.emissive_samples : 0u;
  return args.scene.at[0].light_count + samples;
}

#endif
