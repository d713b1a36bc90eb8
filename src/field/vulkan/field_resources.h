// SPDX-License-Identifier: Apache-2.0
// A field in a device's memory, and its passes, as they are recorded. Each pass names what it is
// the twin of; what a pass reads must be visible before, and what it writes is afterwards.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "field/transport/list_sizes.h"
#include "field/transport/solve_bounces.h"
#include "field/transport/surfels.h"
#include "field/vulkan/device_arguments.h"
#include "field/vulkan/device_kernels.h"
#include "field/vulkan/device_visibility.h"
#include "vulkan/buffer.h"
#include "vulkan/recorder.h"

namespace lambent {

/// Probes that passes work on. Those that last traced the same rays follow one another.
struct DeviceProbes {
  std::vector<int> probes;            ///< In the list's order.
  std::vector<std::size_t> position;  ///< In the list, of each probe as the caller named it.
  int most_rays = 0;                  ///< Of any of them.
  int block_count = 0;
  vulkan::Buffer indices, ray_sets, blocks;
  /// Where the device decides how many they are: a buffer that begins with a ListState; count() and
  /// block_count are the most then.
  const vulkan::Buffer* chosen = nullptr;
  RaySetArray sets;  ///< What ray_sets point into; none where its address is 0: the field's own.

  int count() const { return static_cast<int>(probes.size()); }
  IntArray index_array() const { return {indices.address()}; }
  ProbeBlockArray block_array() const { return {blocks.address()}; }
};

/// What transport reads and writes. `field`: of all probes; the others of the list's.
struct DeviceTransport {
  Vec4Array field, fallback;
  Vec4Array history_ratio;  ///< None where its address is 0.
  Vec4Array received;
  uint light = kGatherAll;  ///< Or kGatherDirect, kGatherSky.
};

/// Where the groups of its kernels are read from, if the device decides; bytes into the buffer.
struct TransportGroups {
  const vulkan::Buffer* buffer = nullptr;
  std::size_t rays = 0, blocks = 0;
};

/// Part of a list, all of which traces the same rays now.
struct DeviceGroup {
  int first = 0;  ///< Of the list.
  int count = 0;
  int rays = 0;  ///< Of a probe.
};

class FieldResources {
 public:
  /// Of the store's shape, without light. The device must outlive it.
  FieldResources(const vulkan::Device& device, const FieldSettings& settings,
                 const ProbeStore& shape);

  const vulkan::Device& device() const { return device_; }
  const FieldKernels& kernels() const { return kernels_; }
  const FieldSettings& settings() const { return settings_; }
  int probes() const { return probes_; }
  int volumes() const { return volumes_; }
  int tile_texels() const { return settings_.irradiance_texels * settings_.irradiance_texels; }
  int lookups_per_surfel() const { return lookups_; }
  std::size_t surfel_bytes() const { return surfels_.bytes() + lookup_records_.bytes(); }

  // What the store consists of.
  StoreArrays store() const;
  const vulkan::Buffer& grids() const { return grids_; }
  const vulkan::Buffer& offsets() const { return offsets_; }
  const vulkan::Buffer& irradiance() const { return irradiance_; }
  const vulkan::Buffer& distance() const { return distance_; }
  /// Of all probes, so many each.
  SurfelArray surfels() const { return {surfels_.address()}; }
  int surfel_stride() const { return stride_; }

  // Up and down. None may be called while the device works with the field.

  /// Where probes stand: grids and offsets.
  void set_places(const ProbeStore& store);
  /// All encoded tiles, or those of distances of some probes.
  void write_store(const ProbeStore& store);
  void write_distances(const ProbeStore& store, std::span<const int> probes);
  void read_store(ProbeStore& store) const;
  /// What some probes' rays met, with their lookups.
  void write_surfels(std::span<const int> probes, std::span<const ProbeTrace> traces);
  /// The lookups of a probe's surfels, `lookups_per_surfel` each.
  std::vector<SurfelLookup> read_lookups(int probe) const;
  std::vector<SurfelRecord> read_surfels(int probe) const;
  /// Light of all probes, before it was encoded: of the field, ...
  const vulkan::Buffer& light() const { return light_; }
  /// ... and as their last rays told it.
  const vulkan::Buffer& last_irradiance_estimate() const { return last_irradiance_estimate_; }

  /// Has probes trace these rays from now on, or none.
  void set_rays(std::span<const int> probes, const std::shared_ptr<const RaySet>& rays);
  /// Null: never traced.
  std::shared_ptr<const RaySet> rays_of(int probe) const;

  /// A list of probes that have rays.
  DeviceProbes list(std::span<const int> probes) const;

  // For rays that the caller keeps, in lists that the caller makes.

  /// Makes room for so many surfels a probe; those that there are stay.
  void reserve_surfels(int rays);
  /// Bytes of the matrices of so many rays.
  std::size_t irradiance_weight_bytes(int rays) const;
  std::size_t distance_weight_bytes(int rays) const;
  /// Fills the matrices of rays.
  void record_weights(vulkan::Recorder& to, Vec3Array directions, int rays, FloatArray irradiance,
                      FloatArray distance) const;

  // Kernels over a list; the shape is one of list_sizes.h.

  ListSize list_size(uint shape, int most_rays) const;
  GroupCounts groups_over(const DeviceProbes& list, uint shape) const;
  template <class Arguments>
  void run_over(vulkan::Recorder& to, const vulkan::Kernel& kernel, const Arguments& arguments,
                const DeviceProbes& list, uint shape) const {
    if (list.chosen != nullptr) {
      to.run_indirect(kernel, arguments, *list.chosen, shape * sizeof(GroupCounts));
      return;
    }
    const GroupCounts groups = groups_over(list, shape);
    to.run(kernel, arguments, groups.x * kernel.group_size(0), groups.y * kernel.group_size(1));
  }

