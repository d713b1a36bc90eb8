// SPDX-License-Identifier: Apache-2.0
#include "field/transport/surfels.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <iterator>

#include "core/parallel.h"
#include "field/transport/surfel_math.h"
#include "shared/packing.h"

namespace lambent {
namespace {

constexpr std::size_t kTracedPerTask = 8;

// The most rays of a probe. It gives each ray of each probe an index of its own, for its random
// numbers.
constexpr std::size_t kMaxRays = 4096;

/// Tests whether a lookup reads one of some probes.
class ReadsOne {
 public:
  ReadsOne(std::span<const int> read, const ProbeStore& store)
      : is_read_(store.probes(), 0), corner_table_(store.corner_table()) {
    for (const int probe : read) is_read_[probe] = 1;
  }
  bool operator()(const CornerWeights& corners) const {
    const CornerOffsets& offsets = corner_table_[corners.table];
    return std::any_of(std::begin(offsets.probe), std::end(offsets.probe),
                       [&](int offset) { return is_read_[corners.base + offset] != 0; });
  }

 private:
  std::vector<std::uint8_t> is_read_;
  std::span<const CornerOffsets> corner_table_;
};

}  // namespace

RaySet::RaySet(const FieldSettings& settings, int rays, uint update_number)
    : update(update_number),
      directions(probe_ray_directions(rays, update_number, settings.seed)),
      irradiance_blend(settings.irradiance_texels, 1.0f, directions) {}

std::size_t ProbeTrace::bytes() const {
  return surfels.size() * sizeof(Surfel) + lookups.size() * sizeof(SurfelLookup) +
         further.size() * sizeof(FurtherLookup);
}

float Surfel::distance_from(const vec3& origin_ws) const {
  if (kind == SurfelKind::sky) return kInfiniteDistance;
  return first_hit_distance(mirror_distance, distance(position_ws, origin_ws));
}

FieldQuery Surfel::query_from(const vec3& origin_ws, const vec3& ray_direction) const {
  const vec3 normal = decode_unit_vector(normal_ws);
  return {position_ws, normal, surfel_viewer(mirror_distance, normal, ray_direction),
          distance(position_ws, origin_ws)};
}

Surfel make_surfel(const ShadedHit& hit) {
  const SurfelRecord surfel =
      surfel_record(hit.point.position_ws, hit.point.normal_ws, hit.point.geometric_normal_ws,
                    hit.surface, hit.direct_irradiance);
  return {surfel.position_ws,
          surfel.material,
          surfel.albedo_over_pi,
          surfel.normal_ws,
          surfel.light,
          surfel.geometric_normal_ws,
          static_cast<SurfelKind>(surfel.kind),
          surfel.gi_share,
          surfel.mirror_distance,
          hit.point.albedo_shape};
}

Ray probe_ray(const vec3& origin_ws, const vec3& direction) {
  return {origin_ws, 0.0f, direction, kInfiniteDistance, kRayOfProbe};
}

std::size_t first_ray_index(int probe) {
  return static_cast<std::size_t>(probe) * kMaxRays;
}

void trace_probe_rays(const RayTracer& tracer, const ProbeStore& store, TraceGroup& group) {
  const std::vector<vec3>& directions = group.rays->directions;
  const std::size_t rays = directions.size();
  group.hits.resize(group.probes.size() * rays);
  parallel_chunks(group.probes.size(), kTracedPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> batch(rays);
    for (std::size_t k = begin; k < end; ++k) {
      const vec3 origin = store.probe_position_ws(group.probes[k]);
      for (std::size_t i = 0; i < rays; ++i) batch[i] = probe_ray(origin, directions[i]);
      tracer.closest_hits(batch, {&group.hits[k * rays], rays});
    }
  });
}

ShadeHitsSettings surfel_shading(const FieldSettings& settings, const RaySet& rays,
                                 const SolidSides* solid_sides) {
  ShadeHitsSettings shading;
  // Compute the width of a ray's cone per metre, from its share of the solid angle of the sphere
  shading.cone_width =
      2.0f * sqrt(4.0f / static_cast<float>(rays.rays())) * exp2(settings.texture_lod_bias);
  shading.max_albedo = settings.max_albedo;
  shading.emissive_samples = settings.emissive_samples;
  shading.candidates = kSecondaryCandidates;
  shading.solid_sides = solid_sides;
  shading.follow_mirrors = true;
  shading.salt = rays.update;
  shading.seed = settings.seed;
  return shading;
}

std::uint64_t shade_surfels(const World& world, const SolidSides& solid_sides,
                            const ProbeStore& store, const TraceGroup& group,
                            const FieldSettings& settings, std::span<ProbeTrace> traces) {
  const std::vector<vec3>& directions = group.rays->directions;
  const std::size_t rays = directions.size();
  const ShadeHitsSettings shading = surfel_shading(settings, *group.rays, &solid_sides);
  std::atomic<std::uint64_t> shadow_rays = 0;

  parallel_chunks(group.probes.size(), kTracedPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> batch(rays);
    std::vector<ShadedHit> shaded(rays);
    ShadeHitsScratch scratch;
    for (std::size_t k = begin; k < end; ++k) {
      const int probe = group.probes[k];
      const vec3 origin = store.probe_position_ws(probe);
      for (std::size_t i = 0; i < rays; ++i) batch[i] = probe_ray(origin, directions[i]);
      const std::span<const Hit> hits(&group.hits[k * rays], rays);
      shadow_rays +=
          shade_hits(world, batch, hits, shading, first_ray_index(probe), scratch, shaded);
      ProbeTrace& trace = traces[probe];
      trace.rays = group.rays;
      trace.surfels.resize(rays);
      for (std::size_t i = 0; i < rays; ++i) trace.surfels[i] = make_surfel(shaded[i]);
    }
  });
  return shadow_rays;
}

