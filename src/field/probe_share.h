// SPDX-License-Identifier: Apache-2.0
// Which probes of a field a process works on, where several (core/ranks.h) work on it together.
//
// Every process holds the tiles, the light and the state of all probes: lookups read any of them.
// The surfels of a probe, which take most of the memory, are where the probe is worked on. What a
// pass finds of single probes is gathered after it, so that all processes have the same bits.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

#include "core/ranks.h"

namespace lambent {

class ProbeShare {
 public:
  /// All of so many probes belong to this process.
  explicit ProbeShare(int probes) : firsts_{0, probes} {}

  /// From now on, probes are parted among these processes, as many to each. `ranks` must outlive
  /// it.
  void part_among(Ranks& ranks);
  /// Parts the probes anew, so that each process has about as much work with these, which are in
  /// ascending order: as many of them, or what learn_work() was told. Without any, all stay where
  /// they are.
  void divide(std::span<const int> probes);
  /// Notes how much work this process had with so many probes: any number in proportion. All
  /// processes call it.
  void learn_work(std::size_t probes, double work);

  Ranks& ranks() const { return *ranks_; }
  bool alone() const { return ranks_->count() == 1; }
  int first() const { return firsts_[static_cast<std::size_t>(ranks_->own())]; }
  int end() const { return firsts_[static_cast<std::size_t>(ranks_->own()) + 1]; }
  bool has(int probe) const { return probe >= first() && probe < end(); }

  /// Those of some probes that are this process's. Where it is not alone, `probes` must be in
  /// ascending order.
  std::span<const int> own(std::span<const int> probes) const {
    if (alone()) return probes;
    const std::vector<std::size_t> begins = places_of_parts(probes);
    const auto rank = static_cast<std::size_t>(ranks_->own());
    return probes.subspan(begins[rank], begins[rank + 1] - begins[rank]);
  }
  /// Where the part of each process begins in such a list, and the size of the list.
  std::vector<std::size_t> places_of_parts(std::span<const int> probes) const;

  /// Gives every process what the others found of their probes. `values` has as many entries for
  /// each probe of the field, probe after probe.
  template <class T>
  void gather(std::span<T> values) const {
    if (alone()) return;
    const auto probes = static_cast<std::size_t>(firsts_.back());
    assert(values.size() % probes == 0);
    std::vector<std::size_t> firsts(firsts_.begin(), firsts_.end());
    for (std::size_t& first : firsts) first *= values.size() / probes;
    gather_parts(*ranks_, values, firsts);
  }

 private:
  double work_of(int probe) const;

  Ranks* ranks_ = &one_rank();
  std::vector<int> firsts_;   // of each process's probes; then the number of all
  std::vector<double> work_;  // with a probe of each process's; empty: not known
};

}  // namespace lambent
