// SPDX-License-Identifier: Apache-2.0
#include "bench/rsm_workload.h"

#include <cstdio>
#include <cstdlib>

#include "bench/workload.h"
#include "core/parallel.h"
#include "raytracing/camera_rays.h"
#include "raytracing/surface.h"
#include "raytracing/world_access.h"

namespace lambent::bench {
namespace {

glm::ivec2 picture_size() {
  glm::ivec2 size(1920, 1080);
  if (const char* asked = std::getenv("LAMBENT_BENCH_RSM_SIZE")) {
    std::sscanf(asked, "%dx%d", &size.x, &size.y);
  }
  return size;
}

}  // namespace

RsmWorkload::RsmWorkload(const glm::ivec2& picture) : size(picture) {
  const Workload& work = workload();
  const std::size_t pixels = static_cast<std::size_t>(size.x) * size.y;
  positions.resize(pixels);
  normals.assign(pixels, glm::vec3(0.0f));
  depths.resize(pixels);
  parallel_chunks(size.y, 1, [&](std::size_t y, std::size_t) {
    for (int x = 0; x < size.x; ++x) {
      const Ray ray = camera_ray(work.camera, size.x, size.y, static_cast<float>(x) + 0.5f,
                                 static_cast<float>(y) + 0.5f);
      const Hit hit = tracer_of(work.world).closest_hit(ray);
      if (hit.missed()) continue;
      const Surface surface = surface_at(work.scene, ray, hit);
      const std::size_t i = y * size.x + x;
      positions[i] = surface.position_ws;
      normals[i] = surface.normal_ws;
      depths[i] = view_depth(work.camera, surface.position_ws);
    }
  });
  maps = render_rsms(work.world, work.camera,
                     static_cast<float>(size.x) / static_cast<float>(size.y), {})
             .value();
}

RsmWorkload& rsm_workload() {
  static RsmWorkload work(picture_size());
  return work;
}

}  // namespace lambent::bench
