// SPDX-License-Identifier: Apache-2.0
#include "vulkan/device.h"

#include <array>
#include <stdexcept>
#include <utility>

#include "vulkan/instance.h"
#include "vulkan/recorder.h"

namespace lambent::vulkan {

void check(VkResult result, const char* call) {
  if (result == VK_SUCCESS) return;
  throw std::runtime_error(std::string(call) + " failed (VkResult " + std::to_string(result) + ")");
}

/// Messages of the validation layer, from any thread.
struct Device::Messages {
  mutable std::mutex mutex;
  std::vector<std::string> texts;
};

namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL keep_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                            VkDebugUtilsMessageTypeFlagsEXT,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* keeper) {
  (*static_cast<std::function<void(const char*)>*>(keeper))(data->pMessage);
  return VK_FALSE;
}

/// The index of the device that a request selects. Fails with what each device lacks.
Expected<std::size_t> choose(const DeviceRequest& request,
                             const std::vector<DeviceDescription>& found) {
  if (found.empty())
    return fail("", "Vulkan", "there is no Vulkan device on this machine", Error::Kind::failed);
  if (request.index >= static_cast<int>(found.size())) {
    return fail("", "device " + std::to_string(request.index),
                "there are only " + std::to_string(found.size()));
  }
  std::string reasons;
  for (const bool software : {false, true}) {
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (request.index >= 0 && i != static_cast<std::size_t>(request.index)) continue;
      if (found[i].software != software) continue;
      if (found[i].missing.empty()) return i;
      reasons += (reasons.empty() ? "" : "; ") + ("\"" + found[i].name + "\" lacks");
      for (const std::string& name : found[i].missing) {
        reasons += (name == found[i].missing.front() ? " " : ", ") + name;
      }
    }
  }
  return fail("", "Vulkan", "no device can be used: " + reasons, Error::Kind::failed);
}

}  // namespace

Device::Device() = default;

Expected<std::shared_ptr<Device>> open_device(const DeviceRequest& request) {
  Expected<Instance> instance = Instance::make(request.validation);
  if (!instance) return tl::unexpected(instance.error());
  const std::vector<VkPhysicalDevice> physical = instance->devices();
  std::vector<DeviceDescription> found;
  for (const VkPhysicalDevice device : physical) found.push_back(describe(instance->fn(), device));
  const Expected<std::size_t> chosen = choose(request, found);
  if (!chosen) return tl::unexpected(chosen.error());

  std::shared_ptr<Device> device(new Device);
  device->functions_ = instance->fn();
  device->physical_device_ = physical[*chosen];
  device->description_ = found[*chosen];
  device->owned_ = true;
  if (request.validation && instance->has_debug_utils()) device->listen(instance->handle());

  const std::uint32_t family = *compute_queue_family(instance->fn(), device->physical_device_);
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  RequiredFeatures features;
  features.request();
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &features.core;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<std::uint32_t>(kRequiredExtensions.size());
  info.ppEnabledExtensionNames = kRequiredExtensions.data();
  const VkResult made =
      instance->fn().vkCreateDevice(device->physical_device_, &info, nullptr, &device->device_);
  device->instance_ = instance->release();
  if (made != VK_SUCCESS) {
    return fail("", "\"" + device->description_.name + "\"",
                "the device cannot be opened (VkResult " + std::to_string(made) + ")");
  }
  if (!load_device_functions(device->instance_, device->device_, device->functions_)) {
    return fail("", "\"" + device->description_.name + "\"", "the driver is incomplete",
                Error::Kind::failed);
  }
  device->functions_.vkGetDeviceQueue(device->device_, family, 0, &device->queue_);
  device->finish(family);
  return device;
}

