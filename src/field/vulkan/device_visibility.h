// SPDX-License-Identifier: Apache-2.0
// Visibility by rays for lookups on a device, like visibility.h: which probes of each cell are
// visible to each other, and the visibility rays of lookups.
#pragma once

#include "field/vulkan/device_arguments.h"
#include "field/vulkan/device_kernels.h"
#include "raytracing/vulkan/device_tracer.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent {

/// The length of a list. Where the device decides it, `chosen` begins with a ListState, and `most`
/// is an upper bound.
struct ListLength {
  int most = 0;
  const vulkan::Buffer* chosen = nullptr;
};

class DeviceVisibility {
 public:
  /// At first, all probes of a cell are visible to each other. The device must outlive this object.
  DeviceVisibility(const vulkan::Device& device, const FieldSettings& settings, int probes,
                   int volumes, int lookups);

  /// Reserves memory for at least this many points at a time. Must not be called while the device
  /// uses it.
  void reserve(int points);
  /// The largest number of points whose lookups may be tested at a time.
  int points() const { return points_; }
  /// Memory for the lookups of points that are no surfels.
  LookupArray lookups() const { return {lookups_.address()}; }
  bool exact() const { return exact_; }
  /// Two words a probe (all_visible): which corners see each other of the cell whose lowest one it
  /// is.
  UintArray of_cells() const { return {cell_visibility_.address()}; }
  /// Reserves memory for record_visibility_around(). Must not be called while the device uses it.
  void reserve_cells_around();
  std::size_t bytes() const;

  // Passes. What they read must be visible before them, and what they write is visible after them.
  // The scene's textures must be bound.

  /// Records CellVisibility::update() for cells that exist.
  void record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer,
                              const StoreArrays& store, IntArray cells, int count) const;
  /// Records the same for all cells that have one of a list's probes as a corner.
  void record_visibility_around(vulkan::Recorder& to, const DeviceTracer& tracer,
                                const StoreArrays& store, IntArray probes,
                                const ListLength& length) const;
  /// Records how many rows of points the corner tests that follow have in all.
  void record_rows(vulkan::Recorder& to, const ListLength& rows) const;
  /// Records visibility rays for the corners whose visibility is in doubt (VisibilityMask), or with
  /// exact visibility for all corners with a weight, and the lookups' weights that result. `first`
  /// is the first of the points' rows among all. Only the first `columns` points of each row exist.
  void record_corner_tests(vulkan::Recorder& to, const DeviceTracer& tracer,
                           const StoreArrays& store, const LookupPoints& points, int first,
                           LookupArray lookups, int columns) const;
  /// Records the computation of queries' irradiance from their lookups.
  void record_reading(vulkan::Recorder& to, const ReadLookupsArguments& arguments) const;
  /// Records a copy of the number of rays since the last call into a buffer of one word, and resets
  /// the count.
  void take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const;

 private:
  void record_listed_cells(vulkan::Recorder& to, const DeviceTracer& tracer,
                           const StoreArrays& store, IntArray cells, int most) const;
  void record_first_item(vulkan::Recorder& to, int first) const;
  RayBatch requested_rays(int most) const;

  const vulkan::Device& device_;
  const VisibilityKernels& kernels_;
  bool exact_;
  int probes_;
  int lookups_a_point_;
  int points_ = 0;
  vulkan::Buffer cell_visibility_;  // two words per probe
  vulkan::Buffer rays_, occluded_;  // for the lookups of points_ points, or for cells
  vulkan::Buffer counter_;          // kCounterWords
  vulkan::Buffer tests_, lookups_;  // for points_ points
  vulkan::Buffer marks_, cells_;    // one word per probe; empty where the host lists the cells
};

}  // namespace lambent
