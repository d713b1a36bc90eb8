// SPDX-License-Identifier: Apache-2.0
// The private state of IrradianceField: the probes and what they hold, the schedule, and edits of
// the world that have not reached all probes yet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "field/edits/scene_edits.h"
#include "field/field_backend.h"
#include "field/placement/placement_state.h"
#include "field/probes/probe_status.h"
#include "field/probes/volumes.h"
#include "field/schedule/scheduling.h"
#include "lambent/field.h"
#include "lambent/world.h"

namespace lambent {

struct FieldFile;
struct FieldVolume;

/// The volumes of a field, beside the store that holds their probes.
struct FieldVolumes {
  std::vector<VolumeRole> roles;  ///< One entry per volume.
  std::vector<FieldGrid> grids;   ///< The grids of the store's volumes, for the public interface.
};

struct IrradianceField::State {
  State(const FieldSettings& field_settings, std::span<const Volume> volumes);

  FieldSettings settings;
  FieldVolumes volumes;
  ProbeData data;
  std::vector<ProbeStatus> statuses;
  PlacementState placement;
  FieldEdits edits;
  Scheduling scheduling;
  int updates = 0;

  /// Where the field lives; never null.
  std::unique_ptr<FieldBackend> backend;

  /// Moves the field to the processor or device that the world is on. The light is copied; the
  /// surfels are discarded, and traced again later.
  void move_to(const World& world, UpdateStatistics& statistics);
  std::vector<int> all_probes() const;
  void end_warm_up(UpdateStatistics& statistics);
  void weigh_importance(std::span<const FieldQuery> seen);
  bool has_budget(const UpdateRequest& request) const;
  EditBudget edit_budget(const UpdateRequest& request, double spent_ms) const;
  std::uint64_t budget_after_edits(const UpdateRequest& request, std::uint64_t spent,
                                   double spent_ms, bool edited) const;
  std::vector<TraceGroup> schedule(std::uint64_t budget, const std::optional<vec3>& viewer_ws);

  /// Seed of the dither with which this update stores its results.
  uint dither_seed() const;

  /// Finds which sides of surfaces bound solid matter, where that may differ from what was found
  /// last. Returns whether it searched.
  bool find_solid_sides(const World& world);
  /// Lets the probes start anew whose places were closed and are open now.
  void reset_opened_probes(std::span<const OpenPlaces> before, std::uint64_t revision);
  /// Whether one of the volumes moves with the viewer.
  bool follows_viewer() const;
  /// Scrolls volumes with the viewer, and places and classifies probes. Returns whether it placed
  /// some, or found what is solid.
  bool place_all(const World& world, const std::optional<vec3>& viewer_ws,
                 UpdateStatistics& statistics);
  /// Relocates some probes, starting from their places on the grid, and updates their
  /// classification inputs. Resets and returns those that moved.
  std::vector<int> place_probes(const World& world, std::span<const int> probes);
  /// Traces the fixed rays of some probes to compute their classification inputs. With
  /// `learn_distances`, the distances of these rays become the probes' first stored distances.
  void update_classification_inputs(const World& world, std::span<const int> probes,
                                    bool learn_distances = false);
  /// Computes the first distances of relocated probes, and recomputes the lookups of all surfels
  /// that read one of them.
  void initialize_relocated(const World& world, std::span<const int> moved,
                            UpdateStatistics& statistics);
  /// Keeps the light of a relocated probe as the start of its new average.
  void inherit_history(int probe, const World& world);
  /// The probes near places where edits have stopped, which are edited places no longer.
  std::vector<int> probes_where_edits_stopped();
  /// Relocates probes near edited static geometry, once nothing there has been edited for a while;
  /// all probes where what is solid differs. Returns whether it did.
  bool relocate_edited(const World& world, UpdateStatistics& statistics);
  /// Scrolls the volumes that follow the viewer. Returns the number of recycled probes.
  int scroll_volumes(const World& world, const vec3& viewer_ws, UpdateStatistics& statistics);
  /// For hybrid visibility, finds which probes of the cells around the given ones are visible to
  /// each other.
  /// Returns the number of rays traced; 0 in other modes.
  std::uint64_t update_cell_visibility(const World& world, std::span<const int> probes);

  /// Brings stale probes up to date with the world, and solves for the light that results. Spends
  /// about the budget, on important probes or those near the viewer first.
  EditProgress apply_scene_edits(const World& world, const EditBudget& budget,
                                 const std::optional<vec3>& viewer_ws,
                                 UpdateStatistics& statistics);
  /// Finds the stale probes. Those that cannot be brought up to date start their average again.
  StaleProbes find_stale_probes(const World& world);
  /// Stores a copy of the light before edits, while light and surfels still belong to the same
  /// world.
  void begin_edits(const World& world, const EditBudget& budget, std::span<const int> traced);
  /// Brings waiting probes up to date until the budget is spent, and removes them from
  /// `stale.waiting`. Returns the time that it took [ms].
  double apply_edits_in_slices(const World& world, const EditBudget& budget, StaleProbes& stale,
                               UpdateStatistics& statistics);
  /// Brings one slice of the stale probes up to date. `all` are all traced probes. Reduces their
  /// history ratios, and returns what the edits changed at each.
  EditedProbes apply_edits_to_slice(const World& world, std::span<const WorldChanges> changes,
                                    std::span<const int> probes, std::span<const int> all,
                                    WorkingIrradiance& history_ratio, UpdateStatistics& statistics);
  /// Reduces the weight of averages and corrections whose light the pending edits changed.
  void reduce_history();
  void forget_corrections(EditProgress progress);
  void darken_sleeping();
  void solve_edited(UpdateStatistics& statistics);
  /// Stores solved light where it differs visibly from the light before, and restores the old light
  /// elsewhere. Returns the number of probes whose light changed.
  int store_edited_light(std::span<const int> probes, const WorkingIrradiance& before,
                         const SolveResult& solved, const WorkingIrradiance& history_ratio);
  /// Brings some of the stale sleeping probes up to date.
  void apply_edits_to_sleeping(const World& world, const EditBudget& budget,
                               std::span<const int> all, UpdateStatistics& statistics);
  /// Whether an update that traces these probes learns corrections of lookups.
  bool learns_corrections(std::span<const TraceGroup> groups) const;
  /// Traces the scheduled probes, and blends what they receive into the store: first all but those
  /// that take turns, and then these.
  void trace(const World& world, std::vector<TraceGroup> groups, UpdateStatistics& statistics);
  /// Traces the probes of some groups, adds what that took to the statistics, and learns the
  /// variance of their light.
  ProbeUpdateResult trace_groups(const World& world, std::vector<TraceGroup> groups, bool in_turn,
                                 UpdateStatistics& statistics);
  /// Solves for the light of all traced probes, from the hits of their last rays.
  void solve_warm_up(UpdateStatistics& statistics);
  /// Replaces all light by what a file holds.
  void restore(const FieldFile& file, const World& world, float correction_weight);
  /// A volume as a file stores it.
  FieldVolume volume_for_file(int volume, const World& world) const;
  /// All that a file stores but the corrections.
  FieldFile for_file(const World& world) const;
};

}  // namespace lambent
