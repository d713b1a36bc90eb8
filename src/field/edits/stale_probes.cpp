// SPDX-License-Identifier: Apache-2.0
#include "field/edits/stale_probes.h"

#include <algorithm>
#include <limits>

namespace lambent {
namespace {

// Probes that lag behind the world by more revisions than this are brought up to date before all
// others.
constexpr std::uint64_t kOverdueRevisions = 16;

}  // namespace

StaleSlice next_slice(std::span<const int> waiting, std::span<const ProbeTrace> traces,
                      std::span<const ProbeStatus> statuses, const SliceLimit& most) {
  StaleSlice slice;
  slice.oldest = statuses[waiting.front()].revision;
  std::uint64_t surfels = 0;
  for (const int probe : waiting.first(std::min(waiting.size(), most.probes))) {
    // A probe that was relocated has no surfels
    if (traces[probe].rays) surfels += static_cast<std::uint64_t>(traces[probe].rays->rays());
    if (surfels > most.surfels && !slice.probes.empty()) break;
    slice.probes.push_back(probe);
    slice.oldest = std::min(slice.oldest, statuses[probe].revision);
  }
  return slice;
}

void order_stale_probes(std::uint64_t revision, const ProbeStore& store,
                        std::span<const ProbeStatus> statuses, std::span<const float> importance,
                        const std::optional<vec3>& viewer_ws, std::vector<int>& waiting) {
  std::vector<float> rank(statuses.size(), 0.0f);
  for (const int probe : waiting) {
    if (revision - statuses[probe].revision > kOverdueRevisions) {
      rank[probe] = -std::numeric_limits<float>::max();
    } else if (!importance.empty()) {
      rank[probe] = -importance[probe];
    } else if (viewer_ws) {
      rank[probe] = glm::distance(store.probe_position_ws(probe), *viewer_ws);
    }
  }
  std::stable_sort(waiting.begin(), waiting.end(), [&](int a, int b) { return rank[a] < rank[b]; });
}

}  // namespace lambent
