// SPDX-License-Identifier: Apache-2.0
// A field whose passes an engine records into its own command buffers, on its own Vulkan device,
// with its own rays and shading; see docs/integration.md. Needs Vulkan's headers; without them,
// this file declares nothing.
#pragma once

#if __has_include(<vulkan/vulkan_core.h>)
#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/pass_time.h"
#include "lambent/vulkan_device.h"
#include "lambent/world.h"

namespace lambent::vulkan {

struct RecordedFieldSettings {
  /// Updates whose command buffers may be unfinished while the next one is planned and recorded, 1
  /// to 16. Each costs some ten kilobytes.
  int frames_in_flight = 2;
  /// Number of probes that an update traces, in turn; 0: all, but of the cascade of level L only
  /// one in 2^L. An update's cost is in proportion, and so is its memory for rays, hits and results
  /// (128 bytes per ray).
  int probes_per_update = 0;
  /// Maximum number of rays that an update traces. Once the first rounds and placing are over, the
  /// device chooses the probes whose light is least settled, and settled ones are not traced. 0: no
  /// such choice, only `probes_per_update` counts. Otherwise at least the rays of eight probes
  /// (FieldSettings::rays_per_probe each), since probes are traced in groups of eight. Cost and
  /// memory as for `probes_per_update`.
  int rays_per_update = 0;
  /// Relocation: after each of the first `placing_updates` times that it is traced, counted from
  /// the start or from UpdatePlan::place_again, a probe may move to a better place; 2 to 64, or 0:
  /// none moves. Most are well placed after three, those in corners after five. The averages of a
  /// probe that moved start anew.
  int placing_updates = 8;
  /// Mask of the probes' rays and of visibility rays: in record_trace and record_update they hit
  /// instances whose mask shares a bit.
  std::uint8_t ray_mask = 0xFF;
};

/// What an update does besides tracing the next batch of probes.
struct UpdatePlan {
  /// Factor on the weight of the probes' history, 0 to 1. 1: nothing changed, or `changes` lists
  /// it. 0: the whole scene was replaced.
  float history = 1.0f;
  /// Restarts the relocation of all probes.
  bool place_again = false;
  /// The differences from the scene in which the last update's rays were traced; empty: none. All
  /// rays are traced again whatever differs. Therefore only matters whether each of moved, rebuilt,
  /// lights, materials, emission and environment reports a change. Must stay valid during the call.
  ///
  /// Where all probes are traced at once and bounces are not counted, the change is followed
  /// exactly: the update traces every probe's last rays again (PlannedUpdate::retraces), solves for
  /// the light of all bounces, and changes only the light of probes where it differs visibly. The
  /// more the distribution of their light over directions differs, and the fewer rays tell of the
  /// change, the less their history counts. Otherwise all averages start anew, as in a new
  /// field. Eight updates after static geometry was last `rebuilt`, relocation restarts.
  ///
  /// An update that traces rays again adds no new ones to the averages: a field with changes in
  /// every update follows each of them, but does not become less noisy.
  std::span<const WorldChanges> changes = {};
  /// Where the camera is [m]: cascades (FieldSettings::cascades) follow it. None, or numbers that
  /// are not finite: they do not move.
  std::optional<glm::vec3> viewer_ws = std::nullopt;
};

/// The work of an update.
struct PlannedUpdate {
  std::uint32_t probes = 0;          ///< Number of probes; an upper bound if `on_device`.
  std::uint32_t rays_per_probe = 0;  ///< Rays per probe, which are consecutive.
  std::uint32_t rays = 0;            ///< Number of all rays; an upper bound if `on_device`.
  bool moves_probes = false;         ///< record_maintain may move some.
  bool on_device = false;            ///< The device chooses the probes; see ray_launch().
  /// Probes trace their last rays again, to follow UpdatePlan::changes. Shading with random numbers
  /// must give the same results as before where nothing changed: seed them by the index of the ray.
  bool retraces = false;
};

/// The buffers in which shaders look the field up. They stay the same for the field's whole life.
struct LookupBuffers {
  BufferRange grids;       ///< One ProbeGrid per volume.
  BufferRange offsets;     ///< One word per probe.
  BufferRange irradiance;  ///< Irradiance tiles, one after the other.
  BufferRange distance;    ///< Distance tiles, one after the other.
  /// A FieldRecord (field/lookup/field_record.h) with the addresses of these four, of the lookup
  /// corrections from a file, and of the visibility between the probes of cells, for
  /// lambent/shaders/field_lookup.glsl. RecordedField::start_from changes its contents.
  BufferRange record;
};

/// A field in the memory of an engine's device. All resources of its passes are created with it:
/// recording creates nothing, waits for nothing and reads nothing back. An update consists of these
/// calls, once per frame or less often:
///
///   plan             chooses probes and rays, on the host
///   record_rays      scrolls cascades with the viewer; writes the probes' rays to rays()
///   record_trace     traces the rays in the engine's acceleration structure and writes hits(); an
///                    engine may trace them itself instead
///   (the engine)     shades the hits with a shader of its own and writes results()
///   record_update    turns the results into the light that lookups read
///   record_maintain  classifies and relocates probes, with effect from their next rays on; may be
///                    left out
///
/// Record them in this order, into one primary command buffer or several that are submitted in
/// order, to one queue family, outside render passes. Each call unbinds pipelines, descriptor sets
/// and push constants that were bound before.
///
/// Barriers. Each record_* begins and ends with a memory barrier from all commands to all commands:
/// all that it writes is visible to commands that the engine records after it, and it sees all that
/// was submitted before it to the same queue or waited for with a semaphore. So on one queue, the
/// engine needs barriers only between its own commands. For engines that use several queues or
/// track resources themselves, these are the resources and stages of each call:
///
///   record_rays      reads the lookup buffers, writes rays()      compute shaders, transfer,
///                    and ray_launch(); with cascades it writes    indirect commands
///                    the lookup buffers, too
///   record_trace     reads rays(), ray_launch() and the           ray tracing shaders,
///                    structure, writes hits()                     indirect commands
///   record_update    reads rays(), results() and, where           compute shaders, transfer,
///                    visibility is by rays, the structure,        indirect commands,
///                    writes the lookup buffers                    ray tracing shaders
///   record_maintain  reads rays() and results(), writes states()  compute shaders
///
/// Lookups may run at any time except during record_update and, with cascades, record_rays. A
/// cascade that moves places the probes that it leaves behind in front. These have no weight until
/// record_update has given them light; coarser volumes answer in their place.
///
/// Frames in flight. Updates run on the device one after the other. plan must not be called while
/// RecordedFieldSettings::frames_in_flight updates are unfinished. Engines that wait for the fence
/// of the frame whose command buffer they are about to reuse comply.
///
/// Not thread-safe. The field must not be destroyed while the device uses it.
class RecordedField {
 public:
  /// A field without light, for a scene of these bounds [m]. Submits to the device's queue, and
  /// waits. Fails on settings out of range, and on those that recorded fields do not support: a
  /// limit of bounces where not all probes are traced at once.
  /// Throws std::runtime_error where the device's memory runs out.
  static Expected<RecordedField> make(std::shared_ptr<Device> device, const FieldSettings& settings,
                                      const Bounds& bounds,
                                      const RecordedFieldSettings& recorded = {});
  ~RecordedField();
  RecordedField(RecordedField&&) noexcept;
  RecordedField& operator=(RecordedField&&) noexcept;

