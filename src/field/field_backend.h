// SPDX-License-Identifier: Apache-2.0
// The interface to the executor that holds a field and runs its passes: the processor, or a device
// that stores tiles, surfels and light in its own memory. IrradianceField::State decides what is
// done with which probes. The data that these decisions depend on (probe statuses, positions, and
// the light where edits are applied) is in the processor's memory. A device's backend brings it up
// to date when the functions below are called.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/edits/invalidation.h"
#include "field/probe_data.h"
#include "field/probes/tile_light_math.h"
#include "field/transport/solve_bounces.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"
#include "lambent/world.h"

namespace lambent {

namespace vulkan {
class Recorder;
}

/// The arguments of FieldBackend::update_probes.
struct ProbeUpdate {
  const World& world;
  std::vector<TraceGroup> groups;    ///< Probes, grouped by ray set. The hits are empty.
  std::vector<int> probes;           ///< The probes of all groups, group after group.
  std::vector<float> blend_weights;  ///< How much each probe's new light counts, 0 to 1.
  SolveSettings solve;
  uint number = 0;       ///< Number of the update, from 0.
  bool learns = false;   ///< Whether the update learns corrections of lookups.
  bool divides = true;   ///< Whether its probes are divided among the ranks anew.
  uint dither_seed = 0;  ///< Seed of the dither with which results are stored.
};

/// What an update of probes did.
struct ProbeUpdateResult {
  std::vector<LightChange> changes;  ///< One per probe, in the order of ProbeUpdate::probes.
  std::uint64_t probe_rays = 0, shadow_rays = 0, correction_rays = 0;
  int iterations = 0;            ///< Iterations of the solve.
  double error = 0.0;            ///< See SolveResult::error.
  double change = 0.0;           ///< See SolveResult::change.
  std::vector<PassTime> passes;  ///< In the order in which they ran.
};

/// Looks a field up on the device that holds it.
class DeviceLookups {
 public:
  virtual ~DeviceLookups() = default;

  /// Whether the world is on the same device.
  virtual bool is_on(const World& world) const = 0;
  /// Records the lookup of `count` queries. `queries` and `irradiance` are addresses of QueryRecord
  /// and vec3 [W/m^2]. Binds the world's textures.
  virtual void record_lookups(vulkan::Recorder& recorder, const World* world, std::uint64_t queries,
                              std::uint32_t count, CorrectionUse use,
                              std::uint64_t irradiance) const = 0;
};

class FieldBackend {
 public:
  virtual ~FieldBackend() = default;

  /// Whether this is the backend for a field that follows the world. If not, make_field_backend
  /// makes the one that is.
  virtual bool suits(const World& world) const = 0;
  /// Null where the processor's memory holds the field.
  virtual const DeviceLookups* on_device() const = 0;

  // Transfers between ProbeData and the device that holds the field. On the processor ProbeData is
  // the field, and none of these does anything.

  /// Reads the light and the last irradiance estimates back where the device's are newer.
  virtual void fetch_light() = 0;
  /// Reads the store's tiles back where the device's are newer.
  virtual void fetch_store() = 0;
  /// Reads the corrections of lookups back where the device's are newer.
  virtual void fetch_corrections() = 0;
  /// Uploads the light and the last irradiance estimates.
  virtual void push_light() = 0;
  /// Uploads the grids and the probes' offsets. Discards the surfels of the probes that moved, and
  /// uploads their distance tiles.
  virtual void push_places(std::span<const int> moved) = 0;

  /// Uploads ProbeData::solid_sides.
  virtual void push_solid_sides() = 0;

  // Passes.

  /// Runs all passes of update_probes() in passes.h.
  virtual ProbeUpdateResult update_probes(ProbeUpdate update) = 0;
  /// Brings the surfels and stored distances of `probes` up to date with the world, and recomputes
  /// the lookups that this affects. `among` are all traced probes. `changes` name everything that
  /// may differ from the world in which the surfels were found. What the edits do not affect keeps
  /// its value.
  virtual InvalidationResult retrace(const World& world, std::span<const WorldChanges> changes,
                                     std::span<const int> probes, std::span<const int> among,
                                     uint dither_seed) = 0;
  /// CellVisibility::update of a field with hybrid visibility. `cells` come from cells_around().
  /// Returns the number of rays traced.
  virtual std::uint64_t update_cell_visibility(const World& world, std::span<const int> cells) = 0;
  /// Recomputes the lookups of those probes in `among`, all of which have been traced, whose
  /// surfels may read one of the probes `moved`. Returns the number of visibility rays traced.
  virtual std::uint64_t find_lookups(const World& world, std::span<const int> moved,
                                     std::span<const int> among) = 0;

  /// Solves for the light of some traced probes as solve_bounces() does, starting from the field's
  /// light. ProbeData::light is up to date afterwards.
  virtual SolveResult solve(std::span<const int> probes, std::span<const float> blend_weights,
                            const WorkingIrradiance& history_ratio,
                            const SolveSettings& settings) = 0;
  /// Computes the irradiance that some probes receive from the field's light. Texels for which no
  /// ray counts keep their value in `received`.
  virtual void receive(std::span<const int> probes, WorkingIrradiance& received) = 0;
  /// Encodes the light of some probes into the store.
  virtual void store_light(std::span<const int> probes, uint dither_seed) = 0;

  /// Does what CorrectionTable::forget() does, for the field's corrections.
  virtual void forget_corrections(std::span<const float> kept) = 0;

  /// See ImportanceScatter in importance.h.
  virtual std::vector<float> scatter_importance(std::span<const float> received, float least) = 0;
  /// Irradiance for each query [W/m^2]. `world` is the world in which visibility rays are traced.
  /// Where it is null or not on the field's device, visibility is by distances.
  virtual void irradiance(std::span<const FieldQuery> queries, const World* world,
                          CorrectionUse use, std::span<vec3> result) const = 0;

  /// Bytes that surfels and their lookups take.
  virtual std::size_t surfel_bytes() const = 0;
};

/// The most probes that passes on a device can handle: every device accepts dispatches of 65,535
/// groups of eight probes, and texel indices stay within 31 bits. Larger fields stay on the host
/// and use the device to trace rays only.
inline constexpr int kMaxBackendProbes = 1 << 18;

/// Whether a field of this many probes lives on the device of the world that it follows.
bool lives_on_device(const World& world, int probes);

/// Makes the backend for a field that follows the world. No other function chooses an executor. The
/// backend takes over all data but surfels. The data must outlive it.
std::unique_ptr<FieldBackend> make_field_backend(const World& world, ProbeData& data);
std::unique_ptr<FieldBackend> make_field_backend_cpu(ProbeData& data);
/// For worlds on a device.
std::unique_ptr<FieldBackend> make_field_backend_vulkan(const World& world, ProbeData& data);

}  // namespace lambent
