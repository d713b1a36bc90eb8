// SPDX-License-Identifier: Apache-2.0
// Which probes of a field a process works on, where several (core/ranks.h) work on it together.
//
// Every process holds the tiles, the light and the state of all probes, since lookups read any of
// them. The surfels of a probe, which take most of the memory, are held only by the process that
// works on the probe. The results of a pass for single probes are gathered after it, so that all
// processes have the same bits.
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
  /// Starts with all probes of a field of this many belonging to this process.
  explicit ProbeShare(int probes) : firsts_{0, probes} {}

  /// From now on, probes are divided equally among these processes. `ranks` must outlive this
  /// object.
  void part_among(Ranks& ranks);
  /// Divides the probes again, so that each process has about the same work with `probes`, which
  /// are in ascending order. Work is measured by learn_work(); before its first call, each process
  /// gets the same number of them. With no probes, the division stays as it is.
  void divide(std::span<const int> probes);
  /// Notes how much work this process had with this many probes, in a unit that all processes
  /// share. All processes must call it together.
  void learn_work(std::size_t probes, double work);

  Ranks& ranks() const { return *ranks_; }
  bool alone() const { return ranks_->count() == 1; }
  int first() const { return firsts_[static_cast<std::size_t>(ranks_->own())]; }
  int end() const { return firsts_[static_cast<std::size_t>(ranks_->own()) + 1]; }
  bool has(int probe) const { return probe >= first() && probe < end(); }

  /// Returns those of the probes that belong to this process. Where it is not alone, `probes` must
  /// be in ascending order.
  std::span<const int> own(std::span<const int> probes) const {
    if (alone()) return probes;
    const std::vector<std::size_t> begins = places_of_parts(probes);
    const auto rank = static_cast<std::size_t>(ranks_->own());
    return probes.subspan(begins[rank], begins[rank + 1] - begins[rank]);
  }
  /// The place in a list of probes, in ascending order, at which the part of each process begins,
  /// and then the size of the list.
  std::vector<std::size_t> places_of_parts(std::span<const int> probes) const;

  /// Gives every process the values that the others computed for their probes. `values` has the
  /// same number of entries for each probe of the field, probe after probe.
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
  std::vector<int> firsts_;   // the first probe of each process; then the number of all probes
  std::vector<double> work_;  // per probe, one entry for each process; empty: not known
};

}  // namespace lambent
