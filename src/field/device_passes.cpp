// SPDX-License-Identifier: Apache-2.0
// Recording the passes of a field.
#include <cassert>

#include "field/device_field.h"
#include "field/device_memory.h"

namespace lambent {
namespace {

// Points in a row of a lookup's dispatch: rows are whole groups, and few enough.
constexpr std::uint32_t kLookupRow = 1u << 20;

// Queries in a row of points that look the field up: so that a group's follow one another.
constexpr int kQueryRow = 8;

template <class Array>
Array from(const vulkan::Buffer& buffer, std::size_t first, std::size_t size) {
  return {buffer.address() + first * size};
}

/// Part of a list's array of indices.
IntArray indices_from(const DeviceProbes& list, int first) {
  return from<IntArray>(list.indices, static_cast<std::size_t>(first), sizeof(int));
}

/// Runs so many groups of a kernel, or as many as the device says.
template <class Arguments>
void run_groups(vulkan::Recorder& to, const vulkan::Kernel& kernel, const Arguments& arguments,
                const GroupCounts& count, const TransportGroups& groups, std::size_t offset) {
  if (groups.buffer != nullptr) {
    to.run_indirect(kernel, arguments, *groups.buffer, offset);
  } else {
    to.run(kernel, arguments, count.x * kernel.group_size(0), count.y * kernel.group_size(1));
  }
  to.barrier();
}

}  // namespace

ProbeList DeviceField::arrays(const DeviceProbes& list, int first) const {
  const RaySetArray own = {sets_.address()};
  return {indices_from(list, first),
          from<IntArray>(list.ray_sets, static_cast<std::size_t>(first), sizeof(int)),
          list.sets.address != 0 ? list.sets : own};
}

StoreArrays DeviceField::store() const {
  return {{grids_.address()}, {offsets_.address()}, {irradiance_.address()}, {distance_.address()}};
}

void DeviceField::record_rays(vulkan::Recorder& to, const DeviceProbes& list,
                              const DeviceGroup& group, RayArray rays) const {
  const RaySlot& slot = slots_[slot_of_[list.probes[group.first]]];
  const ProbeRaysArguments arguments = {
      store(),   indices_from(list, group.first), {slot.directions.address()}, rays, group.count,
      group.rays};
  to.run(kernels_.probe_rays, arguments, group.rays, group.count);
  to.barrier();
}

void DeviceField::record_surfels(vulkan::Recorder& to, const DeviceProbes& list,
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

void DeviceField::reserve_seen(const DeviceProbes& list) {
  const auto count = static_cast<std::size_t>(list.count());
  reserve<float>(device_, count * round_up(list.most_rays, kClusterLanes), "seen distances", seen_);
  reserve<uint>(device_, count, "probes in solid matter", blocked_);
}

void DeviceField::record_seen_distances(vulkan::Recorder& to, const DeviceProbes& list,
                                        const DeviceGroup& group, HitArray hits) {
  const int seen_stride = round_up(list.most_rays, kClusterLanes);
  const auto first = static_cast<std::size_t>(group.first);
  const SeeDistancesArguments arguments = {
      {grids_.address()},
      indices_from(list, group.first),
      hits,
      {surfels_.address()},
      from<FloatArray>(seen_, first * seen_stride, sizeof(float)),
      from<UintArray>(blocked_, first, sizeof(uint)),
      group.count,
      group.rays,
      stride_,
      seen_stride};
  to.run(kernels_.see_distances, arguments, group.count * kClusterLanes);
  to.barrier();
}

void DeviceField::record_blend_distances(vulkan::Recorder& to, const DeviceProbes& list,
                                         FloatArray shares, uint salt) {
  const int edge = settings_.distance_texels;
  const BlendDistancesArguments arguments = {store(),
                                             arrays(list),
                                             list.block_array(),
                                             {seen_.address()},
                                             {blocked_.address()},
                                             shares,
                                             list.block_count,
                                             round_up(list.most_rays, kClusterLanes),
                                             salt};
  to.run(kernels_.blend_distances, arguments, groups_of(edge * edge, kDistanceBlock) * kGroupLanes,
         groups_of(list.block_count, kGroupLanes / kClusterLanes));
  to.barrier();
  record_gutters(to, {distance_.address()}, list.index_array(), list.count(), edge,
                 words_per_distance_texel_);
}

void DeviceField::record_gutters(vulkan::Recorder& to, UintArray words, IntArray probes, int count,
                                 int texels, int words_per_texel) const {
  const GuttersArguments arguments = {words, probes, count, texels, words_per_texel};
  to.run(kernels_.gutters, arguments, gutter_texels(texels), count);
  to.barrier();
}

void DeviceField::record_lookups(vulkan::Recorder& to, const DeviceProbes& list,
                                 const DeviceTracer* tracer) const {
  const auto points = [&](int first, int rows) {
    return LookupPoints{arrays(list, first),
                        {surfels_.address()},
                        {},
                        rows,
                        stride_,
                        0,
                        sights_ && sights_->exact() ? 1u : 0u};
  };
  const LookupArray lookups{lookup_records_.address()};
  const FindLookupsArguments arguments = {store(), points(0, list.count()), lookups};
  to.run(kernels_.find_lookups, arguments, list.most_rays, list.count());
  to.barrier();
  if (!sights_ || tracer == nullptr) return;
  const int rows = sights_->points() / stride_;
  for (int first = 0; first < list.count(); first += rows) {
    const int some = std::min(rows, list.count() - first);
    sights_->record_weighing(to, *tracer, store(), points(first, some), lookups, list.most_rays);
  }
}

void DeviceField::reserve_transport(const DeviceProbes& list) {
  const auto count = static_cast<std::size_t>(list.count());
  reserve<vec4>(device_, count * round_up(list.most_rays, kClusterLanes), "radiance", radiance_);
  reserve<vec4>(device_, count * tile_texels(), "irradiance at centres", at_centres_);
}

TransportSize DeviceField::transport_size(const DeviceProbes& list) const {
  const std::uint32_t blocks = groups_of(list.block_count, kGroupLanes / kClusterLanes);
  const std::uint32_t columns = groups_of(tile_texels(), kIrradianceBlock);
  const auto x = static_cast<int>(kernels_.gather.group_size(0));
  const auto y = static_cast<int>(kernels_.gather.group_size(1));
  return {{groups_of(round_up(list.most_rays, kClusterLanes), x), groups_of(list.count(), y), 1},
          {columns, blocks, 1},
          {columns, blocks, 1}};
}

void DeviceField::record_transport(vulkan::Recorder& to, const DeviceProbes& list,
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
                                  round_up(list.most_rays, kClusterLanes),
                                  transport.light};
  run_groups(to, kernels_.gather, gather, transport_size(list).over_rays, groups, groups.rays);
  record_receive(to, list, transport, groups);
}

void DeviceField::record_receive(vulkan::Recorder& to, const DeviceProbes& list,
                                 const DeviceTransport& transport,
                                 const TransportGroups& groups) const {
  const ReceiveArguments receive = {arrays(list),          list.block_array(),
                                    {radiance_.address()}, {at_centres_.address()},
                                    list.block_count,      round_up(list.most_rays, kClusterLanes)};
  const FitArguments fit = {{fit_.address()},        list.block_array(),
                            {at_centres_.address()}, transport.fallback,
                            transport.gain,          transport.received,
                            list.block_count,        transport.gain.address != 0 ? 1u : 0u};
  const TransportSize size = transport_size(list);
  run_groups(to, kernels_.receive, receive, size.over_receive_blocks, groups,
             groups.receive_blocks);
  run_groups(to, kernels_.fit, fit, size.over_fit_blocks, groups, groups.fit_blocks);
}

void DeviceField::record_store_light(vulkan::Recorder& to, IntArray probes, int count,
                                     uint salt) const {
  const UintArray words = {irradiance_.address()};
  const StoreIrradianceArguments arguments = {words, probes, {light_.address()}, count, salt};
  to.run(kernels_.store_irradiance, arguments, tile_texels(), count);
  to.barrier();
  record_gutters(to, words, probes, count, settings_.irradiance_texels,
                 words_per_irradiance_texel_);
}

void DeviceField::record_compare_light(vulkan::Recorder& to, const DeviceProbes& list,
                                       Vec4Array before, float darkest, Vec3Array changes) const {
  const CompareLightArguments arguments = {
      list.index_array(), {light_.address()}, before, changes, list.count(), darkest};
  to.run(kernels_.compare_light, arguments, list.count());
  to.barrier();
}

void DeviceField::record_lookup(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                                Vec3Array irradiance, const DeviceTracer* tracer) const {
  if (count == 0) return;
  if (sights_ && tracer != nullptr) {
    record_lookup_by_rays(to, queries, count, irradiance, *tracer);
    return;
  }
  const std::uint32_t width = std::min(count, kLookupRow);
  const LookupArguments arguments = {store(), queries, irradiance, static_cast<int>(count),
                                     static_cast<int>(kLookupRow)};
  to.run(kernels_.lookup, arguments, width, groups_of(static_cast<int>(count), kLookupRow));
  to.barrier();
}

/// The same where rays tell which probes are seen, some points at a time.
void DeviceField::record_lookup_by_rays(vulkan::Recorder& to, QueryArray queries,
                                        std::uint32_t count, Vec3Array irradiance,
                                        const DeviceTracer& tracer) const {
  const auto most = static_cast<std::uint32_t>(sights_->points() / kQueryRow * kQueryRow);
  for (std::uint32_t first = 0; first < count; first += most) {
    const auto some = static_cast<int>(std::min(most, count - first));
    const QueryArray asked{queries.address + first * sizeof(QueryRecord)};
    const LookupPoints points = {{},
                                 {},
                                 asked,
                                 static_cast<int>(groups_of(some, kQueryRow)),
                                 kQueryRow,
                                 some,
                                 sights_->exact() ? 1u : 0u};
    const FindLookupsArguments found = {store(), points, sights_->lookups()};
    to.run(kernels_.find_lookups, found, kQueryRow, points.rows);
    to.barrier();
    sights_->record_weighing(to, tracer, store(), points, sights_->lookups(), kQueryRow);
    sights_->record_reading(
        to,
        {store(), asked, sights_->lookups(), {irradiance.address + first * sizeof(vec3)}, some});
  }
}

void DeviceField::record_look(vulkan::Recorder& to, const DeviceTracer& tracer, IntArray cells,
                              int count) const {
  assert(sights_);
  sights_->record_look(to, tracer, store(), cells, count);
}

void DeviceField::take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const {
  if (sights_) sights_->take_ray_count(to, count);
}

}  // namespace lambent
