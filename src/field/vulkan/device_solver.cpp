// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/device_solver.h"

#include <cstddef>

#include "vulkan/device_memory.h"

namespace lambent {
namespace {

/// The places in a SolveState where the device writes the workgroup counts of an iteration's
/// kernels.
TransportGroups groups_in(const vulkan::Buffer& state) {
  return {&state, offsetof(SolveState, over_rays), offsetof(SolveState, over_blocks)};
}

}  // namespace

DeviceSolver::DeviceSolver(FieldResources& field)
    : field_(field),
      state_(field.device(), sizeof(SolveState), vulkan::Memory::device, "solve"),
      sums_(field.device(), sizeof(Wide) * kSumLanes * kSolveSums, vulkan::Memory::device,
            "sums of a solve") {}

void DeviceSolver::reserve(const DeviceProbes& list) {
  const vulkan::Device& device = field_.device();
  const auto texels = static_cast<std::size_t>(list.count()) * field_.tile_texels();
  lambent::reserve<vec4>(device, texels, "history of a solve", history_);
  lambent::reserve<vec4>(device, texels, "solution", solution_);
  lambent::reserve<vec4>(device, texels, "image of the solution", image_);
  lambent::reserve<vec4>(device, texels, "residual", residual_);
  lambent::reserve<vec4>(device, texels, "image before", previous_image_);
  lambent::reserve<vec4>(device, kAndersonDepth * texels, "residual changes", residual_changes_);
  lambent::reserve<vec4>(device, kAndersonDepth * texels, "image changes", image_changes_);
  field_.reserve_transport(list);
}

std::size_t DeviceSolver::bytes() const {
  return bytes_of({&state_, &sums_, &history_, &solution_, &image_, &residual_, &previous_image_,
                   &residual_changes_, &image_changes_});
}

SolveArrays DeviceSolver::arrays(const DeviceProbes& list,
                                 const vulkan::Buffer& blend_weights) const {
  return {list.index_array(),         {blend_weights.address()},   {field_.light().address()},
          {history_.address()},       {solution_.address()},       {image_.address()},
          {residual_.address()},      {previous_image_.address()}, {residual_changes_.address()},
          {image_changes_.address()}, {state_.address()}};
}

void DeviceSolver::blend_solution(vulkan::Recorder& to, const DeviceProbes& list,
                                  const SolveArrays& arrays, uint step) const {
  const BlendSolutionArguments arguments = {arrays, list.count(), step};
  const vulkan::Kernel& kernel = field_.kernels().blend_solution;
  if (step == kNextSolution) {
    to.run_indirect(kernel, arguments, state_, offsetof(SolveState, over_texels));
  } else {
    field_.run_over(to, kernel, arguments, list, kOverTexels);
  }
  to.barrier();
}

/// Copies the device's decision about the list into the state.
void DeviceSolver::take_chosen(vulkan::Recorder& to, const vulkan::Buffer& chosen) const {
  const auto take = [&](std::size_t bytes, std::size_t from, std::size_t into) {
    to.copy(chosen, state_, bytes, from, into);
  };
  const auto take_groups = [&](uint shape, std::size_t into) {
    take(sizeof(GroupCounts), shape * sizeof(GroupCounts), into);
  };
  take_groups(kOverTexels, offsetof(SolveState, over_texels));
  take_groups(kOverRays, offsetof(SolveState, over_rays));
  take_groups(kOverIrradianceBlocks, offsetof(SolveState, over_blocks));
  take(sizeof(uint), offsetof(ListState, texels), offsetof(SolveState, texels));
  take(sizeof(float), offsetof(ListState, largest_blend_weight),
       offsetof(SolveState, largest_blend_weight));
  to.barrier();
}

void DeviceSolver::record_begin(vulkan::Recorder& to, const DeviceProbes& list,
                                const SolveArrays& arrays, SolveState state) const {
  state.texels = list.count() * field_.tile_texels();
  state.over_texels = field_.groups_over(list, kOverTexels);
  state.over_rays = field_.groups_over(list, kOverRays);
  state.over_blocks = field_.groups_over(list, kOverIrradianceBlocks);
  state.over_sums = {groups_of(kSumLanes, kGroupLanes), 1, 1};
  state.over_step = {1, 1, 1};
  to.update(state_, &state, sizeof(state));
  to.barrier();
  if (list.chosen != nullptr) take_chosen(to, *list.chosen);
  blend_solution(to, list, arrays, kBeginSolve);
}

void DeviceSolver::record_end(vulkan::Recorder& to, const DeviceProbes& list,
                              const SolveArrays& arrays) const {
  blend_solution(to, list, arrays, kEndSolve);
  const SolveSumsArguments sums = {
      arrays, {sums_.address()}, list.count() * field_.tile_texels(), 1u};
  to.run(field_.kernels().solve_sums, sums, kSumLanes);
  to.barrier();
  const SolveStepArguments step = {{state_.address()}, {sums_.address()}, 1u};
  to.run(field_.kernels().solve_step, step, 1);
  to.barrier();
}

void DeviceSolver::record(vulkan::Recorder& to, const DeviceProbes& list,
                          const vulkan::Buffer& blend_weights, float largest_blend_weight,
                          Vec4Array history_ratio, const SolveSettings& settings) {
  const SolveArrays arrays = this->arrays(list, blend_weights);
  SolveState state{};
  state.max_iterations = settings.max_iterations;
  state.tolerance = settings.tolerance;
  state.largest_blend_weight = largest_blend_weight;
  state.max_albedo = settings.max_albedo;
  record_begin(to, list, arrays, state);
  const FieldKernels& kernels = field_.kernels();
  const SolveSumsArguments sums = {
      arrays, {sums_.address()}, list.count() * field_.tile_texels(), 0u};
  const SolveStepArguments step = {{state_.address()}, {sums_.address()}, 0u};
  for (int iteration = 0; iteration < settings.max_iterations; ++iteration) {
    // Apply the transport once
    field_.record_transport(to, list, {arrays.field, arrays.history, history_ratio, arrays.image},
                            groups_in(state_));
    to.run_indirect(kernels.solve_sums, sums, state_, offsetof(SolveState, over_sums));
    to.barrier();
    to.run_indirect(kernels.solve_step, step, state_, offsetof(SolveState, over_step));
    to.barrier();
    if (iteration + 1 < settings.max_iterations) blend_solution(to, list, arrays, kNextSolution);
  }
  record_end(to, list, arrays);
}

void DeviceSolver::record_bounces(vulkan::Recorder& to, const DeviceProbes& list,
                                  const vulkan::Buffer& blend_weights, int bounces) {
  const SolveArrays arrays = this->arrays(list, blend_weights);
  SolveState state{};
  record_begin(to, list, arrays, state);
  field_.record_transport(to, list, {arrays.field, arrays.history, {}, arrays.image, kGatherSky});
  for (int bounce = 0; bounce < bounces; ++bounce) {
    blend_solution(to, list, arrays, kPlainSolution);
    field_.record_transport(to, list, {arrays.field, arrays.history, {}, arrays.image});
  }
  record_end(to, list, arrays);
}

DeviceSolve DeviceSolver::result() const {
  const SolveState state = vulkan::download<SolveState>(field_.device(), state_).front();
  return {state.iterations, state.error, state.change};
}

}  // namespace lambent
