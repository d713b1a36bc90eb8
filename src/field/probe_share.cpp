// SPDX-License-Identifier: Apache-2.0
#include "field/probe_share.h"

namespace lambent {

void ProbeShare::part_among(Ranks& ranks) {
  ranks_ = &ranks;
  const auto probes = static_cast<std::size_t>(firsts_.back());
  const auto count = static_cast<std::size_t>(ranks.count());
  firsts_.resize(count + 1);
  for (std::size_t r = 0; r <= count; ++r) firsts_[r] = static_cast<int>(r * probes / count);
}

void ProbeShare::divide(std::span<const int> probes) {
  if (alone() || probes.empty()) return;
  assert(std::is_sorted(probes.begin(), probes.end()));
  const auto count = static_cast<std::size_t>(ranks_->count());
  for (std::size_t r = 1; r < count; ++r) firsts_[r] = probes[r * probes.size() / count];
}

std::vector<std::size_t> ProbeShare::places_of_parts(std::span<const int> probes) const {
  std::vector<std::size_t> begins;
  for (const int first : firsts_) {
    begins.push_back(static_cast<std::size_t>(
        std::lower_bound(probes.begin(), probes.end(), first) - probes.begin()));
  }
  return begins;
}

}  // namespace lambent
