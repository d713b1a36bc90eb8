// SPDX-License-Identifier: Apache-2.0
// Every formula between a hit and its light, for random numbers: one body that both languages run.
#ifndef LAMBENT_TESTS_TWIN_SHADING_MATH_H
#define LAMBENT_TESTS_TWIN_SHADING_MATH_H

#include "raytracing/emitter_sampling.h"
#include "raytracing/ray_records.h"
#include "raytracing/surface_math.h"
#include "scene/coverage.h"
#include "scene/latitude_longitude.h"
#include "scene/light_tree/unoccluded_math.h"
#include "scene/mip_level.h"
#include "scene/punctual_light.h"
#include "scene/texture_lookup.h"

LAMBENT_BEGIN

/// What comes out as numbers that differ by rounding.
struct ShadingNumbers {
  vec3 position, area_normal;
  float cone_share;
  vec4 tangent;
  vec3 orthogonal, mapped, shading_normal, reflecting_normal;
  Reflectance coated, plain;
  PunctualSample punctual[3];
  vec2 uv;
  float wrapped[3];
  vec2 map_fraction;
  TrianglePointSeen near, far;
  vec3 shadow_direction;
  LightCandidate candidate;
  float shadow_length, stopping;
  float importance[2];
  float unoccluded[2];
  float opened[2];
  float form_factor;
};

/// What comes of inverse sines and tangents, which devices approximate.
struct AngleNumbers {
  vec2 map_point;
  vec3 map_direction;
  float solid_angle;
};

/// What decides, and must be the same.
struct ShadingDecisions {
  int wrapped_index[3];
  int nearest[3];
  int first[3];
  int second[3];
  int level;
  uint mean_alone;
  uint stops_mask;
  uint stops_blend;
  uint uniform_bits;
  uint sample_bits;
};

struct ShadingMath {
  ShadingNumbers numbers;
  AngleNumbers angles;
  ShadingDecisions decisions;
};
LAMBENT_DEVICE_ARRAY(ShadingMathArray, ShadingMath, 4)

struct ShadingMathArguments {
  ShadingMathArray results;
  uint count;
  uint padding;
};

LAMBENT_FN vec3 random_vec3(LAMBENT_INOUT(RandomStream) random, float low, float high) {
  float x = next_uniform(random);
  float y = next_uniform(random);
  float z = next_uniform(random);
  return vec3(low) + vec3(x, y, z) * (high - low);
}

LAMBENT_FN vec3 random_direction(LAMBENT_INOUT(RandomStream) random) {
  return normalize(random_vec3(random, -1.0f, 1.0f) + vec3(0.0f, 0.0f, 0.01f));
}

