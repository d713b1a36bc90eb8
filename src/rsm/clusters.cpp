// SPDX-License-Identifier: Apache-2.0
// Based on: Walter et al., "Lightcuts: A Scalable Approach to Illumination", SIGGRAPH 2005 (many
// lights as few clusters); here built from the top, by splitting where the weight is.
#include "rsm/clusters.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "rsm/geometry.h"

namespace lambent {
namespace {

// Texels along an edge of a block.
constexpr int kBlock = 4;
// Surfaces that a block tells apart; what shows more is rare and small.
constexpr int kSurfaces = 3;
// Texels are of one surface where their normals are within 37 degrees, and where they are off its
// plane by less than this share of the block's edge.
constexpr float kSameNormal = 0.8f, kSamePlane = 0.25f;
// A right angle between normals parts clusters as much as this share of the scene's size does.
constexpr float kNormalScale = 0.3f;
// A map is merged by several threads once that many clusters are left to each.
constexpr std::size_t kParallelClusters = 2048;

float power_of(const vec3& flux) {
  return std::max({flux.x, flux.y, flux.z});
}

/// Whether two texels show one surface, on the scale of `edge` [m].
bool same_surface(const RsmTexel& a, const RsmTexel& b, float edge) {
  return dot(a.normal_ws, b.normal_ws) > kSameNormal &&
         std::abs(dot(a.position_ws - b.position_ws, b.normal_ws)) <= kSamePlane * edge;
}

/// Sums up texels, or clusters, around one that tells which surface they stand for: others' light
/// counts, but not where they are, or the sum would hang in mid-air.
class Sum {
 public:
  Sum(const RsmTexel& seed, float edge) : seed_(seed), edge_(edge) {}
  void add(const RsmTexel& texel) {
    flux_ += texel.flux;
    area_ += texel.area;
    if (!same_surface(texel, seed_, edge_)) return;
    const float power = power_of(texel.flux);
    power_ += power;
    position_ += power * texel.position_ws;
    normal_ += power * texel.normal_ws;
  }
  RsmTexel texel() const {
    RsmTexel result = seed_;
    if (power_ > 0.0f) {
      result.position_ws = position_ / power_;
      result.normal_ws = normalize(normal_);
    }
    result.flux = flux_;
    result.area = area_;
    result.softening = kSofteningPerArea * area_;
    return result;
  }

 private:
  const RsmTexel& seed_;
  float edge_;
  vec3 position_{0.0f}, normal_{0.0f}, flux_{0.0f};
  float power_ = 0.0f, area_ = 0.0f;
};

/// Parts the texels of a block by surface, brightest first.
void cluster_block(const ReflectiveShadowMap& map, std::vector<std::uint32_t>& left,
                   std::vector<Cluster>& result) {
  for (int s = 0; s < kSurfaces && !left.empty(); ++s) {
    const std::uint32_t seed = *std::max_element(left.begin(), left.end(), [&](auto a, auto b) {
      return power_of(map.texels[a].flux) < power_of(map.texels[b].flux);
    });
    const RsmTexel& first = map.texels[seed];
    const float edge = kBlock * std::sqrt(first.area);
    Sum sum(first, edge);
    const auto others = std::partition(left.begin(), left.end(), [&](std::uint32_t i) {
      return s + 1 == kSurfaces || same_surface(map.texels[i], first, edge);
    });
    // In the order of the map, so that sums do not depend on how the library partitions
    std::sort(left.begin(), others);
    for (auto i = left.begin(); i != others; ++i) sum.add(map.texels[*i]);
    result.push_back({sum.texel(), seed, 0.0f, 0.0f});
    left.erase(left.begin(), others);
    std::sort(left.begin(), left.end());
  }
}

using Key = std::array<float, 6>;

Key key_of(const Cluster& cluster, float normal_scale) {
  const vec3& p = cluster.texel.position_ws;
  const vec3 n = cluster.texel.normal_ws * normal_scale;
  return {p.x, p.y, p.z, n.x, n.y, n.z};
}

/// The coordinate in which clusters are farthest apart, by their weights.
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

/// Fills result with one cluster for each of its places.
void merge(std::span<Cluster> clusters, float normal_scale, std::span<Cluster> result) {
  if (clusters.size() == 1) {
    // Part its light among its places
    Cluster part = clusters.front();
    const float share = 1.0f / static_cast<float>(result.size());
    part.texel.flux *= share;
    part.brought *= share;
    std::fill(result.begin(), result.end(), part);
    return;
  }
  if (result.size() == 1) {
    const Cluster* brightest = &clusters.front();
    float area = 0.0f;
    for (const Cluster& cluster : clusters) {
      area += cluster.texel.area;
      if (power_of(cluster.texel.flux) > power_of(brightest->texel.flux)) brightest = &cluster;
    }
    Sum sum(brightest->texel, std::sqrt(area));
    float brought = 0.0f;
    for (const Cluster& cluster : clusters) {
      sum.add(cluster.texel);
      brought += cluster.brought;
    }
    result.front() = {sum.texel(), brightest->place, 0.0f, brought};
    return;
  }

  // Split where the weight is parted as the places are
  const int axis = widest_axis(clusters, normal_scale);
  std::sort(clusters.begin(), clusters.end(), [&](const Cluster& a, const Cluster& b) {
    const float key_a = key_of(a, normal_scale)[axis], key_b = key_of(b, normal_scale)[axis];
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
  // Places go with the weight, which a heavy cluster keeps from being parted evenly
  const double fair = total > 0.0 ? sum / total * static_cast<double>(result.size()) : 1.0;
  const auto places =
      std::clamp<std::size_t>(static_cast<std::size_t>(fair + 0.5), 1, result.size() - 1);
  const auto half = [&](std::size_t i) {
    merge(i == 0 ? clusters.first(split) : clusters.subspan(split), normal_scale,
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
  const int blocks = (map.resolution + kBlock - 1) / kBlock;
  std::vector<std::vector<Cluster>> rows(blocks);
  parallel_chunks(blocks, 1, [&](std::size_t row, std::size_t) {
    std::vector<std::uint32_t> lit;
    for (int block = 0; block < blocks; ++block) {
      lit.clear();
      const int top = static_cast<int>(row) * kBlock, left = block * kBlock;
      for (int y = top; y < std::min(top + kBlock, map.resolution); ++y) {
        for (int x = left; x < std::min(left + kBlock, map.resolution); ++x) {
          const auto i = static_cast<std::uint32_t>(y * map.resolution + x);
          if (power_of(map.texels[i].flux) > 0.0f) lit.push_back(i);
        }
      }
      cluster_block(map, lit, rows[row]);
    }
  });
  std::vector<Cluster> clusters;
  for (const std::vector<Cluster>& row : rows) {
    clusters.insert(clusters.end(), row.begin(), row.end());
  }
  return clusters;
}

std::vector<Cluster> merge_clusters(std::vector<Cluster> clusters, std::uint32_t count) {
  std::vector<Cluster> result;
  double total = 0.0;
  Bounds bounds;
  for (const Cluster& cluster : clusters) {
    total += cluster.weight;
    bounds.add(cluster.texel.position_ws);
  }
  if (!(total > 0.0) || count == 0) return result;
  result.resize(count);
  merge(clusters, kNormalScale * length(bounds.max - bounds.min), result);
  return result;
}

}  // namespace lambent
