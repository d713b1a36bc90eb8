// SPDX-License-Identifier: Apache-2.0
#include "engine.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::uint32_t kPushConstantBytes = 128;  // what every device has
constexpr std::uint32_t kGroupSize = 64;           // of all the engine's kernels

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS) throw std::runtime_error(std::string(call) + " failed");
}

template <class T>
T made(VkStructureType type) {
  T info{};
  info.sType = type;
  return info;
}

bool has_validation_layer() {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::string_view(layer.layerName) == kValidationLayer;
  });
}

bool has_extensions(VkPhysicalDevice device, std::span<const char* const> names) {
  std::uint32_t count = 0;
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> there(count);
  vkEnumerateDeviceExtensionProperties(device, nullptr, &count, there.data());
  return std::all_of(names.begin(), names.end(), [&](std::string_view name) {
    return std::any_of(there.begin(), there.end(),
                       [&](const VkExtensionProperties& e) { return name == e.extensionName; });
  });
}

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* messages) {
  static_cast<std::vector<std::string>*>(messages)->emplace_back(data->pMessage);
  return VK_FALSE;
}

}  // namespace

// Functions of extensions, by their names.
#define ENGINE_FUNCTION(name) reinterpret_cast<PFN_##name>(vkGetDeviceProcAddr(device, #name))

Engine::Engine(std::span<const char* const> extensions, const void* features) {
  make_instance();
  choose_device(extensions);
  make_device(extensions, features);
  auto pool = made<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = queue_family;
  check(vkCreateCommandPool(device, &pool, nullptr, &pool_), "vkCreateCommandPool");
  for (Frame& frame : frames_) {
    auto info = made<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    info.commandPool = pool_;
    info.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device, &info, &frame.commands), "vkAllocateCommandBuffers");
    auto fence = made<VkFenceCreateInfo>(VK_STRUCTURE_TYPE_FENCE_CREATE_INFO);
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    check(vkCreateFence(device, &fence, nullptr, &frame.fence), "vkCreateFence");
  }
  const VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushConstantBytes};
  auto layout = made<VkPipelineLayoutCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO);
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &range;
  check(vkCreatePipelineLayout(device, &layout, nullptr, &layout_), "vkCreatePipelineLayout");
}

Engine::~Engine() {
  if (device != VK_NULL_HANDLE) vkDeviceWaitIdle(device);
  for (const VkAccelerationStructureKHR structure : structures_) {
    ENGINE_FUNCTION(vkDestroyAccelerationStructureKHR)(device, structure, nullptr);
  }
  for (const EngineBuffer& buffer : buffers_) {
    vkDestroyBuffer(device, buffer.buffer, nullptr);
    vkFreeMemory(device, buffer.memory, nullptr);
  }
  for (const VkPipeline pipeline : pipelines_) vkDestroyPipeline(device, pipeline, nullptr);
  vkDestroyPipelineLayout(device, layout_, nullptr);
  for (const Frame& frame : frames_) vkDestroyFence(device, frame.fence, nullptr);
  vkDestroyCommandPool(device, pool_, nullptr);
  vkDestroyDevice(device, nullptr);
  if (messenger_ != VK_NULL_HANDLE) {
    reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
        instance, "vkDestroyDebugUtilsMessengerEXT"))(instance, messenger_, nullptr);
  }
  vkDestroyInstance(instance, nullptr);
}

void Engine::make_instance() {
  auto application = made<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.apiVersion = VK_API_VERSION_1_2;
  const char* debug_utils = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  auto info = made<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pApplicationInfo = &application;
  if (has_validation_layer()) {
    info.enabledLayerCount = info.enabledExtensionCount = 1;
    info.ppEnabledLayerNames = &kValidationLayer;
    info.ppEnabledExtensionNames = &debug_utils;
  }
  if (vkCreateInstance(&info, nullptr, &instance) != VK_SUCCESS) {
    throw NoDevice("there is no Vulkan driver");
  }
  if (info.enabledLayerCount == 0) return;
  auto listener = made<VkDebugUtilsMessengerCreateInfoEXT>(
      VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  listener.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                             VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  listener.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  listener.pfnUserCallback = keep_message;
  listener.pUserData = &messages;
  check(reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
            instance, "vkCreateDebugUtilsMessengerEXT"))(instance, &listener, nullptr, &messenger_),
        "vkCreateDebugUtilsMessengerEXT");
}

