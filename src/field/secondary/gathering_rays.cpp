// SPDX-License-Identifier: Apache-2.0
#include "field/secondary/gathering_rays.h"

#include "field/lookup/query_at.h"
#include "field/secondary/secondary_math.h"
#include "raytracing/emitter_sampling.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

/// The volumes of a field.
struct FieldVolumes {
  std::span<const ProbeGrid> grids;

  const ProbeGrid& fetch_grid(int volume) const { return grids[static_cast<std::size_t>(volume)]; }
#include "field/lookup/spacing.inl.h"
};

/// Draws the secondary gathers of a depth (see gather_salt()) at the hits of the rays of the depth
/// before. Returns these hits in rising order.
std::vector<std::size_t> draw_secondary_rays(const HitLighting& by, const GatheringRays& before,
                                             int depth, GatheringRays& following) {
  std::vector<std::size_t> parents;
  FieldVolumes volumes{by.grids};
  const int count = static_cast<int>(by.grids.size());
  for (std::size_t i = 0; i < before.rays.size(); ++i) {
    if (!reads_field(before.shaded[i].surface)) continue;
    const LitPoint& point = before.shaded[i].point;
    const SecondaryRay drawn = secondary_ray(
        point.position_ws, point.normal_ws, point.geometric_normal_ws,
        min(point.viewer_distance, before.shaded[i].light_distance),
        volumes.spacing_at(count, point.position_ws), static_cast<uint>(before.indices[i]),
        gather_salt(by.shading.salt, depth), by.shading.seed);
    if (!drawn.traced) continue;
    parents.push_back(i);
    following.add(drawn.origin_ws, drawn.direction_ws, before.indices[i]);
  }
  return parents;
}

/// Looks up the field where hits reflect its light, but for the hits `skipped`, in rising order.
std::uint64_t look_up(const HitLighting& by, std::span<const std::size_t> skipped,
                      GatheringRays& of) {
  std::vector<FieldQuery> queries;
  std::vector<std::size_t> asking;
  std::size_t next = 0;  // of the skipped hits
  for (std::size_t i = 0; i < of.shaded.size(); ++i) {
    const bool skips = next < skipped.size() && skipped[next] == i;
    if (skips) ++next;
    if (skips || !reads_field(of.shaded[i].surface)) continue;
    queries.push_back(query_at(of.shaded[i].point));
    asking.push_back(i);
  }
  std::vector<vec3> answers(queries.size());
  const std::uint64_t traced = by.look_up(queries, answers);
  of.arrives.assign(of.shaded.size(), vec3(0.0f));
  for (std::size_t k = 0; k < asking.size(); ++k) of.arrives[asking[k]] = answers[k];
  return traced;
}

/// Finds the light that the rays of a depth bring. Returns the number of rays traced.
std::uint64_t light_depth(const HitLighting& by, int depth, ShadeHitsScratch& scratch,
                          GatheringRays& of) {
  if (of.rays.empty()) return 0;
  std::vector<Hit> hits(of.rays.size());
  tracer_of(by.world).closest_hits(of.rays, hits);
  of.shaded.resize(of.rays.size());
  ShadeHitsSettings shading = by.shading;
  shading.salt = gather_salt(by.shading.salt, depth);
  std::uint64_t traced =
      of.rays.size() + shade_hits(by.world, of.rays, hits, shading, of.indices, scratch, of.shaded);
  GatheringRays following;
  std::vector<std::size_t> parents;  // hits from which the following rays start
  if (depth < by.max_secondary_rays) {
    parents = draw_secondary_rays(by, of, depth + 1, following);
    traced += light_depth(by, depth + 1, scratch, following);
  }
  traced += look_up(by, parents, of);
  for (std::size_t k = 0; k < parents.size(); ++k) {
    const LitPoint& point = of.shaded[parents[k]].point;
    of.arrives[parents[k]] = secondary_irradiance(
        point.normal_ws, point.geometric_normal_ws, following.rays[k].direction,
        following.shaded[k].surface, following.shaded[k].direct_irradiance, following.arrives[k]);
  }
  return traced;
}

}  // namespace

ShadeHitsSettings gathering_shading(int rays, float max_albedo, std::uint32_t salt,
                                    std::uint32_t seed) {
  ShadeHitsSettings shading;
  shading.cone_width = kHemisphereConeWidth / sqrt(static_cast<float>(rays));
  shading.max_albedo = max_albedo;
  shading.candidates = kSecondaryCandidates;
  shading.follow_mirrors = true;
  shading.salt = salt;
  shading.seed = seed;
  return shading;
}

void GatheringRays::add(const vec3& origin_ws, const vec3& direction_ws, std::size_t index) {
  rays.push_back({origin_ws, 0.0f, direction_ws, kInfiniteDistance, kRayGathers});
  indices.push_back(index);
}

std::uint64_t GatheringRays::light(const HitLighting& by, ShadeHitsScratch& scratch) {
  return light_depth(by, 0, scratch, *this);
}

}  // namespace lambent
