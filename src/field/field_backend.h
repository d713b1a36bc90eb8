// SPDX-License-Identifier: Apache-2.0
// What an update asks of a device that keeps the field's tiles, surfels and light in its own
// memory. IrradianceField::State decides what is done with which probes, as it does on the
// processor. What it decides by (probe statuses, positions, and the light where edits are applied)
// stays on the host or is read back.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "field/transport/solve_bounces.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"
#include "lambent/world.h"

namespace lambent {

namespace vulkan {
class Recorder;
}

/// How much a probe's light changed in an update.
struct LightChange {
  float relative_square;  ///< relative_square() of tile_light.h, of the new light to the old.
  float before, now;      ///< Mean luminance of the probe's texels before and after the update.
};

/// The outcome of a solve for the light of some probes, without the solution itself.
struct DeviceSolve {
  int iterations = 0;
  double error = 0.0;   ///< See SolveResult::error.
  double change = 0.0;  ///< See SolveResult::change.
};

/// The arguments of FieldBackend::trace.
struct DeviceTracing {
  const World& world;
  std::span<const TraceGroup> groups;    ///< Probes by their rays. The hits stay empty.
  std::span<const float> blend_weights;  ///< One per probe, group after group.
  SolveSettings solve;
  int max_bounces = -1;  ///< See FieldSettings::max_bounces.
  float darkest = 0.0f;  ///< See relative_square() [luminance].
  uint dither_seed = 0;  ///< Seed of the dither with which results are stored.
};

/// What tracing on a device came to.
struct DeviceTraced {
  DeviceSolve solve;
  std::vector<LightChange> changes;  ///< One per probe, in the order of the blend weights.
  std::uint64_t probe_rays = 0, shadow_rays = 0;
  double trace_ms = 0.0, shade_ms = 0.0, solve_ms = 0.0, blend_ms = 0.0;
};

class FieldBackend {
 public:
  virtual ~FieldBackend() = default;

  /// Whether the world is on the same device.
  virtual bool is_on(const World& world) const = 0;

  /// Uploads the grids and the probes' offsets.
  virtual void set_places(const ProbeStore& store) = 0;
  /// Uploads the encoded distance tiles of some probes.
  virtual void set_distances(const ProbeStore& store, std::span<const int> probes) = 0;
  /// Uploads grids, offsets and all encoded tiles.
  virtual void write_store(const ProbeStore& store) = 0;
  /// Reads all encoded tiles back.
  virtual void read_store(ProbeStore& store) const = 0;
  /// Uploads the light of all probes, before encoding, and what their last rays estimated.
  virtual void write_light(const WorkingIrradiance& light,
                           const WorkingIrradiance& last_irradiance_estimate) = 0;
  /// Reads both back.
  virtual void read_light(WorkingIrradiance& light,
                          WorkingIrradiance& last_irradiance_estimate) const = 0;
  /// Encodes the light of some probes into the store.
  virtual void store_light(std::span<const int> probes, uint dither_seed) = 0;

  /// Traces rays, blends distances, shades surfels, finds their lookups, solves for the light of
  /// all bounces, and stores it: all that State::trace does on the processor.
  virtual DeviceTraced trace(const DeviceTracing& tracing) = 0;
  /// Traces and shades the rays that some probes traced last once more, moves the probes' stored
  /// distances by as much as the rays' distances changed, and finds the lookups of all traced
  /// probes' surfels. What the edits of the world do not affect keeps its value.
  virtual DeviceTraced retrace(const World& world, std::span<const int> probes,
                               uint dither_seed) = 0;
  /// CellVisibility::update of a field with hybrid visibility. `cells` come from cells_around().
  /// Returns the number of rays traced.
  virtual std::uint64_t update_cell_visibility(const World& world, std::span<const int> cells) = 0;
  /// Finds the lookups of some probes' surfels. Returns the number of visibility rays traced.
  virtual std::uint64_t find_lookups(const World& world, std::span<const int> probes) = 0;
  /// Drops the surfels of some probes.
  virtual void drop_surfels(std::span<const int> probes) = 0;

  /// Solves for the light of some probes as solve_bounces() does, starting from the light that the
  /// device holds. Where `solution` is not null, it receives the solution before blending.
  virtual DeviceSolve solve(std::span<const int> probes, std::span<const float> blend_weights,
                            const WorkingIrradiance& history_ratio, const SolveSettings& settings,
                            WorkingIrradiance* solution) = 0;
  /// What some probes receive from the light that the device holds.
  virtual void receive(std::span<const int> probes, const WorkingIrradiance& fallback,
                       WorkingIrradiance& received) = 0;
  /// Luminance of the direct and sky light that each probe receives, summed over its texels.
  virtual std::vector<double> direct_light(std::span<const int> probes) = 0;

  /// See ImportanceScatter in importance.h.
  virtual std::vector<float> scatter_importance(std::span<const float> received, float least) = 0;
  /// Irradiance for each query [W/m^2]. `world` is the world in which visibility rays are traced.
  /// Where it is null or not on this device, visibility is by distances.
  virtual void irradiance(std::span<const FieldQuery> queries, const World* world,
                          std::span<vec3> result) const = 0;
  /// Records the lookup of `count` queries. `queries` and `irradiance` are addresses of QueryRecord
  /// and vec3 [W/m^2]. Binds the world's textures.
  virtual void record_lookups(vulkan::Recorder& recorder, const World* world, std::uint64_t queries,
                              std::uint32_t count, std::uint64_t irradiance) const = 0;

  /// Bytes that surfels and their lookups take on the device.
  virtual std::size_t surfel_bytes() const = 0;
};

/// The most probes that passes on a device can handle: every device accepts dispatches of 65,535
/// groups of eight probes, and texel indices stay within 31 bits. Larger fields stay on the host
/// and use the device to trace rays only.
inline constexpr int kMaxBackendProbes = 1 << 18;

/// Makes an empty field of the store's shape, of at most kMaxBackendProbes probes, on the device
/// that the world is on. Returns null where the library was built without devices.
std::unique_ptr<FieldBackend> make_field_backend(const World& world, const FieldSettings& settings,
                                                 const ProbeStore& store);

}  // namespace lambent
