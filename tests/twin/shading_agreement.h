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

/// Kernels are compiled once for all tests; drivers of processors take their time.
inline HitShading& shading_on(const vulkan::Device& device) {
  static HitShading shading(device);
  return shading;
}

/// A world, on the host and on the device.
struct TwinWorld {
  explicit TwinWorld(const vulkan::Device& device, Scene made)
      : scene(std::move(made)),
        world(scene),
        on_device(device, scene, emissive_of(world), lights_of(world)) {}
  Scene scene;
  World world;
  DeviceScene on_device;
};

/// What shading on a device leaves.
struct Shaded {
  std::vector<LitPointRecord> points;
  std::vector<ShadedHitRecord> shaded;
  std::vector<glm::vec3> irradiance;
};

/// Shades a batch on a device, whose first ray has this index.
inline Shaded shade_on_device(const vulkan::Device& device, const World& world,
                              const DeviceScene& scene, const HitBatch& batch,
                              const ShadeHitsSettings& settings, std::uint32_t first_index) {
  const auto count = static_cast<std::uint32_t>(batch.rays.size());
  const UploadedHits hits = upload_hits(device, batch);
  // Two runs of rays, as of two probes
  const std::uint32_t per_index = (count + 1) / 2;
  const vulkan::Buffer indices = vulkan::upload(
      device, std::vector<std::uint32_t>{first_index, first_index + per_index}, "first indices");
  const auto room = [&](std::size_t bytes) {
    return vulkan::Buffer(device, count * bytes, vulkan::Memory::device, "shaded");
  };
  const vulkan::Buffer points = room(sizeof(LitPointRecord));
  const vulkan::Buffer shaded = room(sizeof(ShadedHitRecord));
  const vulkan::Buffer irradiance = room(sizeof(glm::vec3));
  HostTracer tracer(device, tracer_of(world));
  HitShading& shading = shading_on(device);
  DeviceSolidSides sides;
  vulkan::Buffer first_words, words;
  if (settings.solid_sides != nullptr) {
    first_words = vulkan::upload(device, settings.solid_sides->first_word, "first words");
    words = vulkan::upload(device, settings.solid_sides->words, "solid sides");
    sides = {{first_words.address()}, {words.address()}};
  }
  tracer.run([&](vulkan::Recorder& to) {
    shading.shade_hits(to, {scene, tracer, sides}, hits.view, {indices.address()}, per_index,
                       settings, {{points.address()}, {shaded.address()}, {irradiance.address()}});
  });
  return {vulkan::download<LitPointRecord>(device, points),
          vulkan::download<ShadedHitRecord>(device, shaded),
          vulkan::download<glm::vec3>(device, irradiance)};
}

}  // namespace lambent::test
