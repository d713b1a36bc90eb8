// SPDX-License-Identifier: Apache-2.0
// Visibility by rays, for lookups on a device: which probes of each cell see each other, and the
// rays that lookups ask. As visibility.h, in passes that are recorded.
#pragma once

#include "field/vulkan/device_arguments.h"
#include "field/vulkan/device_kernels.h"
#include "raytracing/vulkan/device_tracer.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent {

class DeviceVisibility {
 public:
  /// Every probe sees every other. The device must outlive it.
  DeviceVisibility(const vulkan::Device& device, const FieldSettings& settings, int probes,
                   int volumes, int lookups);

  /// Has it take at least so many points at a time. Not to be called while the device works with
  /// it.
  void reserve(int points);
  /// Points whose lookups may be weighed at a time.
  int points() const { return points_; }
  /// Room for their lookups, where they are not a surfel's.
  LookupArray lookups() const { return {lookups_.address()}; }
  bool exact() const { return exact_; }

  // Passes. What they read must be visible before, and what they write is afterwards. The scene's
  // textures are bound.

  /// As CellVisibility::look, for cells that the host knows to be there.
  void record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer,
                              const StoreArrays& store, IntArray cells, int count) const;
  /// Asks rays for what the distances that lookups were found by do not decide, and weighs the
  /// lookups anew. `columns`: of the points' rows, so many exist.
  void record_corner_tests(vulkan::Recorder& to, const DeviceTracer& tracer,
                           const StoreArrays& store, const LookupPoints& points,
                           LookupArray lookups, int columns) const;
  /// Irradiance of queries, from lookups.
  void record_reading(vulkan::Recorder& to, const ReadLookupsArguments& arguments) const;
  /// Copies the number of rays that lookups asked since the last time into the buffer (one word),
  /// and starts counting anew.
  void take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const;

 private:
  const vulkan::Device& device_;
  const VisibilityKernels& kernels_;
  bool exact_;
  int lookups_a_point_;
  int points_ = 0;
  vulkan::Buffer cell_visibility_;  // two words a probe
  vulkan::Buffer rays_, occluded_;  // of points_, or of cells
  vulkan::Buffer counter_;          // kCounterWords
  vulkan::Buffer tests_, lookups_;  // of points_
};

}  // namespace lambent
