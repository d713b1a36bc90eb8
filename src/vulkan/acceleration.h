// SPDX-License-Identifier: Apache-2.0
// Acceleration structures: one of triangles for each mesh, and one of instances over these.
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

/// What buffers of vertices and indices must be made for, besides what all buffers are.
inline constexpr VkBufferUsageFlags kGeometryUsage =
    VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;

/// Triangles in a device's memory, in buffers made for kGeometryUsage.
struct TriangleGeometry {
  VkDeviceAddress positions = 0;  ///< Three floats a vertex, one vertex after the other.
  VkDeviceAddress indices = 0;    ///< Three 32-bit words a triangle.
  std::uint32_t vertices = 0;     ///< > 0.
  std::uint32_t triangles = 0;    ///< > 0.
  bool opaque = true;             ///< false: any-hit shaders say what stops a ray.
  bool deforms = false;           ///< Can be refitted; costs memory, as it is not compacted.
};

/// A structure of its own, in memory that it may share with others. Movable; empty by default. The
/// device must outlive it.
class AccelerationStructure {
 public:
  AccelerationStructure() = default;
  /// Not yet built. `offset`: of the storage, a multiple of kStructureAlignment.
  AccelerationStructure(const Device& device, std::shared_ptr<const Buffer> storage,
                        std::size_t offset, std::size_t bytes, VkAccelerationStructureTypeKHR type);
  ~AccelerationStructure();
  AccelerationStructure(AccelerationStructure&& other) noexcept;
  AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;

  VkAccelerationStructureKHR handle() const { return handle_; }
  /// What instances and shaders know it by; 0 where it is empty: nothing is met there.
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

/// Where structures may begin in their storage: what Vulkan asks for.
inline constexpr std::size_t kStructureAlignment = 256;

/// Builds structures of triangles, many at once, with memory to work in that is kept. The device
/// must outlive it.
class TriangleBuilder {
 public:
  /// Structures are built in groups that need about so much memory, to work in and before they are
  /// compacted [bytes].
  static constexpr std::size_t kGroupBytes = std::size_t{256} << 20;

  explicit TriangleBuilder(const Device& device, std::size_t group_bytes = kGroupBytes)
      : device_(&device), group_bytes_(group_bytes) {}

  /// One structure for each geometry; compacted unless it deforms. Waits. Throws std::runtime_error
  /// where memory runs out.
  std::vector<AccelerationStructure> build(std::span<const TriangleGeometry> geometries);

  /// A structure that deforms, and its vertices that moved; all else is as when it was built.
  struct Deformed {
    AccelerationStructure* structure;
    TriangleGeometry geometry;
    bool anew = false;  ///< Sort the triangles anew, which costs more and makes rays fast again.
  };
  /// Records what fits structures to their vertices; once a command buffer. A barrier is to follow.
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
  VkDeviceAddress structure = 0;   ///< 0: this instance cannot be met.
  std::uint32_t custom_index = 0;  ///< For shaders; 24 bits.
  std::uint8_t mask = 0xFF;        ///< Rays whose mask shares a bit meet it.
};

/// The structure over all instances. The device must outlive it.
class InstanceStructure {
 public:
  explicit InstanceStructure(const Device& device) : device_(&device) {}

  /// Records the build. It is always sorted anew: next to tracing that is cheap, and a refitted one
  /// would get slower with every object that moves. Structures of triangles must be finished
  /// before; a barrier is to follow. What an earlier build wrote is gone.
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
