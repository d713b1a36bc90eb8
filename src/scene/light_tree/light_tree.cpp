// SPDX-License-Identifier: Apache-2.0
// Based on: Conty Estevez and Kulla, "Importance Sampling of Many Lights with Adaptive Tree
// Splitting", PACMCGIT 1(2), 2018.
#include "scene/light_tree/light_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>

#include "scene/light_tree/cluster.h"
#include "shared/constants.h"

namespace lambent {
namespace {

// Places along each axis at which a cluster may be split.
constexpr int kBins = 12;
// For larger clusters, orientations are ignored and count as all directions: their cones would take
// most of the time of a build.
constexpr std::size_t kMostLightsWithCones = 256;
// A fitted tree whose cost has grown by this factor is built again.
constexpr double kWornOut = 2.0;

bool is_asked(const Light& light, std::size_t local_lights) {
  return light.type == Light::Type::directional || local_lights <= kMaxLightsAsked;
}

/// Splits ranges of lights in two.
class Splitter {
 public:
  explicit Splitter(std::span<const LightCluster> lights) : lights_(lights) {
    middles_.reserve(lights.size());
    for (const LightCluster& light : lights) {
      middles_.push_back(0.5f * light.box.min + 0.5f * light.box.max);
    }
  }

  /// Partitions at least two lights by the best split; returns the length of the first part.
  std::size_t split(std::span<std::uint32_t> range) {
    if (range.size() == 2) return 1;
    Bounds middles;
    for (const std::uint32_t light : range) middles.add(middles_[light]);
    const glm::vec3 size = middles.max - middles.min;
    const float longest = std::max({size.x, size.y, size.z});
    Best best;
    for (int axis = 0; axis < 3; ++axis) {
      if (size[axis] > 0.0f) try_axis(range, middles, axis, longest / size[axis], best);
    }
    // Lights at the same place are split arbitrarily
    if (best.axis < 0) return range.size() / 2;
    const auto second = std::partition(range.begin(), range.end(), [&](std::uint32_t light) {
      return bin_of(middles_[light], middles, best.axis) < best.bin;
    });
    return static_cast<std::size_t>(second - range.begin());
  }

 private:
  struct Best {
    double cost = 0.0;
    int axis = -1;
    int bin = 0;  // first bin of the second part
  };

  static int bin_of(const glm::vec3& middle, const Bounds& middles, int axis) {
    const float low = middles.min[axis], size = middles.max[axis] - low;
    return std::min(static_cast<int>((middle[axis] - low) / size * kBins), kBins - 1);
  }

  void try_axis(std::span<const std::uint32_t> range, const Bounds& middles, int axis,
                float thinness, Best& best) {
    std::array<LightCluster, kBins> bins;
    const bool with_cones = range.size() <= kMostLightsWithCones;
    for (const std::uint32_t light : range) {
      LightCluster& bin = bins[bin_of(middles_[light], middles, axis)];
      if (with_cones || bin.empty) {
        bin.add(lights_[light]);
      } else {
        bin.box.add(lights_[light].box);
        bin.intensity += lights_[light].intensity;
      }
    }
    std::array<double, kBins> cost_from{};
    LightCluster after;
    for (int bin = kBins - 1; bin > 0; --bin) {
      after.add(bins[bin]);
      cost_from[bin] = after.cost();
    }
    LightCluster before;
    for (int bin = 1; bin < kBins; ++bin) {
      before.add(bins[bin - 1]);
      if (before.empty || (bins[bin].empty && cost_from[bin] == 0.0)) continue;
      // Conty Estevez and Kulla 2018, eq. 2: thin slices of long clusters are discouraged
      const double cost = thinness * (before.cost() + cost_from[bin]);
      if (best.axis < 0 || cost < best.cost) best = {cost, axis, bin};
    }
  }

  std::span<const LightCluster> lights_;
  std::vector<glm::vec3> middles_;
};

}  // namespace

LightTree::LightTree(const Scene& scene, const EmissiveTriangles& emissive) {
  update(scene, emissive);
}

void LightTree::update(const Scene& scene, const EmissiveTriangles& emissive) {
  list_lights(scene);
  std::vector<LightKey> keys;
  keys.reserve(emissive.size() + drawn_.size());
  for (const EmitterRecord& emitter : emissive.entries()) {
    keys.push_back({emitter.instance, emitter.triangle, emitter.piece_corner, emitter.piece_size});
  }
  for (const std::uint32_t light : drawn_) keys.push_back({kPunctual, light});
  const bool same = keys == keys_;
  keys_ = std::move(keys);
  if (same && builds_ > 0) {
    fit(emissive, false);
    if (cost() <= kWornOut * cost_when_built_) return;
  }
  build(emissive);
  visibility_ = {};
  fit(emissive, true);
  cost_when_built_ = cost();
}

void LightTree::list_lights(const Scene& scene) {
  const auto local = static_cast<std::size_t>(
      std::count_if(scene.lights.begin(), scene.lights.end(),
                    [](const Light& light) { return light.type != Light::Type::directional; }));
  lights_.clear();
  asked_.clear();
  drawn_.clear();
  for (const Light& light : scene.lights) {
    (is_asked(light, local) ? asked_ : drawn_)
        .push_back(static_cast<std::uint32_t>(lights_.size()));
    lights_.push_back(light_record(light));
  }
}

// Emissive triangles and their pieces come first, then the lights that are drawn.
std::vector<LightCluster> LightTree::clusters_of_lights(const EmissiveTriangles& emissive) const {
  std::vector<LightCluster> clusters;
  clusters.reserve(emissive.size() + drawn_.size());
  const float whole = emissive.total_power() / kTwoPi;
  for (std::size_t e = 0; e < emissive.size(); ++e) {
    const EmitterRecord& emitter = emissive.entries()[e];
    clusters.push_back(cluster_of(emitter, emitter.probability * whole, emissive.tints()[e]));
  }
  for (const std::uint32_t light : drawn_) clusters.push_back(cluster_of(lights_[light]));
  return clusters;
}

std::uint32_t LightTree::light_of(std::size_t place, const EmissiveTriangles& emissive) const {
  const std::size_t emitters = emissive.size();
  if (place < emitters) return static_cast<std::uint32_t>(place);
  return static_cast<std::uint32_t>(emitters) + drawn_[place - emitters];
}

void LightTree::build(const EmissiveTriangles& emissive) {
  struct Task {
    std::uint32_t node;
    std::size_t begin, end;  // of `order`
  };
  ++builds_;
  const std::vector<LightCluster> lights = clusters_of_lights(emissive);
  const std::size_t count = lights.size();
  nodes_.assign(count == 0 ? 0 : 1, {});
  parents_.assign(nodes_.size(), 0);
  leaves_.assign(emissive.size() + lights_.size(), 0);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  Splitter splitter(lights);
  std::vector<Task> tasks;
  if (count > 0) tasks.push_back({0, 0, count});
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    if (task.end - task.begin == 1) {
      const std::uint32_t light = light_of(order[task.begin], emissive);
      nodes_[task.node].link = kLightTreeLeaf | light;
      leaves_[light] = task.node;
      continue;
    }
    const std::size_t length =
        splitter.split(std::span(order).subspan(task.begin, task.end - task.begin));
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[task.node].link = first;
    nodes_.resize(nodes_.size() + 2);
    parents_.resize(nodes_.size(), task.node);
    tasks.push_back({first + 1, task.begin + length, task.end});
    tasks.push_back({first, task.begin, task.begin + length});
  }
}

