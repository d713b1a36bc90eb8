// SPDX-License-Identifier: Apache-2.0
#include "field/edits/moved_corrections.h"

#include <algorithm>

#include "raytracing/boxes.h"

namespace lambent {

std::vector<float> corrections_kept_by_moves(std::span<const WorldChanges> changes,
                                             const ProbeStore& store) {
  std::vector<Bounds> moved;
  Bounds all;
  for (const WorldChanges& change : changes) {
    moved.insert(moved.end(), change.moved.begin(), change.moved.end());
    for (const Bounds& box : change.moved) all.add(box);
  }
  if (moved.empty()) return {};
  std::vector<float> kept(static_cast<std::size_t>(store.probes()), 1.0f);
  bool any = false;
  for (int probe = 0; probe < store.probes(); ++probe) {
    const vec3 place = store.probe_position_ws(probe);
    const auto holds = [&](const Bounds& box) { return contains(box, place); };
    if (!contains(all, place) || std::none_of(moved.begin(), moved.end(), holds)) continue;
    kept[static_cast<std::size_t>(probe)] = 0.0f;
    any = true;
  }
  if (!any) kept.clear();
  return kept;
}

}  // namespace lambent
