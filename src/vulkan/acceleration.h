// SPDX-License-Identifier: Apache-2.0
// Acceleration structures: one of triangles for each mesh (bottom level), and one of instances over
// these (top level).
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {

/// Usage flags that buffers of vertices and indices need in addition to those of all buffers.
inline constexpr VkBufferUsageFlags kGeometryUsage =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

/// Triangles in a device's memory, in buffers with kGeometryUsage.
struct TriangleGeometry {
  VkDeviceAddress positions = 0;  ///< Three floats per vertex, tightly packed.
  VkDeviceAddress indices = 0;    ///< Three 32-bit words per triangle.
  std::uint32_t vertices = 0;     ///< > 0.
  std::uint32_t triangles = 0;    ///< > 0.
  bool opaque = true;             ///< false: any-hit shaders decide what stops a ray.
  bool deforms = false;           ///< Can be refitted; costs memory, since it is not compacted.
};

/// An acceleration structure, in memory that it may share with others. Movable; empty by default.
/// The device must outlive it.
class AccelerationStructure {
 public:
  AccelerationStructure() = default;
  /// Creates a structure that is not built yet. `offset` into the storage is a multiple of
  /// kStructureAlignment.
  AccelerationStructure(const Device& device, std::shared_ptr<const Buffer> storage,
                        std::size_t offset, std::size_t bytes, VkAccelerationStructureTypeKHR type);
  ~AccelerationStructure();
  AccelerationStructure(AccelerationStructure&& other) noexcept;
  AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

  VkAccelerationStructureKHR handle() const { return handle_; }
  /// The address by which instances and shaders refer to it; 0 where it is empty, and rays hit
  /// nothing.
  VkDeviceAddress address() const { return address_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void release();

  const Device* device_ = nullptr;
  std::shared_ptr<const Buffer> storage_;
  VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
  std::size_t bytes_ = 0;
};

/// Alignment of structures in their storage, required by Vulkan.
inline constexpr std::size_t kStructureAlignment = 256;

/// Builds structures of triangles, many at once. Reuses its scratch memory. The device must outlive
/// it.
class TriangleBuilder {
 public:
  /// Structures are built in groups that need about this much scratch memory, and before they are
  /// compacted as much storage [bytes].
  static constexpr std::size_t kGroupBytes = std::size_t{256} << 20;

  explicit TriangleBuilder(const Device& device, std::size_t group_bytes = kGroupBytes)
      : device_(&device), group_bytes_(group_bytes) {}

  /// Builds one structure for each geometry; compacted unless it deforms. Waits. Throws
  /// std::runtime_error where memory runs out.
  std::vector<AccelerationStructure> build(std::span<const TriangleGeometry> geometries);

  /// A structure that deforms, and its geometry, of which only vertices have moved since the build.
  struct Deformed {
    AccelerationStructure* structure;
    TriangleGeometry geometry;
    bool anew = false;  ///< Rebuild rather than refit: costs more, but makes rays fast again.
  };
  /// Records refits and rebuilds of structures; at most once per command buffer. A barrier must
  /// follow.
  void fit(Recorder& recorder, std::span<const Deformed> deformed);

 private:
  VkDeviceAddress scratch(std::size_t bytes);
  void build_group(std::span<const TriangleGeometry> geometries,
                   std::vector<AccelerationStructure>& built);

  const Device* device_;
  std::size_t group_bytes_;
  Buffer scratch_;
};

/// A structure of triangles placed in the world.
struct PlacedStructure {
  glm::mat4 world_from_object{1.0f};
  VkDeviceAddress structure = 0;   ///< 0: rays cannot hit this instance.
  std::uint32_t custom_index = 0;  ///< For shaders; 24 bits.
  std::uint8_t mask = 0xFF;        ///< Rays hit it if their mask shares a bit.
};

/// The structure over all instances. The device must outlive it.
class InstanceStructure {
 public:
  explicit InstanceStructure(const Device& device) : device_(&device) {}

  /// Records the build. The structure is always rebuilt: compared to tracing that is cheap, and a
  /// refitted one would get slower with every object that moves. Structures of triangles must be
  /// finished before; a barrier must follow. Replaces the result of an earlier build.
  void build(Recorder& recorder, std::span<const PlacedStructure> instances);

  VkAccelerationStructureKHR handle() const { return structure_.handle(); }
  VkDeviceAddress address() const { return structure_.address(); }
  std::size_t bytes() const { return structure_.bytes() + instances_.bytes(); }

 private:
  const Device* device_;
  std::uint32_t capacity_ = 0;  // instances
  Buffer instances_;
  Buffer scratch_;
  AccelerationStructure structure_;
};

}  // namespace lambent::vulkan
