// SPDX-License-Identifier: Apache-2.0
// Groups of processes that divide a task among them and exchange data. All of them run the same
// program with the same input, and call the functions of this file in the same order.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <type_traits>
#include <vector>

namespace lambent {

/// One process's access to its group. Not thread-safe.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int count() const = 0;  ///< Number of processes, >= 1.
  virtual int own() const = 0;    ///< Rank of this process, 0 to count() - 1.

  /// Gives every process the bytes of all: those of process r are [firsts[r], firsts[r + 1]) of
  /// `bytes`, where process r has stored them. `firsts` has count() + 1 entries, the same on all of
  /// them. Returns once this process has all bytes. If a process terminates, the whole job ends.
  virtual void gather_bytes(std::span<std::byte> bytes, std::span<const std::size_t> firsts) = 0;
};

/// A group of this process alone.
Ranks& one_rank();

/// Gives every process the values of all: those of process r are [firsts[r], firsts[r + 1]).
template <class T>
void gather_parts(Ranks& ranks, std::span<T> values, std::span<const std::size_t> firsts) {
  static_assert(std::is_trivially_copyable_v<T>);
  if (ranks.count() == 1) return;
  std::vector<std::size_t> bytes(firsts.begin(), firsts.end());
  for (std::size_t& first : bytes) first *= sizeof(T);
  ranks.gather_bytes(std::as_writable_bytes(values), bytes);
}

/// The value that each process has, by rank.
template <class T>
std::vector<T> gather_each(Ranks& ranks, const T& own) {
  const auto count = static_cast<std::size_t>(ranks.count());
  std::vector<T> all(count);
  std::vector<std::size_t> firsts(count + 1);
  std::iota(firsts.begin(), firsts.end(), std::size_t{0});
  all[static_cast<std::size_t>(ranks.own())] = own;
  gather_parts(ranks, std::span(all), firsts);
  return all;
}

/// The values of all processes, rank after rank; each may have any number of them.
template <class T>
std::vector<T> gather_all(Ranks& ranks, std::vector<T> own) {
  if (ranks.count() == 1) return own;
  std::vector<std::size_t> firsts = {0};
  for (const std::uint64_t size : gather_each<std::uint64_t>(ranks, own.size())) {
    firsts.push_back(firsts.back() + size);
  }
  std::vector<T> all(firsts.back());
  std::copy(own.begin(), own.end(), all.begin() + firsts[static_cast<std::size_t>(ranks.own())]);
  own = {};
  gather_parts(ranks, std::span(all), firsts);
  return all;
}

/// The sum of a number over all processes.
inline std::uint64_t sum_over(Ranks& ranks, std::uint64_t own) {
  const std::vector<std::uint64_t> all = gather_each(ranks, own);
  return std::accumulate(all.begin(), all.end(), std::uint64_t{0});
}

}  // namespace lambent
