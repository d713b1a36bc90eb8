// SPDX-License-Identifier: Apache-2.0
// Based on: Walter et al., "Lightcuts: A Scalable Approach to Illumination", SIGGRAPH 2005 (many
// lights as few clusters); here built from the top, by splitting where the weight is.
#include "rsm/maps/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "rsm/maps/choice.h"
#include "rsm/to_records.h"

namespace lambent {
namespace {

// Distance that a right angle between normals counts for, as a share of the scene's size.
constexpr float kNormalScale = 0.3f;
// Least number of clusters a thread for which a map is merged by several threads.
constexpr std::size_t kParallelClusters = 2048;

/// A block of a map, as cluster_block.inl.h reads it.
struct Block {
  Block(const ReflectiveShadowMap& of, int x, int y) : map(of), first_x(x), first_y(y) {}

  std::uint32_t place(int k) const {
    return static_cast<std::uint32_t>((first_y + k / kBlockEdge) * map.resolution + first_x +
                                      k % kBlockEdge);
  }
  RsmTexelRecord fetch_block_texel(int k) {
    const bool inside =
        first_x + k % kBlockEdge < map.resolution && first_y + k / kBlockEdge < map.resolution;
    return to_record(inside ? map.texels[place(k)] : RsmTexel());
  }
  void put_cluster(int, const RsmTexelRecord& texel, int seed) {
    clusters->push_back({to_texel(texel), place(seed), 0.0f, 0.0f});
  }

#include "rsm/maps/cluster_block.inl.h"

