// SPDX-License-Identifier: Apache-2.0
// What the order of an update asks of a device that keeps the field's tiles, surfels and light in
// its own memory. What is to be done and to which probes is decided by State, as on the processor;
// what it decides by (records, places, the light where an edit is followed) it reads back.
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

/// By how much a probe's light changed in an update.
struct LightChange {
  float relative_square;  ///< As of tile_light.h: of what it holds to what it held.
  float before, now;      ///< Mean luminance of its texels.
};

/// What a solve for the light of some probes came to.
struct DeviceSolve {
  int iterations = 0;
  double error = 0.0;   ///< As SolveResult's.
  double change = 0.0;  ///< Likewise.
};

/// Traces some probes anew.
struct DeviceTracing {
  const World& world;
  std::span<const TraceGroup> groups;    ///< Their hits stay empty.
  std::span<const float> blend_weights;  ///< Of all groups' probes, one group after the other.
  SolveSettings solve;
  int max_bounces = -1;  ///< As FieldSettings::max_bounces.
  float darkest = 0.0f;  ///< As relative_square takes it.
  uint dither_seed = 0;  ///< Of the store's dither.
};

struct DeviceTraced {
  DeviceSolve solve;
  std::vector<LightChange> changes;  ///< One a share.
  std::uint64_t probe_rays = 0, shadow_rays = 0;
  double trace_ms = 0.0, shade_ms = 0.0, solve_ms = 0.0, blend_ms = 0.0;
};

class FieldBackend {
 public:
  virtual ~FieldBackend() = default;

  /// Whether the world is on the same device.
  virtual bool is_on(const World& world) const = 0;

  /// Where probes stand: grids and offsets.
  virtual void set_places(const ProbeStore& store) = 0;
  /// The encoded tiles, of distances of some probes alone, or all there are.
  virtual void set_distances(const ProbeStore& store, std::span<const int> probes) = 0;
  virtual void write_store(const ProbeStore& store) = 0;
  virtual void read_store(ProbeStore& store) const = 0;
  /// The light of all probes, before it was encoded, and what their last rays told.
  virtual void write_light(const WorkingIrradiance& light,
                           const WorkingIrradiance& last_irradiance_estimate) = 0;
  virtual void read_light(WorkingIrradiance& light,
                          WorkingIrradiance& last_irradiance_estimate) const = 0;
  /// Encodes the light of some probes.
  virtual void store_light(std::span<const int> probes, uint dither_seed) = 0;

  /// Rays, distances, surfels, their lookups, the light of all bounces, and the store: all that
  /// State::trace does.
  virtual DeviceTraced trace(const DeviceTracing& tracing) = 0;
  /// Finds again, with the rays that they last traced, what some probes' surfels are, moves their
  /// stored distances by as much as those changed, and finds the lookups of all traced probes'
  /// surfels. What the world's edits do not touch comes out as it was.
  virtual DeviceTraced retrace(const World& world, std::span<const int> probes,
                               uint dither_seed) = 0;
  /// As CellVisibility::look, of a field with hybrid visibility; `cells` as of cells_around.
  virtual std::uint64_t update_cell_visibility(const World& world, std::span<const int> cells) = 0;
  /// Finds the lookups of some probes' surfels. Returns the rays that their visibility took.
  virtual std::uint64_t find_lookups(const World& world, std::span<const int> probes) = 0;
  /// Has probes forget their surfels.
  virtual void drop_surfels(std::span<const int> probes) = 0;

  /// Solves for the light of some probes as `relight` does, from the light that there is.
  /// `solution` takes what was solved for before a share of it was blended in, where it is not
  /// null.
  virtual DeviceSolve solve(std::span<const int> probes, std::span<const float> blend_weights,
                            const WorkingIrradiance& history_ratio, const SolveSettings& settings,
                            WorkingIrradiance* solution) = 0;
  /// What some probes receive of the light that there is.
  virtual void receive(std::span<const int> probes, const WorkingIrradiance& fallback,
                       WorkingIrradiance& received) = 0;
  /// Luminance of what each probe receives of direct light and the sky, added up over its texels.
  virtual std::vector<double> direct_light(std::span<const int> probes) = 0;

  /// As ImportanceScatter of importance.h.
  virtual std::vector<float> scatter_importance(std::span<const float> received, float least) = 0;
  /// Irradiance for each query [W/m^2]. `world` is what visibility traces rays in; null, or not on
  /// this device: visibility is by distances.
  virtual void irradiance(std::span<const FieldQuery> queries, const World* world,
                          std::span<vec3> result) const = 0;
  /// Records lookups: `count` queries to as many irradiances [W/m^2], at these addresses
  /// (QueryRecord and vec3). Binds the world's textures.
  virtual void record_lookups(vulkan::Recorder& recorder, const World* world, std::uint64_t queries,
                              std::uint32_t count, std::uint64_t irradiance) const = 0;

  virtual std::size_t surfel_bytes() const = 0;
};

/// Probes of a field that passes on a device can take: every device takes dispatches of 65,535
/// groups of eight probes, and indices of texels stay within 31 bits. Larger fields stay on the
/// host and ask the device for rays alone.
inline constexpr int kMaxBackendProbes = 1 << 18;

/// An empty field of the store's shape, of at most kMaxBackendProbes, on the device that the world
/// is on; null where the library knows no devices.
std::unique_ptr<FieldBackend> make_field_backend(const World& world, const FieldSettings& settings,
                                                 const ProbeStore& store);

}  // namespace lambent