std::uint64_t find_surfel_lookups(const ProbeStore& store, const VisibilityRays& by,
                                  std::span<const int> probes, std::span<ProbeTrace> traces) {
  return find_surfel_lookups(store, by, probes, {}, traces);
}

std::uint64_t find_surfel_lookups(const ProbeStore& store, const VisibilityRays& by,
                                  std::span<const int> probes, std::span<const SurfelFlags> flagged,
                                  std::span<ProbeTrace> traces) {
  assert(flagged.empty() || (flagged.size() == probes.size() && store.volumes() == 1));
  const int texels = store.irradiance_texels();
  std::atomic<std::uint64_t> rays = 0;
  parallel_chunks(probes.size(), kTracedPerTask, [&](std::size_t begin, std::size_t end) {
    struct Place {
      int probe;
      int ray;
    };
    std::vector<FieldQuery> queries;
    std::vector<Place> reflecting;
    int most_rays = 0;
    for (std::size_t k = begin; k < end; ++k) {
      ProbeTrace& trace = traces[probes[k]];
      trace.lookups.resize(trace.surfels.size());
      trace.further.clear();
      most_rays = max(most_rays, static_cast<int>(trace.surfels.size()));
    }
    // Rays of neighbouring probes along one direction tend to end in the same cell. Looked up one
    // after the other, they find its probes in the cache
    for (int ray = 0; ray < most_rays; ++ray) {
      for (std::size_t k = begin; k < end; ++k) {
        ProbeTrace& trace = traces[probes[k]];
        if (ray >= static_cast<int>(trace.surfels.size())) continue;
        if (!flagged.empty() && flagged[k][ray] == 0) continue;
        const Surfel& surfel = trace.surfels[ray];
        // A surfel that reflects nothing needs no lookup
        if (!surfel.reflects()) continue;
        trace.lookups[ray] = {};
        if (surfel.gi_share <= 0.0f) continue;
        reflecting.push_back({probes[k], ray});
        queries.push_back(
            surfel.query_from(store.probe_position_ws(probes[k]), trace.rays->directions[ray]));
      }
    }
    QueryWeights weights;
    rays += find_weights(store, by, queries, weights);
    std::vector<std::uint8_t> answered(queries.size(), 0);
    for (std::size_t i = 0; i < weights.corners.size(); ++i) {
      const std::uint32_t query = weights.query[i];
      const TileFetch fetch = tile_fetch(queries[query].normal_ws, texels);
      SurfelLookup lookup = {
          weights.corners[i],
          static_cast<std::uint32_t>(fetch.corner.x + (texels + 1) * fetch.corner.y),
          fetch.fraction.x, fetch.fraction.y};
      ProbeTrace& trace = traces[reflecting[query].probe];
      const int ray = reflecting[query].ray;
      for (float& weight : lookup.corners.weight) weight *= trace.surfels[ray].gi_share;
      if (answered[query] == 0) {
        trace.lookups[ray] = lookup;
      } else {
        trace.further.push_back({static_cast<std::uint32_t>(ray), lookup});
      }
      answered[query] = 1;
    }
  });
  return rays;
}

void flag_readers(std::span<const int> read, std::span<const int> probes, const ProbeStore& store,
                  std::span<const ProbeTrace> traces, std::span<SurfelFlags> flagged) {
  const ReadsOne reads_one(read, store);
  parallel_chunks(probes.size(), kTracedPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const ProbeTrace& trace = traces[probes[k]];
      flagged[k].resize(trace.surfels.size(), 0);
      for (std::size_t i = 0; i < trace.surfels.size(); ++i) {
        if (flagged[k][i] != 0 || !trace.surfels[i].reflects()) continue;
        flagged[k][i] = reads_one(trace.lookups[i].corners) ? 1 : 0;
      }
    }
  });
}

std::vector<int> probes_reading(std::span<const int> read, std::span<const int> among,
                                const ProbeStore& store, std::span<const ProbeTrace> traces) {
  std::vector<std::uint8_t> reads(among.size(), 0);
  const ReadsOne reads_one(read, store);
  parallel_chunks(among.size(), kTracedPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const ProbeTrace& trace = traces[among[k]];
      bool one = std::any_of(trace.further.begin(), trace.further.end(),
                             [&](const FurtherLookup& f) { return reads_one(f.lookup.corners); });
      for (std::size_t i = 0; i < trace.lookups.size() && !one; ++i) {
        one = trace.surfels[i].reflects() && reads_one(trace.lookups[i].corners);
      }
      reads[k] = one ? 1 : 0;
    }
  });
  std::vector<int> readers;
  for (std::size_t k = 0; k < among.size(); ++k) {
    if (reads[k] != 0) readers.push_back(among[k]);
  }
  return readers;
}

}  // namespace lambent
