// SPDX-License-Identifier: Apache-2.0
// The same hits shaded on the host and on a device.
#pragma once

#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "lambent/world.h"
#include "raytracing/shade_hits.h"
#include "raytracing/vulkan/hit_shading.h"
#include "raytracing/world_access.h"
#include "twin/host_tracer.h"

namespace lambent::test {

/// What a batch of rays met, by the host's ray tracer.
struct HitBatch {
  std::vector<Ray> rays;
  std::vector<Hit> hits;
};
inline HitBatch trace_batch(const World& world, std::vector<Ray> rays) {
  HitBatch batch{std::move(rays), {}};
  batch.hits.resize(batch.rays.size());
  tracer_of(world).closest_hits(batch.rays, batch.hits);
  return batch;
}

/// The batch in a device's memory.
struct UploadedHits {
  vulkan::Buffer rays, hits;
  DeviceHits view;
};
inline UploadedHits upload_hits(const vulkan::Device& device, const HitBatch& batch) {
  std::vector<RayRecord> rays;
  std::vector<HitRecord> hits;
  for (const Ray& ray : batch.rays) rays.push_back(record_of(ray));
  for (const Hit& hit : batch.hits) hits.push_back(record_of(hit));
  UploadedHits uploaded{
      vulkan::upload(device, rays, "rays"), vulkan::upload(device, hits, "hits"), {}};
  uploaded.view = {{uploaded.rays.address()},
                   {uploaded.hits.address()},
                   static_cast<std::uint32_t>(rays.size())};
  return uploaded;
}

/// Counts values that differ by more than a tolerance, and tells the first of them.
class Agreement {
 public:
  Agreement(std::string name, float tolerance) : name_(std::move(name)), tolerance_(tolerance) {}

  void compare(const glm::vec3& host, const glm::vec3& device, std::size_t index) {
    ++count_;
    const float scale = 1.0f + glm::length(host);
    if (glm::length(host - device) <= tolerance_ * scale) return;
    if (apart_++ == 0) {
      std::ostringstream first;
      first << "[" << index << "] host " << host.x << " " << host.y << " " << host.z << ", device "
            << device.x << " " << device.y << " " << device.z;
      first_ = first.str();
    }
  }
  /// At most this share of the values may be apart.
  void expect(double share) const {
    EXPECT_GT(count_, 0u) << name_;
    EXPECT_LE(static_cast<double>(apart_), share * static_cast<double>(count_))
        << name_ << ": " << apart_ << " of " << count_ << " apart, first " << first_;
  }

 private:
  std::string name_;
  float tolerance_;
  std::size_t count_ = 0, apart_ = 0;
  std::string first_;
};

}  // namespace lambent::test
