// SPDX-License-Identifier: Apache-2.0
// A field in a device's memory, and functions that record its passes. What a pass reads must be
// visible before it, and what it writes is visible after it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/correction/device_corrections.h"
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

/// A list of probes that passes work on. Probes that last traced the same ray set are consecutive.
struct DeviceProbes {
  std::vector<int> probes;  ///< The probes' indices, in the list's order.
  std::vector<std::size_t>
      position;       ///< For each probe in the caller's order, its place in the list.
  int most_rays = 0;  ///< The largest number of rays of a probe.
  int block_count = 0;
  vulkan::Buffer indices, ray_sets, blocks;
  /// Where the device decides the length of the list, a buffer that begins with a ListState.
  /// count() and block_count are then upper bounds.
  const vulkan::Buffer* chosen = nullptr;
  RaySetArray sets;  ///< The sets that ray_sets index; the field's own where its address is 0.

  int count() const { return static_cast<int>(probes.size()); }
  IntArray index_array() const { return {indices.address()}; }
  ProbeBlockArray block_array() const { return {blocks.address()}; }
};

/// The arrays that transport reads and writes. `field` has the texels of all probes, and the others
/// those of the list.
struct DeviceTransport {
  Vec4Array field, fallback;
  Vec4Array history_ratio;  ///< There is none where its address is 0.
  Vec4Array received;
  uint light = kGatherAll;  ///< kGatherAll or kGatherSky.
};

/// The buffer from which the workgroup counts of transport's kernels are read where the device
/// decides them, and their byte offsets in it. Null where the host decides them.
struct TransportGroups {
  const vulkan::Buffer* buffer = nullptr;
  std::size_t rays = 0, blocks = 0;
};

/// Consecutive probes of a list that now trace the same ray set.
struct DeviceGroup {
  int first = 0;  ///< Place of the first probe in the list.
  int count = 0;
  int rays = 0;  ///< Rays per probe.
};

class FieldResources {
 public:
  /// Makes an empty field of the store's shape. The device must outlive it.
  FieldResources(const vulkan::Device& device, const FieldSettings& settings,
                 const ProbeStore& shape);

  const vulkan::Device& device() const { return device_; }
  const FieldKernels& kernels() const { return kernels_; }
  const FieldSettings& settings() const { return settings_; }
  int probes() const { return probes_; }
  int volumes() const { return volumes_; }
  int tile_texels() const { return settings_.irradiance_texels * settings_.irradiance_texels; }
  int lookups_per_surfel() const { return lookups_; }
  std::size_t bytes() const;
  std::size_t surfel_bytes() const { return surfels_.bytes() + lookup_records_.bytes(); }

  // The store's arrays and buffers.
  StoreArrays store() const;
  const vulkan::Buffer& grids() const { return grids_; }
  const vulkan::Buffer& offsets() const { return offsets_; }
  const vulkan::Buffer& irradiance() const { return irradiance_; }
  const vulkan::Buffer& distance() const { return distance_; }
  /// Words of a probe's distance tile, gutter included.
  int distance_words() const;
  /// The surfels of all probes, surfel_stride() per probe.
  SurfelArray surfels() const { return {surfels_.address()}; }
  int surfel_stride() const { return stride_; }

  // Transfers. None may be called while the device uses the field.

  /// Uploads the grids and the probes' offsets.
  void set_places(const ProbeStore& store);
  /// Uploads grids, offsets and all encoded tiles.
  void write_store(const ProbeStore& store);
  /// Uploads the encoded distance tiles of some probes.
  void write_distances(const ProbeStore& store, std::span<const int> probes);
  /// Reads all encoded tiles back.
  void read_store(ProbeStore& store) const;
  /// Uploads the surfels of some probes, with their lookups.
  void write_surfels(std::span<const int> probes, std::span<const ProbeTrace> traces);
  /// Reads the lookups of a probe's surfels back, `lookups_per_surfel` each.
  std::vector<SurfelLookup> read_lookups(int probe) const;
  /// Reads the surfels of a probe back.
  std::vector<SurfelRecord> read_surfels(int probe) const;
  /// The light of all probes before encoding.
  const vulkan::Buffer& light() const { return light_; }
  /// The irradiance that the last rays of each probe estimated.
  const vulkan::Buffer& last_irradiance_estimate() const { return last_irradiance_estimate_; }

  /// Assigns a ray set to probes; null discards their surfels.
  void set_rays(std::span<const int> probes, const std::shared_ptr<const RaySet>& rays);
  /// The ray set of a probe's surfels; null where it has none.
  std::shared_ptr<const RaySet> rays_of(int probe) const;