void Engine::choose_device(std::span<const char* const> extensions) {
  std::uint32_t count = 0;
  vkEnumeratePhysicalDevices(instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  vkEnumeratePhysicalDevices(instance, &count, devices.data());
  const auto found = std::find_if(devices.begin(), devices.end(), [&](VkPhysicalDevice candidate) {
    return has_extensions(candidate, extensions);
  });
  if (found == devices.end()) throw NoDevice("no Vulkan device has the extensions");
  physical_device = *found;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_device, &count, families.data());
  while ((families.at(queue_family).queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) ++queue_family;
}

void Engine::make_device(std::span<const char* const> extensions, const void* features) {
  const float priority = 1.0f;
  auto one = made<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
  one.queueFamilyIndex = queue_family;
  one.queueCount = 1;
  one.pQueuePriorities = &priority;
  auto info = made<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
  info.pNext = features;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &one;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  check(vkCreateDevice(physical_device, &info, nullptr, &device), "vkCreateDevice");
  vkGetDeviceQueue(device, queue_family, 0, &queue);
}

EngineBuffer Engine::buffer(std::size_t bytes, VkBufferUsageFlags usage) {
  EngineBuffer buffer;
  auto info = made<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
  info.size = bytes;
  info.usage =
      usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
  check(vkCreateBuffer(device, &info, nullptr, &buffer.buffer), "vkCreateBuffer");
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device, buffer.buffer, &needs);
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical_device, &memory);
  const VkMemoryPropertyFlags seen =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  std::uint32_t type = 0;
  while ((needs.memoryTypeBits >> type & 1u) == 0 ||
         (memory.memoryTypes[type].propertyFlags & seen) != seen) {
    ++type;
  }
  auto flags = made<VkMemoryAllocateFlagsInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO);
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  auto allocation = made<VkMemoryAllocateInfo>(VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO);
  allocation.pNext = &flags;
  allocation.allocationSize = needs.size;
  allocation.memoryTypeIndex = type;
  check(vkAllocateMemory(device, &allocation, nullptr, &buffer.memory), "vkAllocateMemory");
  check(vkBindBufferMemory(device, buffer.buffer, buffer.memory, 0), "vkBindBufferMemory");
  check(vkMapMemory(device, buffer.memory, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), "vkMapMemory");
  auto where = made<VkBufferDeviceAddressInfo>(VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO);
  where.buffer = buffer.buffer;
  buffer.address = vkGetBufferDeviceAddress(device, &where);
  buffers_.push_back(buffer);
  return buffer;
}

VkPipeline Engine::pipeline(const std::string& spirv_file) {
  std::ifstream file(spirv_file, std::ios::binary);
  const std::string code(std::istreambuf_iterator<char>(file), {});
  if (code.empty()) throw std::runtime_error(spirv_file + " cannot be read");
  std::vector<std::uint32_t> words(code.size() / sizeof(std::uint32_t));
  std::memcpy(words.data(), code.data(), code.size());
  auto module = made<VkShaderModuleCreateInfo>(VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO);
  module.codeSize = code.size();
  module.pCode = words.data();
  auto info = made<VkComputePipelineCreateInfo>(VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO);
  info.stage =
      made<VkPipelineShaderStageCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO);
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.pName = "main";
  info.layout = layout_;
  check(vkCreateShaderModule(device, &module, nullptr, &info.stage.module), "vkCreateShaderModule");
  VkPipeline pipeline = VK_NULL_HANDLE;
  const VkResult result =
      vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline);
  vkDestroyShaderModule(device, info.stage.module, nullptr);
  check(result, "vkCreateComputePipelines");
  pipelines_.push_back(pipeline);
  return pipeline;
}

void Engine::dispatch_bytes(VkCommandBuffer commands, VkPipeline pipeline, const void* arguments,
                            std::uint32_t bytes, std::uint32_t count) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes, arguments);
  vkCmdDispatch(commands, (count + kGroupSize - 1) / kGroupSize, 1, 1);
}

VkCommandBuffer Engine::begin_frame() {
  frame_ = (frame_ + 1) % kFramesInFlight;
  const Frame& frame = frames_[frame_];
  check(vkWaitForFences(device, 1, &frame.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device, 1, &frame.fence), "vkResetFences");
  auto info = made<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(frame.commands, &info), "vkBeginCommandBuffer");
  return frame.commands;
}

void Engine::submit_frame() {
  const Frame& frame = frames_[frame_];
  check(vkEndCommandBuffer(frame.commands), "vkEndCommandBuffer");
  auto submit = made<VkSubmitInfo>(VK_STRUCTURE_TYPE_SUBMIT_INFO);
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &frame.commands;
  check(vkQueueSubmit(queue, 1, &submit, frame.fence), "vkQueueSubmit");
}