  /// Initialises a field that was not updated yet from a field file (save_field, `lambent bake`):
  /// its light, its distances, the places and states of its probes, and the number of updates that
  /// these average. Lookups find that light once the call returns; updates continue its averages
  /// and its sequence of random numbers. Probes do not move until UpdatePlan::place_again. Submits
  /// to the device's queue, and waits; temporary memory is freed before it returns.
  ///
  /// The file's lookup corrections (FieldSettings::corrections) are then applied by surfels and by
  /// lambent/shaders/field_lookup.glsl, but not by lookup.hlsl and lookup.wgsl. They are not
  /// updated, not even by edits: recorded fields learn no corrections, since engines would have to
  /// shade the hits of further rays.
  ///
  /// Fails, naming the file, where it cannot be read, is broken, or does not fit, and leaves the
  /// field as it was. Formats and texels must be those of the field's settings, and volumes those
  /// that it was made with, to a thousandth of a cell; lookups then use the places of the file.
  /// Cascades may be elsewhere, and scroll from there to the viewer.
  ///
  /// It is not checked whether the file belongs to the scene that the engine traces, which Lambent
  /// does not have. With other geometry the file is of no use. Where lights, materials,
  /// FieldSettings::max_bounces or max_albedo are not those of the bake, give the first update a
  /// history of 0: the solve then starts from the light, but averages do not include it. Edits
  /// (UpdatePlan::changes) restart all averages until every probe has been traced once. Throws
  /// std::runtime_error where the device's memory runs out.
  Expected<void> start_from(const std::string& path);

