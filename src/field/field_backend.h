// SPDX-License-Identifier: Apache-2.0
// Where a field lives, and who runs its passes there: the processor, or a device that keeps tiles,
// surfels and light in its own memory. The host decides what is to be done and to which probes;
// what it decides by (the probes' statuses, places, and their light where an edit is followed) is
// in the processor's memory, and a device's backend brings that up to date when it is asked to.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/edits/follow.h"
#include "field/probe_memory.h"
#include "field/transport/relight.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"
#include "lambent/world.h"

namespace lambent {

namespace vulkan {
class Recorder;
}

/// By how much a probe's light changed in an update.
struct LightChange {
  float relative_square;  ///< As of tile_light.h: of what it holds to what it held.
  float before, now;      ///< Mean luminance of its texels.
};

/// Probes to trace anew, and how their light is solved for.
struct ProbeUpdate {
  const World& world;
  std::vector<TraceGroup> groups;  ///< Without hits.
  std::vector<int> probes;         ///< Of all groups, one group after the other.
  std::vector<float> shares;       ///< Of what each holds afterwards, its new light.
  RelightSettings relight;
  float darkest = 0.0f;  ///< As relative_square takes it.
  uint salt = 0;         ///< Of the store's dither.
};

/// What an update of probes came to.
struct ProbeUpdateResult {
  std::vector<LightChange> changes;  ///< One a probe.
  std::uint64_t probe_rays = 0, shadow_rays = 0;
  int iterations = 0;   ///< Of the solve.
  double error = 0.0;   ///< As RelightResult's.
  double change = 0.0;  ///< As RelightResult's.
  std::vector<PassTime> passes;
};

/// Looks a field up on the device that holds it.
class DeviceLookups {
 public:
  virtual ~DeviceLookups() = default;

  /// Whether the world is on the same device.
  virtual bool is_on(const World& world) const = 0;

  /// Records lookups: `count` queries to as many irradiances [W/m^2], at these addresses
  /// (QueryRecord and vec3). Binds the world's textures.
  virtual void record_lookups(vulkan::Recorder& recorder, const World* world, std::uint64_t queries,
                              std::uint32_t count, std::uint64_t irradiance) const = 0;
};

class FieldBackend {
 public:
  virtual ~FieldBackend() = default;

  /// Whether a field of its size is to live here while it follows this world.
  virtual bool suits(const World& world) const = 0;
  /// Null: the processor's memory holds the field.
  virtual const DeviceLookups* on_device() const = 0;

  // Memory. The processor's is what it works on: none of these does anything there.

  /// Brings light and told, or the store's tiles, in the processor's memory up to date.
  virtual void fetch_light() = 0;
  virtual void fetch_store() = 0;
  /// Takes over light and told, which the host changed.
  virtual void push_light() = 0;
  /// Takes over where probes stand. Those that moved have no surfels any more; their distances are
  /// taken over.
  virtual void push_places(std::span<const int> moved) = 0;

  // Passes.

  /// All passes of an update, in the order of update_probes.
  virtual ProbeUpdateResult update_probes(ProbeUpdate update) = 0;
  /// Brings surfels and stored distances of `probes` up to date with the world, and the lookups of
  /// those `among` all traced probes that this may have changed. `changes` tell what may differ
  /// from the world that the surfels were found in; what they do not touch comes out as it was.
  virtual FollowedEdits retrace(const World& world, std::span<const WorldChanges> changes,
                                std::span<const int> probes, std::span<const int> among,
                                uint salt) = 0;
  /// As ProbeSights::look, of a field with hybrid visibility; `cells` as of cells_around. Returns
  /// the rays traced.
  virtual std::uint64_t look(const World& world, std::span<const int> cells) = 0;
  /// Finds the lookups of those `among` traced probes whose surfels may read one of `moved`.
  /// Returns the rays that their visibility took.
  virtual std::uint64_t find_lookups(const World& world, std::span<const int> moved,
                                     std::span<const int> among) = 0;

  /// As relight, of probes that have been traced and in the field's light, which is up to date in
  /// the processor's memory afterwards.
  virtual RelightResult solve(std::span<const int> probes, std::span<const float> shares,
                              const WorkingIrradiance& gain, const RelightSettings& settings) = 0;
  /// What some probes receive of the light that there is. Texels that no ray counts for stay.
  virtual void receive(std::span<const int> probes, WorkingIrradiance& received) = 0;
  /// Luminance of what each probe's rays bring back of direct light and the sky, added up.
  virtual std::vector<double> direct_light(std::span<const int> probes) = 0;
  /// Encodes the light of some probes.
  virtual void store_light(std::span<const int> probes, uint salt) = 0;

  /// As SendBack of importance.h.
  virtual std::vector<float> send_back(std::span<const float> received, float least) = 0;
  /// Irradiance for each query [W/m^2]. `world` is what visibility traces rays in; null, or not on
  /// the same device: visibility is by distances.
  virtual void irradiance(std::span<const FieldQuery> queries, const World* world,
                          std::span<vec3> result) const = 0;

  virtual std::size_t surfel_bytes() const = 0;
};

/// Probes of a field that passes on a device can take: every device takes dispatches of 65,535
/// groups of eight probes, and indices of texels stay within 31 bits. Larger fields stay on the
/// host and ask the device for rays alone.
inline constexpr int kMostDeviceProbes = 1 << 18;

/// Whether a field of so many probes that follows the world lives on the world's device.
bool lives_on_device(const World& world, int probes);

/// The backend for a field that follows the world, with all that the memory holds but surfels. The
/// memory must outlive it.
std::unique_ptr<FieldBackend> make_field_backend(const World& world, ProbeMemory& memory);
std::unique_ptr<FieldBackend> make_field_backend_cpu(ProbeMemory& memory);
/// For worlds on a device.
std::unique_ptr<FieldBackend> make_field_backend_vulkan(const World& world, ProbeMemory& memory);

}  // namespace lambent
