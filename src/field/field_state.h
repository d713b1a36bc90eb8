// SPDX-License-Identifier: Apache-2.0
// The private state of IrradianceField: the probes and what they hold, the schedule, and edits of
// the world that have not reached all probes yet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/edits/invalidation.h"
#include "field/field_backend.h"
#include "field/placement/classify.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/probes/volumes.h"
#include "field/schedule/schedule.h"
#include "field/transport/blend.h"
#include "field/transport/solve_bounces.h"
#include "field/transport/surfels.h"
#include "lambent/field.h"
#include "lambent/world.h"

namespace lambent {

struct FieldFile;
struct FieldVolume;

/// Edits of the world that have reached some probes and not yet others.
struct PendingEdits {
  std::uint64_t revision = 0;  ///< The world's revision that the edits led to.
  /// The light of all probes before the edits. Empty where no edits are pending.
  WorkingIrradiance before;
  /// For each texel of the updated probes, the ratio of the averaged light to what the last rays
  /// alone estimated (history_ratio.cpp).
  WorkingIrradiance history_ratio;
  std::vector<int> updated;  ///< The probes that the edits have reached, in ascending order.
};

/// How far an update got with the edits of the world: no probe was stale, some stale probes are
/// left, or all stale probes have been brought up to date.
enum class EditProgress { none, partial, complete };

/// A box in which static geometry was edited. Probes near it are relocated once edits there stop.
struct EditedPlace {
  Bounds box;
  int update;  ///< Number of the update that last saw an edit in the box.
};

/// The probes that an update traces, and how much their new rays count.
struct TracedProbes {
  std::vector<int> probes;
  /// For each probe, the weight of the new light in the blend with its history, 0 to 1.
  std::vector<float> blend_weights;
  /// For each probe, its number of new rays over FieldSettings::rays_per_probe.
  std::vector<float> weights;
};

/// The probes that have been traced at all, and those whose surfels belong to an older revision of
/// the world.
struct StaleProbes {
  std::vector<int> traced;    ///< All probes that have surfels.
  std::vector<int> waiting;   ///< The stale probes among them, without the sleeping ones.
  std::vector<int> sleeping;  ///< The stale probes among them that sleep.
};

struct IrradianceField::State {
  State(const FieldSettings& field_settings, std::span<const Volume> volumes);

  FieldSettings settings;
  std::vector<VolumeRole> roles;  ///< One entry per volume.
  mutable ProbeStore store;
  std::vector<FieldGrid> grids;  ///< The grids of the store's volumes, for the public interface.
  BlendMatrix tile_fit;
  std::vector<ProbeTrace> traces;
  std::vector<ProbeStatus> statuses;
  CellVisibility cell_visibility;  ///< Only hybrid visibility keeps it up to date.
  std::vector<ClassificationInput> classification_inputs;  ///< From the static part of the scene.
  WorkingIrradiance light;                     ///< The irradiance that the store encodes.
  WorkingIrradiance last_irradiance_estimate;  ///< What each probe's last rays alone estimated.
  /// 1 where a probe's last estimate comes from a solve that stopped at its tolerance, so that it
  /// is less exact than what edits are compared by.
  std::vector<std::uint8_t> last_estimate_is_coarse;
  ProbeScheduler scheduler;
  std::vector<float> importance;  ///< Per probe; empty where an update has no visible points.
  PendingEdits pending_edits;
  std::vector<EditedPlace> edited_places;
  std::uint64_t placed_revision = 0;  ///< The revision that edited_places are up to date with.
  RayCost ray_cost;
  int updates = 0;
  bool warming_up = true;              ///< Some live probe has not been traced since the start.
  float mean_light = 0.0f;             ///< Mean luminance of the live probes.
  std::uint64_t applied_revision = 0;  ///< The revision that all but sleeping probes know.
  std::vector<int> stale_sleeping;     ///< Stale sleeping probes, the oldest first.
  std::size_t sleeping_per_slice = 0;  ///< How many of those an update brings up to date.
  bool applied_edits_last = false;     ///< The last update applied edits and traced nothing else.
  bool classified = false;       ///< The classification inputs have not changed since classify().
  std::vector<Bounds> moved_to;  ///< Bounds of the dynamic instances at the last classify().

