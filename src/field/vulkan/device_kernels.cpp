// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/device_kernels.h"

#include <array>
#include <map>
#include <mutex>
#include <string>

#include "shaders/apply_corner_tests_comp.h"
#include "shaders/blend_distances_comp.h"
#include "shaders/blend_solution_comp.h"
#include "shaders/cell_visibility_bits_comp.h"
#include "shaders/cell_visibility_rays_comp.h"
#include "shaders/cells_around_comp.h"
#include "shaders/compare_light_comp.h"
#include "shaders/edited_light_comp.h"
#include "shaders/find_lookups_comp.h"
#include "shaders/fit_comp.h"
#include "shaders/gather_comp.h"
#include "shaders/gutters_comp.h"
#include "shaders/hit_distances_comp.h"
#include "shaders/hit_queries_comp.h"
#include "shaders/lookup_comp.h"
#include "shaders/make_surfels_comp.h"
#include "shaders/move_distances_comp.h"
#include "shaders/probe_rays_comp.h"
#include "shaders/ray_weights_comp.h"
#include "shaders/read_lookups_comp.h"
#include "shaders/receive_comp.h"
#include "shaders/scatter_importance_comp.h"
#include "shaders/scatter_tiles_comp.h"
#include "shaders/secondary_light_comp.h"
#include "shaders/secondary_rays_comp.h"
#include "shaders/solve_step_comp.h"
#include "shaders/solve_sums_comp.h"
#include "shaders/store_irradiance_comp.h"
#include "shaders/surfel_distances_comp.h"
#include "shaders/test_corners_comp.h"
#include "shaders/training_points_comp.h"
#include "shaders/training_rays_comp.h"
#include "shaders/training_samples_comp.h"
#include "vulkan/device.h"

namespace lambent {

std::array<vulkan::Constant, 6> tile_constants(const FieldSettings& settings, int volumes,
                                               int lookups) {
  return {{{0, static_cast<std::uint32_t>(settings.irradiance_texels)},
           {1, static_cast<std::uint32_t>(settings.distance_texels)},
           {2, static_cast<std::uint32_t>(settings.irradiance_format)},
           {3, static_cast<std::uint32_t>(settings.distance_format)},
           {4, static_cast<std::uint32_t>(volumes)},
           {5, static_cast<std::uint32_t>(lookups)}}};
}

namespace {

/// A cache of kernels by their specialisation constants.
template <class Kernels>
class KernelCache {
 public:
  explicit KernelCache(const vulkan::Device& device) : device_(device) {}

  const Kernels& get(const FieldSettings& settings, int volumes, int lookups) {
    std::array<std::uint32_t, 6> key{};
    for (const vulkan::Constant& constant : tile_constants(settings, volumes, lookups)) {
      key[constant.id] = constant.value;
    }
    const std::lock_guard lock(mutex_);
    const auto found = kernels_.find(key);
    if (found != kernels_.end()) return found->second;
    return kernels_.emplace(key, Kernels(device_, settings, volumes, lookups)).first->second;
  }

 private:
  const vulkan::Device& device_;
  std::mutex mutex_;
  std::map<std::array<std::uint32_t, 6>, Kernels> kernels_;
};

}  // namespace

const FieldKernels& FieldKernels::of(const vulkan::Device& device, const FieldSettings& settings,
                                     int volumes, int lookups) {
  return device.kept<KernelCache<FieldKernels>>().get(settings, volumes, lookups);
}

const VisibilityKernels& VisibilityKernels::of(const vulkan::Device& device,
                                               const FieldSettings& settings, int volumes,
                                               int lookups) {
  return device.kept<KernelCache<VisibilityKernels>>().get(settings, volumes, lookups);
}

const TrainingKernels& TrainingKernels::of(const vulkan::Device& device,
                                           const FieldSettings& settings, int volumes,
                                           int lookups) {
  return device.kept<KernelCache<TrainingKernels>>().get(settings, volumes, lookups);
}

FieldKernels::FieldKernels(const vulkan::Device& device, const FieldSettings& settings, int volumes,
                           int lookups) {
  const std::array constants = tile_constants(settings, volumes, lookups);
  const auto make = [&](vulkan::Spirv spirv, const char* name) {
    return vulkan::Kernel(device, spirv, name, constants);
  };
  ray_weights = make(shaders::ray_weights_comp(), "ray_weights");
  probe_rays = make(shaders::probe_rays_comp(), "probe_rays");
  make_surfels = make(shaders::make_surfels_comp(), "make_surfels");
  hit_distances = make(shaders::hit_distances_comp(), "hit_distances");
  blend_distances = make(shaders::blend_distances_comp(), "blend_distances");
  gutters = make(shaders::gutters_comp(), "gutters");
  find_lookups = make(shaders::find_lookups_comp(), "find_lookups");
  gather = make(shaders::gather_comp(), "gather");
  receive = make(shaders::receive_comp(), "receive");
  fit = make(shaders::fit_comp(), "fit");
  blend_solution = make(shaders::blend_solution_comp(), "blend_solution");
  solve_sums = make(shaders::solve_sums_comp(), "solve_sums");
  solve_step = make(shaders::solve_step_comp(), "solve_step");
  store_irradiance = make(shaders::store_irradiance_comp(), "store_irradiance");
  compare_light = make(shaders::compare_light_comp(), "compare_light");
  lookup = make(shaders::lookup_comp(), "lookup");
  scatter_tiles = make(shaders::scatter_tiles_comp(), "scatter_tiles");
  surfel_distances = make(shaders::surfel_distances_comp(), "surfel_distances");
  edited_light = make(shaders::edited_light_comp(), "edited_light");
  scatter_importance = make(shaders::scatter_importance_comp(), "scatter_importance");
  move_distances = make(shaders::move_distances_comp(), "move_distances");
}

VisibilityKernels::VisibilityKernels(const vulkan::Device& device, const FieldSettings& settings,
                                     int volumes, int lookups) {
  const std::array constants = tile_constants(settings, volumes, lookups);
  const auto make = [&](vulkan::Spirv spirv, const char* name) {
    return vulkan::Kernel(device, spirv, name, constants);
  };
  cells_around = make(shaders::cells_around_comp(), "cells_around");
  cell_visibility_rays = make(shaders::cell_visibility_rays_comp(), "cell_visibility_rays");
  cell_visibility_bits = make(shaders::cell_visibility_bits_comp(), "cell_visibility_bits");
  test_corners = make(shaders::test_corners_comp(), "test_corners");
  apply_corner_tests = make(shaders::apply_corner_tests_comp(), "apply_corner_tests");
  read_lookups = make(shaders::read_lookups_comp(), "read_lookups");
}

TrainingKernels::TrainingKernels(const vulkan::Device& device, const FieldSettings& settings,
                                 int volumes, int lookups) {
  const std::array constants = tile_constants(settings, volumes, lookups);
  const auto make = [&](vulkan::Spirv spirv, const char* name) {
    return vulkan::Kernel(device, spirv, name, constants);
  };
  points = make(shaders::training_points_comp(), "training_points");
  rays = make(shaders::training_rays_comp(), "training_rays");
  queries = make(shaders::hit_queries_comp(), "hit_queries");
  secondary_rays = make(shaders::secondary_rays_comp(), "secondary_rays");
  secondary_light = make(shaders::secondary_light_comp(), "secondary_light");
  samples = make(shaders::training_samples_comp(), "training_samples");
}

}  // namespace lambent