LAMBENT_FN void evaluate_surfaces(LAMBENT_INOUT(RandomStream) random,
                                  LAMBENT_INOUT(ShadingNumbers) n) {
  // Drawn one by one: languages differ in the order of arguments
  vec3 x = random_vec3(random, -1.0f, 1.0f);
  vec3 y = random_vec3(random, -1.0f, 1.0f);
  vec3 z = random_vec3(random, -1.0f, 1.0f);
  vec3 origin = random_vec3(random, -10.0f, 10.0f);
  mat4 place = mat4(vec4(x, 0.0f), vec4(y, 0.0f), vec4(z, 0.0f), vec4(origin, 1.0f));
  vec3 edge1 = random_vec3(random, -1.0f, 1.0f);
  vec3 edge2 = random_vec3(random, -1.0f, 1.0f);
  n.position = transform_point(place, edge1);
  n.area_normal = cofactors(place) * cross(edge1, edge2);
  n.cone_share = share_of_triangle(next_uniform(random), length(edge1));
  vec2 uv1 = next_uniform2(random);
  vec2 uv2 = next_uniform2(random);
  n.tangent = tangent_from_uvs(edge1, edge2, uv1, uv2);
  vec3 normal = random_direction(random);
  vec3 along = random_direction(random);
  n.orthogonal = orthogonal_tangent(normal, along);
  float handedness = next_uniform(random) - 0.5f;
  vec3 texel = random_vec3(random, 0.0f, 1.0f);
  float normal_scale = 2.0f * next_uniform(random);
  vec3 bump = map_vector(texel, normal_scale);
  n.mapped = mapped_normal(normal, n.orthogonal, handedness, bump) *
             horizon_share(scaled_mean_length(length(bump), normal_scale), dot(normal, along));
  vec3 geometric = random_direction(random);
  bool along_winding = next_uniform(random) < 0.5f;
  bool from_front = next_uniform(random) < 0.5f;
  n.shading_normal = normal_towards_viewer(normal, along_winding, from_front, along, geometric);
  n.reflecting_normal = reflecting_normal(n.shading_normal, along, geometric);
  vec3 base = random_vec3(random, 0.0f, 1.0f);
  vec3 tint = random_vec3(random, 0.0f, 1.5f);
  vec2 amounts = next_uniform2(random);
  vec2 strengths = next_uniform2(random);
  n.coated =
      coated_reflectance(base, amounts.x, amounts.y, strengths.x, tint, 1.0f + 2.0f * strengths.y);
  n.plain = lambert_reflectance(base);
}

LAMBENT_FN void evaluate_lights(LAMBENT_INOUT(RandomStream) random, LAMBENT_INOUT(ShadingNumbers) n,
                                LAMBENT_INOUT(AngleNumbers) angles) {
  vec3 point = random_vec3(random, -3.0f, 3.0f);
  for (uint type = kLightDirectional; type <= kLightSpot; ++type) {
    LightRecord light = {random_vec3(random, 0.0f, 5.0f),
                         type,
                         random_vec3(random, -3.0f, 3.0f),
                         8.0f * next_uniform(random) - 2.0f,
                         random_direction(random),
                         0.2f,
                         cone_scale(0.9f, 0.2f)};
    n.punctual[type] = sample_punctual(light, point);
    // Infinity is no number to compare
    if (type == kLightDirectional) n.punctual[type].distance = 0.0f;
  }
  vec3 normal = random_direction(random);
  // Triangles about as large as their distance, and small ones
  vec3 corner = random_vec3(random, 1.0f, 3.0f);
  vec3 edge1 = random_vec3(random, -1.0f, 1.0f);
  vec3 edge2 = random_vec3(random, -1.0f, 1.0f) + vec3(0.0f, 0.0f, 2.0f);
  vec2 u = next_uniform2(random);
  n.near = draw_on_triangle(corner, edge1, edge2, u);
  n.far = draw_on_triangle(50.0f * corner, edge1 * 0.1f, edge2 * 0.1f, u);
  angles.solid_angle = 1.0f / n.near.pdf;
  n.near.pdf = 0.0f;
  n.far.pdf = 1.0f / max(n.far.pdf, 1.0f);
  vec3 direction = sample_cosine_about(normal, u);
  Resampling resampling = begin_resampling(next_uniform(random));
  for (int i = 0; i < 4; ++i) {
    LightCandidate offered = {random_direction(random), 1.0f + float(i),
                              random_vec3(random, 0.0f, 5.0f), 0u};
    offer(resampling, offered, offered.perpendicular_irradiance.x);
  }
  n.candidate = resampled(resampling, 0.25f);
  RayRecord shadow = shadow_ray_record(point, direction, n.candidate);
  n.shadow_direction = shadow.direction_ws;
  n.shadow_length = shadow.t_max;
  for (uint both_sides = 0u; both_sides < 2u; ++both_sides) {
    float spread = next_uniform(random);
    vec3 center = random_vec3(random, -3.0f, 3.0f);
    LightTreeNode node = {center,
                          random_vec3(random, 0.0f, 1.0f),
                          random_direction(random),
                          sqrt(1.0f - spread * spread),
                          spread,
                          1.0f,
                          0.3f,
                          0.0f,
                          both_sides,
                          vec3(1.0f),
                          0u};
    PickLobe lobe = {random_direction(random), 0.01f, 0.5f, 0.05f};
    n.importance[both_sides] = min(light_importance(node, point, normal, lobe), 10.0f);
    n.unoccluded[both_sides] = min(light_of_cluster(node, point, normal), 10.0f);
    n.opened[both_sides] = opened_share(node, point);
  }
  vec3 far_corner = random_vec3(random, -2.0f, 2.0f);
  vec3 first_edge = random_vec3(random, 1.0f, 2.0f);
  vec3 second_edge = random_vec3(random, -2.0f, -1.0f);
  n.form_factor = triangle_form_factor(far_corner, first_edge, second_edge, normal);
  vec3 towards = random_direction(random);
  angles.map_point = latitude_longitude_from_direction(towards, 0.7f);
  angles.map_direction = direction_from_latitude_longitude(angles.map_point, 0.7f);
  n.map_fraction = map_texels(next_uniform2(random), 16, 8).fraction;
}