  /// Null where the processor's memory holds the field. Otherwise a device's memory holds it, and
  /// the store's tiles, the surfels, `light` and `last_irradiance_estimate` above are copies from
  /// the last time they were read back.
  std::unique_ptr<FieldBackend> device;
  bool host_light_is_stale = false;          ///< The device has newer `light` and estimates.
  mutable bool host_store_is_stale = false;  ///< The device has newer tiles.

  /// Moves the field to the processor or device that the world is on. The light moves along; the
  /// surfels are dropped, to be traced again.
  void move_to(const World& world, UpdateStatistics& statistics);
  /// Reads back `light` and `last_irradiance_estimate` where the device's are newer.
  void fetch_light();
  /// Reads back the store's tiles where the device's are newer.
  void fetch_store() const;

  int tile_texels() const { return settings.irradiance_texels * settings.irradiance_texels; }
  /// Seed of the dither with which this update stores its results.
  uint dither_seed() const;
  /// Probes that have surfels, in ascending order.
  std::vector<int> traced_probes() const;
  SolveSettings solve_settings() const {
    return {settings.max_albedo, settings.solve_tolerance, settings.max_solve_iterations};
  }
  TransportOperator transport(std::span<const int> probes) const {
    return {store.corner_table(), traces, probes, tile_fit, settings.irradiance_texels};
  }

  /// Relocates some probes, starting from their places on the grid, and updates their
  /// classification inputs. Resets and returns those that moved.
  std::vector<int> place_probes(const World& world, std::span<const int> probes);
  /// Traces the fixed rays of some probes to find what classification needs to know of them. With
  /// `learn_distances`, the distances of these rays become the probes' first stored distances.
  void update_classification_inputs(const World& world, std::span<const int> probes,
                                    bool learn_distances = false);
  /// Drops a probe's surfels, stored distances and number of samples. Its light stays.
  void reset_probe(int probe);
  /// Gives relocated probes their first distances, and finds the lookups of all surfels that read
  /// one of them again.
  void initialize_relocated(const World& world, std::span<const int> moved,
                            UpdateStatistics& statistics);
  /// Lets a relocated probe continue from the light that it holds.
  void inherit_history(int probe, const World& world);
  /// Relocates probes near edited static geometry, once nothing there has been edited for a while.
  void relocate_edited(const World& world, UpdateStatistics& statistics);
  /// Scrolls the volumes that follow the viewer. Returns the number of recycled probes.
  int scroll_volumes(const World& world, const vec3& viewer_ws, UpdateStatistics& statistics);
  /// Looks the field up at the places that some probes will move to, in all directions of a tile.
  /// `tiles` receives what they should store, probe after probe.
  void interpolate_tiles(std::span<const int> probes, std::span<const vec3> places_ws,
                         std::span<vec4> tiles) const;
  /// Sets the state of each probe from its classification input and from where dynamic instances
  /// are now.
  void classify(const World& world);
  /// For hybrid visibility, finds which probes of the cells around the given ones see each other.
  /// Returns the number of rays traced; 0 in other modes.
  std::uint64_t update_cell_visibility(const World& world, std::span<const int> probes);
  VisibilityRays visibility(const World& world) const {
    return {settings.visibility, &world.tracer(), &cell_visibility};
  }

