// SPDX-License-Identifier: Apache-2.0
// Calls every function that the interleaved gather shares between languages, on random inputs.
#ifndef LAMBENT_TESTS_TWIN_RSM_FUNCTIONS_H
#define LAMBENT_TESTS_TWIN_RSM_FUNCTIONS_H

#include "rsm/deinterleave.h"
#include "rsm/gather_texel.h"
#include "rsm/maps/map_texel.h"
#include "rsm/upsample.h"
#include "rsm/visibility_rays.h"
#include "rsm/vulkan/device_passes.h"
#include "shared/cross_bilateral.h"
#include "shared/packing.h"
#include "shared/random.h"
#include "shared/reorient_irradiance.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

const int kRsmFloats = 80;
const int kRsmInts = 24;

/// What they returned; those of integers are exact on every device.
struct RsmFunctionResults {
  float floats[kRsmFloats];
  int ints[kRsmInts];
};

/// Fills in results, one after the other.
struct RsmResultCursor {
  RsmFunctionResults results;
  int float_count;
  int int_count;
};

LAMBENT_FN void tell(LAMBENT_INOUT(RsmResultCursor) to, float value) {
  to.results.floats[to.float_count] = value;
  to.float_count += 1;
}

LAMBENT_FN void tell(LAMBENT_INOUT(RsmResultCursor) to, vec2 value) {
  tell(to, value.x);
  tell(to, value.y);
}

LAMBENT_FN void tell(LAMBENT_INOUT(RsmResultCursor) to, vec3 value) {
  tell(to, value.x);
  tell(to, value.y);
  tell(to, value.z);
}

LAMBENT_FN void tell(LAMBENT_INOUT(RsmResultCursor) to, int value) {
  to.results.ints[to.int_count] = value;
  to.int_count += 1;
}

LAMBENT_FN void tell(LAMBENT_INOUT(RsmResultCursor) to, ivec2 value) {
  tell(to, value.x);
  tell(to, value.y);
}

/// What functions are asked for.
struct RsmInputs {
  vec3 position_ws;
  vec3 normal_ws;
  vec3 other_normal_ws;
  RsmTexelRecord texel;
  MapProjection projection;
  vec2 square;
  float number;
  int resolution;
  int n;
};

LAMBENT_FN vec3 random_unit_vector(LAMBENT_INOUT(RandomStream) random) {
  return sample_uniform_sphere(next_uniform2(random));
}

LAMBENT_FN vec3 random_vector(LAMBENT_INOUT(RandomStream) random) {
  float x = next_uniform(random);
  float y = next_uniform(random);
  float z = next_uniform(random);
  return vec3(x, y, z);
}

/// A point and a texel that see each other, mostly, and all else.
LAMBENT_FN RsmInputs random_inputs(uint index) {
  RandomStream random = make_random_stream(index, 0x52534Du, 1u);
  RsmInputs a;
  a.position_ws = random_vector(random);
  a.normal_ws = random_unit_vector(random);
  a.other_normal_ws = normalize(a.normal_ws + 0.5f * random_unit_vector(random));
  vec3 way = random_unit_vector(random);
  way = dot(way, a.normal_ws) > 0.0f ? way : -way;
  a.texel.position_ws = a.position_ws + way * (0.1f + next_uniform(random));
  a.texel.normal_ws = normalize(random_unit_vector(random) - way);
  a.texel.area = 0.1f + next_uniform(random);
  a.texel.softening = 0.01f + 0.1f * next_uniform(random);
  a.texel.flux = random_vector(random);
  a.texel.unused = 0.0f;
  Frame axes = make_frame(random_unit_vector(random));
  a.projection.kind = index % 3u;
  a.projection.origin_ws = random_vector(random);
  a.projection.world_from_light = mat3(axes.tangent, axes.bitangent, axes.normal);
  a.projection.half_extent = vec2(0.3f) + next_uniform2(random);
  a.square = 2.0f * next_uniform2(random) - vec2(1.0f);
  a.number = next_uniform(random);
  a.resolution = 1 + int(next_uniform(random) * 600.0f);
  a.n = 1 + int(next_uniform(random) * 16.0f);
  return a;
}

LAMBENT_FN void tell_texel(LAMBENT_INOUT(RsmResultCursor) to, RsmTexelRecord texel) {
  tell(to, texel.position_ws);
  tell(to, texel.area);
  tell(to, texel.softening);
  tell(to, texel.flux);
}

