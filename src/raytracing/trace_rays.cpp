// SPDX-License-Identifier: Apache-2.0
#include "raytracing/trace_rays.h"

#include "core/parallel.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

// Rays that one task traces: enough to hide the task's overhead.
constexpr std::size_t kRaysPerTask = 128;
// Rays go on this share of their distance beyond a hit, so that they do not meet it again.
constexpr float kBeyondHit = 1e-4f;

}  // namespace

std::vector<Hit> trace(const World& world, std::span<const Ray> rays) {
  std::vector<Hit> hits(rays.size());
  const std::size_t chunk = batch_of(tracer_of(world), 1, kRaysPerTask);
  parallel_chunks(rays.size(), chunk, [&](std::size_t begin, std::size_t end) {
    tracer_of(world).closest_hits(rays.subspan(begin, end - begin),
                                  std::span(hits).subspan(begin, end - begin));
  });
  return hits;
}

std::vector<Hit> trace_behind(const World& world, std::vector<Ray> rays, std::span<const Hit> first,
                              float reach) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (first[i].missed()) continue;
    rays[i].t_min = first[i].distance * (1.0f + kBeyondHit);
    rays[i].t_max = first[i].distance + reach;
  }
  return trace(world, rays);
}

std::vector<std::uint8_t> trace_occlusion(const World& world, std::span<const Ray> rays) {
  std::vector<std::uint8_t> occluded(rays.size());
  const std::size_t chunk = batch_of(tracer_of(world), 1, kRaysPerTask);
  parallel_chunks(rays.size(), chunk, [&](std::size_t begin, std::size_t end) {
    tracer_of(world).occlusions(rays.subspan(begin, end - begin),
                                std::span(occluded).subspan(begin, end - begin));
  });
  return occluded;
}

}  // namespace lambent