  const ReflectiveShadowMap& map;
  int first_x, first_y;
  std::vector<Cluster>* clusters = nullptr;
};

using Key = std::array<float, 6>;

Key key_of(const Cluster& cluster, float normal_scale) {
  const vec3& p = cluster.texel.position_ws;
  const vec3 n = cluster.texel.normal_ws * normal_scale;
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

/// The coordinate along which clusters differ most, by their weights.
int widest_axis(std::span<const Cluster> clusters, float normal_scale) {
  std::array<double, 6> mean{}, square{};
  double total = 0.0;
  for (const Cluster& cluster : clusters) {
    const Key key = key_of(cluster, normal_scale);
    total += cluster.weight;
    for (int a = 0; a < 6; ++a) {
      mean[a] += static_cast<double>(cluster.weight) * key[a];
      square[a] += static_cast<double>(cluster.weight) * key[a] * key[a];
    }
  }
  int best = 0;
  double widest = -1.0;
  for (int a = 0; a < 6 && total > 0.0; ++a) {
    const double variance = square[a] / total - mean[a] * mean[a] / (total * total);
    if (variance <= widest) continue;
    widest = variance;
    best = a;
  }
  return best;
}

/// Area of all clusters [m^2]. Where they overlap, areas do not add up, and the extent is used: a
/// square of area A has a mean squared distance from its middle of A / 6, and so have squares of
/// the clusters' own areas.
float area_of(std::span<const Cluster> clusters, bool overlap) {
  float sum = 0.0f;
  vec3 middle(0.0f);
  for (const Cluster& cluster : clusters) {
    sum += cluster.texel.area;
    middle += cluster.texel.area * cluster.texel.position_ws;
  }
  if (!overlap || !(sum > 0.0f)) return sum;
  middle /= sum;
  float moment = 0.0f;
  for (const Cluster& cluster : clusters) {
    const vec3 offset = cluster.texel.position_ws - middle;
    moment += cluster.texel.area * (6.0f * dot(offset, offset) + cluster.texel.area);
  }
  return std::min(sum, moment / sum);
}

/// Parameters of merging.
struct Merging {
  float normal_scale;
  bool overlap;

  /// Whether cluster `a` defines the surface of a merged cluster rather than `b`. Where maps
  /// overlap, light that one source sends to the far side of a wall must not move the light of
  /// others there.
  bool leads(const Cluster& a, const Cluster& b) const {
    return overlap ? a.brought > b.brought : power_of(a.texel.flux) > power_of(b.texel.flux);
  }
};

/// Fills the result with one cluster for each of its places.
void merge(std::span<Cluster> clusters, const Merging& by, std::span<Cluster> result) {
  if (clusters.size() == 1) {
    // Divide its light among its places
    Cluster part = clusters.front();
    const float share = 1.0f / static_cast<float>(result.size());
    part.texel.flux *= share;
    part.brought *= share;
    std::fill(result.begin(), result.end(), part);
    return;
  }
  if (result.size() == 1) {
    const Cluster* brightest = &clusters.front();
    const float area = area_of(clusters, by.overlap);
    for (const Cluster& cluster : clusters) {
      if (by.leads(cluster, *brightest)) brightest = &cluster;
    }
    const RsmTexelRecord seed = to_record(brightest->texel);
    ClusterSum sum = empty_cluster();
    float brought = 0.0f;
    for (const Cluster& cluster : clusters) {
      add_to_cluster(sum, to_record(cluster.texel), seed, std::sqrt(area));
      brought += cluster.brought;
    }
    sum.area = area;
    result.front() = {to_texel(cluster_texel(sum, seed)), brightest->place, 0.0f, brought};
    return;
  }

  // Split the clusters where the weight divides like the number of places
  const int axis = widest_axis(clusters, by.normal_scale);
  std::sort(clusters.begin(), clusters.end(), [&](const Cluster& a, const Cluster& b) {
    const float key_a = key_of(a, by.normal_scale)[axis];
    const float key_b = key_of(b, by.normal_scale)[axis];
    return key_a != key_b ? key_a < key_b : a.place < b.place;
  });
  double total = 0.0;
  for (const Cluster& cluster : clusters) total += cluster.weight;
  const std::size_t wanted = result.size() / 2;
  double sum = clusters.front().weight;
  std::size_t split = 1;
  const double share = total * static_cast<double>(wanted) / static_cast<double>(result.size());
  while (split + 1 < clusters.size() && sum + 0.5 * clusters[split].weight < share) {
    sum += clusters[split++].weight;
  }
  // Divide the places by weight, which a heavy cluster may keep from being split evenly
  const double fair = total > 0.0 ? sum / total * static_cast<double>(result.size()) : 1.0;
  const auto places =
      std::clamp<std::size_t>(static_cast<std::size_t>(fair + 0.5), 1, result.size() - 1);
  const auto half = [&](std::size_t i) {
    merge(i == 0 ? clusters.first(split) : clusters.subspan(split), by,
          i == 0 ? result.first(places) : result.subspan(places));
  };
  if (clusters.size() >= kParallelClusters) {
    parallel_chunks(2, 1, [&](std::size_t i, std::size_t) { half(i); });
  } else {
    half(0);
    half(1);
  }
}

}  // namespace

std::vector<Cluster> cluster_blocks(const ReflectiveShadowMap& map) {
  const int blocks = (map.resolution + kBlockEdge - 1) / kBlockEdge;
  std::vector<std::vector<Cluster>> rows(blocks);
  parallel_chunks(blocks, 1, [&](std::size_t row, std::size_t) {
    for (int column = 0; column < blocks; ++column) {
      Block block(map, column * kBlockEdge, static_cast<int>(row) * kBlockEdge);
      block.clusters = &rows[row];
      block.cluster_block();
    }
  });
  std::vector<Cluster> clusters;
  for (const std::vector<Cluster>& row : rows) {
    clusters.insert(clusters.end(), row.begin(), row.end());
  }
  return clusters;
}

std::vector<Cluster> merge_clusters(std::vector<Cluster> clusters, std::uint32_t count,
                                    bool overlap) {
  std::vector<Cluster> result;
  double total = 0.0;
  Bounds bounds;
  for (const Cluster& cluster : clusters) {
    total += cluster.weight;
    bounds.add(cluster.texel.position_ws);
  }
  if (!(total > 0.0) || count == 0) return result;
  result.resize(count);
  merge(clusters, {kNormalScale * length(bounds.max - bounds.min), overlap}, result);
  return result;
}

}  // namespace lambent
