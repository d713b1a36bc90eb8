// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/vulkan_raytracer.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <utility>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "raytracing/vulkan/trace_arguments.h"
#include "scene/transmission.h"
#include "shaders/closest_rahit.h"
#include "shaders/closest_rchit.h"
#include "shaders/closest_rgen.h"
#include "shaders/closest_rmiss.h"
#include "shaders/occlusion_rahit.h"
#include "shaders/occlusion_rgen.h"
#include "shaders/occlusion_rmiss.h"
#include "shaders/transmittance_rahit.h"
#include "shaders/transmittance_rgen.h"
#include "shaders/transmittance_rmiss.h"
#include "vulkan/device.h"
#include "vulkan/recorder.h"

namespace lambent {
namespace {

// Rays of one round trip: enough to hide its fixed cost, few enough that the rays and hits of
// several threads in flight take little memory.
constexpr std::size_t kBatchRays = std::size_t{1} << 18;
// Least capacity of staging memory [rays].
constexpr std::size_t kLeastRoom = std::size_t{1} << 10;

// Rays are uploaded without conversion.
static_assert(sizeof(Ray) == sizeof(RayRecord) && std::is_trivially_copyable_v<Ray> &&
              offsetof(Ray, origin) == offsetof(RayRecord, origin_ws) &&
              offsetof(Ray, t_min) == offsetof(RayRecord, t_min) &&
              offsetof(Ray, direction) == offsetof(RayRecord, direction_ws) &&
              offsetof(Ray, t_max) == offsetof(RayRecord, t_max) &&
              offsetof(Ray, mask) == offsetof(RayRecord, mask));

}  // namespace

/// Staging memory for one batch of the host's rays and their results.
class VulkanRayTracer::Staging {
 public:
  void make_room(const vulkan::Device& device, std::size_t rays) {
    if (rays <= room_) return;
    room_ = std::max(std::bit_ceil(rays), kLeastRoom);
    using vulkan::Buffer, vulkan::Memory;
    up_ = Buffer(device, room_ * sizeof(RayRecord), Memory::upload, "rays up");
    rays_ = Buffer(device, room_ * sizeof(RayRecord), Memory::device, "rays");
    results_ = Buffer(device, room_ * sizeof(HitRecord), Memory::device, "hits");
    down_ = Buffer(device, room_ * sizeof(HitRecord), Memory::readback, "hits down");
  }

  /// Uploads rays, has `record` trace them, and reads back their results of `result_bytes` each.
  template <class Record>
  const std::byte* carry(const vulkan::Device& device, std::span<const Ray> rays,
                         std::size_t result_bytes, Record record) {
    make_room(device, rays.size());
    std::memcpy(up_.host(), rays.data(), rays.size_bytes());
    device.run([&](vulkan::Recorder& recorder) {
      recorder.copy(up_, rays_, rays.size_bytes());
      recorder.barrier();
      record(recorder, RayBatch{{rays_.address()}, static_cast<std::uint32_t>(rays.size())},
             results_.address());
      recorder.barrier();
      recorder.copy(results_, down_, rays.size() * result_bytes);
    });
    return down_.host();
  }

 private:
  std::size_t room_ = 0;  // rays
  vulkan::Buffer up_, rays_, results_, down_;
};

/// Staging memory, borrowed for the time of a batch.
class VulkanRayTracer::Borrowed {
 public:
  explicit Borrowed(const VulkanRayTracer& tracer) : tracer_(tracer) {
    const std::lock_guard lock(tracer.staging_mutex_);
    if (tracer.idle_staging_.empty()) {
      staging_ = std::make_unique<Staging>();
    } else {
      staging_ = std::move(tracer.idle_staging_.back());
      tracer.idle_staging_.pop_back();
    }
  }
  ~Borrowed() {
    const std::lock_guard lock(tracer_.staging_mutex_);
    tracer_.idle_staging_.push_back(std::move(staging_));
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;
  Staging* operator->() const { return staging_.get(); }

 private:
  const VulkanRayTracer& tracer_;
  std::unique_ptr<Staging> staging_;
};

/// The pipelines, which all worlds on a device share.
struct VulkanRayTracer::Kernels {
  explicit Kernels(const vulkan::Device& device)
      : closest(device,
                {shaders::closest_rgen(), shaders::closest_rmiss(), shaders::closest_rchit(),
                 shaders::closest_rahit()},
                "closest hits"),
        occlusion(
            device,
            {shaders::occlusion_rgen(), shaders::occlusion_rmiss(), {}, shaders::occlusion_rahit()},
            "occlusions"),
        transmittance(device,
                      {shaders::transmittance_rgen(),
                       shaders::transmittance_rmiss(),
                       {},
                       shaders::transmittance_rahit()},
                      "transmittances") {}

