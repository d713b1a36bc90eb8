// SPDX-License-Identifier: Apache-2.0
// A field that an engine records into command buffers of its own, on its own Vulkan device, with
// its own rays and its own shading: docs/integration.md. Needs Vulkan's headers; where there are
// none it declares nothing.
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
  /// Probes that an update traces, in turn; 0: all, but of the cascade of level L one in 2^L.
  /// Costs of an update are in proportion, its memory for rays, hits and results too (128 bytes a
  /// ray).
  int probes_per_update = 0;
  /// Rays that an update traces at most, of the probes whose light is least settled: the device
  /// decides which, once the first rounds and placing are over, and those that are settled rest. 0:
  /// as above. At least eight probes' rays (FieldSettings::rays_per_probe each); probes are served
  /// in eights. Costs and memory as above.
  int rays_per_update = 0;
  /// Times that a probe is traced, from the start or from UpdatePlan::place_again on, after which
  /// it may move to where it stands better; 2 to 64, or 0: none moves. Most stand well after
  /// three, those in corners after five. One that moved averages anew.
  int placing_updates = 8;
  /// Mask of the probes' rays and of visibility rays: record_trace and record_update meet instances
  /// whose mask shares a bit.
  std::uint8_t ray_mask = 0xFF;
};

/// What an update does besides tracing the next batch of probes.
struct UpdatePlan {
  /// Factor to the weight of all that probes have averaged so far, 0 to 1. 1: what changed is told
  /// by `changes`, or nothing did. 0: the place is another one.
  float history = 1.0f;
  /// Lets relocation of all probes begin again at once.
  bool place_again = false;
  /// What differs from the scene in which the last update's rays were traced; empty: nothing. All
  /// rays are traced again whatever differs, so that it is only read whether each of moved,
  /// rebuilt, lights, materials, emission and environment tells of something. Must stay valid
  /// during the call.
  ///
  /// Where all probes are traced at once and bounces are not counted, the change is followed
  /// exactly: the update traces every probe's last rays again (PlannedUpdate::retraces), solves for
  /// the light of all bounces, and changes just those probes whose light differs visibly. The more
  /// the distribution of their light over directions differs, the less their history counts; the
  /// others keep all of it, and their bits. Otherwise all averages begin again, as in a new field.
  /// Eight updates after static geometry was `rebuilt` last, relocation begins again.
  ///
  /// An update that traces rays again adds no new ones to the averages: a field that is told of
  /// changes in every update follows each, but does not become less noisy.
  std::span<const WorldChanges> changes = {};
  /// Where the camera is [m]: cascades (FieldSettings::cascades) follow it. None, or numbers that
  /// are not finite: they stay.
  std::optional<glm::vec3> viewer_ws = std::nullopt;
};

/// The work of an update.
struct PlannedUpdate {
  std::uint32_t probes = 0;          ///< Number of probes; an upper bound where the device decides.
  std::uint32_t rays_per_probe = 0;  ///< Rays per probe, which are consecutive.
  std::uint32_t rays = 0;     ///< Number of all rays; an upper bound where the device decides.
  bool moves_probes = false;  ///< record_maintain may move some.
  bool on_device = false;     ///< The device decides which probes; see ray_launch().
  /// Probes trace their last rays again, to follow UpdatePlan::changes. What an engine shades with
  /// random numbers must come out as before where nothing changed: seed them by the ray.
  bool retraces = false;
};

/// The buffers in which shaders look the field up. They stay the same for the field's whole life.
struct LookupBuffers {
  BufferRange grids;       ///< One ProbeGrid per volume.
  BufferRange offsets;     ///< One word per probe.
  BufferRange irradiance;  ///< Irradiance tiles, one after the other.
  BufferRange distance;    ///< Distance tiles, one after the other.
  /// A FieldRecord (field/lookup/field_record.h) that names the four, the corrections of lookups
  /// that came with a file, and which probes see each other: what
  /// lambent/shaders/field_lookup.glsl takes.
  /// RecordedField::start_from changes what it holds.
  BufferRange record;
};

