// SPDX-License-Identifier: Apache-2.0
// The order in which stale probes are brought up to date with the edits of the world, and how many
// at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "field/transport/surfels.h"

namespace lambent {

/// Some stale probes that are brought up to date together.
struct StaleSlice {
  std::vector<int> probes;
  std::uint64_t oldest = 0;  ///< The oldest revision that any of them is up to date with.
};

/// The most that a slice may have.
struct SliceLimit {
  std::uint64_t surfels;
  std::size_t probes;
};

/// Takes the first waiting probes: at least one, and otherwise no more than the limit.
StaleSlice next_slice(std::span<const int> waiting, std::span<const ProbeTrace> traces,
                      std::span<const ProbeStatus> statuses, const SliceLimit& most);

/// Sorts stale probes by how urgently they must be brought up to date: overdue ones come first, so
/// that no probe stays stale for ever in a world that is edited continually. Then come probes by
/// their importance, or by their distance from the viewer.
void order_stale_probes(std::uint64_t revision, const ProbeStore& store,
                        std::span<const ProbeStatus> statuses, std::span<const float> importance,
                        const std::optional<vec3>& viewer_ws, std::vector<int>& waiting);

}  // namespace lambent