  /// Makes a list of probes, all of which must have a ray set.
  DeviceProbes list(std::span<const int> probes) const;

  // For callers that manage ray sets and lists themselves.

  /// The field's corrections of lookups, which surfels and lookups read.
  DeviceCorrections& corrections() { return corrections_; }
  const DeviceCorrections& corrections() const { return corrections_; }
  /// The ray set of a probe's surfels, as an index into ray_sets().
  int ray_set_of(int probe) const { return slot_of_[probe]; }
  RaySetArray ray_sets() const { return {sets_.address()}; }

  /// Reserves memory for this many surfels per probe. Existing surfels stay.
  void reserve_surfels(int rays);
  /// Bytes of the matrices of a ray set with this many rays.
  std::size_t irradiance_weight_bytes(int rays) const;
  std::size_t distance_weight_bytes(int rays) const;
  /// Records the computation of a ray set's matrices.
  void record_weights(vulkan::Recorder& to, Vec3Array directions, int rays, FloatArray irradiance,
                      FloatArray distance) const;

  // Kernels that work on a list. Shapes are those of list_sizes.h.

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

  /// Records the rays of a group, count x rays of them. See trace_probe_rays().
  void record_rays(vulkan::Recorder& to, const DeviceProbes& list, const DeviceGroup& group,
                   RayArray rays) const;
  /// Records the surfels of a group's shaded hits. See make_surfel().
  void record_surfels(vulkan::Recorder& to, const DeviceProbes& list, const DeviceGroup& group,
                      LitPointArray points, ShadedHitArray shaded, Vec3Array irradiance) const;
  /// The twin of blend_distances() in two parts. record_seen_distances() records the distances of
  /// the rays of a group, which must have surfels. record_blend_distances() records the blending of
  /// the distances of the whole list into the store. `blend_weights` are of the list.
  void record_seen_distances(vulkan::Recorder& to, const DeviceProbes& list,
                             const DeviceGroup& group, HitArray hits);
  void record_blend_distances(vulkan::Recorder& to, const DeviceProbes& list,
                              FloatArray blend_weights, uint dither_seed);
  /// Records what record_seen_distances() does, for all rays of a list, from their surfels.
  void record_seen_surfels(vulkan::Recorder& to, const DeviceProbes& list);
  /// Reserves memory for the distances of a list's rays. Must be called before the functions above
  /// that record or blend distances.
  void reserve_seen(const DeviceProbes& list);
  /// record_rays_before() keeps the distances of a list's surfels and the direct light along their
  /// rays. It reserves memory if reserve_rays_before() has not been called. record_move_distances()
  /// then shifts the probes' stored distances by the change since, like invalidate_surfels().
  void record_rays_before(vulkan::Recorder& to, const DeviceProbes& list);
  void reserve_rays_before(const DeviceProbes& list);
  /// Records the sums of the list's probes over direct light then and now.
  void record_edited_light(vulkan::Recorder& to, const DeviceProbes& list,
                           EditedLightArray edited) const;
  /// One word per probe of the list: 1 where it stood inside geometry before, or has no distances
  /// from before for another reason (kNoDistancesBefore in edits/edit_arguments.h).
  UintArray blocked_before() const { return {blocked_before_.address()}; }
  void record_move_distances(vulkan::Recorder& to, const DeviceProbes& list, uint dither_seed);
  /// Records CellVisibility::update() of a field with visibility by rays. `cells` come from
  /// cells_around().
  void record_cell_visibility(vulkan::Recorder& to, const DeviceTracer& tracer, IntArray cells,
                              int count) const;
  /// Records the same for all cells around a list's probes, which the device finds.
  void record_visibility_around(vulkan::Recorder& to, const DeviceTracer& tracer,
                                const DeviceProbes& list) const;
  /// Reserves memory for that. Must be called before.
  void reserve_visibility_around();
  /// Two words a probe, as DeviceVisibility::of_cells(); of address 0 where visibility is by
  /// distances only.
  UintArray cell_visibility() const;
  /// Records find_surfel_lookups(). `tracer` traces the visibility rays, with the scene's textures
  /// bound. Where it is null, visibility is by distances.
  void record_lookups(vulkan::Recorder& to, const DeviceProbes& list,
                      const DeviceTracer* tracer = nullptr) const;
  /// Records a copy of the number of visibility rays since the last call into a buffer of one word,
  /// and resets the count. Leaves the buffer as it is in fields without visibility by rays.
  void take_ray_count(vulkan::Recorder& to, const vulkan::Buffer& count) const;

