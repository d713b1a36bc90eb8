// SPDX-License-Identifier: Apache-2.0
// The passes of an update of the field, as executors supply them; update.cpp says in which order
// they run.
//
// There are two executors: the processor (passes_cpu.cpp), which does what it is asked at once, and
// Vulkan (vulkan/passes_vulkan.h), which only records. Where rays come from is the executor's ray
// source: Embree, our Vulkan world, or an engine. An engine shades what rays meet with commands of
// its own, so that its update is recorded in parts.
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
  /// Parts in which the update's rays are traced and shaded, so that each fits into memory.
  virtual int batches() const = 0;

  /// Chooses the probes and draws their rays, where the executor and not the host decides.
  virtual void schedule() = 0;
  /// Finds what a batch's rays meet.
  virtual void trace(int batch) = 0;
  /// Makes surfels of what they met, with the direct light on them.
  virtual void shade(int batch) = 0;
  /// Blends the distances that all rays saw into the store.
  virtual void blend_distances() = 0;
  /// Finds which probes of the cells around the update's probes see each other.
  virtual void visibility() = 0;
  /// Finds which probes light each surfel, and by how much.
  virtual void lookups() = 0;
  /// Solves for the light of all bounces, and blends it into what the probes hold.
  virtual void solve() = 0;
  /// Finds by how much that changed their light.
  virtual void variability() = 0;
  /// Encodes their light for lookups.
  virtual void store() = 0;
  /// Moves probes and says what they are for, where the update's own rays are all there is to
  /// decide by.
  virtual void placement() = 0;

  /// Around each pass, with its name.
  virtual void begin(const char* name) = 0;
  virtual void end() = 0;
};

/// All passes of an update whose probes the host has chosen and placed.
void update_probes(FieldPasses& passes);

// The parts in which an engine records an update; they follow one another in this order.

void choose_rays(FieldPasses& passes);
void find_hits(FieldPasses& passes);
/// From hits that the engine has shaded to stored light.
void follow_hits(FieldPasses& passes);
void maintain_probes(FieldPasses& passes);

}  // namespace lambent
