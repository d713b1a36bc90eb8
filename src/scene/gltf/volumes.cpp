// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/volumes.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "scene/gltf/boxes.h"
#include "scene/limits.h"

namespace lambent::gltf {
namespace {

using json = nlohmann::json;

constexpr const char* kVolumeKey = "lambent_probe_volume";

// Limit of probes along one axis, above that of any field.
constexpr double kMaxBatchProbes = 1048576.0;
// Limit of priorities, which fits into an int.
constexpr double kMaxPriority = 1e6;

/// Returns null, or a description of the error.
const char* read_volume(const json& extras, ProbeVolume& volume) {
  if (!extras.is_object()) return "is not an object";
  for (const auto& [key, value] : extras.items()) {
    double number = 0.0;
    if (key == "size") {
      if (!read_vector(value, 0.0, kMaxCoordinate, volume.size))
        return "has no three numbers as size";
    } else if (key == "probes") {
      if (!read_vector(value, 2.0, kMaxBatchProbes, volume.probe_count)) {
        return "has no three whole numbers of 2 or more as probes";
      }
    } else if (key == "spacing") {
      if (!read_number(value, 0.0, kMaxCoordinate, number) || !(number > 0.0)) {
        return "has no number above 0 as spacing";
      }
      volume.probe_spacing = static_cast<float>(number);
    } else if (key == "priority") {
      if (!read_number(value, -kMaxPriority, kMaxPriority, number) ||
          number != std::floor(number)) {
        return "has no whole number as priority";
      }
      volume.priority = static_cast<int>(number);
    } else {
      return "has a member that means nothing to us";
    }
  }
  const bool counted = volume.probe_count != glm::ivec3(0);
  return counted && volume.probe_spacing > 0.0f ? "has both probes and spacing" : nullptr;
}

}  // namespace

void read_node_volumes(Document& document, const json& root) {
  const json nodes = root.value("nodes", json::array());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const json::json_pointer pointer(std::string("/extras/") + kVolumeKey);
    if (!nodes[i].contains(pointer)) continue;
    ProbeVolume volume;
    if (const char* flaw = read_volume(nodes[i][pointer], volume)) {
      document.warn(entry("nodes", i) + ".extras." + kVolumeKey + " " + flaw + " and was ignored.");
      continue;
    }
    document.node_volumes.emplace(static_cast<int>(i), std::move(volume));
  }
}

void place_volume(Document& document, int node, const glm::mat4& world_from_node, Scene& scene) {
  const auto asked = document.node_volumes.find(node);
  if (asked == document.node_volumes.end()) return;
  ProbeVolume volume = asked->second;
  volume.name = document.model.nodes[node].name;
  if (const char* flaw = place_box(world_from_node, volume.centre, volume.size, volume.axes)) {
    document.warn(entry("nodes", node) + ".extras." + kVolumeKey + " was ignored: " + flaw);
    return;
  }
  scene.volumes.push_back(std::move(volume));
}

}  // namespace lambent::gltf
