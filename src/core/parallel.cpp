// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.h"

#include <tbb/parallel_for.h>

#include <numeric>
#include <vector>

namespace lambent {

void parallel_chunks(std::size_t count, std::size_t chunk,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  tbb::parallel_for(std::size_t{0}, chunks,
                    [&](std::size_t i) { body(i * chunk, std::min(count, (i + 1) * chunk)); });
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