/// A structure and where it is.
struct Engine::Structure {
  VkAccelerationStructureKHR handle;
  VkDeviceAddress address;
};

Engine::Structure Engine::build(const VkAccelerationStructureGeometryKHR& geometry,
                                std::uint32_t primitives, VkAccelerationStructureTypeKHR type) {
  auto info = made<VkAccelerationStructureBuildGeometryInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR);
  info.type = type;
  info.geometryCount = 1;
  info.pGeometries = &geometry;
  auto sizes = made<VkAccelerationStructureBuildSizesInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR);
  ENGINE_FUNCTION(vkGetAccelerationStructureBuildSizesKHR)
  (device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info, &primitives, &sizes);
  auto create = made<VkAccelerationStructureCreateInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR);
  create.buffer = buffer(sizes.accelerationStructureSize,
                         VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR)
                      .buffer;
  create.size = sizes.accelerationStructureSize;
  create.type = type;
  check(ENGINE_FUNCTION(vkCreateAccelerationStructureKHR)(device, &create, nullptr,
                                                          &info.dstAccelerationStructure),
        "vkCreateAccelerationStructureKHR");
  structures_.push_back(info.dstAccelerationStructure);
  // Memory to work in begins where devices want it to
  constexpr VkDeviceSize kScratchAlignment = 256;
  const VkDeviceAddress scratch = buffer(sizes.buildScratchSize + kScratchAlignment).address;
  info.scratchData.deviceAddress =
      (scratch + kScratchAlignment - 1) / kScratchAlignment * kScratchAlignment;
  const VkAccelerationStructureBuildRangeInfoKHR range = {primitives, 0, 0, 0};
  const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
  const VkCommandBuffer commands = begin_frame();
  ENGINE_FUNCTION(vkCmdBuildAccelerationStructuresKHR)(commands, 1, &info, &ranges);
  submit_frame();
  wait_idle();
  auto where = made<VkAccelerationStructureDeviceAddressInfoKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR);
  where.accelerationStructure = info.dstAccelerationStructure;
  return {where.accelerationStructure,
          ENGINE_FUNCTION(vkGetAccelerationStructureDeviceAddressKHR)(device, &where)};
}

VkAccelerationStructureKHR Engine::build_structure(std::span<const WallShape> walls) {
  constexpr VkBufferUsageFlags kInput =
      VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR;
  const std::uint32_t corners[] = {0, 1, 2, 0, 2, 3};
  const EngineBuffer indices = upload<std::uint32_t>(corners, kInput);
  std::vector<VkAccelerationStructureInstanceKHR> instances;
  for (const WallShape& wall : walls) {
    const glm::vec3 vertices[] = {wall.corner, wall.corner + wall.a, wall.corner + wall.a + wall.b,
                                  wall.corner + wall.b};
    auto geometry = made<VkAccelerationStructureGeometryKHR>(
        VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR);
    geometry.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
    auto& triangles = geometry.geometry.triangles =
        made<VkAccelerationStructureGeometryTrianglesDataKHR>(
            VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR);
    triangles.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
    triangles.vertexData.deviceAddress = upload<glm::vec3>(vertices, kInput).address;
    triangles.vertexStride = sizeof(glm::vec3);
    triangles.maxVertex = 3;
    triangles.indexType = VK_INDEX_TYPE_UINT32;
    triangles.indexData.deviceAddress = indices.address;
    VkAccelerationStructureInstanceKHR placed{};
    placed.transform.matrix[0][0] = placed.transform.matrix[1][1] = placed.transform.matrix[2][2] =
        1.0f;
    placed.instanceCustomIndex = static_cast<std::uint32_t>(instances.size());
    placed.mask = 0xFF;
    // An engine's own pipelines may have a record of their tables for each: of no concern to others
    placed.instanceShaderBindingTableRecordOffset = placed.instanceCustomIndex;
    placed.accelerationStructureReference =
        build(geometry, 2, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR).address;
    instances.push_back(placed);
  }
  auto geometry = made<VkAccelerationStructureGeometryKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR);
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.geometry.instances = made<VkAccelerationStructureGeometryInstancesDataKHR>(
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR);
  geometry.geometry.instances.data.deviceAddress =
      upload<VkAccelerationStructureInstanceKHR>(instances, kInput).address;
  return build(geometry, static_cast<std::uint32_t>(instances.size()),
               VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR)
      .handle;
}