  // Passes.

  /// As trace_probe_rays: the rays of a group, count x rays.
  void record_rays(vulkan::Recorder& to, const DeviceProbes& list, const DeviceGroup& group,
                   RayArray rays) const;
  /// As make_surfel, of what a group's rays met.
  void record_surfels(vulkan::Recorder& to, const DeviceProbes& list, const DeviceGroup& group,
                      LitPointArray points, ShadedHitArray shaded, Vec3Array irradiance) const;
  /// As blend_distances, in two parts: what each group's rays saw, once it has surfels; and what
  /// all of the list's did, into the store. `shares`: of the list's probes.
  void record_seen_distances(vulkan::Recorder& to, const DeviceProbes& list,
                             const DeviceGroup& group, HitArray hits);
  void record_blend_distances(vulkan::Recorder& to, const DeviceProbes& list,
                              FloatArray blend_weights, uint dither_seed);
  /// The first part of all of a list's rays, from their surfels.
  void record_seen_surfels(vulkan::Recorder& to, const DeviceProbes& list);
  /// Makes room for what a list's rays see: before the former are recorded.
  void reserve_seen(const DeviceProbes& list);
  /// Moves the stored distances of a list's probes by as much as those of their surfels changed
  /// between the two, as invalidate_surfels does. Makes room before it records.
  void record_distances_before(vulkan::Recorder& to, const DeviceProbes& list);
  void record_move_distances(vulkan::Recorder& to, const DeviceProbes& list, uint dither_seed);
  /// As CellVisibility::look, of a field that sees by rays; `cells` as of cells_around.
  void record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer, IntArray cells,
                              int count) const;
  /// As find_surfel_lookups. `tracer`: of the rays that the settings' visibility asks, with the
  /// scene's textures bound; null: by distances.
  void record_lookups(vulkan::Recorder& to, const DeviceProbes& list,
                      const DeviceTracer* tracer = nullptr) const;
  /// Copies the number of rays that lookups asked since the last time into the buffer (one word);
  /// it stays as it is where none does.
  void take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const;

  /// As TransportOperator::apply, apply_direct and apply_sky.
  void record_transport(vulkan::Recorder& to, const DeviceProbes& list,
                        const DeviceTransport& transport, const TransportGroups& groups = {}) const;
  /// Its second half alone: from the radiance that was gathered last.
  void record_receive(vulkan::Recorder& to, const DeviceProbes& list,
                      const DeviceTransport& transport, const TransportGroups& groups = {}) const;
  /// Makes room for both: before they are recorded.
  void reserve_transport(const DeviceProbes& list);

  /// As ProbeStore::store_irradiance, of the field's light.
  void record_store_light(vulkan::Recorder& to, const DeviceProbes& list, uint dither_seed) const;
  /// As ImportanceScatter of importance.h, for a list of those that send; `sent` was 0.
  void record_scatter_importance(vulkan::Recorder& to, const DeviceProbes& list,
                                 FloatArray received, UintArray sent, float scale) const;
  /// Remembers what the list's probes' rays told; see State::store_last_estimates.
  void record_last_estimates(vulkan::Recorder& to, const DeviceProbes& list,
                             Vec4Array solution) const;
  /// As relative_square and mean_luminance of tile_light.h: of what the field holds to what the
  /// list's probes held.
  void record_compare_light(vulkan::Recorder& to, const DeviceProbes& list, Vec4Array before,
                            float darkest, Vec3Array changes) const;
  /// As lookup_irradiance; `tracer` as of record_lookups.
  void record_lookup(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                     Vec3Array irradiance, const DeviceTracer* tracer = nullptr) const;

 private:
  /// Rays that some probes traced last.
  struct RaySlot {
    std::shared_ptr<const RaySet> rays;
    vulkan::Buffer directions, irradiance_weights, distance_weights;
    int users = 0;
  };
  int slot_for(const std::shared_ptr<const RaySet>& rays);
  void fill_weights(RaySlot& slot) const;
  void write_sets();
  void record_see_surfels(vulkan::Recorder& to, const DeviceProbes& list, FloatArray seen,
                          UintArray blocked) const;
  template <class Arguments>
  void run_transport(vulkan::Recorder& to, const vulkan::Kernel& kernel, const Arguments& arguments,
                     const DeviceProbes& list, uint shape, const TransportGroups& groups,
                     std::size_t offset) const;
  void record_distance_gutters(vulkan::Recorder& to, const DeviceProbes& list) const;
  void record_lookup_by_rays(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                             Vec3Array irradiance, const DeviceTracer& tracer) const;
  ProbeList arrays(const DeviceProbes& list, int first = 0) const;

  const vulkan::Device& device_;
  FieldSettings settings_;
  int probes_, volumes_, lookups_;
  int words_per_irradiance_texel_, words_per_distance_texel_;
  const FieldKernels& kernels_;
  std::unique_ptr<DeviceVisibility> cell_visibility_;  // null: nothing is seen by rays
  vulkan::Buffer grids_, offsets_, irradiance_, distance_, corners_, fit_;
  vulkan::Buffer light_, last_irradiance_estimate_;
  vulkan::Buffer surfels_, lookup_records_;  // probes x stride_ (x lookups_)
  int stride_ = 0;
  std::vector<RaySlot> slots_;
  std::vector<int> slot_of_;  // of each probe; -1: none
  vulkan::Buffer sets_;       // RaySetRecords of the slots
  // What passes hand on to each other
  vulkan::Buffer seen_, blocked_, radiance_, at_centres_;
  vulkan::Buffer seen_before_, blocked_before_;
};

}  // namespace lambent