  /// Brings stale probes up to date with the world, and solves for the light that results. Spends
  /// about `ray_budget` rays (0: no bound), on important probes or those near the viewer first.
  EditProgress apply_scene_edits(const World& world, std::uint64_t ray_budget,
                                 const std::optional<vec3>& viewer_ws,
                                 UpdateStatistics& statistics);
  /// The ratio of the light that some probes hold to what their last rays estimate, texel by texel.
  WorkingIrradiance history_ratio_of(std::span<const int> probes) const;
  /// Computes coarse last estimates again, from the light as it is held.
  void refine_last_estimates(std::span<const int> probes);
  /// Stores what the last rays of some probes estimate, as a solve without history ratio found it.
  void store_last_estimates(std::span<const int> probes, const WorkingIrradiance& solution);
  /// Finds the stale probes. Those that cannot be brought up to date start their average again.
  StaleProbes find_stale_probes(const World& world);
  /// Keeps the light before edits, while light and surfels still belong to the same world.
  void begin_edits(std::uint64_t revision, std::span<const int> traced);
  /// Brings waiting probes up to date until the budget is spent, and removes them from
  /// `stale.waiting`.
  void apply_edits_in_slices(const World& world, std::uint64_t ray_budget, StaleProbes& stale,
                             UpdateStatistics& statistics);
  /// Brings one slice of the stale probes up to date. `all` are all traced probes.
  void apply_edits_to_slice(const World& world, std::span<const WorldChanges> changes,
                            std::span<const int> probes, std::span<const int> all,
                            UpdateStatistics& statistics);
  /// Luminance of the direct and sky light that each probe's rays bring back, summed over its rays
  /// (processor) or texels (device).
  std::vector<double> direct_light(std::span<const int> probes);
  /// Brings the surfels and stored distances of some probes up to date with the world.
  InvalidationResult update_stale_surfels(const World& world, std::span<const WorldChanges> changes,
                                          std::span<const int> probes, std::span<const int> all);
  /// Solves for the light of all probes that the pending edits have reached.
  void solve_edited(UpdateStatistics& statistics);
  /// Stores solved light where it differs visibly from the light before, and restores the old light
  /// elsewhere. Returns the number of probes whose light changed.
  int store_edited_light(std::span<const int> probes, const WorkingIrradiance& before,
                         const SolveResult& solved, const WorkingIrradiance& history_ratio);
  /// Lowers the sample counts of the probes whose light the pending edits changed.
  void reduce_history();
  /// Under a budget, sorts stale probes by how urgently they must be brought up to date.
  void order_stale_probes(std::vector<int>& waiting, std::uint64_t ray_budget,
                          const std::optional<vec3>& viewer_ws, std::uint64_t revision) const;
  /// Brings some of the stale sleeping probes up to date.
  void apply_edits_to_sleeping(const World& world, std::uint64_t ray_budget,
                               std::span<const int> all, UpdateStatistics& statistics);
  /// Lets a probe start its average again at this revision.
  void reset_history(int probe, std::uint64_t revision);
  /// Traces the scheduled probes, and blends what they receive into the store.
  void trace(const World& world, std::vector<TraceGroup> groups, UpdateStatistics& statistics);
  /// Solves for the light of all traced probes, from what their last rays met.
  void solve_warm_up(UpdateStatistics& statistics);
  /// How much the rays of the groups' probes count in the blend with their history.
  TracedProbes blend_weights_of(std::span<const TraceGroup> groups) const;
  /// Blends the distances of the groups' hits into the store.
  void blend_in_distances(const Scene& scene, std::span<const TraceGroup> groups,
                          std::span<const float> blend_weights);
  /// Probes darker than this luminance count as this bright where noise is judged.
  float darkest() const;
  /// How much the light of some probes differs from `history`.
  std::vector<LightChange> light_changes(std::span<const int> probes,
                                         const WorkingIrradiance& history) const;
  /// Updates the noise, sample counts and states of the probes that were traced.
  void update_variability(const World& world, const TracedProbes& traced,
                          std::span<const LightChange> changes);
  /// What trace() does, on the device.
  void trace_on_device(const World& world, std::span<const TraceGroup> groups,
                       UpdateStatistics& statistics);
  /// solve_bounces() on the processor or the device. The probes must have surfels.
  SolveResult solve(std::span<const int> probes, std::span<const float> blend_weights,
                    const WorkingIrradiance& history_ratio, const SolveSettings& by);
  /// Encodes the light of some probes into the store.
  void store_light(std::span<const int> probes);
  /// Replaces all light by what a file holds.
  void restore(const FieldFile& file, const World& world);
  /// A volume as a file stores it.
  FieldVolume volume_for_file(int volume, const World& world) const;
};

}  // namespace lambent
