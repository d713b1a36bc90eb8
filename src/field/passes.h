// SPDX-License-Identifier: Apache-2.0
// The passes of an update of the field, which executors implement. update.cpp calls them in their
// order.
//
// There are two executors: the processor (field_backend_cpu.cpp), which runs each pass at once, and
// Vulkan (vulkan/passes_vulkan.h), which records commands. Rays are traced by the executor's ray
// source: Embree, our Vulkan world, or an engine. An engine shades hits with commands of its own,
// so that its update is recorded in parts.
#pragma once

#include "lambent/field.h"

namespace lambent {

/// Names of passes. A pass has one name everywhere: as its row in statistics, its timer and its
/// debug label.
namespace field_pass {
inline constexpr const char* kPlacement = "placement";
inline constexpr const char* kEdits = "edits";
inline constexpr const char* kSchedule = "schedule";
inline constexpr const char* kTrace = "trace";
inline constexpr const char* kShade = "shade";
inline constexpr const char* kBlendDistances = "blend_distances";
inline constexpr const char* kVisibility = "visibility";
inline constexpr const char* kCorrections = "corrections";
inline constexpr const char* kLookups = "lookups";
inline constexpr const char* kSolve = "solve";
inline constexpr const char* kVariability = "variability";
inline constexpr const char* kStore = "store";
}  // namespace field_pass

/// The passes over the probes of one update. Each call leaves its result for those that follow.
class FieldPasses {
 public:
  virtual ~FieldPasses() = default;

  virtual const FieldSettings& settings() const = 0;
  /// The number of batches in which the update's rays are traced and shaded. A batch fits into
  /// memory.
  virtual int batches() const = 0;

  /// Scrolls the volumes that follow the viewer, where the host has not done so.
  virtual void scroll() = 0;
  /// Chooses the probes and draws their rays, where the host has not done so.
  virtual void schedule() = 0;
  /// Finds the hits of a batch's rays.
  virtual void trace(int batch) = 0;
  /// Makes surfels of a batch's hits, with the direct light on them.
  virtual void shade(int batch) = 0;
  /// Stores the state of the probes before edits that the passes after them need. Called before the
  /// probes' rays are traced again.
  virtual void keep_history() = 0;
  /// Shifts the stored distances by the change in the distances of the same rays.
  virtual void move_distances() = 0;
  /// Blends the distances of all rays into the store.
  virtual void blend_distances() = 0;
  /// Finds which probes of the cells around the update's probes are visible to each other.
  virtual void visibility() = 0;
  /// Whether the executor learns corrections of lookups.
  virtual bool learns() const = 0;
  /// Learns corrections of lookups, from the light of the update before.
  virtual void corrections() = 0;
  /// Finds the probes that light each surfel, and their weights.
  virtual void lookups() = 0;
  /// Solves for the light of all bounces, and blends it into what the probes hold.
  virtual void solve() = 0;
  /// Finds by how much the solution changed the probes' light.
  virtual void variability() = 0;
  /// Encodes the probes' light for lookups.
  virtual void store() = 0;
  /// Relocates and classifies the probes by the hits of the update's own rays, where the host
  /// cannot trace fixed rays.
  virtual void placement() = 0;

  /// Called before each pass, with its name.
  virtual void begin(const char* name) = 0;
  /// Called after each pass.
  virtual void end() = 0;
};

/// Runs all passes of an update whose probes the host has placed and chosen.
void update_probes(FieldPasses& passes);
/// Traces the last rays of probes again, after edits, and brings their distances and lookups up to
/// date. The host has looked across the cells around them, and solves for the light.
void retrace_probes(FieldPasses& passes);

// An engine records an update in four parts, in this order, with commands of its own in between.

/// Scrolls the volumes of a field with cascades, and runs the schedule.
void choose_rays(FieldPasses& passes);
/// Finds the hits of the chosen rays. The engine shades them afterwards.
void find_hits(FieldPasses& passes);
/// Runs all passes from shaded hits to stored light.
void follow_hits(FieldPasses& passes);
/// Runs all passes from shaded hits to stored light for rays that were traced again after edits.
void follow_retraced_hits(FieldPasses& passes);
/// Runs the placement.
void maintain_probes(FieldPasses& passes);

}  // namespace lambent
