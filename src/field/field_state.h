// SPDX-License-Identifier: Apache-2.0
// All that an irradiance field consists of.
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

/// Edits of the world that some probes have been held against and others not yet.
struct PendingEdits {
  std::uint64_t revision = 0;       ///< Of the world.
  WorkingIrradiance before;         ///< The light when the edits came, of all probes; empty: none.
  WorkingIrradiance history_ratio;  ///< What was held over what the last rays told, where followed.
  std::vector<int> updated;         ///< In ascending order.
};

/// Which of the probes that edits of the world may have touched an update held against them.
enum class EditProgress { none, partial, complete };

/// A box in which what should keep still was edited: probes are placed anew once it does.
struct EditedPlace {
  Bounds box;
  int update;  ///< In which it was edited last.
};

/// Probes that an update traces, and for each what its rays count for.
struct TracedProbes {
  std::vector<int> probes;
  std::vector<float> blend_weights;  ///< Of what the probe holds afterwards.
  std::vector<float> weights;        ///< In updates of the settings' rays.
};

/// The probes that have been traced, and those among them that know an older world.
struct StaleProbes {
  std::vector<int> traced, waiting;
  std::vector<int> sleeping;  ///< Sleeping ones; not among the waiting.
};

struct IrradianceField::State {
  State(const FieldSettings& field_settings, std::span<const Volume> volumes);

  FieldSettings settings;
  std::vector<VolumeRole> roles;  ///< One a volume.
  mutable ProbeStore store;
  std::vector<FieldGrid> grids;  ///< Of the store, as the public interface tells them.
  BlendMatrix tile_fit;
  std::vector<ProbeTrace> traces;
  std::vector<ProbeStatus> statuses;
  CellVisibility
      cell_visibility;  ///< Kept for hybrid visibility alone; see update_cell_visibility.
  std::vector<ClassificationInput> classification_inputs;  ///< Of the scene that keeps still.
  WorkingIrradiance light;                     ///< That the store holds, before it was encoded.
  WorkingIrradiance last_irradiance_estimate;  ///< What of it the last rays told on their own.
  /// 1: told is as exact as the solution, not as what the probe holds: it was traced since.
  std::vector<std::uint8_t> last_estimate_is_coarse;
  ProbeScheduler scheduler;
  std::vector<float> importance;  ///< Of each probe, in an update that knows what is seen.
  PendingEdits pending_edits;
  std::vector<EditedPlace> edited_places;
  std::uint64_t placed_revision = 0;  ///< Of the world that edited_places know.
  RayCost ray_cost;
  int updates = 0;
  bool warming_up = true;   ///< Some probe has not been traced since the field knew nothing.
  float mean_light = 0.0f;  ///< Luminance that probes hold on average, when last traced.
  std::uint64_t applied_revision = 0;  ///< Of the world that all but sleeping probes know.
  std::vector<int> stale_sleeping;     ///< Sleeping probes that know an older world, oldest first.
  std::size_t sleeping_per_slice = 0;  ///< ... of which so many follow in an update.
  bool applied_edits_last = false;     ///< The last update followed edits and traced nothing else.
  bool classified = false;       ///< Since reaches were found, it was said what probes are for.
  std::vector<Bounds> moved_to;  ///< What moved when that was last said.

  /// Null: the processor's memory holds the field. Else a device's does, and of what is above, the
  /// store's tiles, the surfels, light and told are as of the last time they were read back.
  std::unique_ptr<FieldBackend> device;
  bool host_light_is_stale = false;          ///< The device's light and told are newer.
  mutable bool host_store_is_stale = false;  ///< So are its tiles.

  /// Has the passes of this update run where the world is. What moves from the one to the other
  /// takes its light along; its surfels are found anew.
  void move_to(const World& world, UpdateStatistics& statistics);
  /// Brings light and told, or the store's tiles, up to date.
  void fetch_light();
  void fetch_store() const;

  int tile_texels() const { return settings.irradiance_texels * settings.irradiance_texels; }
  /// Of this update's dither.
  uint dither_seed() const;
  /// Probes that have surfels, in ascending order.
  std::vector<int> traced_probes() const;
  SolveSettings solve_settings() const {
    return {settings.max_albedo, settings.solve_tolerance, settings.max_solve_iterations};
  }
  TransportOperator transport(std::span<const int> probes) const {
    return {store.corner_table(), traces, probes, tile_fit, settings.irradiance_texels};
  }