LAMBENT_FN void evaluate_textures(LAMBENT_INOUT(RandomStream) random,
                                  LAMBENT_INOUT(ShadingMath) result) {
  // Whole multiples of 2^-10, so that both sides compute the same without rounding
  float u = floor(next_uniform(random) * 16384.0f) / 1024.0f - 8.0f;
  vec2 turn = next_uniform(random) < 0.5f ? vec2(1.0f, 0.0f) : vec2(0.6f, 0.8f);
  result.numbers.uv = transform_uv(vec2(u, -0.5f * u), vec2(2.0f, 3.0f), turn, vec2(0.25f, 0.5f));
  for (uint wrap = kWrapRepeat; wrap <= kWrapClampToEdge; ++wrap) {
    float wrapped = wrap_coordinate(u, wrap);
    TexelPair pair = texels_around(wrapped, 24, wrap);
    result.numbers.wrapped[wrap] = wrapped;
    result.decisions.wrapped_index[wrap] = wrap_index(int(wrapped * 24.0f) - 1, 24, wrap);
    result.decisions.nearest[wrap] = nearest_index(wrapped, 24, wrap);
    result.decisions.first[wrap] = pair.first;
    result.decisions.second[wrap] = pair.second;
  }
  float share = exp2(floor(next_uniform(random) * 20.0f) - 10.0f);
  result.decisions.level =
      mip_level(vec2(1.0f, 0.0f), vec2(0.0f, 1.5f), vec2(1.0f, 2.0f), 64, 128, share);
  result.decisions.mean_alone = shows_mean_alone(result.decisions.level, 7) ? 1u : 0u;

  vec2 barycentrics = next_uniform2(random);
  float distance = next_uniform(random);
  float alpha = next_uniform(random);
  result.numbers.stopping = stopping_probability(kAlphaBlend, 0.5f, alpha) +
                            stopping_probability(kAlphaMask, 0.5f, alpha);
  result.decisions.stops_mask = stops_ray(kAlphaMask, 0.5f, alpha, distance) ? 1u : 0u;
  result.decisions.stops_blend = stops_ray(kAlphaBlend, 0.5f, alpha, distance) ? 1u : 0u;
  result.decisions.uniform_bits = floatBitsToUint(uniform_of_hit(barycentrics, distance, 7u));
  result.decisions.sample_bits =
      floatBitsToUint(uniform_of_sample(sample_mask(floatBitsToUint(alpha), 5u, 8u, 3u)));
}

LAMBENT_FN ShadingMath evaluate_shading_math(uint i) {
  ShadingMath result;
  RandomStream random = make_random_stream(i, 3u, 5u);
  evaluate_surfaces(random, result.numbers);
  evaluate_lights(random, result.numbers, result.angles);
  evaluate_textures(random, result);
  return result;
}

LAMBENT_END
#endif
