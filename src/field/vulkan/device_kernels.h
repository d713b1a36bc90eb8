// SPDX-License-Identifier: Apache-2.0
// The kernels of a field's passes, made for the settings of one field.
#pragma once

#include <array>

#include "lambent/field.h"
#include "vulkan/kernel.h"

namespace lambent {

// A surfel reads at most so many volumes; where more have a share in it, those asked first answer
// for all. Cascades hand over to the next but one only within a cell or two.
inline constexpr int kMaxSurfelLookups = 4;

/// The constants of shaders/tiles.glsl.
std::array<vulkan::Constant, 6> tile_constants(const FieldSettings& settings, int volumes,
                                               int lookups);

struct FieldKernels {
  /// Those for these settings, made once and kept by the device.
  static const FieldKernels& of(const vulkan::Device& device, const FieldSettings& settings,
                                int volumes, int lookups);

  FieldKernels(const vulkan::Device& device, const FieldSettings& settings, int volumes,
               int lookups);

  vulkan::Kernel ray_weights, probe_rays, make_surfels, see_distances, blend_distances, gutters;
  vulkan::Kernel find_lookups, gather, receive, fit, blend_solution, solve_sums, solve_step;
  vulkan::Kernel store_irradiance, compare_light, lookup, scatter_tiles;
  vulkan::Kernel see_surfels, move_distances, scatter_importance;
};

/// Those of visibility by rays, which few fields need.
struct VisibilityKernels {
  static const VisibilityKernels& of(const vulkan::Device& device, const FieldSettings& settings,
                                     int volumes, int lookups);

  VisibilityKernels(const vulkan::Device& device, const FieldSettings& settings, int volumes,
                    int lookups);

  vulkan::Kernel cell_visibility_rays, cell_visibility_bits, test_corners, apply_corner_tests,
      read_lookups;
};

}  // namespace lambent