LAMBENT_FN void call_gather(LAMBENT_INOUT(RsmResultCursor) to, RsmInputs a) {
  tell(to, geometry_term(a.position_ws, a.normal_ws, a.texel.position_ws, a.texel.normal_ws));
  tell(to, softening_compensation(2.0f * a.number - 1.0f));
  tell(to, bounded_geometry_term(a.position_ws, a.normal_ws, a.texel.position_ws, a.texel.normal_ws,
                                 a.texel.softening));
  TexelLight sum = {vec3(0.0f), vec3(0.0f)};
  TexelSight sight = see_texel_record(a.position_ws, a.normal_ws, a.texel);
  gather_texel(sum, sight, a.texel);
  gather_direction(sum, sight, a.texel);
  tell(to, sum.light);
  tell(to, sum.directions);
  float light = 0.1f + luminance(a.texel.flux);
  vec3 means = reorientation(vec3(sight.x, sight.y, sight.z), a.normal_ws, light);
  tell(to, means);
  tell(to, reoriented_fraction(means, a.other_normal_ws, light));
  vec3 offset = 0.1f * (a.texel.flux - vec3(0.5f));
  tell(to, relit_bilateral_weight(offset, a.normal_ws, a.other_normal_ws, 5.0f * a.number));
  tell(to, cross_bilateral_weight(offset, a.normal_ws, a.other_normal_ws, 5.0f * a.number));
  uint word = pack_upper_halves(a.square.x, a.number);
  tell(to, unpack_upper_half(word));
  tell(to, unpack_lower_half(word));
}

LAMBENT_FN void call_map(LAMBENT_INOUT(RsmResultCursor) to, RsmInputs a) {
  MapRay ray = map_ray(a.projection, a.square);
  tell(to, ray.origin_ws);
  tell(to, ray.direction_ws);
  tell(to, perpendicular_area(a.projection, a.square, a.resolution, 1.0f + a.number));
  tell(to, project_to_map(a.projection, a.position_ws, a.resolution) / float(a.resolution));
  tell(to, texel_middle(a.n, a.n / 2, a.resolution + 16));
  Reflectance reflectance = {a.texel.flux, 0.3f, vec3(0.04f), 1.0f, no_layers(), 1.0f};
  tell_texel(to, lit_texel(a.position_ws, a.other_normal_ws, a.normal_ws, reflectance,
                           normalize(a.texel.position_ws - a.position_ws) * -1.0f, vec3(a.number),
                           a.texel.area));
}

LAMBENT_FN void call_choice(LAMBENT_INOUT(RsmResultCursor) to, RsmInputs a) {
  DiskSample disk = disk_sample(uint(a.n), uint(a.n + 40), 1.0f);
  tell(to, disk.offset);
  tell(to, disk.weight);
  tell_texel(to, weigh_disk_texel(a.texel, 100.0f * a.number, 3, 2.0f));
  tell(to, texel_target(a.position_ws, a.normal_ws, a.texel));
  tell(to, drawn_worth(a.number, 3, a.square.x, 8));
  RayRecord ray = ray_to_point(a.position_ws, a.normal_ws, a.texel.position_ws, 1u);
  tell(to, ray.origin_ws);
  tell(to, ray.direction_ws);
  tell(to, ray.t_max);
  vec2 place = place_in_small_picture(vec2(float(a.resolution), float(a.n)), 1.0f / 3.0f);
  tell(to, place / 600.0f);
  tell(to, nearness(place, ivec2(int(place.x), int(place.y))));
}

LAMBENT_FN void call_layout(LAMBENT_INOUT(RsmResultCursor) to, RsmInputs a) {
  ivec2 size = ivec2(a.resolution, a.resolution / 2 + 1);
  ivec2 pixel = ivec2(int(a.number * float(size.x)), int(a.number * float(size.y)));
  ivec2 sub = sub_image_of(pixel, a.n);
  ivec2 place = place_in_sub_image(pixel, a.n);
  tell(to, sub);
  tell(to, place);
  tell(to, pixel_of_sub_image(sub, place, a.n));
  tell(to, sub_image_size(a.resolution, sub.x, a.n));
  tell(to, sub_image_start(a.resolution, sub.x, a.n));
  tell(to, sub_map_of(sub, 3));
  tell(to, sub_map_start(a.resolution, a.n, sub.x, sub.y));
  tell(to, sub_map_texel(pixel, a.resolution, a.n));
  tell(to, mosaic_stride(size.x, a.n));
  tell(to, mosaic_index(pixel, size, a.n));
  tell(to, mosaic_places(size, a.n));
  tell(to, nearest_in_sub_map(vec2(pixel) + vec2(0.3f), sub, a.n));
}

LAMBENT_FN RsmFunctionResults call_rsm_functions(uint index) {
  RsmInputs a = random_inputs(index);
  RsmResultCursor to;
  for (int i = 0; i < kRsmFloats; ++i) to.results.floats[i] = 0.0f;
  for (int i = 0; i < kRsmInts; ++i) to.results.ints[i] = 0;
  to.float_count = 0;
  to.int_count = 0;
  call_gather(to, a);
  call_map(to, a);
  call_choice(to, a);
  call_layout(to, a);
  return to.results;
}

LAMBENT_DEVICE_ARRAY(RsmFunctionResultsArray, RsmFunctionResults, 4)

struct RsmFunctionsArguments {
  RsmFunctionResultsArray results;
  uint count;
  uint unused;
};

LAMBENT_END
#endif