/// A field in the memory of an engine's device. What its passes take is made with it: recording
/// makes nothing, waits for nothing and reads nothing back. An update is, once a frame or less:
///
///   plan             which probes, which rays; on the host
///   record_rays      cascades move with the viewer; the probes' rays, into rays()
///   record_trace     what they meet in the engine's acceleration structure, into hits(); or the
///                    engine's own way to find out
///   (the engine)     what that brings back, into results(), by a shader of the engine's
///   record_update    from that to the light that lookups find
///   record_maintain  what probes are for and where they stand from their next rays on; may be left
///                    out
///
/// in this order, into one command buffer or several that are submitted in it, to one queue family:
/// primary ones, outside render passes. Pipelines, descriptor sets and push constants that were
/// bound before a call are not bound any more after it.
///
/// Barriers. Each record_* ends with a memory barrier from all commands to all commands, and
/// begins with one: all that it writes is visible to what the engine records after it, and all that
/// was submitted before it to the same queue is visible to it, as is what was waited for with a
/// semaphore. So on one queue the engine owes no barrier but between its own commands. What each
/// one touches, for engines that use several queues or track resources themselves:
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
/// Lookups may run at any time but during record_update, and with cascades during record_rays:
/// between two updates' they find whole ones. A cascade that has moved gives the probes of the slab
/// that it left behind places in front. Until record_update has given these light, they have no
/// weight, and coarser volumes answer in their stead.
///
/// Frames in flight. Updates run on the device one after the other. While so many updates as
/// RecordedFieldSettings::frames_in_flight are unfinished, plan must not be called: an engine waits
/// for the fence of the frame whose command buffer it is about to fill again, as it does anyway.
///
/// Not thread-safe. The device must not use the field any more when it is destroyed.
class RecordedField {
 public:
  /// A field that holds no light yet, for a place of these bounds [m]. Submits to the device's
  /// queue, and waits. Fails on settings out of range, and on those that recorded fields do not
  /// follow: counted bounces where not all probes are traced at once.
  /// Throws std::runtime_error where the device's memory runs out.
  static Expected<RecordedField> make(std::shared_ptr<Device> device, const FieldSettings& settings,
                                      const Bounds& bounds,
                                      const RecordedFieldSettings& recorded = {});
  ~RecordedField();
  RecordedField(RecordedField&&) noexcept;
  RecordedField& operator=(RecordedField&&) noexcept;

  /// Starts a field that was not updated yet from a field file (save_field, `lambent bake`): from
  /// its light, its distances, the places and states of its probes, and how many updates these
  /// average. Lookups find that light once the call returns; updates add to it, with the random
  /// numbers that come next. Probes stay where they stand until UpdatePlan::place_again. Submits to
  /// the device's queue, and waits; memory that the copy takes is given back before it returns.
  ///
  /// The file's corrections of lookups (FieldSettings::corrections) are read from then on, by
  /// surfels and by lambent/shaders/field_lookup.glsl; not by lookup.hlsl and lookup.wgsl. They
  /// stay as the bake left them: gathers would have engines shade the hits of further rays, so that
  /// recorded fields learn none, and edits do not change them.
  ///
  /// Fails, naming the file, where it cannot be read, is broken, or does not fit, and leaves the
  /// field as it was. Formats and texels must be those of the field's settings, and volumes those
  /// that it was made with, to a thousandth of a cell; lookups then use the places of the file.
  /// Cascades may stand elsewhere, and scroll from there to the viewer.
  ///
  /// Whether the file is of the scene that the engine traces is not checked: Lambent does not know
  /// that scene. Where the geometry is another, the file is of no use. Where lights, materials,
  /// FieldSettings::max_bounces or max_albedo are not those of the bake, give the first update a
  /// history of 0: the light is then a start, but no part of averages. Edits (UpdatePlan::changes)
  /// let all averages begin anew until every probe has been traced once. Throws std::runtime_error
  /// where the device's memory runs out.
  Expected<void> start_from(const std::string& path);

  /// Begins an update. Fails where a number of `update` is out of range; nothing has begun then.
  Expected<PlannedUpdate> plan(const UpdatePlan& update = {});

  /// RayRecord (raytracing/ray_records.h), one a ray. A mask of 0: need not be traced, as those of
  /// PlannedUpdate::rays that are more than the device decided on.
  void record_rays(VkCommandBuffer commands) const;
  /// HitRecord, one a ray, by a ray tracing pipeline of Lambent's. `instance` is the custom index.
  /// Knows no materials: rays stop where triangles are see-through.
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

  /// Of the update that was planned last, in the same buffers always.
  BufferRange rays() const;
  BufferRange hits() const;
  /// RayResult (lambent/shaders/ray_results.h), one a ray: what the engine writes.
  BufferRange results() const;

  /// Where PlannedUpdate::on_device: a VkTraceRaysIndirectCommandKHR, as wide as a probe has rays
  /// and as high as the device decided on probes; ray (x, y) is y * width + x. None else.
  BufferRange ray_launch() const;

  /// What each pass took on the device in the last update that had finished when `plan` was called
  /// [ms], in their order, by the names of UpdateStatistics::passes; none where the device has no
  /// timestamps, and of parts that were not recorded.
  const std::vector<PassTime>& pass_times() const;
  /// Memory that the field's buffers take on the device and in what the host shares with it
  /// [bytes], the same for its whole life; pipelines are not counted.
  std::size_t bytes() const;
  LookupBuffers lookup_buffers() const;
  /// One word a probe: 0, or 1 where it stands in solid matter. Such probes light nothing, and are
  /// traced but every eighth turn; where the device decides, once in 128 updates or a few more.
  BufferRange states() const;
  /// Grids, offsets, irradiance and distance as storage buffers at bindings 0 to 3, for all stages:
  /// what lookup.hlsl and lookup.wgsl read. These see probes by distances.
  VkDescriptorSetLayout lookup_set_layout() const;
  VkDescriptorSet lookup_set() const;

  const FieldSettings& settings() const;
  int probes() const;
  /// Updates planned so far, and those of the file that it started from.
  std::uint32_t updates() const;

 private:
  struct State;
  explicit RecordedField(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lambent::vulkan
#endif