void LightTree::fit(const EmissiveTriangles& emissive, bool is_new) {
  const std::vector<LightCluster> lights = clusters_of_lights(emissive);
  std::vector<LightCluster> clusters(nodes_.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    clusters[leaves_[light_of(i, emissive)]] = lights[i];
  }
  // Children come after their parents
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    const std::uint32_t link = nodes_[i].link;
    if ((link & kLightTreeLeaf) == 0) {
      clusters[i] = clusters[link];
      clusters[i].add(clusters[link + 1]);
    }
    nodes_[i] = node_of(clusters[i]);
    nodes_[i].link = link;
  }
  if (is_new) groups_.build(nodes_);
  groups_.fit(nodes_);
}

double LightTree::cost() const {
  // Over the intensity of all: a tree does not wear out by getting brighter
  const double intensity = nodes_.empty() ? 0.0 : double{nodes_.front().intensity};
  if (!(intensity > 0.0)) return 0.0;
  double sum = 0.0;
  for (const LightTreeNode& node : nodes_) {
    sum +=
        double{node.intensity} * glm::dot(node.half_size, node.half_size) * (2.0 - node.cos_spread);
  }
  return sum / intensity;
}

GroupNumbers LightTree::seen_from(const glm::vec3& position_ws, const glm::vec3& normal_ws) const {
  GroupNumbers groups = groups_.all_numbers();
  groups.weights = visibility_.at(position_ws, normal_ws);
  return groups;
}

PickLobe LightTree::bounded(const glm::vec3& position_ws, const glm::vec3& normal_ws,
                            const PickLobe& lobe) const {
  return bounded_in_groups(seen_from(position_ws, normal_ws), position_ws, normal_ws, lobe);
}

float LightTree::fluence(const glm::vec3& position_ws) const {
  return fluence_in_groups(groups_.all_numbers(), position_ws);
}

LightPick LightTree::pick(const glm::vec3& position_ws, const glm::vec3& normal_ws,
                          const PickLobe& lobe, float u) const {
  LightPicks picks;
  picks.at[0].rest = u;
  pick_in_groups(seen_from(position_ws, normal_ws), position_ws, normal_ws, lobe, 1, picks);
  return picks.at[0];
}

void LightTree::pick(const glm::vec3& position_ws, const glm::vec3& normal_ws, const PickLobe& lobe,
                     std::uint32_t count, LightPicks& picks) const {
  pick_in_groups(seen_from(position_ws, normal_ws), position_ws, normal_ws, lobe, count, picks);
}

LightPick LightTree::pick_below(std::uint32_t link, const glm::vec3& position_ws,
                                const glm::vec3& normal_ws, float u) const {
  LightPicks picks;
  picks.at[0].rest = u;
  pick_below_in_groups(groups_.all_numbers(), link, position_ws, normal_ws, no_pick_lobe(), 1,
                       picks);
  return picks.at[0];
}

float LightTree::probability(std::uint32_t light, const glm::vec3& position_ws,
                             const glm::vec3& normal_ws, const PickLobe& lobe) const {
  const GroupNumbers seen = seen_from(position_ws, normal_ws);
  float probability = 1.0f;
  for (std::uint32_t node = leaves_[light];; node = parents_[node]) {
    const std::uint32_t place = groups_.place_of(node);
    if (place != LightGroups::kNowhere) {
      float importances[kLightGroupSize], sum = 0.0f;
      const std::uint32_t group = place / kLightGroupSize;
      lambent::group_importances(seen.at(group), position_ws, normal_ws, lobe, importances);
      for (std::uint32_t k = 0; k < kLightGroupSize; ++k) {
        importances[k] *= visibility_in_groups(seen, group, k);
        sum += importances[k];
      }
      const float importance = importances[place % kLightGroupSize];
      if (!(importance > 0.0f)) return 0.0f;
      probability *= importance / sum;
    }
    if (node == 0) break;
  }
  return probability;
}

}  // namespace lambent