Expected<std::shared_ptr<Device>> adopt_device(const LentDevice& lent) {
  std::shared_ptr<Device> device(new Device);
  Functions& f = device->functions_;
  f.vkGetInstanceProcAddr =
      lent.get_instance_proc_addr != nullptr ? lent.get_instance_proc_addr : find_loader();
  if (f.vkGetInstanceProcAddr == nullptr) {
    return fail("", "Vulkan", "there is no Vulkan loader (libvulkan.so.1) on this machine",
                Error::Kind::failed);
  }
  if (!load_instance_functions(lent.instance, f) ||
      !load_device_functions(lent.instance, lent.device, f)) {
    return fail("", "lent device",
                "it was not created with Vulkan 1.2 and the extensions that are needed");
  }
  device->instance_ = lent.instance;
  device->physical_device_ = lent.physical_device;
  device->device_ = lent.device;
  device->queue_ = lent.queue;
  device->description_ = describe(f, lent.physical_device);
  if (!device->description_.missing.empty()) {
    return fail("", "lent device", "it lacks " + device->description_.missing.front(),
                Error::Kind::failed);
  }
  device->finish(lent.queue_family);
  return device;
}

void Device::listen(VkInstance instance) {
  messages_ = std::make_unique<Messages>();
  keep_ = [messages = messages_.get()](const char* text) {
    const std::lock_guard lock(messages->mutex);
    messages->texts.emplace_back(text);
  };
  VkDebugUtilsMessengerCreateInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = keep_message;
  info.pUserData = &keep_;
  check(functions_.vkCreateDebugUtilsMessengerEXT(instance, &info, nullptr, &messenger_),
        "vkCreateDebugUtilsMessengerEXT");
}

