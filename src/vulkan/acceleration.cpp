// SPDX-License-Identifier: Apache-2.0
#include "vulkan/acceleration.h"

#include <algorithm>
#include <cassert>
#include <iterator>
#include <utility>

#include "vulkan/device.h"

namespace lambent::vulkan {
namespace {

std::size_t align_up(std::size_t bytes, std::size_t alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

/// The parameters of one build. `info` points into this object, and so is valid until it is moved.
struct Build {
  VkAccelerationStructureGeometryKHR geometry{};
  VkAccelerationStructureBuildRangeInfoKHR range{};
  VkAccelerationStructureBuildGeometryInfoKHR info{};
  VkAccelerationStructureBuildSizesInfoKHR sizes{};

  void ask_sizes(const Device& device) {
    info.pGeometries = &geometry;
    sizes.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR;
    device.fn().vkGetAccelerationStructureBuildSizesKHR(
        device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info,
        &range.primitiveCount, &sizes);
  }
};

Build build_of_triangles(const Device& device, const TriangleGeometry& triangles) {
  assert(triangles.vertices > 0 && triangles.triangles > 0);
  Build build;
  build.geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
  build.geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
  // Any-hit shaders must run once per hit, as light that passes a surface is multiplied by its
  // transmittance
  build.geometry.flags = triangles.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR
                                          : VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR;
  auto& data = build.geometry.geometry.triangles;
  data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
  data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
  data.vertexData.deviceAddress = triangles.positions;
  data.vertexStride = 3 * sizeof(float);
  data.maxVertex = triangles.vertices - 1;
  data.indexType = VK_INDEX_TYPE_UINT32;
  data.indexData.deviceAddress = triangles.indices;
  build.range.primitiveCount = triangles.triangles;
  build.info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
  build.info.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
  build.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                     (triangles.deforms ? VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR
                                        : VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_COMPACTION_BIT_KHR);
  build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
  build.info.geometryCount = 1;
  build.ask_sizes(device);
  return build;
}

void record_builds(Recorder& recorder, std::vector<Build>& builds) {
  std::vector<VkAccelerationStructureBuildGeometryInfoKHR> infos;
  std::vector<const VkAccelerationStructureBuildRangeInfoKHR*> ranges;
  for (Build& build : builds) {
    build.info.pGeometries = &build.geometry;
    infos.push_back(build.info);
    ranges.push_back(&build.range);
  }
  recorder.device().fn().vkCmdBuildAccelerationStructuresKHR(
      recorder.commands(), static_cast<std::uint32_t>(infos.size()), infos.data(), ranges.data());
}

std::shared_ptr<const Buffer> make_storage(const Device& device, std::size_t bytes,
                                           const char* name) {
  return std::make_shared<const Buffer>(device, bytes, Memory::device, name, kStructureAlignment,
                                        VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
}

/// Queries of the sizes of structures after compaction.
class CompactedSizes {
 public:
  CompactedSizes(const Device& device, std::uint32_t count) : device_(device), count_(count) {
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    info.queryCount = count;
    check(device.fn().vkCreateQueryPool(device.handle(), &info, nullptr, &pool_),
          "vkCreateQueryPool");
  }
  ~CompactedSizes() { device_.fn().vkDestroyQueryPool(device_.handle(), pool_, nullptr); }
  CompactedSizes(const CompactedSizes&) = delete;
  CompactedSizes& operator=(const CompactedSizes&) = delete;

  void ask(Recorder& recorder, std::span<const VkAccelerationStructureKHR> structures) const {
    device_.fn().vkCmdResetQueryPool(recorder.commands(), pool_, 0, count_);
    device_.fn().vkCmdWriteAccelerationStructuresPropertiesKHR(
        recorder.commands(), count_, structures.data(),
        VK_QUERY_TYPE_ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR, pool_, 0);
  }
  std::vector<VkDeviceSize> read() const {
    std::vector<VkDeviceSize> sizes(count_);
    check(device_.fn().vkGetQueryPoolResults(
              device_.handle(), pool_, 0, count_, sizes.size() * sizeof(VkDeviceSize), sizes.data(),
              sizeof(VkDeviceSize), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
    return sizes;
  }

 private:
  const Device& device_;
  std::uint32_t count_;
  VkQueryPool pool_ = VK_NULL_HANDLE;
};

/// Creates structures of these sizes in shared storage.
std::vector<AccelerationStructure> make_together(const Device& device,
                                                 std::span<const VkDeviceSize> sizes,
                                                 const char* name) {
  std::size_t bytes = 0;
  for (const VkDeviceSize size : sizes) bytes += align_up(size, kStructureAlignment);
  const std::shared_ptr<const Buffer> storage = make_storage(device, bytes, name);
  std::vector<AccelerationStructure> structures;
  std::size_t offset = 0;
  for (const VkDeviceSize size : sizes) {
    structures.emplace_back(device, storage, offset, size,
                            VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR);
    offset += align_up(size, kStructureAlignment);
  }
  return structures;
}

/// Copies the structures `which` to storage of their compacted size.
void compact(const Device& device, std::span<const std::size_t> which,
             std::vector<AccelerationStructure>& structures) {
  if (which.empty()) return;
  std::vector<VkAccelerationStructureKHR> handles;
  for (const std::size_t i : which) handles.push_back(structures[i].handle());
  const CompactedSizes asked(device, static_cast<std::uint32_t>(handles.size()));
  device.run([&](Recorder& recorder) { asked.ask(recorder, handles); });
  std::vector<AccelerationStructure> compacted =
      make_together(device, asked.read(), "acceleration structures");
  device.run([&](Recorder& recorder) {
    for (std::size_t k = 0; k < which.size(); ++k) {
      VkCopyAccelerationStructureInfoKHR copy{};
      copy.sType = VK_STRUCTURE_TYPE_COPY_ACCELERATION_STRUCTURE_INFO_KHR;
      copy.src = handles[k];
      copy.dst = compacted[k].handle();
      copy.mode = VK_COPY_ACCELERATION_STRUCTURE_MODE_COMPACT_KHR;
      device.fn().vkCmdCopyAccelerationStructureKHR(recorder.commands(), &copy);
    }
  });
  for (std::size_t k = 0; k < which.size(); ++k) {
    structures[which[k]] = std::move(compacted[k]);
  }
}

}  // namespace

AccelerationStructure::AccelerationStructure(const Device& device,
                                             std::shared_ptr<const Buffer> storage,
                                             std::size_t offset, std::size_t bytes,
                                             VkAccelerationStructureTypeKHR type)
    : device_(&device), storage_(std::move(storage)), bytes_(bytes) {
  assert(offset % kStructureAlignment == 0);
  VkAccelerationStructureCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR;
  info.buffer = storage_->handle();
  info.offset = storage_->offset() + offset;
  info.size = bytes;
  info.type = type;
  check(device.fn().vkCreateAccelerationStructureKHR(device.handle(), &info, nullptr, &handle_),
        "vkCreateAccelerationStructureKHR");
  VkAccelerationStructureDeviceAddressInfoKHR asked{};
  asked.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR;
  asked.accelerationStructure = handle_;
  address_ = device.fn().vkGetAccelerationStructureDeviceAddressKHR(device.handle(), &asked);
}

void AccelerationStructure::release() {
  if (handle_ == VK_NULL_HANDLE) return;
  device_->fn().vkDestroyAccelerationStructureKHR(device_->handle(), handle_, nullptr);
  handle_ = VK_NULL_HANDLE;
}

AccelerationStructure::~AccelerationStructure() {
  release();
}

AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept
    : device_(other.device_),
      storage_(std::move(other.storage_)),
      handle_(std::exchange(other.handle_, VK_NULL_HANDLE)),
      address_(std::exchange(other.address_, 0)),
      bytes_(std::exchange(other.bytes_, 0)) {}

AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
  if (this == &other) return *this;
  release();
  device_ = other.device_;
  storage_ = std::move(other.storage_);
  handle_ = std::exchange(other.handle_, VK_NULL_HANDLE);
  address_ = std::exchange(other.address_, 0);
  bytes_ = std::exchange(other.bytes_, 0);
  return *this;
}

VkDeviceAddress TriangleBuilder::scratch(std::size_t bytes) {
  const std::size_t alignment = device_->limits().acceleration_scratch_alignment;
  if (scratch_.bytes() < bytes) {
    scratch_ = {};
    scratch_ = Buffer(*device_, bytes, Memory::device, "acceleration structure scratch", alignment);
  }
  return scratch_.address();
}

std::vector<AccelerationStructure> TriangleBuilder::build(
    std::span<const TriangleGeometry> geometries) {
  std::vector<AccelerationStructure> built;
  built.reserve(geometries.size());
  while (built.size() < geometries.size()) build_group(geometries.subspan(built.size()), built);
  // Free the scratch memory, since later refits need much less
  scratch_ = {};
  return built;
}

/// Builds one group of structures.
void TriangleBuilder::build_group(std::span<const TriangleGeometry> geometries,
                                  std::vector<AccelerationStructure>& built) {
  const std::size_t alignment = device_->limits().acceleration_scratch_alignment;
  std::vector<Build> builds;
  std::vector<VkDeviceSize> passing, lasting;
  std::size_t scratch_bytes = 0, group_bytes = 0;
  for (const TriangleGeometry& geometry : geometries) {
    const Build build = build_of_triangles(*device_, geometry);
    const std::size_t working = align_up(build.sizes.buildScratchSize, alignment);
    group_bytes += working + build.sizes.accelerationStructureSize;
    if (group_bytes > group_bytes_ && !builds.empty()) break;
    scratch_bytes += working;
    (geometry.deforms ? lasting : passing).push_back(build.sizes.accelerationStructureSize);
    builds.push_back(build);
  }

  // Structures that will be compacted are stored separately from the others
  std::vector<AccelerationStructure> to_compact, to_keep;
  if (!passing.empty()) to_compact = make_together(*device_, passing, "structures to be compacted");
  if (!lasting.empty()) to_keep = make_together(*device_, lasting, "acceleration structures");
  std::vector<AccelerationStructure> structures;
  std::vector<std::size_t> which;
  VkDeviceAddress working = scratch(scratch_bytes);
  for (std::size_t i = 0, c = 0, k = 0; i < builds.size(); ++i) {
    if (!geometries[i].deforms) which.push_back(i);
    structures.push_back(std::move(geometries[i].deforms ? to_keep[k++] : to_compact[c++]));
    builds[i].info.dstAccelerationStructure = structures[i].handle();
    builds[i].info.scratchData.deviceAddress = working;
    working += align_up(builds[i].sizes.buildScratchSize, alignment);
  }
  device_->run([&](Recorder& recorder) { record_builds(recorder, builds); });
  compact(*device_, which, structures);
  std::move(structures.begin(), structures.end(), std::back_inserter(built));
}

void TriangleBuilder::fit(Recorder& recorder, std::span<const Deformed> deformed) {
  if (deformed.empty()) return;
  const std::size_t alignment = device_->limits().acceleration_scratch_alignment;
  std::vector<Build> builds;
  std::vector<std::size_t> offsets;
  std::size_t bytes = 0;
  for (const Deformed& one : deformed) {
    assert(one.geometry.deforms);
    Build build = build_of_triangles(*device_, one.geometry);
    build.info.dstAccelerationStructure = one.structure->handle();
    offsets.push_back(bytes);
    bytes += align_up(one.anew ? build.sizes.buildScratchSize : build.sizes.updateScratchSize,
                      alignment);
    if (!one.anew) {
      build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR;
      build.info.srcAccelerationStructure = one.structure->handle();
    }
    builds.push_back(build);
  }
  const VkDeviceAddress working = scratch(bytes);
  for (std::size_t i = 0; i < builds.size(); ++i) {
    builds[i].info.scratchData.deviceAddress = working + offsets[i];
  }
  record_builds(recorder, builds);
}

void InstanceStructure::build(Recorder& recorder, std::span<const PlacedStructure> instances) {
  const auto count = static_cast<std::uint32_t>(instances.size());
  const bool grow = capacity_ < count || structure_.handle() == VK_NULL_HANDLE;
  // Grow by half, so that a list that grows frame by frame is not reallocated each time
  if (grow) capacity_ = std::max(count, capacity_ + capacity_ / 2);

  std::vector<Build> builds(1);
  Build& build = builds.front();
  build.geometry.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR;
  build.geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  auto& data = build.geometry.geometry.instances;
  data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
  build.info.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR;
  build.info.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
  build.info.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
  build.info.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
  build.info.geometryCount = 1;
  if (grow) {
    build.range.primitiveCount = capacity_;
    build.ask_sizes(*device_);
    structure_ = {};
    structure_ = AccelerationStructure(
        *device_,
        make_storage(*device_, build.sizes.accelerationStructureSize, "instance structure"), 0,
        build.sizes.accelerationStructureSize, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR);
    scratch_ =
        Buffer(*device_, build.sizes.buildScratchSize, Memory::device, "instance structure scratch",
               device_->limits().acceleration_scratch_alignment);
    instances_ = Buffer(*device_, capacity_ * sizeof(VkAccelerationStructureInstanceKHR),
                        Memory::upload, "instances", 16, kGeometryUsage);
  }

  const std::span records = instances_.as<VkAccelerationStructureInstanceKHR>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const PlacedStructure& placed = instances[i];
    VkAccelerationStructureInstanceKHR record{};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        record.transform.matrix[row][column] = placed.world_from_object[column][row];
      }
    }
    record.instanceCustomIndex = placed.custom_index & 0xFFFFFFu;
    record.mask = placed.mask;
    record.accelerationStructureReference = placed.structure;
    records[i] = record;
  }

  build.range.primitiveCount = count;
  data.data.deviceAddress = instances_.address();
  build.info.dstAccelerationStructure = structure_.handle();
  build.info.scratchData.deviceAddress = scratch_.address();
  record_builds(recorder, builds);
}

}  // namespace lambent::vulkan
