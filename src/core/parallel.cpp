// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.h"

#include <numeric>
#include <vector>

// Under the thread sanitizer, use std::thread: oneTBB is not instrumented, so the sanitizer would
// report its handing over of work as races. std::thread is also used where oneTBB is missing.
#if defined(__SANITIZE_THREAD__)
#define LAMBENT_UNDER_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define LAMBENT_UNDER_TSAN 1
#endif
#endif
#ifndef LAMBENT_UNDER_TSAN
#define LAMBENT_UNDER_TSAN 0
#endif

#if LAMBENT_UNDER_TSAN || !LAMBENT_CPU
#define LAMBENT_OWN_THREADS 1
#else
#define LAMBENT_OWN_THREADS 0
#endif

#if LAMBENT_OWN_THREADS
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#else
#include <tbb/parallel_for.h>
#endif

namespace lambent {
namespace {

#if LAMBENT_OWN_THREADS

std::size_t thread_count() {
#if LAMBENT_UNDER_TSAN
  return 4;  // enough to find races
#else
  return std::max(1u, std::thread::hardware_concurrency());
#endif
}

void for_each_index(std::size_t count, const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next = 0;
  std::mutex failing;
  std::exception_ptr failure;
  const auto work = [&] {
    try {
      for (std::size_t i = next.fetch_add(1, std::memory_order_relaxed); i < count;
           i = next.fetch_add(1, std::memory_order_relaxed)) {
        body(i);
      }
    } catch (...) {
      const std::lock_guard lock(failing);
      failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < std::min(count, thread_count()); ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
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