  /// Records TransportOperator::apply or apply_sky.
  void record_transport(vulkan::Recorder& to, const DeviceProbes& list,
                        const DeviceTransport& transport, const TransportGroups& groups = {}) const;
  /// Records only the second half of record_transport(), after the gathering of radiance. It reads
  /// the radiance that was gathered last.
  void record_receive(vulkan::Recorder& to, const DeviceProbes& list,
                      const DeviceTransport& transport, const TransportGroups& groups = {}) const;
  /// Reserves memory for the two functions above. Must be called before them.
  void reserve_transport(const DeviceProbes& list);

  /// Records ProbeStore::store_irradiance() of the field's light for the list's probes. Where there
  /// is an array `changed`, for those only that have a 1 in it.
  void record_store_light(vulkan::Recorder& to, const DeviceProbes& list, uint dither_seed,
                          UintArray changed = {}) const;
  /// Records ImportanceScatter of importance.h for a list of the probes that scatter. `sent` must
  /// be filled with 0.
  void record_scatter_importance(vulkan::Recorder& to, const DeviceProbes& list,
                                 FloatArray received, UintArray sent, float scale) const;
  /// Records that a solution becomes the last estimates of a list's probes. See
  /// store_last_estimates() in edits/history_ratio.h.
  void record_last_estimates(vulkan::Recorder& to, const DeviceProbes& list,
                             Vec4Array solution) const;
  /// Records light_change() of tile_light.h, from `before`, the earlier light of the list's probes,
  /// to their current light.
  void record_compare_light(vulkan::Recorder& to, const DeviceProbes& list, Vec4Array before,
                            Vec3Array changes) const;
  /// Records lookup_irradiance(). For `tracer`, see record_lookups(). `corrections` is the table
  /// that lookups read; none: lookups are not corrected.
  void record_lookup(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                     Vec3Array irradiance, const DeviceTracer* tracer = nullptr,
                     const CorrectionArrays& corrections = {}) const;
  /// Records find_weights() of queries, lookups_per_surfel() lookups each. In fields with
  /// visibility by rays, `count` is at most DeviceVisibility::points(), rounded down to a multiple
  /// of 8.
  void record_find_lookups(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                           LookupArray lookups, const DeviceTracer* tracer,
                           const CorrectionArrays& corrections = {}) const;

 private:
  /// A ray set that some probes traced last.
  struct RaySlot {
    std::shared_ptr<const RaySet> rays;
    vulkan::Buffer directions, irradiance_weights, distance_weights;
    int users = 0;
  };
  int slot_for(const std::shared_ptr<const RaySet>& rays);
  void fill_weights(RaySlot& slot) const;
  void write_sets();
  void record_surfel_distances(vulkan::Recorder& to, const DeviceProbes& list, FloatArray distances,
                               UintArray blocked) const;
  /// Records a step of edited_light; kCompareLight alone writes `edited`.
  void record_ray_lights(vulkan::Recorder& to, const DeviceProbes& list, uint step,
                         EditedLightArray edited) const;
  template <class Arguments>
  void run_transport(vulkan::Recorder& to, const vulkan::Kernel& kernel, const Arguments& arguments,
                     const DeviceProbes& list, uint shape, const TransportGroups& groups,
                     std::size_t offset) const;
  void record_distance_gutters(vulkan::Recorder& to, const DeviceProbes& list) const;
  void record_lookup_by_rays(vulkan::Recorder& to, QueryArray queries, std::uint32_t count,
                             Vec3Array irradiance, const DeviceTracer& tracer,
                             const CorrectionArrays& corrections) const;
  ProbeList arrays(const DeviceProbes& list, int first = 0) const;

  const vulkan::Device& device_;
  FieldSettings settings_;
  int probes_, volumes_, lookups_;
  int words_per_irradiance_texel_, words_per_distance_texel_;
  const FieldKernels& kernels_;
  DeviceCorrections corrections_;
  std::unique_ptr<DeviceVisibility> cell_visibility_;  // null: visibility is by distances only
  vulkan::Buffer grids_, offsets_, irradiance_, distance_, corners_, fit_;
  vulkan::Buffer light_, last_irradiance_estimate_;
  vulkan::Buffer surfels_, lookup_records_;  // probes x stride_ (x lookups_)
  int stride_ = 0;
  std::vector<RaySlot> slots_;
  std::vector<int> slot_of_;  // one per probe; -1: it has no surfels
  vulkan::Buffer sets_;       // RaySetRecords of the slots
  // Intermediate results, from one pass to the next
  vulkan::Buffer ray_distances_, blocked_, radiance_, at_centres_;
  vulkan::Buffer ray_distances_before_, blocked_before_, ray_lights_before_;
};

}  // namespace lambent
