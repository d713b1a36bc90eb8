// SPDX-License-Identifier: Apache-2.0
// A field that follows a lamp, and what a client decodes of its stream.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "field/field_access.h"
#include "field/probes/probe_status.h"
#include "field/probes/probe_store.h"
#include "lambent/stream.h"
#include "lambent/world.h"
#include "scenes/builtin.h"

namespace lambent::test {

/// A Cornell box whose lamp changes, and a field that follows it.
class Box {
 public:
  explicit Box(const FieldSettings& settings = small_field())
      : scene_(scenes::make("cornell").value()), world_(scene_), field_(made(settings)) {
    for (int i = 0; i < 4; ++i) field_.update(world_);
  }

  static FieldSettings small_field() {
    FieldSettings settings;
    settings.probe_count = glm::ivec3(5, 5, 5);
    settings.rays_per_probe = 32;
    settings.corrections = false;
    return settings;
  }

  void shine(float factor) {
    for (Material& material : scene_.materials) material.emission *= factor;
    ASSERT_TRUE(world_.update());
    field_.update(world_);
  }
  /// A step of light that swells and fades.
  void advance() { shine(++steps_ % 6 < 3 ? 1.2f : 1.0f / 1.2f); }
  void look_from(const glm::vec3& viewer) { field_.update(world_, {.viewer_ws = viewer}); }

  const IrradianceField& field() const { return field_; }
  const World& world() const { return world_; }

 private:
  IrradianceField made(const FieldSettings& settings) const {
    return std::move(IrradianceField::make(settings, open_bounds(world_)).value());
  }

  Scene scene_;
  World world_;
  IrradianceField field_;
  int steps_ = 0;
};

using Messages = std::vector<stream::LightMessage>;

inline stream::LightEncoder made_encoder(const stream::LightEncoderSettings& settings = {}) {
  return std::move(stream::LightEncoder::create(settings).value());
}

inline Messages encoded(stream::LightEncoder& encoder, const Box& box) {
  Expected<Messages> messages = encoder.encode(box.field());
  if (!messages) throw std::runtime_error(messages.error().message());
  return std::move(*messages);
}

template <class Client>
void receive_all(Client& client, const Messages& messages) {
  for (const stream::LightMessage& message : messages) {
    const Expected<void> fine = client.receive(message.bytes);
    ASSERT_TRUE(fine) << fine.error().message();
  }
}

/// All that a decoder tells of its state.
struct Decoded {
  std::uint64_t update = 0;
  std::vector<glm::vec3> light, places;
  std::vector<glm::vec2> distances;
  bool operator==(const Decoded&) const = default;
};

inline Decoded state_of(const stream::LightDecoder& decoder) {
  Decoded state;
  state.update = decoder.update();
  std::vector<glm::vec3> tile(decoder.irradiance_texels() * decoder.irradiance_texels());
  std::vector<glm::vec2> moments(decoder.distance_texels() * decoder.distance_texels());
  for (int probe = 0; probe < decoder.probes(); ++probe) {
    decoder.irradiance(probe, tile);
    decoder.distances(probe, moments);
    state.light.insert(state.light.end(), tile.begin(), tile.end());
    state.distances.insert(state.distances.end(), moments.begin(), moments.end());
    state.places.push_back(decoder.position_ws(probe));
  }
  return state;
}

/// stream::LightErrors of a decoder's light, found anew from the field's store.
inline stream::LightErrors errors_of(const stream::LightDecoder& decoder,
                                     const IrradianceField& field) {
  const ProbeStore& store = store_of(field);
  const int edge = store.irradiance_texels();
  std::vector<glm::vec3> tile(edge * edge);
  std::vector<std::pair<double, double>> pairs;
  double mean = 0.0;
  for (int probe = 0; probe < decoder.probes(); ++probe) {
    if (statuses_of(field)[probe].state == ProbeState::off) continue;
    decoder.irradiance(probe, tile);
    for (int t = 0; t < edge * edge; ++t) {
      const vec3 truth = store.irradiance_texel(probe, ivec2(t % edge, t / edge) + 1);
      for (int c = 0; c < 3; ++c) {
        pairs.emplace_back(tile[t][c], truth[c]);
        mean += truth[c];
      }
    }
  }
  mean /= static_cast<double>(pairs.size());
  double square = 0.0, dark = 0.0;
  for (const auto& [decoded, truth] : pairs) {
    square += (decoded - truth) * (decoded - truth);
    dark += std::pow((decoded - truth) / (truth + 0.1 * mean), 2.0);
  }
  const auto count = static_cast<double>(pairs.size());
  return {std::sqrt(square / count) / mean, std::sqrt(dark / count)};
}

/// What a store of floats holds is what the field's light is.
inline FieldSettings exact_field() {
  FieldSettings settings = Box::small_field();
  settings.irradiance_format = IrradianceFormat::float32;
  return settings;
}

}  // namespace lambent::test
