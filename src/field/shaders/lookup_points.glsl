// SPDX-License-Identifier: Apache-2.0
// Points that look the field up; the includer has declared push constants with `args.points`.
#ifndef LAMBENT_FIELD_SHADERS_LOOKUP_POINTS_GLSL
#define LAMBENT_FIELD_SHADERS_LOOKUP_POINTS_GLSL

#include "field/device_arguments.h"
#include "field/shaders/tiles.glsl"
#include "shared/octahedral.h"

struct LookupPoint {
  bool exists;
  bool reads;  ///< It reflects what it would look up.
  int place;   ///< Among the points of this dispatch.
  int lookup;  ///< The first of its lookups.
  QueryRecord query;
};

/// The point of an invocation.
LookupPoint lookup_point() {
  int column = int(gl_GlobalInvocationID.x), row = int(gl_GlobalInvocationID.y);
  LookupPoint point;
  point.exists = row < args.points.rows && column < args.points.stride;
  point.reads = false;
  point.place = row * args.points.stride + column;
  point.lookup = point.place * kLookups;
  if (!point.exists) return point;

  if (args.points.count > 0) {
    point.exists = point.reads = point.place < args.points.count;
    if (point.exists) point.query = args.points.queries.at[point.place];
    return point;
  }
  int surfel_at = args.points.list.probes.at[row] * args.points.stride + column;
  RaySetRecord set = args.points.list.sets.at[args.points.list.ray_sets.at[row]];
  SurfelRecord surfel = args.points.surfels.at[surfel_at];
  point.reads =
      column < set.rays && surfel.receives_gi != 0u && surfel.albedo_over_pi != vec3(0.0);
  point.lookup = surfel_at * kLookups;
  point.query = QueryRecord(surfel.position_ws, decode_unit_vector(surfel.normal_ws),
                            -set.directions.at[min(column, set.rays - 1)]);
  return point;
}

#endif
