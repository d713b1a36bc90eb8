// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/device_visibility.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>

#include "field/lookup/visibility_math.h"
#include "field/transport/list_sizes.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

// The least number of rays for which memory is reserved: enough to keep any device busy, in 42 MB
// with the results.
constexpr int kMaxCornerRays = 1 << 20;

}  // namespace

DeviceVisibility::DeviceVisibility(const vulkan::Device& device, const FieldSettings& settings,
                                   int probes, int volumes, int lookups)
    : device_(device),
      kernels_(VisibilityKernels::of(device, settings, volumes, lookups)),
      exact_(settings.visibility == Visibility::exact),
      probes_(probes),
      lookups_a_point_(lookups),
      cell_visibility_(device, 2 * sizeof(uint) * probes, vulkan::Memory::device,
                       "visibility within cells"),
      counter_(device, kCounterWords * sizeof(uint), vulkan::Memory::device, "rays of lookups") {
  reserve(kMaxCornerRays / (kCellCorners * lookups));
  device.run([&](vulkan::Recorder& to) {
    to.fill(cell_visibility_, ~0u);
    to.fill(counter_, 0u);
  });
}

void DeviceVisibility::reserve(int points) {
  if (points <= points_) return;
  points_ = points;
  const std::size_t lookups = static_cast<std::size_t>(points) * lookups_a_point_;
  const std::size_t rays = lookups * kCellCorners;
  lambent::reserve<RayRecord>(device_, rays, "rays to corners", rays_);
  lambent::reserve<uint>(device_, rays, "hidden corners", occluded_);
  lambent::reserve<CornerTests>(device_, points, "tests of lookups", tests_);
  lambent::reserve<SurfelLookup>(device_, lookups, "lookups of queries", lookups_);
}

void DeviceVisibility::reserve_cells_around() {
  lambent::reserve<uint>(device_, probes_, "marks of cells", marks_);
  lambent::reserve<int>(device_, probes_, "cells to look across", cells_);
}

std::size_t DeviceVisibility::bytes() const {
  return bytes_of(
      {&cell_visibility_, &rays_, &occluded_, &counter_, &tests_, &lookups_, &marks_, &cells_});
}

/// Resets the size of the dispatch of rays, and says which item is the first.
void DeviceVisibility::record_first_item(vulkan::Recorder& to, int first) const {
  static_assert(kRaysRequested == 0 && kFirstItem == 3);
  const std::array<std::uint32_t, 4> none = {0u, 1u, 1u, static_cast<std::uint32_t>(first)};
  to.update(counter_, none.data(), sizeof(none));
  to.barrier();
}

/// The rays that a kernel has asked for: as many as the counter says, and never more than `most`.
RayBatch DeviceVisibility::requested_rays(int most) const {
  RayBatch batch;
  batch.rays = {rays_.address()};
  batch.count = static_cast<std::uint32_t>(most);
  batch.indirect = &counter_;
  batch.indirect_offset = kRaysRequested * sizeof(uint);
  return batch;
}

void DeviceVisibility::record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer,
                                              const StoreArrays& store, IntArray cells,
                                              int count) const {
  to.update(counter_, &count, sizeof(count), kCellsListed * sizeof(uint));
  record_listed_cells(to, tracer, store, cells, count);
}

void DeviceVisibility::record_visibility_around(vulkan::Recorder& to, const DeviceTracer& tracer,
                                                const StoreArrays& store, IntArray probes,
                                                const ListLength& length) const {
  assert(cells_.bytes() > 0);
  to.fill(marks_, 0u);
  to.fill(counter_, 0u, kCellsListed * sizeof(uint), sizeof(uint));
  record_rows(to, length);
  const CellsAroundArguments around = {
      store.grids, probes, {marks_.address()}, {cells_.address()}, {counter_.address()}};
  to.run(kernels_.cells_around, around, length.most);
  to.barrier();
  const int most = std::min(kCellCorners * length.most, probes_);
  record_listed_cells(to, tracer, store, {cells_.address()}, most);
}

/// Records the rays within the counter's number of cells, which is at most `most`.
void DeviceVisibility::record_listed_cells(vulkan::Recorder& to, const DeviceTracer& tracer,
                                           const StoreArrays& store, IntArray cells,
                                           int most) const {
  const int at_a_time = points_ * lookups_a_point_ * kCellCorners / kCellPairs;
  for (int first = 0; first < most; first += at_a_time) {
    const int some = std::min(at_a_time, most - first);
    record_first_item(to, first);
    const CellVisibilityRaysArguments asked = {
        store, cells, {rays_.address()}, {counter_.address()}, some, 0};
    to.run(kernels_.cell_visibility_rays, asked, some);
    to.barrier();
    tracer.occlusions(to, requested_rays(some * kCellPairs), {occluded_.address()});
    to.barrier();
    const CellVisibilityBitsArguments found = {
        cells, {occluded_.address()}, {cell_visibility_.address()}, {counter_.address()}, some, 0};
    to.run(kernels_.cell_visibility_bits, found, some);
    to.barrier();
  }
}

void DeviceVisibility::record_rows(vulkan::Recorder& to, const ListLength& rows) const {
  if (rows.chosen != nullptr) {
    to.copy(*rows.chosen, counter_, sizeof(uint), offsetof(ListState, probes),
            kRowsListed * sizeof(uint));
  } else {
    to.update(counter_, &rows.most, sizeof(rows.most), kRowsListed * sizeof(uint));
  }
  to.barrier();
}

void DeviceVisibility::record_corner_tests(vulkan::Recorder& to, const DeviceTracer& tracer,
                                           const StoreArrays& store, const LookupPoints& points,
                                           int first, LookupArray lookups, int columns) const {
  record_first_item(to, first);
  const TestCornersArguments asked = {store,
                                      points,
                                      lookups,
                                      {cell_visibility_.address()},
                                      {counter_.address()},
                                      {tests_.address()},
                                      {rays_.address()}};
  to.run(kernels_.test_corners, asked, columns, points.rows);
  to.barrier();
  tracer.occlusions(to, requested_rays(points_ * lookups_a_point_ * kCellCorners),
                    {occluded_.address()});
  to.barrier();
  const ApplyCornerTestsArguments answered = {store,
                                              points,
                                              lookups,
                                              {cell_visibility_.address()},
                                              {tests_.address()},
                                              {occluded_.address()},
                                              {counter_.address()}};
  to.run(kernels_.apply_corner_tests, answered, columns, points.rows);
  to.barrier();
}

void DeviceVisibility::record_reading(vulkan::Recorder& to,
                                      const ReadLookupsArguments& arguments) const {
  to.run(kernels_.read_lookups, arguments, arguments.count);
  to.barrier();
}

void DeviceVisibility::take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const {
  to.barrier();
  to.copy(counter_, count, sizeof(uint), kRaysTotal * sizeof(uint));
  to.barrier();
  to.fill(counter_, 0u, kRaysTotal * sizeof(uint), sizeof(uint));
  to.barrier();
}

}  // namespace lambent
