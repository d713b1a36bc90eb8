// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.h"

#include <numeric>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <atomic>
#include <thread>
#else
#include <tbb/parallel_for.h>
#endif

namespace lambent {
namespace {

#ifdef __SANITIZE_THREAD__

// The thread sanitizer does not see how oneTBB, which is not built for it, hands work from thread
// to thread, and calls all of it a race. With these threads it sees everything.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& body) {
  constexpr int kThreads = 4;
  std::atomic<std::size_t> next = 0;
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&] {
      for (std::size_t i = next.fetch_add(1, std::memory_order_relaxed); i < count;
           i = next.fetch_add(1, std::memory_order_relaxed)) {
        body(i);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

#else

template <class Body>
void for_each_index(std::size_t count, const Body& body) {
  tbb::parallel_for(std::size_t{0}, count, body);
}

#endif

}  // namespace

void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  for_each_index(chunks, [&](std::size_t i) { body(i * chunk, std::min(count, (i + 1) * chunk)); });
}

double parallel_sum(std::size_t count, std::size_t chunk,
                    const std::function<double(std::size_t, std::size_t)>& body) {
  std::vector<double> sums((count + chunk - 1) / chunk);
  parallel_chunks(count, chunk, [&](std::size_t begin, std::size_t end) {
    sums[begin / chunk] = body(begin, end);
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace lambent
