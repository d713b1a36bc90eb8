// SPDX-License-Identifier: Apache-2.0
// Recording the passes of a field.
#include <cassert>

#include "field/vulkan/field_resources.h"
#include "vulkan/device_memory.h"

namespace lambent {
namespace {

// Points per row of a lookup's dispatch: a multiple of the group size, and large enough that the
// number of rows does not exceed any device's limit.
constexpr std::uint32_t kLookupRow = 1u << 20;

// Queries per row of LookupPoints: the width of a workgroup, so that its queries are consecutive.
constexpr int kQueryRow = 8;

template <class Array>
Array from(const vulkan::Buffer& buffer, std::size_t first, std::size_t size) {
  return {buffer.address() + first * size};
}

/// The part of a list's array of indices that begins at `first`.
IntArray indices_from(const DeviceProbes& list, int first) {
  return from<IntArray>(list.indices, static_cast<std::size_t>(first), sizeof(int));
}

}  // namespace

ProbeList FieldResources::arrays(const DeviceProbes& list, int first) const {
  const RaySetArray own = {sets_.address()};
  return {indices_from(list, first),
          from<IntArray>(list.ray_sets, static_cast<std::size_t>(first), sizeof(int)),
          list.sets.address != 0 ? list.sets : own};
}

StoreArrays FieldResources::store() const {
  return {{grids_.address()}, {offsets_.address()}, {irradiance_.address()}, {distance_.address()}};
}

int FieldResources::distance_words() const {
  const int edge = settings_.distance_texels + 2;
  return edge * edge * words_per_distance_texel_;
}

void FieldResources::record_rays(vulkan::Recorder& to, const DeviceProbes& list,
                                 const DeviceGroup& group, RayArray rays) const {
  const RaySlot& slot = slots_[slot_of_[list.probes[group.first]]];
  const ProbeRaysArguments arguments = {
      store(),   indices_from(list, group.first), {slot.directions.address()}, rays, group.count,
      group.rays};
  to.run(kernels_.probe_rays, arguments, group.rays, group.count);
  to.barrier();
}

void FieldResources::record_surfels(vulkan::Recorder& to, const DeviceProbes& list,
                                    const DeviceGroup& group, LitPointArray points,
                                    ShadedHitArray shaded, Vec3Array irradiance) const {
  const MakeSurfelsArguments arguments = {indices_from(list, group.first),
                                          points,
                                          shaded,
                                          irradiance,
                                          {surfels_.address()},
                                          group.count,
                                          group.rays,
                                          stride_};
  to.run(kernels_.make_surfels, arguments, group.rays, group.count);
  to.barrier();
}

void FieldResources::reserve_seen(const DeviceProbes& list) {
  const auto count = static_cast<std::size_t>(list.count());
  reserve<float>(device_, count * round_up(list.most_rays, kLaneGroupSize), "distances of rays",
                 ray_distances_);
  reserve<uint>(device_, count, "probes in solid matter", blocked_);
}

void FieldResources::record_seen_distances(vulkan::Recorder& to, const DeviceProbes& list,
                                           const DeviceGroup& group, HitArray hits) {
  const int distance_stride = round_up(list.most_rays, kLaneGroupSize);
  const auto first = static_cast<std::size_t>(group.first);
  const HitDistancesArguments arguments = {
      {grids_.address()},
      indices_from(list, group.first),
      hits,
      {surfels_.address()},
      from<FloatArray>(ray_distances_, first * distance_stride, sizeof(float)),
      from<UintArray>(blocked_, first, sizeof(uint)),
      group.count,
      group.rays,
      stride_,
      distance_stride};
  to.run(kernels_.hit_distances, arguments, group.count * kLaneGroupSize);
  to.barrier();
}

void FieldResources::record_blend_distances(vulkan::Recorder& to, const DeviceProbes& list,
                                            FloatArray blend_weights, uint dither_seed) {
  const BlendDistancesArguments arguments = {store(),
                                             arrays(list),
                                             list.block_array(),
                                             {ray_distances_.address()},
                                             {blocked_.address()},
                                             blend_weights,
                                             list.block_count,
                                             round_up(list.most_rays, kLaneGroupSize),
                                             dither_seed};
  run_over(to, kernels_.blend_distances, arguments, list, kOverDistanceBlocks);
  to.barrier();
  record_distance_gutters(to, list);
}

void FieldResources::record_distance_gutters(vulkan::Recorder& to, const DeviceProbes& list) const {
  const GuttersArguments arguments = {{distance_.address()},
                                      list.index_array(),
                                      list.count(),
                                      settings_.distance_texels,
                                      words_per_distance_texel_};
  run_over(to, kernels_.gutters, arguments, list, kOverDistanceGutters);
  to.barrier();
}

void FieldResources::record_lookups(vulkan::Recorder& to, const DeviceProbes& list,
                                    const DeviceTracer* tracer) const {
  const auto points = [&](int first, int rows) {
    return LookupPoints{arrays(list, first),
                        {surfels_.address()},
                        {},
                        rows,
                        stride_,
                        0,
                        cell_visibility_ && cell_visibility_->exact() ? 1u : 0u};
  };
  const LookupArray lookups{lookup_records_.address()};
  const FindLookupsArguments arguments = {store(), points(0, list.count()), lookups,
                                          corrections_.arrays(CorrectionUse::picked)};
  run_over(to, kernels_.find_lookups, arguments, list, kOverRays);
  to.barrier();
  if (!cell_visibility_ || tracer == nullptr) return;
  cell_visibility_->record_rows(to, {list.count(), list.chosen});
  const int rows = cell_visibility_->points() / stride_;
  for (int first = 0; first < list.count(); first += rows) {
    const int some = std::min(rows, list.count() - first);
    cell_visibility_->record_corner_tests(to, *tracer, store(), points(first, some), first, lookups,
                                          list.most_rays);
  }
}

void FieldResources::reserve_transport(const DeviceProbes& list) {
  const auto count = static_cast<std::size_t>(list.count());
  reserve<vec4>(device_, count * round_up(list.most_rays, kLaneGroupSize), "radiance", radiance_);
  reserve<vec4>(device_, count * tile_texels(), "irradiance at centres", at_centres_);
}

ListSize FieldResources::list_size(uint shape, int most_rays) const {
  const auto squares = [](const vulkan::Kernel& kernel, int across) {
    return ListSize{groups_of(across, static_cast<int>(kernel.group_size(0))), kernel.group_size(1),
                    0u};
  };
  const auto products = [](int edge, int columns) {
    return ListSize{groups_of(edge * edge, columns), kGroupLanes / kLaneGroupSize, 1u};
  };
  switch (shape) {
    case kOverRays:
      return squares(kernels_.gather, most_rays);
    case kOverTexels:
      return squares(kernels_.blend_solution, tile_texels());
    case kOverIrradianceGutters:
      return squares(kernels_.gutters, gutter_texels(settings_.irradiance_texels));
    case kOverDistanceGutters:
      return squares(kernels_.gutters, gutter_texels(settings_.distance_texels));
    case kOverLaneGroups:
      return {0u, kGroupLanes / kLaneGroupSize, 0u};
    case kOverIrradianceBlocks:
      return products(settings_.irradiance_texels, kIrradianceBlock);
    case kOverDistanceBlocks:
      return products(settings_.distance_texels, kDistanceBlock);
    case kOverLanes:
      return {0u, kGroupLanes, 0u};
    case kOverProbes:
      return {0u, 1u, 0u};
    default:
      return {static_cast<uint>(most_rays), 1u, 0u};
  }
}

GroupCounts FieldResources::groups_over(const DeviceProbes& list, uint shape) const {
  return list_groups(list_size(shape, list.most_rays), static_cast<uint>(list.count()),
                     static_cast<uint>(list.block_count));
}

/// Records a kernel of transport over a list, or over the number of groups that the solve has
/// written to `groups`.
template <class Arguments>
void FieldResources::run_transport(vulkan::Recorder& to, const vulkan::Kernel& kernel,
                                   const Arguments& arguments, const DeviceProbes& list, uint shape,
                                   const TransportGroups& groups, std::size_t offset) const {
  if (groups.buffer != nullptr) {
    to.run_indirect(kernel, arguments, *groups.buffer, offset);
  } else {
    run_over(to, kernel, arguments, list, shape);
  }
  to.barrier();
}

void FieldResources::record_transport(vulkan::Recorder& to, const DeviceProbes& list,
                                      const DeviceTransport& transport,
                                      const TransportGroups& groups) const {
  const GatherArguments gather = {arrays(list),
                                  {corners_.address()},
                                  {surfels_.address()},
                                  {lookup_records_.address()},
                                  transport.field,
                                  {radiance_.address()},
                                  list.count(),
                                  stride_,
                                  round_up(list.most_rays, kLaneGroupSize),
                                  transport.light};
  run_transport(to, kernels_.gather, gather, list, kOverRays, groups, groups.rays);
  record_receive(to, list, transport, groups);
}

void FieldResources::record_receive(vulkan::Recorder& to, const DeviceProbes& list,
                                    const DeviceTransport& transport,
                                    const TransportGroups& groups) const {
  const ReceiveArguments receive = {
      arrays(list),          list.block_array(),
      {radiance_.address()}, {at_centres_.address()},
      list.block_count,      round_up(list.most_rays, kLaneGroupSize)};
  const FitArguments fit = {
      {fit_.address()},        list.block_array(),
      {at_centres_.address()}, transport.fallback,
      transport.history_ratio, transport.received,
      list.block_count,        transport.history_ratio.address != 0 ? 1u : 0u};
  run_transport(to, kernels_.receive, receive, list, kOverIrradianceBlocks, groups, groups.blocks);
  run_transport(to, kernels_.fit, fit, list, kOverIrradianceBlocks, groups, groups.blocks);
}

void FieldResources::record_store_light(vulkan::Recorder& to, const DeviceProbes& list,
                                        uint dither_seed, UintArray changed) const {
  const UintArray words = {irradiance_.address()};
  const StoreIrradianceArguments arguments = {words,
                                              list.index_array(),
                                              {light_.address()},
                                              changed,
                                              list.count(),
                                              dither_seed,
                                              changed.address != 0 ? 1u : 0u,
                                              0u};
  run_over(to, kernels_.store_irradiance, arguments, list, kOverTexels);
  to.barrier();
  const GuttersArguments gutters = {words, list.index_array(), list.count(),
                                    settings_.irradiance_texels, words_per_irradiance_texel_};
  run_over(to, kernels_.gutters, gutters, list, kOverIrradianceGutters);
  to.barrier();
}

void FieldResources::record_compare_light(vulkan::Recorder& to, const DeviceProbes& list,
                                          Vec4Array before, Vec3Array changes) const {
  const CompareLightArguments arguments = {
      list.index_array(), {light_.address()}, before, changes, list.count(), 0};
  run_over(to, kernels_.compare_light, arguments, list, kOverLanes);
  to.barrier();
}

void FieldResources::record_lookup(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                                   Vec3Array irradiance, const DeviceTracer* tracer,
                                   const CorrectionArrays& corrections) const {
  if (count == 0) return;
  if (cell_visibility_ && tracer != nullptr) {
    record_lookup_by_rays(to, queries, count, irradiance, *tracer, corrections);
    return;
  }
  const std::uint32_t width = std::min(count, kLookupRow);
  const LookupArguments arguments = {
      store(),    queries, irradiance, static_cast<int>(count), static_cast<int>(kLookupRow),
      corrections};
  to.run(kernels_.lookup, arguments, width, groups_of(static_cast<int>(count), kLookupRow));
  to.barrier();
}

void FieldResources::record_find_lookups(vulkan::Recorder& to, QueryArray queries,
                                         std::uint32_t count, LookupArray lookups,
                                         const DeviceTracer* tracer,
                                         const CorrectionArrays& corrections) const {
  const auto all = static_cast<int>(count);
  assert(!cell_visibility_ || all <= cell_visibility_->points() / kQueryRow * kQueryRow);
  const LookupPoints points = {{},
                               {},
                               queries,
                               static_cast<int>(groups_of(all, kQueryRow)),
                               kQueryRow,
                               all,
                               cell_visibility_ && cell_visibility_->exact() ? 1u : 0u};
  const FindLookupsArguments found = {store(), points, lookups, corrections};
  to.run(kernels_.find_lookups, found, kQueryRow, points.rows);
  to.barrier();
  if (!cell_visibility_ || tracer == nullptr) return;
  cell_visibility_->record_rows(to, {points.rows});
  cell_visibility_->record_corner_tests(to, *tracer, store(), points, /*first=*/0, lookups,
                                        kQueryRow);
}

/// Records a lookup with visibility by rays, for a limited number of points at a time.
void FieldResources::record_lookup_by_rays(vulkan::Recorder& to, QueryArray queries,
                                           std::uint32_t count, Vec3Array irradiance,
                                           const DeviceTracer& tracer,
                                           const CorrectionArrays& corrections) const {
  const auto most = static_cast<std::uint32_t>(cell_visibility_->points() / kQueryRow * kQueryRow);
  for (std::uint32_t first = 0; first < count; first += most) {
    const std::uint32_t some = std::min(most, count - first);
    const QueryArray asked{queries.address + first * sizeof(QueryRecord)};
    record_find_lookups(to, asked, some, cell_visibility_->lookups(), &tracer, corrections);
    cell_visibility_->record_reading(to, {store(),
                                          asked,
                                          cell_visibility_->lookups(),
                                          {irradiance.address + first * sizeof(vec3)},
                                          static_cast<int>(some)});
  }
}

void FieldResources::record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer,
                                            IntArray cells, int count) const {
  assert(cell_visibility_);
  cell_visibility_->record_cell_visibility(to, tracer, store(), cells, count);
}

void FieldResources::record_visibility_around(vulkan::Recorder& to, const DeviceTracer& tracer,
                                              const DeviceProbes& list) const {
  assert(cell_visibility_);
  cell_visibility_->record_visibility_around(to, tracer, store(), list.index_array(),
                                             {list.count(), list.chosen});
}

void FieldResources::take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const {
  if (cell_visibility_) cell_visibility_->take_ray_count(to, count);
}

}  // namespace lambent