void Device::finish(std::uint32_t queue_family) {
  const Functions& f = functions_;
  f.vkGetPhysicalDeviceMemoryProperties(physical_device_, &memory_);
  VkPhysicalDeviceRayTracingPipelinePropertiesKHR rays{};
  rays.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR;
  VkPhysicalDeviceAccelerationStructurePropertiesKHR structures{};
  structures.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR;
  structures.pNext = &rays;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &structures;
  f.vkGetPhysicalDeviceProperties2(physical_device_, &properties);
  const VkPhysicalDeviceLimits& core = properties.properties.limits;
  limits_.shader_group_handle_bytes = rays.shaderGroupHandleSize;
  limits_.shader_group_handle_alignment = rays.shaderGroupHandleAlignment;
  limits_.shader_group_base_alignment = rays.shaderGroupBaseAlignment;
  limits_.acceleration_scratch_alignment =
      structures.minAccelerationStructureScratchOffsetAlignment;
  limits_.max_sampled_images =
      std::min({core.maxPerStageDescriptorSampledImages, core.maxDescriptorSetSampledImages,
                core.maxPerStageResources - kMaxSamplers, kMaxTextures});
  limits_.max_image_extent = core.maxImageDimension2D;
  limits_.max_groups = std::min(core.maxComputeWorkGroupCount[0], core.maxComputeWorkGroupCount[1]);
  const std::uint32_t bits = timestamp_bits(f, physical_device_, queue_family);
  limits_.timestamp_mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  limits_.timestamp_period_ns = bits > 0 ? core.timestampPeriod : 0.0f;

  VkCommandPoolCreateInfo pool{};
  pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
  pool.queueFamilyIndex = queue_family;
  check(f.vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
  VkFenceCreateInfo fence{};
  fence.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  check(f.vkCreateFence(device_, &fence, nullptr, &fence_), "vkCreateFence");
  make_pipeline_layout();
}

void Device::make_pipeline_layout() {
  std::array<VkDescriptorSetLayoutBinding, 2> bindings{};
  bindings[0] = {kTextureBinding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, limits_.max_sampled_images,
                 VK_SHADER_STAGE_ALL, nullptr};
  bindings[1] = {kSamplerBinding, VK_DESCRIPTOR_TYPE_SAMPLER, kMaxSamplers, VK_SHADER_STAGE_ALL,
                 nullptr};
  const std::array<VkDescriptorBindingFlags, 2> flags = {VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT,
                                                         VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT};
  VkDescriptorSetLayoutBindingFlagsCreateInfo partly{};
  partly.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO;
  partly.bindingCount = static_cast<std::uint32_t>(flags.size());
  partly.pBindingFlags = flags.data();
  VkDescriptorSetLayoutCreateInfo set{};
  set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
  set.pNext = &partly;
  set.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set.pBindings = bindings.data();
  check(functions_.vkCreateDescriptorSetLayout(device_, &set, nullptr, &texture_set_layout_),
        "vkCreateDescriptorSetLayout");

  const VkPushConstantRange arguments = {VK_SHADER_STAGE_ALL, 0, kMaxArgumentBytes};
  VkPipelineLayoutCreateInfo layout{};
  layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  layout.setLayoutCount = 1;
  layout.pSetLayouts = &texture_set_layout_;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &arguments;
  check(functions_.vkCreatePipelineLayout(device_, &layout, nullptr, &pipeline_layout_),
        "vkCreatePipelineLayout");
}

void* Device::keep(std::type_index type, const std::function<std::shared_ptr<void>()>& make) const {
  {
    const std::lock_guard lock(keeping_);
    const auto found = kept_.find(type);
    if (found != kept_.end()) return found->second.get();
  }
  // Its constructor may request another object, so it runs without the lock; of two created
  // concurrently, the first is kept
  std::shared_ptr<void> made = make();
  const std::lock_guard lock(keeping_);
  return kept_.try_emplace(type, std::move(made)).first->second.get();
}

Device::~Device() {
  kept_.clear();
  const Functions& f = functions_;
  if (device_ != VK_NULL_HANDLE && f.vkDestroyFence != nullptr) {
    f.vkDestroyPipelineLayout(device_, pipeline_layout_, nullptr);
    f.vkDestroyDescriptorSetLayout(device_, texture_set_layout_, nullptr);
    f.vkDestroyFence(device_, fence_, nullptr);
    f.vkDestroyCommandPool(device_, pool_, nullptr);
    if (owned_) f.vkDestroyDevice(device_, nullptr);
  }
  if (!owned_ || instance_ == VK_NULL_HANDLE) return;
  if (messenger_ != VK_NULL_HANDLE) {
    f.vkDestroyDebugUtilsMessengerEXT(instance_, messenger_, nullptr);
  }
  f.vkDestroyInstance(instance_, nullptr);
}

void Device::run(const std::function<void(Recorder&)>& record) const {
  const std::lock_guard lock(running_);
  const Functions& f = functions_;
  VkCommandBufferAllocateInfo allocation{};
  allocation.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  allocation.commandPool = pool_;
  allocation.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocation.commandBufferCount = 1;
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(f.vkAllocateCommandBuffers(device_, &allocation, &commands), "vkAllocateCommandBuffers");
  struct Freed {
    const Device& device;
    VkCommandBuffer commands;
    ~Freed() { device.fn().vkFreeCommandBuffers(device.device_, device.pool_, 1, &commands); }
  } const freed{*this, commands};

  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(f.vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  Recorder recorder(*this, commands);
  record(recorder);
  // Make the last writes visible to the host
  recorder.barrier();
  check(f.vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(f.vkQueueSubmit(queue_, 1, &submit, fence_), "vkQueueSubmit");
  check(f.vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(f.vkResetFences(device_, 1, &fence_), "vkResetFences");
}

void Device::name(VkObjectType type, std::uint64_t object, const std::string& name) const {
  if (!has_debug_names()) return;
  VkDebugUtilsObjectNameInfoEXT info{};
  info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT;
  info.objectType = type;
  info.objectHandle = object;
  info.pObjectName = name.c_str();
  functions_.vkSetDebugUtilsObjectNameEXT(device_, &info);
}

std::vector<std::string> Device::messages() const {
  if (messages_ == nullptr) return {};
  const std::lock_guard lock(messages_->mutex);
  return messages_->texts;
}

const DeviceDescription& description(const Device& device) {
  return device.description();
}

std::vector<std::string> validation_messages(const Device& device) {
  return device.messages();
}

}  // namespace lambent::vulkan
