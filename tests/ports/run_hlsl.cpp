// SPDX-License-Identifier: Apache-2.0
// usage: ports_run_hlsl SHADER.spv CASES TOLERANCE
// Runs the HLSL port of the lookup, compiled to SPIR-V, on the queries of a file (cases.h) and
// holds it to the answers. Exits with 77 where no Vulkan device can be opened.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ports/cases.h"
#include "vulkan/buffer.h"
#include "vulkan/device.h"
#include "vulkan/recorder.h"

namespace lambent::ports {
namespace {

constexpr int kSkipped = 77;
constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kBindings = 6;  // grids, offsets, irradiance, distances, queries, answers

std::vector<std::uint32_t> read_words(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::vector<std::uint32_t> words(static_cast<std::size_t>(file.tellg()) / 4);
  file.seekg(0);
  file.read(reinterpret_cast<char*>(words.data()), static_cast<std::streamsize>(4 * words.size()));
  return words;
}

/// A pipeline over storage buffers, as an engine with descriptors of its own makes one.
class Pipeline {
 public:
  Pipeline(const vulkan::Device& device, std::span<const std::uint32_t> spirv) : device_(device) {
    const vulkan::Functions& fn = device.fn();
    std::array<VkDescriptorSetLayoutBinding, kBindings> bindings{};
    for (std::uint32_t i = 0; i < kBindings; ++i) {
      bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
    }
    VkDescriptorSetLayoutCreateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = kBindings;
    set.pBindings = bindings.data();
    vulkan::check(fn.vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &set_layout_),
                  "layout");
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &set_layout_;
    vulkan::check(fn.vkCreatePipelineLayout(device.handle(), &layout, nullptr, &layout_), "layout");

    VkShaderModuleCreateInfo code{};
    code.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    code.codeSize = spirv.size_bytes();
    code.pCode = spirv.data();
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.layout = layout_;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = "main";
    vulkan::check(fn.vkCreateShaderModule(device.handle(), &code, nullptr, &info.stage.module),
                  "shader");
    const VkResult made =
        fn.vkCreateComputePipelines(device.handle(), {}, 1, &info, nullptr, &pipeline_);
    fn.vkDestroyShaderModule(device.handle(), info.stage.module, nullptr);
    vulkan::check(made, "vkCreateComputePipelines");

    const VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBindings};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    vulkan::check(fn.vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_), "pool");
  }

  ~Pipeline() {
    const vulkan::Functions& fn = device_.fn();
    fn.vkDestroyDescriptorPool(device_.handle(), pool_, nullptr);
    fn.vkDestroyPipeline(device_.handle(), pipeline_, nullptr);
    fn.vkDestroyPipelineLayout(device_.handle(), layout_, nullptr);
    fn.vkDestroyDescriptorSetLayout(device_.handle(), set_layout_, nullptr);
  }
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  void run(std::span<const vulkan::Buffer, kBindings> buffers, std::uint32_t groups) const {
    const vulkan::Functions& fn = device_.fn();
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool_;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &set_layout_;
    VkDescriptorSet set = VK_NULL_HANDLE;
    vulkan::check(fn.vkAllocateDescriptorSets(device_.handle(), &allocate, &set), "descriptors");
    std::array<VkDescriptorBufferInfo, kBindings> infos{};
    std::array<VkWriteDescriptorSet, kBindings> writes{};
    for (std::uint32_t i = 0; i < kBindings; ++i) {
      infos[i] = {buffers[i].handle(), buffers[i].offset(), buffers[i].bytes()};
      writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
      writes[i].dstSet = set;
      writes[i].dstBinding = i;
      writes[i].descriptorCount = 1;
      writes[i].descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
      writes[i].pBufferInfo = &infos[i];
    }
    fn.vkUpdateDescriptorSets(device_.handle(), kBindings, writes.data(), 0, nullptr);
    device_.run([&](vulkan::Recorder& to) {
      fn.vkCmdBindPipeline(to.commands(), VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
      fn.vkCmdBindDescriptorSets(to.commands(), VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0, 1, &set,
                                 0, nullptr);
      fn.vkCmdDispatch(to.commands(), groups, 1, 1);
    });
  }

 private:
  const vulkan::Device& device_;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
};

/// Compares, each query by its largest channel. Returns how many queries are too far off.
int compare(std::span<const vec3> expected, std::span<const vec3> found, float tolerance) {
  float worst = 0.0f;
  int failures = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const vec3 e = expected[i], off = abs(e - found[i]);
    const float scale = std::max({e.x, e.y, e.z, 1e-6f});
    const float relative = std::max({off.x, off.y, off.z}) / scale;
    worst = std::max(worst, relative);
    failures += relative <= tolerance ? 0 : 1;
  }
  std::printf("%zu queries, %d too far off, the worst by %.2e\n", expected.size(), failures,
              static_cast<double>(worst));
  return failures;
}

int run(const std::string& shader, const std::string& cases, float tolerance) {
  const auto device = vulkan::open_device({.index = -1, .validation = true});
  if (!device) {
    std::printf("skipped: %s\n", device.error().message().c_str());
    return kSkipped;
  }
  const std::vector<std::uint32_t> words = read_words(cases);
  const CaseCounts counts = {words[0], words[1], words[2], words[3], words[4]};
  const std::array<std::size_t, kBindings> sizes = {counts.volumes * sizeof(ProbeGrid) / 4,
                                                    counts.probes,
                                                    counts.irradiance_words,
                                                    counts.distance_words,
                                                    counts.queries * 9U,
                                                    counts.queries * 3U};
  std::span<const std::uint32_t> rest = std::span(words).subspan(sizeof(CaseCounts) / 4);
  std::array<vulkan::Buffer, kBindings> buffers;
  for (std::size_t i = 0; i < kBindings; ++i) {
    // The last one holds the answers: their place alone is made
    buffers[i] = i + 1 < kBindings
                     ? vulkan::upload(**device, rest.first(sizes[i]), "input")
                     : vulkan::Buffer(**device, 4 * sizes[i], vulkan::Memory::device, "answers");
    if (i + 1 < kBindings) rest = rest.subspan(sizes[i]);
  }
  const Pipeline pipeline(**device, read_words(shader));
  pipeline.run(buffers, (counts.queries + kGroup - 1) / kGroup);
  const std::vector<vec3> found = vulkan::download<vec3>(**device, buffers.back());
  int failures =
      compare({reinterpret_cast<const vec3*>(rest.data()), counts.queries}, found, tolerance);
  for (const std::string& message : validation_messages(**device)) {
    std::fprintf(stderr, "validation: %s\n", message.c_str());
    ++failures;
  }
  return failures == 0 ? 0 : 1;
}

}  // namespace
}  // namespace lambent::ports

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: ports_run_hlsl SHADER.spv CASES TOLERANCE\n");
    return 2;
  }
  try {
    return lambent::ports::run(argv[1], argv[2], std::stof(argv[3]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
