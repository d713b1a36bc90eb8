// SPDX-License-Identifier: Apache-2.0
#include "field/vulkan/device_visibility.h"

#include <algorithm>
#include <array>

#include "field/lookup/visibility_math.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

// The least number of rays that memory is reserved for: enough to fill any device, in 42 MB with
// the results.
constexpr int kMaxCornerRays = 1 << 20;

}  // namespace

DeviceVisibility::DeviceVisibility(const vulkan::Device& device, const FieldSettings& settings,
                                   int probes, int volumes, int lookups)
    : device_(device),
      kernels_(VisibilityKernels::of(device, settings, volumes, lookups)),
      exact_(settings.visibility == Visibility::exact),
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

void DeviceVisibility::record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer,
                                              const StoreArrays& store, IntArray cells,
                                              int count) const {
  const int most = points_ * lookups_a_point_ * kCellCorners / kCellPairs;
  for (int first = 0; first < count; first += most) {
    const int some = std::min(most, count - first);
    const IntArray these{cells.address + first * sizeof(int)};
    const CellVisibilityRaysArguments asked = {store, these, {rays_.address()}, some};
    to.run(kernels_.cell_visibility_rays, asked, some);
    to.barrier();
    tracer.occlusions(to, {{rays_.address()}, static_cast<std::uint32_t>(some) * kCellPairs},
                      {occluded_.address()});
    to.barrier();
    const CellVisibilityBitsArguments found = {
        these, {occluded_.address()}, {cell_visibility_.address()}, some};
    to.run(kernels_.cell_visibility_bits, found, some);
    to.barrier();
  }
}

void DeviceVisibility::record_corner_tests(vulkan::Recorder& to, const DeviceTracer& tracer,
                                           const StoreArrays& store, const LookupPoints& points,
                                           LookupArray lookups, int columns) const {
  // Reset the counter, whose first words are the size of a dispatch of rays
  constexpr std::array<std::uint32_t, 3> kNone = {0u, 1u, 1u};
  to.update(counter_, kNone.data(), sizeof(kNone), kRaysRequested * sizeof(uint));
  to.barrier();
  const TestCornersArguments asked = {store,
                                      points,
                                      lookups,
                                      {cell_visibility_.address()},
                                      {counter_.address()},
                                      {tests_.address()},
                                      {rays_.address()}};
  to.run(kernels_.test_corners, asked, columns, points.rows);
  to.barrier();
  RayBatch batch;
  batch.rays = {rays_.address()};
  batch.count = static_cast<std::uint32_t>(points_ * lookups_a_point_ * kCellCorners);
  batch.indirect = &counter_;
  batch.indirect_offset = kRaysRequested * sizeof(uint);
  tracer.occlusions(to, batch, {occluded_.address()});
  to.barrier();
  const ApplyCornerTestsArguments answered = {store,
                                              points,
                                              lookups,
                                              {cell_visibility_.address()},
                                              {tests_.address()},
                                              {occluded_.address()}};
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