  /// Begins an update. Fails where a number of `update` is out of range; nothing has begun then.
  Expected<PlannedUpdate> plan(const UpdatePlan& update = {});

  /// Writes one RayRecord (raytracing/ray_records.h) per ray. Rays with a mask of 0 need not be
  /// traced; where the device chooses the probes, all rays of PlannedUpdate::rays in excess of its
  /// choice have it.
  void record_rays(VkCommandBuffer commands) const;
  /// Writes one HitRecord per ray, by a ray tracing pipeline of Lambent's. `instance` is the custom
  /// index. All triangles count as opaque, since materials are not available here.
  void record_trace(VkCommandBuffer commands, VkAccelerationStructureKHR structure) const;
  /// Where FieldSettings::visibility is hybrid or exact, visibility rays are traced in `structure`,
  /// by a ray tracing pipeline of Lambent's: between the probes of cells around the update's, and
  /// from surfels to the probes that they might see. It must be what the probes' rays met, however
  /// the engine found their hits. As in record_trace, see-through triangles stop rays: leave these
  /// out by RecordedFieldSettings::ray_mask. Else `structure` is not read. Fails, and records
  /// nothing, where it is needed and null.
  Expected<void> record_update(VkCommandBuffer commands,
                               VkAccelerationStructureKHR structure = VK_NULL_HANDLE);
  void record_maintain(VkCommandBuffer commands) const;

  /// Rays and hits of the update that was planned last. The buffers are always the same.
  BufferRange rays() const;
  BufferRange hits() const;
  /// One RayResult (lambent/shaders/ray_results.h) per ray, which the engine writes.
  BufferRange results() const;

  /// With PlannedUpdate::on_device, a VkTraceRaysIndirectCommandKHR whose width is the number of
  /// rays per probe and whose height is the number of probes that the device chose; ray (x, y) has
  /// the index y * width + x. Otherwise none.
  BufferRange ray_launch() const;

  /// Time of each pass on the device [ms] in the last update that had finished when `plan` was
  /// called, in order, with the names of UpdateStatistics::passes. Empty where the device has no
  /// timestamps; passes that were not recorded are left out.
  const std::vector<PassTime>& pass_times() const;
  /// Memory of the field's buffers on the device and in memory that the host shares with it
  /// [bytes], constant for its lifetime; pipelines are not included.
  std::size_t bytes() const;
  LookupBuffers lookup_buffers() const;
  /// One word per probe: 1 where it is in solid matter, else 0. Such probes are not looked up, and
  /// are traced only every eighth turn, or, where the device chooses the probes, about once in 128
  /// updates.
  BufferRange states() const;
  /// Grids, offsets, irradiance and distance as storage buffers at bindings 0 to 3, for all stages,
  /// as lookup.hlsl and lookup.wgsl read them, whose lookups use distances alone.
  VkDescriptorSetLayout lookup_set_layout() const;
  VkDescriptorSet lookup_set() const;

  const FieldSettings& settings() const;
  int probes() const;
  /// Number of updates planned so far, plus those of the file that it started from.
  std::uint32_t updates() const;

 private:
  struct State;
  explicit RecordedField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lambent::vulkan
#endif
