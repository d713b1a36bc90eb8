// SPDX-License-Identifier: Apache-2.0
// Clustering of texels, and their weights, for the choice of those that are gathered.
#ifndef LAMBENT_RSM_MAPS_CHOICE_H
#define LAMBENT_RSM_MAPS_CHOICE_H

#include "raytracing/ray_records.h"
#include "rsm/records.h"
#include "rsm/texel_light.h"
#include "shared/random.h"
#include "shared/sampling.h"

LAMBENT_BEGIN

// Texels along an edge of a block.
const int kBlockEdge = 4;
// Most surfaces that a block distinguishes; further ones are rare and small.
const int kBlockSurfaces = 3;
// Texels belong to one surface where their normals are within 37 degrees, and where they are off
// its plane by less than this share of the block's edge.
const float kSameNormal = 0.8f;
const float kSamePlane = 0.25f;

// Number of points of the view at which clusters' light is measured, and most draws of pixels until
// that many show a surface.
const int kViewPoints = 1024;
const uint kViewPointDraws = 8192u;
// Makes these random numbers independent of others.
const uint kViewSalt = 0x56494557u;

LAMBENT_FN float power_of(vec3 flux) {
  return max(flux.x, max(flux.y, flux.z));
}

/// Whether two texels belong to one surface, on the scale of `edge` [m].
LAMBENT_FN bool same_surface(RsmTexelRecord a, RsmTexelRecord b, float edge) {
  return dot(a.normal_ws, b.normal_ws) > kSameNormal &&
         abs(dot(a.position_ws - b.position_ws, b.normal_ws)) <= kSamePlane * edge;
}

/// Sum of texels, or of clusters, around one (the seed) that defines the surface they represent.
/// The light of other surfaces is added, but not their positions: the mean would be in mid-air.
struct ClusterSum {
  vec3 position;  ///< Sum weighted by power, like the normal.
  vec3 normal;
  vec3 flux;
  float power;
  float area;
};

LAMBENT_FN ClusterSum empty_cluster() {
  ClusterSum sum = {vec3(0.0f), vec3(0.0f), vec3(0.0f), 0.0f, 0.0f};
  return sum;
}

LAMBENT_FN void add_to_cluster(LAMBENT_INOUT(ClusterSum) sum, RsmTexelRecord texel,
                               RsmTexelRecord seed, float edge) {
  sum.flux += texel.flux;
  sum.area += texel.area;
  if (!same_surface(texel, seed, edge)) return;
  float power = power_of(texel.flux);
  sum.power += power;
  sum.position += power * texel.position_ws;
  sum.normal += power * texel.normal_ws;
}

LAMBENT_FN RsmTexelRecord cluster_texel(ClusterSum sum, RsmTexelRecord seed) {
  RsmTexelRecord texel = seed;
  if (sum.power > 0.0f) {
    texel.position_ws = sum.position / sum.power;
    texel.normal_ws = normalize(sum.normal);
  }
  texel.flux = sum.flux;
  texel.area = sum.area;
  texel.softening = kSofteningPerArea * sum.area;
  return texel;
}

/// The pixel of a draw; `shift` is random, the same for all draws.
LAMBENT_FN ivec2 view_point_pixel(uint draw, vec2 shift, ivec2 size) {
  vec2 place = fract(shift + plastic_sequence(draw)) * vec2(size);
  return min(ivec2(place), ivec2(size.x - 1, size.y - 1));
}

/// Sums over points of a texel's bounded_geometry_term() and of its square.
struct TermSums {
  float terms;
  float squares;
};

/// A cluster of a block.
struct ClusterRecord {
  RsmTexelRecord texel;
  uint place;  ///< Index in the map of the brightest of its texels.
  uint found;  ///< 0: unused, as the block has fewer surfaces.
  TermSums brought;
};
LAMBENT_DEVICE_ARRAY(ClusterArray, ClusterRecord, 4)

LAMBENT_END
#endif
