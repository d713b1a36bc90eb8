// SPDX-License-Identifier: Apache-2.0
// Points at which the field is looked up. The includer has declared push constants with
// `args.points` and `args.store`.
#ifndef LAMBENT_FIELD_LOOKUP_SHADERS_LOOKUP_POINTS_GLSL
#define LAMBENT_FIELD_LOOKUP_SHADERS_LOOKUP_POINTS_GLSL

#include "field/vulkan/device_arguments.h"
#include "field/probes/shaders/tiles.glsl"
#include "field/probes/shaders/volume_of.glsl"
#include "field/lookup/shaders/query_of_surfel.glsl"

struct LookupPoint {
  bool exists;
  int row, column;
  int place;   // among the points of this dispatch
  int lookup;  // the first of its lookups
};

/// The point that this invocation works on.
LookupPoint lookup_point() {
  int column = int(gl_GlobalInvocationID.x), row = int(gl_GlobalInvocationID.y);
  int place = row * args.points.stride + column, among_all = place;
  bool exists = row < args.points.rows && column < args.points.stride;
  if (args.points.count > 0) {
    exists = exists && place < args.points.count;
  } else if (exists) {
    among_all = args.points.list.probes.at[row] * args.points.stride + column;
  }
  return LookupPoint(exists, row, column, place, among_all * kLookups);
}

RaySetRecord rays_of(LookupPoint point) {
  return args.points.list.sets.at[args.points.list.ray_sets.at[point.row]];
}

/// The share of the field's irradiance that an existing point receives. 0: the point needs no
/// lookup, because it is a surfel that reflects nothing or a query without a normal.
float gi_share_of(LookupPoint point) {
  if (args.points.count > 0) {
    return args.points.queries.at[point.place].normal_ws == vec3(0.0) ? 0.0 : 1.0;
  }
  SurfelRecord surfel = args.points.surfels.at[point.lookup / kLookups];
  bool reflects = point.column < rays_of(point).rays && surfel.albedo_over_pi != vec3(0.0);
  return reflects ? surfel.gi_share : 0.0;
}

/// The query of an existing point.
QueryRecord query_of(LookupPoint point) {
  if (args.points.count > 0) return args.points.queries.at[point.place];
  SurfelRecord surfel = args.points.surfels.at[point.lookup / kLookups];
  RaySetRecord set = rays_of(point);
  int probe = args.points.list.probes.at[point.row];
  vec3 origin_ws = placed_position_of(args.store.grids, args.store.offsets, probe);
  return query_of_surfel(surfel, origin_ws, set.directions.at[min(point.column, set.rays - 1)]);
}

#endif
