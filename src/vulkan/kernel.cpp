// SPDX-License-Identifier: Apache-2.0
#include "vulkan/kernel.h"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "vulkan/device.h"
#include "vulkan/reflect.h"

namespace lambent::vulkan {
namespace {

/// A shader module, which exists while a pipeline is created.
class Module {
 public:
  Module(const Device& device, Spirv spirv) : device_(device) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = spirv.size_bytes();
    info.pCode = spirv.data();
    check(device.fn().vkCreateShaderModule(device.handle(), &info, nullptr, &module_),
          "vkCreateShaderModule");
  }
  ~Module() { device_.fn().vkDestroyShaderModule(device_.handle(), module_, nullptr); }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits kind) const {
    VkPipelineShaderStageCreateInfo stage{};
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    stage.stage = kind;
    stage.module = module_;
    stage.pName = "main";
    return stage;
  }

 private:
  const Device& device_;
  VkShaderModule module_ = VK_NULL_HANDLE;
};

/// Throws where a shader needs more than pipeline_layout() provides.
void check_interface(const Reflection& shader, const std::string& name) {
  if (shader.argument_bytes > kMaxArgumentBytes) {
    throw std::runtime_error("shader " + name + " takes too many arguments");
  }
  for (const ReflectedBinding& b : shader.bindings) {
    if (b.set != 0 || (b.binding != kTextureBinding && b.binding != kSamplerBinding)) {
      throw std::runtime_error("shader " + name + " reads descriptors that there are not");
    }
  }
}

std::uint32_t round_up(std::uint32_t value, std::uint32_t multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

}  // namespace

Kernel::Kernel(const Device& device, Spirv spirv, const std::string& name,
               std::span<const Constant> constants)
    : device_(&device), name_(name) {
  const Reflection shader = reflect(spirv);
  check_interface(shader, name);
  argument_bytes_ = shader.argument_bytes;
  for (int axis = 0; axis < 3; ++axis) group_size_[axis] = shader.group_size[axis];

  std::vector<VkSpecializationMapEntry> entries;
  std::vector<std::uint32_t> values;
  for (const Constant& constant : constants) {
    entries.push_back({constant.id, static_cast<std::uint32_t>(values.size() * sizeof(values[0])),
                       sizeof(values[0])});
    values.push_back(constant.value);
  }
  const VkSpecializationInfo specialization = {static_cast<std::uint32_t>(entries.size()),
                                               entries.data(), values.size() * sizeof(values[0]),
                                               values.data()};
  const Module module(device, spirv);
  VkComputePipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT);
  info.stage.pSpecializationInfo = &specialization;
  info.layout = device.pipeline_layout();
  check(device.fn().vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr,
                                             &pipeline_),
        "vkCreateComputePipelines");
  device.name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), name);
}

Kernel::~Kernel() {
  if (device_ != nullptr) device_->fn().vkDestroyPipeline(device_->handle(), pipeline_, nullptr);
}

Kernel::Kernel(Kernel&& other) noexcept {
  *this = std::move(other);
}

Kernel& Kernel::operator=(Kernel&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(pipeline_, other.pipeline_);
  std::swap(argument_bytes_, other.argument_bytes_);
  std::swap(group_size_, other.group_size_);
  std::swap(name_, other.name_);
  return *this;
}

RayKernel::RayKernel(const Device& device, const RayShaders& shaders, const std::string& name)
    : device_(&device), name_(name) {
  const Functions& f = device.fn();
  const Reflection shader = reflect(shaders.generation);
  check_interface(shader, name);
  argument_bytes_ = shader.argument_bytes;

  // Stages and groups: ray generation, miss, and one hit group
  const Module generation(device, shaders.generation), miss(device, shaders.miss);
  std::vector<VkPipelineShaderStageCreateInfo> stages = {
      generation.stage(VK_SHADER_STAGE_RAYGEN_BIT_KHR), miss.stage(VK_SHADER_STAGE_MISS_BIT_KHR)};
  VkRayTracingShaderGroupCreateInfoKHR group{};
  group.sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR;
  group.type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
  group.closestHitShader = group.anyHitShader = group.intersectionShader = VK_SHADER_UNUSED_KHR;
  std::vector<VkRayTracingShaderGroupCreateInfoKHR> groups(3, group);
  groups[0].generalShader = 0;
  groups[1].generalShader = 1;
  groups[2].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
  groups[2].generalShader = VK_SHADER_UNUSED_KHR;
  std::optional<Module> closest_hit, any_hit;
  if (!shaders.closest_hit.empty()) {
    closest_hit.emplace(device, shaders.closest_hit);
    groups[2].closestHitShader = static_cast<std::uint32_t>(stages.size());
    stages.push_back(closest_hit->stage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR));
  }
  if (!shaders.any_hit.empty()) {
    any_hit.emplace(device, shaders.any_hit);
    groups[2].anyHitShader = static_cast<std::uint32_t>(stages.size());
    stages.push_back(any_hit->stage(VK_SHADER_STAGE_ANY_HIT_BIT_KHR));
  }
  VkRayTracingPipelineCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR;
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.groupCount = static_cast<std::uint32_t>(groups.size());
  info.pGroups = groups.data();
  info.maxPipelineRayRecursionDepth = 1;
  info.layout = device.pipeline_layout();
  check(f.vkCreateRayTracingPipelinesKHR(device.handle(), VK_NULL_HANDLE, VK_NULL_HANDLE, 1, &info,
                                         nullptr, &pipeline_),
        "vkCreateRayTracingPipelinesKHR");
  device.name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<std::uint64_t>(pipeline_), name);

  // The shader binding table: one record per group, each aligned as the base of a table
  const DeviceLimits& limits = device.limits();
  const std::uint32_t bytes = limits.shader_group_handle_bytes;
  const std::uint32_t stride = round_up(round_up(bytes, limits.shader_group_handle_alignment),
                                        limits.shader_group_base_alignment);
  std::vector<std::byte> handles(groups.size() * bytes);
  check(f.vkGetRayTracingShaderGroupHandlesKHR(device.handle(), pipeline_, 0,
                                               static_cast<std::uint32_t>(groups.size()),
                                               handles.size(), handles.data()),
        "vkGetRayTracingShaderGroupHandlesKHR");
  table_ = Buffer(device, groups.size() * stride, Memory::upload, name + " table",
                  limits.shader_group_base_alignment, VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::memcpy(table_.host() + g * stride, handles.data() + g * bytes, bytes);
    regions_[g] = {table_.address() + g * stride, stride, stride};
  }
  if (shaders.any_record) regions_[2].stride = 0;
}

RayKernel::~RayKernel() {
  if (device_ != nullptr) device_->fn().vkDestroyPipeline(device_->handle(), pipeline_, nullptr);
}

RayKernel::RayKernel(RayKernel&& other) noexcept {
  *this = std::move(other);
}

RayKernel& RayKernel::operator=(RayKernel&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(pipeline_, other.pipeline_);
  std::swap(table_, other.table_);
  std::swap(regions_, other.regions_);
  std::swap(argument_bytes_, other.argument_bytes_);
  std::swap(name_, other.name_);
  return *this;
}

}  // namespace lambent::vulkan
