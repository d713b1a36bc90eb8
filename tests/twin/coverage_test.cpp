// SPDX-License-Identifier: Apache-2.0
// See-through triangles stop the same rays on the host and on a device.
#include "twin/coverage.h"

#include "lambent/world.h"
#include "raytracing/vulkan/device_scene.h"
#include "scene/attributes.h"
#include "scene/light_tree/light_tree.h"
#include "shaders/coverage_comp.h"
#include "shared/sampling.h"
#include "support/vulkan_device.h"
#include "twin/host_tracer.h"
#include "twin/material_scene.h"

namespace lambent::coverage_test {
namespace {

using CoverageTwin = test::OnDevice;

constexpr std::uint32_t kHits = 4000;

/// Hits on all triangles of the scene that are see-through, by turns.
std::vector<Hit> random_hits(const Scene& scene) {
  std::vector<Hit> candidates;
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    if (scene.materials[mesh.material].alpha_mode == AlphaMode::opaque) continue;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) candidates.push_back({1.0f, i, t});
  }
  RandomStream random = make_random_stream(0u, 0u, 3u);
  std::vector<Hit> hits(kHits);
  for (std::uint32_t i = 0; i < kHits; ++i) {
    hits[i] = candidates[i % candidates.size()];
    hits[i].barycentrics = sample_uniform_triangle(next_uniform2(random));
    hits[i].distance = 10.0f * next_uniform(random);
  }
  return hits;
}

TEST_F(CoverageTwin, StopsTheRaysThatTheHostStops) {
  const Scene scene = test::material_scene();
  const EmissiveTriangles emissive(scene);
  const LightTree lights(scene, emissive);
  const DeviceScene on_device(device(), scene, emissive, lights);
  const std::vector<Hit> hits = random_hits(scene);
  std::vector<HitRecord> records;
  for (const Hit& hit : hits) records.push_back(test::record_of(hit));
  const vulkan::Buffer hit_buffer = vulkan::upload(device(), records, "hits");
  const vulkan::Buffer stops(device(), kHits * sizeof(std::uint32_t), vulkan::Memory::device,
                             "stops");
  const vulkan::Kernel kernel(device(), shaders::coverage_comp(), "coverage");
  const CoverageArguments arguments = {
      on_device.address(), {hit_buffer.address()}, {stops.address()}, kHits, 0};
  device().run([&](vulkan::Recorder& to) {
    to.bind_textures(on_device.textures());
    to.run(kernel, arguments, kHits);
  });

  const std::vector<std::uint32_t> found = vulkan::download<std::uint32_t>(device(), stops);
  std::uint32_t stopped = 0;
  for (std::uint32_t i = 0; i < kHits; ++i) {
    const Hit& hit = hits[i];
    const HitCoverage coverage =
        hit_coverage_at(scene, hit.instance, hit.triangle, hit.barycentrics);
    const bool expected =
        stops_ray(coverage, hit.triangle, hit.barycentrics, hit.distance, mask_of_ray(i), kPassed);
    ASSERT_EQ(found[i] != 0, expected) << "hit " << i;
    stopped += found[i];
  }
  EXPECT_GT(stopped, kHits / 5);
  EXPECT_LT(stopped, kHits - kHits / 5);
}

}  // namespace
}  // namespace lambent::coverage_test
