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
  double all = 0.0;
  for (const int probe : probes) all += work_of(probe);
  const auto count = static_cast<std::size_t>(ranks_->count());
  std::vector<int> firsts = {0};
  double before = 0.0;
  for (const int probe : probes) {
    const double share = static_cast<double>(firsts.size()) / static_cast<double>(count);
    if (firsts.size() < count && before >= share * all) firsts.push_back(probe);
    before += work_of(probe);
  }
  firsts.resize(count, firsts_.back());
  firsts.push_back(firsts_.back());
  firsts_ = std::move(firsts);
}

void ProbeShare::learn_work(std::size_t probes, double work) {
  if (alone()) return;
  work_ = gather_each(*ranks_, probes > 0 ? work / static_cast<double>(probes) : 0.0);
  // The work of a process that had no probes is not known: assume the most that any other had
  const double most = *std::max_element(work_.begin(), work_.end());
  for (double& of_probe : work_) of_probe = of_probe > 0.0 ? of_probe : most > 0.0 ? most : 1.0;
}

/// The work with a probe: the mean over the probes of the process to which it belongs.
double ProbeShare::work_of(int probe) const {
  if (work_.empty()) return 1.0;
  const auto next = std::upper_bound(firsts_.begin(), firsts_.end(), probe);
  return work_[static_cast<std::size_t>(next - firsts_.begin()) - 1];
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
