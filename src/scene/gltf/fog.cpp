// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/fog.h"

#include "scene/gltf/boxes.h"
#include "scene/limits.h"

namespace lambent::gltf {
namespace {

using json = nlohmann::json;

constexpr const char* kFogKey = "lambent_fog";

/// Reads one number for all channels, or three.
bool read_albedo(const json& value, glm::vec3& albedo) {
  double number = 0.0;
  if (read_number(value, 0.0, 1.0, number)) {
    albedo = glm::vec3(static_cast<float>(number));
    return true;
  }
  return read_vector(value, 0.0, 1.0, albedo);
}

/// Returns null, or a description of the error.
const char* read_fog(const json& extras, FogVolume& fog) {
  if (!extras.is_object()) return "is not an object";
  for (const auto& [key, value] : extras.items()) {
    double number = 0.0;
    if (key == "size") {
      if (!read_vector(value, 0.0, kMaxCoordinate, fog.size)) return "has no three numbers as size";
    } else if (key == "density") {
      if (!read_number(value, 0.0, kMaxFogDensity, number)) {
        return "has no number within 0 to 1e6 as density";
      }
      fog.density = static_cast<float>(number);
    } else if (key == "albedo") {
      if (!read_albedo(value, fog.albedo)) return "has no numbers within 0 to 1 as albedo";
    } else if (key == "anisotropy") {
      // In float, like the limit
      const bool is_one = read_number(value, -1.0, 1.0, number);
      fog.anisotropy = static_cast<float>(number);
      if (!is_one || std::abs(fog.anisotropy) > kMaxFogAnisotropy) {
        return "has no number within -0.95 to 0.95 as anisotropy";
      }
    } else if (key == "scale_height") {
      if (!read_number(value, 2.0 * kMinFogScaleHeight, 0.5 * kMaxFogScaleHeight, number)) {
        return "has no number within 0.002 to 5e8 as scale_height";
      }
      fog.scale_height = static_cast<float>(number);
    } else {
      return "has a member that means nothing to us";
    }
  }
  return nullptr;
}

}  // namespace

void read_node_fog(Document& document, const json& root) {
  const json nodes = root.value("nodes", json::array());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const json::json_pointer pointer(std::string("/extras/") + kFogKey);
    if (!nodes[i].contains(pointer)) continue;
    FogVolume fog;
    if (const char* flaw = read_fog(nodes[i][pointer], fog)) {
      document.warn(entry("nodes", i) + ".extras." + kFogKey + " " + flaw + " and was ignored.");
      continue;
    }
    document.node_fog.emplace(static_cast<int>(i), std::move(fog));
  }
}

void place_fog(Document& document, int node, const glm::mat4& world_from_node, Scene& scene) {
  const auto asked = document.node_fog.find(node);
  if (asked == document.node_fog.end()) return;
  FogVolume fog = asked->second;
  fog.name = document.model.nodes[node].name;
  const char* flaw = place_box(world_from_node, fog.centre, fog.size, fog.axes);
  if (flaw == nullptr && scene.fog.size() == kMaxFogVolumes) {
    flaw = "there are 16 boxes of fog already.";
  }
  if (flaw != nullptr) {
    document.warn(entry("nodes", node) + ".extras." + kFogKey + " was ignored: " + flaw);
    return;
  }
  scene.fog.push_back(std::move(fog));
}

}  // namespace lambent::gltf
