// SPDX-License-Identifier: Apache-2.0
// What any engine has of its own: an instance and a device with a queue, memory, structures of
// triangles, compute pipelines, command buffers. Knows nothing of Lambent but a way to say which
// features a device is made with.
#pragma once

#include <vulkan/vulkan.h>

#include <cstring>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

/// A wall of a room: the parallelogram at `corner`, whose front is along cross(a, b).
struct WallShape {
  glm::vec3 corner, a, b;
};

struct EngineBuffer {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceAddress address = 0;
  void* mapped = nullptr;
};

/// There is no Vulkan device that has what is asked for.
struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Engine {
 public:
  /// Throws NoDevice where there is no device with these extensions.
  Engine(std::span<const char* const> extensions, const void* features);
  ~Engine();
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  std::uint32_t queue_family = 0;

  /// Memory that both sides see.
  EngineBuffer buffer(std::size_t bytes, VkBufferUsageFlags usage = 0);
  template <class T>
  EngineBuffer upload(std::span<const T> data, VkBufferUsageFlags usage = 0) {
    const EngineBuffer made = buffer(data.size_bytes(), usage);
    std::memcpy(made.mapped, data.data(), data.size_bytes());
    return made;
  }

  /// One instance a wall, whose custom index is the wall's number.
  VkAccelerationStructureKHR build_structure(std::span<const WallShape> walls);

  /// A compute pipeline from a file of SPIR-V; its arguments are push constants.
  VkPipeline pipeline(const std::string& spirv_file);
  template <class Arguments>
  void dispatch(VkCommandBuffer commands, VkPipeline pipeline, const Arguments& arguments,
                std::uint32_t count) {
    dispatch_bytes(commands, pipeline, &arguments, sizeof(arguments), count);
  }

  /// A command buffer to record a frame into: one of `frames_in_flight`, whose last submission has
  /// finished.
  VkCommandBuffer begin_frame();
  void submit_frame();
  void wait_idle() { vkDeviceWaitIdle(device); }

  static constexpr int kFramesInFlight = 2;
  /// What the validation layer had to say, where it is installed.
  std::vector<std::string> messages;

 private:
  struct Structure;
  struct Frame {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkFence fence = VK_NULL_HANDLE;
  };

  void make_instance();
  void choose_device(std::span<const char* const> extensions);
  void make_device(std::span<const char* const> extensions, const void* features);
  Structure build(const VkAccelerationStructureGeometryKHR& geometry, std::uint32_t primitives,
                  VkAccelerationStructureTypeKHR type);
  void dispatch_bytes(VkCommandBuffer commands, VkPipeline pipeline, const void* arguments,
                      std::uint32_t bytes, std::uint32_t count);

  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  Frame frames_[kFramesInFlight];
  int frame_ = 0;
  std::vector<EngineBuffer> buffers_;
  std::vector<VkPipeline> pipelines_;
  std::vector<VkAccelerationStructureKHR> structures_;
};
