// SPDX-License-Identifier: Apache-2.0
// Threads of one process as Ranks: what several processes do, without any.
#pragma once

#include <barrier>
#include <cstddef>
#include <cstring>
#include <functional>
#include <span>
#include <thread>
#include <vector>

#include "core/ranks.h"

namespace lambent::test {

/// What the threads of a group share.
struct ThreadGroup {
  explicit ThreadGroup(int size) : count(size), gathered(size), all_there(size) {}

  int count;
  std::vector<std::span<std::byte>> gathered;  // by rank: what it gathers into
  std::barrier<> all_there;
};

class ThreadRanks final : public Ranks {
 public:
  ThreadRanks(ThreadGroup& group, int own) : group_(group), own_(own) {}

  int count() const override { return group_.count; }
  int own() const override { return own_; }

  void gather_bytes(std::span<std::byte> bytes, std::span<const std::size_t> firsts) override {
    group_.gathered[own_] = bytes;
    group_.all_there.arrive_and_wait();
    for (int r = 0; r < group_.count; ++r) {
      const std::size_t size = firsts[r + 1] - firsts[r];
      if (r == own_ || size == 0) continue;
      std::memcpy(bytes.data() + firsts[r], group_.gathered[r].data() + firsts[r], size);
    }
    group_.all_there.arrive_and_wait();
  }

 private:
  ThreadGroup& group_;
  int own_;
};

/// Runs body(ranks) as each of so many ranks, in threads of their own.
inline void run_as_ranks(int count, const std::function<void(Ranks&)>& body) {
  ThreadGroup group(count);
  std::vector<std::thread> threads;
  for (int r = 0; r < count; ++r) {
    threads.emplace_back([&group, &body, r] {
      ThreadRanks ranks(group, r);
      body(ranks);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

}  // namespace lambent::test
