// SPDX-License-Identifier: Apache-2.0
// Based on: Khronos Group, glTF 2.0 specification, sec. 5.1 to 5.4 "Animation", and the README of
// KHR_animation_pointer.
#include "scene/gltf/channels.h"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>

namespace lambent::gltf {
namespace {

using nlohmann::json;

/// A member of an object, if it is a valid index into an array of that size.
std::optional<int> index_of(const json& object, const char* key, std::size_t size) {
  const auto member = object.find(key);
  if (member == object.end() || !member->is_number_unsigned()) return std::nullopt;
  const auto index = member->get<std::uint64_t>();
  return index < size ? std::optional<int>(static_cast<int>(index)) : std::nullopt;
}

std::string string_of(const json& object, const char* key) {
  const auto member = object.find(key);
  return member != object.end() && member->is_string() ? member->get<std::string>() : std::string();
}

std::size_t size_of(const json& root, const char* key) {
  const auto list = root.find(key);
  return list != root.end() && list->is_array() ? list->size() : 0;
}

/// Reads a channel. Returns null, or the reason why it is dropped.
const char* read_channel(const json& root, const json& samplers, const json& source,
                         ChannelSource& channel) {
  if (!source.is_object()) return "they are not objects";
  const std::optional<int> sampler = index_of(source, "sampler", samplers.size());
  if (!sampler || !samplers[*sampler].is_object()) return "their sampler does not exist";
  const json& keys = samplers[*sampler];
  const std::size_t accessors = size_of(root, "accessors");
  const std::optional<int> input = index_of(keys, "input", accessors);
  const std::optional<int> output = index_of(keys, "output", accessors);
  if (!input || !output) return "their sampler has no keys";
  channel.input = *input;
  channel.output = *output;
  const std::string interpolation =
      keys.contains("interpolation") ? string_of(keys, "interpolation") : "LINEAR";
  if (interpolation == "STEP") {
    channel.interpolation = Interpolation::step;
  } else if (interpolation == "CUBICSPLINE") {
    channel.interpolation = Interpolation::cubic;
  } else if (interpolation != "LINEAR") {
    return "their interpolation is none of STEP, LINEAR and CUBICSPLINE";
  }

  const auto target = source.find("target");
  if (target == source.end() || !target->is_object()) return "they have no target";
  const std::string path = string_of(*target, "path");
  if (path == "pointer") {
    const json::json_pointer pointer("/extensions/KHR_animation_pointer/pointer");
    if (!target->contains(pointer) || !(*target)[pointer].is_string()) {
      return "they have no pointer";
    }
    channel.pointer = (*target)[pointer].get<std::string>();
    return nullptr;
  }
  const std::optional<int> node = index_of(*target, "node", size_of(root, "nodes"));
  if (!node) return "their node does not exist";
  channel.pointer = "/nodes/" + std::to_string(*node) + "/" + path;
  return nullptr;
}

}  // namespace

void read_channels(Document& document, const json& root) {
  const auto animations = root.find("animations");
  if (animations == root.end()) return;
  if (!animations->is_array()) {
    document.warn("Animations were dropped: they are not a list.");
    return;
  }
  for (std::size_t a = 0; a < animations->size(); ++a) {
    const json& source = (*animations)[a];
    AnimationSource& animation = document.animations.emplace_back();
    const std::string place = entry("animations", a);
    const bool whole = source.is_object() && source.contains("channels") &&
                       source["channels"].is_array() && source.contains("samplers") &&
                       source["samplers"].is_array();
    if (!whole) {
      document.warn(place + " was dropped: it lacks channels or samplers.");
      continue;
    }
    animation.name = string_of(source, "name");
    for (std::size_t c = 0; c < source["channels"].size(); ++c) {
      ChannelSource channel;
      channel.place = place + "." + entry("channels", c);
      const char* flaw = read_channel(root, source["samplers"], source["channels"][c], channel);
      if (flaw != nullptr) {
        document.drop_channel(channel.place, flaw);
      } else {
        animation.channels.push_back(std::move(channel));
      }
    }
  }
}

void read_node_flags(Document& document, const json& root) {
  const json nodes = root.value("nodes", json::array());
  document.node_flags.resize(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto extras = nodes[i].find("extras");
    if (extras == nodes[i].end() || !extras->is_object()) continue;
    NodeFlags& flags = document.node_flags[i];
    const auto read = [&](const char* key, bool& flag) {
      const auto member = extras->find(key);
      if (member == extras->end()) return;
      if (member->is_boolean()) {
        flag = member->get<bool>();
      } else {
        document.warn(entry("nodes", i) + ".extras." + key +
                      " is neither true nor false and was ignored.");
      }
    };
    read("lambent_casts_gi", flags.casts_gi);
    read("lambent_receives_gi", flags.receives_gi);
    read("lambent_ignored_by_probes", flags.ignored_by_probes);
  }
}

}  // namespace lambent::gltf