  vulkan::RayKernel closest, occlusion, transmittance;
};

VulkanRayTracer::VulkanRayTracer(const Scene& scene, const DeviceScene& device_scene)
    : scene_(scene),
      device_scene_(device_scene),
      device_(device_scene.device()),
      kernels_(device_.kept<Kernels>()) {
  Stopwatch watch;
  acceleration_ = std::make_unique<SceneAcceleration>(device_, scene, [this](std::size_t mesh) {
    const MeshRecord& record = device_scene_.mesh(mesh);
    vulkan::TriangleGeometry geometry;
    geometry.positions = record.positions.address;
    geometry.indices = record.triangles.address;
    geometry.vertices = static_cast<std::uint32_t>(scene_.meshes[mesh].positions.size());
    geometry.triangles = static_cast<std::uint32_t>(scene_.meshes[mesh].triangles.size());
    return geometry;
  });
  statistics_.build_ms = watch.lap();
  tell_sizes();
}

VulkanRayTracer::~VulkanRayTracer() = default;

void VulkanRayTracer::tell_sizes() {
  statistics_.triangles = triangle_count(scene_);
  statistics_.instances = scene_.instances.size();
  statistics_.bytes = acceleration_->bytes();
  has_glass_ = std::any_of(scene_.materials.begin(), scene_.materials.end(),
                           [](const Material& material) { return is_transmissive(material); });
  dims_shadows_ = std::any_of(scene_.materials.begin(), scene_.materials.end(), dims_light);
}

void VulkanRayTracer::update(const GeometryEdits& edits) {
  Stopwatch watch;
  acceleration_->update(edits);
  statistics_.refit_ms = watch.lap();
  tell_sizes();
}

std::size_t VulkanRayTracer::batch_rays() const {
  return kBatchRays;
}

void VulkanRayTracer::trace(vulkan::Recorder& recorder, const vulkan::RayKernel& kernel,
                            const RayBatch& batch, const Answers& answers) const {
  if (batch.count == 0) return;
  recorder.bind_textures(device_scene_.textures());
  const VkDeviceAddress structure = acceleration_->address();
  const TraceArguments arguments = {
      uvec2(static_cast<uint>(structure), static_cast<uint>(structure >> 32)),
      batch.rays,
      answers.hits,
      answers.occluded,
      answers.through,
      device_scene_.address(),
      batch.count,
      answers.to_hits ? 1u : 0u};
  if (batch.indirect != nullptr) {
    recorder.trace_indirect(kernel, arguments, *batch.indirect, batch.indirect_offset);
    return;
  }
  recorder.trace(kernel, arguments, batch.count);
}

void VulkanRayTracer::closest_hits(vulkan::Recorder& recorder, const RayBatch& batch,
                                   HitArray hits) const {
  trace(recorder, kernels_.closest, batch, {.hits = hits});
}

void VulkanRayTracer::occlusions(vulkan::Recorder& recorder, const RayBatch& batch,
                                 UintArray occluded) const {
  trace(recorder, kernels_.occlusion, batch, {.occluded = occluded});
}

void VulkanRayTracer::transmittances(vulkan::Recorder& recorder, const RayBatch& batch,
                                     HitArray hits, Vec3Array through) const {
  trace(recorder, kernels_.transmittance, batch,
        {.hits = hits, .through = through, .to_hits = hits.address != 0});
}

void VulkanRayTracer::closest_hits(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(rays.size() == hits.size());
  // Trace some rays while others are copied
  parallel_chunks(rays.size(), kBatchRays, [&](std::size_t begin, std::size_t end) {
    const Borrowed staging(*this);
    const std::byte* results =
        staging->carry(device_, rays.subspan(begin, end - begin), sizeof(HitRecord),
                       [&](vulkan::Recorder& recorder, const RayBatch& batch,
                           VkDeviceAddress address) { closest_hits(recorder, batch, {address}); });
    for (std::size_t i = begin; i < end; ++i) {
      HitRecord record;
      std::memcpy(&record, results + (i - begin) * sizeof(record), sizeof(record));
      hits[i] = {record.distance,     record.instance,        record.triangle,
                 record.barycentrics, record.front_face != 0, record.sample_weight};
    }
  });
}

void VulkanRayTracer::occlusions(std::span<const Ray> rays,
                                 std::span<std::uint8_t> occluded) const {
  assert(rays.size() == occluded.size());
  parallel_chunks(rays.size(), kBatchRays, [&](std::size_t begin, std::size_t end) {
    const Borrowed staging(*this);
    const std::byte* results =
        staging->carry(device_, rays.subspan(begin, end - begin), sizeof(std::uint32_t),
                       [&](vulkan::Recorder& recorder, const RayBatch& batch,
                           VkDeviceAddress address) { occlusions(recorder, batch, {address}); });
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t word = 0;
      std::memcpy(&word, results + (i - begin) * sizeof(word), sizeof(word));
      occluded[i] = static_cast<std::uint8_t>(word);
    }
  });
}

void VulkanRayTracer::transmittances(std::span<const Ray> rays,
                                     std::span<glm::vec3> through) const {
  assert(rays.size() == through.size());
  parallel_chunks(rays.size(), kBatchRays, [&](std::size_t begin, std::size_t end) {
    const Borrowed staging(*this);
    const std::byte* results = staging->carry(
        device_, rays.subspan(begin, end - begin), sizeof(glm::vec3),
        [&](vulkan::Recorder& recorder, const RayBatch& batch, VkDeviceAddress address) {
          transmittances(recorder, batch, {}, {address});
        });
    std::memcpy(&through[begin], results, (end - begin) * sizeof(glm::vec3));
  });
}

}  // namespace lambent
