// SPDX-License-Identifier: Apache-2.0
// The kernels of a field's passes, specialised for the field's settings.
#pragma once

#include <array>

#include "lambent/field.h"
#include "vulkan/kernel.h"

namespace lambent {

// The most volumes that a surfel reads. Where more have a weight, the first ones take all of the
// weight. More than two cascades overlap only within a cell or two.
inline constexpr int kMaxSurfelLookups = 4;

/// The specialisation constants of probes/shaders/tiles.glsl.
std::array<vulkan::Constant, 6> tile_constants(const FieldSettings& settings, int volumes,
                                               int lookups);

/// The kernels that every field on a device needs.
struct FieldKernels {
  /// The kernels for these settings. The device makes them once and keeps them.
  static const FieldKernels& of(const vulkan::Device& device, const FieldSettings& settings,
                                int volumes, int lookups);

  FieldKernels(const vulkan::Device& device, const FieldSettings& settings, int volumes,
               int lookups);

  vulkan::Kernel ray_weights, probe_rays, make_surfels, hit_distances, blend_distances, gutters;
  vulkan::Kernel find_lookups, gather, receive, fit, blend_solution, solve_sums, solve_step;
  vulkan::Kernel store_irradiance, compare_light, lookup, scatter_tiles;
  vulkan::Kernel surfel_distances, edited_light, move_distances, scatter_importance;
};

/// The kernels of visibility by rays, which few fields need.
struct VisibilityKernels {
  /// The kernels for these settings. The device makes them once and keeps them.
  static const VisibilityKernels& of(const vulkan::Device& device, const FieldSettings& settings,
                                     int volumes, int lookups);

  VisibilityKernels(const vulkan::Device& device, const FieldSettings& settings, int volumes,
                    int lookups);

  vulkan::Kernel cells_around, cell_visibility_rays, cell_visibility_bits, test_corners,
      apply_corner_tests, read_lookups;
};

/// The kernels with which fields that follow our own world learn corrections of lookups.
struct TrainingKernels {
  /// The kernels for these settings. The device makes them once and keeps them.
  static const TrainingKernels& of(const vulkan::Device& device, const FieldSettings& settings,
                                   int volumes, int lookups);

  TrainingKernels(const vulkan::Device& device, const FieldSettings& settings, int volumes,
                  int lookups);

  vulkan::Kernel points, rays, queries, secondary_rays, secondary_light, samples;
};

}  // namespace lambent
