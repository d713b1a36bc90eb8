// SPDX-License-Identifier: Apache-2.0
// The state of relocation and classification between updates.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "field/placement/classify.h"
#include "field/probe_data.h"
#include "field/schedule/schedule.h"
#include "lambent/world.h"
#include "raytracing/solid_sides/solid_sides.h"

namespace lambent {

/// A box in which static geometry was edited. Probes near it are relocated once edits there stop.
struct EditedPlace {
  Bounds box;
  int update;  ///< Number of the last update that found an edit in the box.
};

/// When what is solid was found last, and whether it must be found again.
struct SolidSearch {
  bool needed = false;   ///< A closed region may have been opened or lit since.
  bool moved = false;    ///< Something has moved since.
  bool in_vain = false;  ///< The last search found nothing new.
  int update = 0;        ///< Number of the update of the last search.
};

struct PlacementState {
  std::vector<ClassificationInput> classification_inputs;  ///< From the static part of the scene.
  std::vector<EditedPlace> edited_places = {};
  std::uint64_t solid_revision = 0;  ///< Revision that ProbeData::solid_sides are up to date with.
  SolidSearch solid = {};
  std::uint64_t placed_revision = 0;  ///< The revision that edited_places are up to date with.
  /// Where what is solid differs since probes were placed: the places that were open before.
  std::optional<std::vector<OpenPlaces>> open_before = {};
  bool classified = false;  ///< The classification inputs have not changed since classify().
  std::vector<Bounds> moved_to = {};  ///< Bounds of the dynamic instances at the last classify().
};

/// Sets the state of each probe from its classification input and from the current bounds of the
/// dynamic instances. Notifies the scheduler of the probes whose states changed.
void classify(const World& world, const ProbeStore& store, PlacementState& placement,
              std::span<ProbeStatus> statuses, ProbeScheduler& scheduler);

/// Discards a probe's surfels, stored distances and number of samples. Its light stays.
void reset_probe(int probe, ProbeData& data, std::span<ProbeStatus> statuses,
                 ProbeScheduler& scheduler);

}  // namespace lambent
