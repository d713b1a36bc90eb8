// SPDX-License-Identifier: Apache-2.0
// Corrections of lookups that edits make wrong at once.
#pragma once

#include <span>
#include <vector>

#include "field/probes/probe_store.h"
#include "lambent/world.h"

namespace lambent {

/// Where things move, the share of corrections that is kept around each probe: none around those
/// inside the box of something that moved. Empty: nothing moved there.
///
/// Cells of corrections stay where they are, and hold what the surfaces in them have taught. Once a
/// hollow thing such as a lampshade moves around a probe, surfaces in it read that probe, with a
/// correction that made up for the darkness outside. They would then return more light than
/// arrives, so that bounces would not fade.
std::vector<float> corrections_kept_by_moves(std::span<const WorldChanges> changes,
                                             const ProbeStore& store);

}  // namespace lambent