  /// Moves probes to where they are needed and finds what they reach. Those that moved forget what
  /// they see, and are returned.
  std::vector<int> place_probes(const World& world, std::span<const int> probes);
  /// `learn_distances`: stores what they see, too, for a start.
  void update_classification_inputs(const World& world, std::span<const int> probes,
                                    bool learn_distances = false);
  /// Has a probe forget what it sees.
  void reset_probe(int probe);
  /// Stores what probes in new places see, and has the surfels that read them ask anew.
  void initialize_relocated(const World& world, std::span<const int> moved,
                            UpdateStatistics& statistics);
  /// Has a probe in a new place go on with the light that it was given.
  void inherit_history(int probe, const World& world);
  /// Places probes anew where what keeps still was edited, once nothing there has moved for a
  /// while.
  void relocate_edited(const World& world, UpdateStatistics& statistics);
  /// Has volumes follow the viewer. Returns how many probes came to belong elsewhere.
  int scroll_volumes(const World& world, const vec3& viewer_ws, UpdateStatistics& statistics);
  /// What the field holds at the places where probes will be, as their tiles.
  void interpolate_tiles(std::span<const int> probes, std::span<const vec3> places_ws,
                         std::span<vec4> tiles) const;
  /// Says what each probe is for, with what moves where it is now.
  void classify(const World& world);
  /// For hybrid visibility: finds which probes of the cells around some see each other. Returns the
  /// rays traced.
  std::uint64_t update_cell_visibility(const World& world, std::span<const int> probes);
  VisibilityRays visibility(const World& world) const {
    return {settings.visibility, &world.tracer(), &cell_visibility};
  }

  /// Follows the world's edits with about so many rays (0: no bound), near the viewer first.
  EditProgress apply_scene_edits(const World& world, std::uint64_t ray_budget,
                                 const std::optional<vec3>& viewer_ws,
                                 UpdateStatistics& statistics);
  WorkingIrradiance history_ratio_of(std::span<const int> probes) const;
  void refine_last_estimates(std::span<const int> probes);
  void store_last_estimates(std::span<const int> probes, const WorkingIrradiance& solution);
  StaleProbes find_stale_probes(const World& world);
  void begin_edits(std::uint64_t revision, std::span<const int> traced);
  void apply_edits_in_slices(const World& world, std::uint64_t ray_budget, StaleProbes& stale,
                             UpdateStatistics& statistics);
  void apply_edits_to_slice(const World& world, std::span<const WorldChanges> changes,
                            std::span<const int> probes, std::span<const int> all,
                            UpdateStatistics& statistics);
  std::vector<double> direct_light(std::span<const int> probes);
  InvalidationResult update_stale_surfels(const World& world, std::span<const WorldChanges> changes,
                                          std::span<const int> probes, std::span<const int> all);
  void solve_edited(UpdateStatistics& statistics);
  int store_edited_light(std::span<const int> probes, const WorkingIrradiance& before,
                         const SolveResult& solved, const WorkingIrradiance& history_ratio);
  void reduce_history();
  void order_stale_probes(std::vector<int>& waiting, std::uint64_t ray_budget,
                          const std::optional<vec3>& viewer_ws, std::uint64_t revision) const;
  /// Has some of the sleeping probes follow that others left behind.
  void apply_edits_to_sleeping(const World& world, std::uint64_t ray_budget,
                               std::span<const int> all, UpdateStatistics& statistics);
  void reset_history(int probe, std::uint64_t revision);
  /// Traces the scheduled probes, and blends what they receive into the store.
  void trace(const World& world, std::vector<TraceGroup> groups, UpdateStatistics& statistics);
  /// Solves for the light of all probes that have been traced, from what their last rays met.
  void solve_warm_up(UpdateStatistics& statistics);
  TracedProbes blend_weights_of(std::span<const TraceGroup> groups) const;
  void blend_in_distances(const Scene& scene, std::span<const TraceGroup> groups,
                          std::span<const float> blend_weights);
  /// Noise of probes darker than this is judged as if they were as bright [luminance].
  float darkest() const;
  std::vector<LightChange> light_changes(std::span<const int> probes,
                                         const WorkingIrradiance& history) const;
  void update_variability(const World& world, const TracedProbes& traced,
                          std::span<const LightChange> changes);
  void trace_on_device(const World& world, std::span<const TraceGroup> groups,
                       UpdateStatistics& statistics);
  /// As relight, of probes that have been traced.
  SolveResult solve(std::span<const int> probes, std::span<const float> blend_weights,
                    const WorkingIrradiance& history_ratio, const SolveSettings& by);
  /// Encodes the light of some probes.
  void store_light(std::span<const int> probes);
  /// Takes over what a file holds.
  void restore(const FieldFile& file, const World& world);
  FieldVolume volume_for_file(int volume, const World& world) const;
};

}  // namespace lambent
