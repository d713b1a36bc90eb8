// SPDX-License-Identifier: Apache-2.0
#include "field/schedule/importance.h"

#include <algorithm>

#include "field/lookup/lookup_volumes.h"
#include "field/schedule/importance_math.h"

namespace lambent {
namespace {

// Bounces through which importance is scattered back. Light of later bounces depends on all probes
// about equally.
constexpr int kBounces = 2;

// Probes below this fraction of the largest importance do not scatter their importance, which would
// make no visible difference.
constexpr float kMinScattered = 1e-3f;

void add_weights(const ProbeStore& store, const CornerWeights& corners, float importance,
                 std::vector<float>& sum) {
  const CornerOffsets& offsets = store.corner_table()[corners.table];
  for (int k = 0; k < kCellCorners; ++k) {
    sum[corners.base + offsets.probe[k]] += importance * corners.weight[k];
  }
}

/// Adds to the probes in `sum` the importance that the surfels of a probe pass on to them, in
/// proportion to the light that they reflect towards the probe.
void scatter_importance(const ProbeStore& store, const ProbeTrace& trace, float importance,
                        std::vector<float>& sum) {
  const auto surfels = static_cast<int>(trace.surfels.size());
  for (std::size_t i = 0; i < trace.surfels.size(); i += kSurfelsPerScatter) {
    const Surfel& surfel = trace.surfels[i];
    if (!surfel.reflects() || surfel.kind != SurfelKind::surface) continue;
    add_weights(store, trace.lookups[i].corners,
                scattered_importance(importance, surfels, surfel.albedo_over_pi), sum);
  }
  for (const FurtherLookup& further : trace.further) {
    if (further.ray % kSurfelsPerScatter != 0) continue;
    const vec3 albedo_over_pi = trace.surfels[further.ray].albedo_over_pi;
    add_weights(store, further.lookup.corners,
                scattered_importance(importance, surfels, albedo_over_pi), sum);
  }
}

}  // namespace

std::vector<float> scatter_from_surfels(const ProbeStore& store, std::span<const ProbeTrace> traces,
                                        std::span<const float> received, float least) {
  // Work on one probe after the other, so that sums have the same bits on any number of threads
  std::vector<float> sent(store.probes(), 0.0f);
  for (int probe = 0; probe < store.probes(); ++probe) {
    if (received[probe] <= least || traces[probe].rays == nullptr) continue;
    scatter_importance(store, traces[probe], received[probe], sent);
  }
  return sent;
}

std::vector<float> probe_importance(const ProbeStore& store, std::span<const FieldQuery> points,
                                    std::span<const ProbeTrace> traces) {
  return probe_importance(store, points, [&](std::span<const float> received, float least) {
    return scatter_from_surfels(store, traces, received, least);
  });
}

std::vector<float> probe_importance(const ProbeStore& store, std::span<const FieldQuery> points,
                                    const ImportanceScatter& send) {
  // Compute the importance of the probes that the points read
  std::vector<float> received(store.probes(), 0.0f);
  QueryWeights weights;
  find_weights(store, {}, points, weights);
  for (const CornerWeights& corners : weights.corners) add_weights(store, corners, 1.0f, received);

  // Scatter the importance to the probes whose light those receive
  std::vector<float> total = received;
  for (int bounce = 0; bounce < kBounces; ++bounce) {
    const float least = kMinScattered * *std::max_element(received.begin(), received.end());
    std::vector<float> sent = send(received, least);
    for (int probe = 0; probe < store.probes(); ++probe) total[probe] += sent[probe];
    received = std::move(sent);
  }
  const float largest = *std::max_element(total.begin(), total.end());
  if (largest > 0.0f) {
    for (float& importance : total) importance /= largest;
  }
  return total;
}

}  // namespace lambent
