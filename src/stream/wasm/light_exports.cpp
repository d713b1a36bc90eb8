// SPDX-License-Identifier: Apache-2.0
// The WebAssembly exports of the light decoder, for web/lambent-three/light_decoder.js. Pointers
// are into the module's memory, and valid until the next message is received.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lambent/stream.h"
#include "stream/edits/sun.h"
#include "stream/light/light_textures.h"

#define LAMBENT_EXPORT(name) extern "C" __attribute__((export_name(#name)))

namespace lambent::stream {
namespace {

struct Client {
  explicit Client(std::size_t most_bytes) : decoder(most_bytes) {}

  LightDecoder decoder;
  LightTextures textures{decoder};
  std::vector<std::byte> message;
  std::string error;
};

}  // namespace

LAMBENT_EXPORT(lambent_make) Client* lambent_make(std::size_t most_bytes) {
  return new Client(most_bytes);
}
LAMBENT_EXPORT(lambent_free) void lambent_free(Client* client) {
  delete client;
}

/// The buffer for a message of `bytes` bytes.
LAMBENT_EXPORT(lambent_message) std::byte* lambent_message(Client* client, std::size_t bytes) {
  client->message.resize(bytes);
  return client->message.data();
}
/// Decodes the message in the buffer; returns 0 if it was refused, and lambent_error then has the
/// reason.
LAMBENT_EXPORT(lambent_receive) int lambent_receive(Client* client) {
  const auto taken = client->decoder.receive(client->message);
  client->error = taken ? std::string() : taken.error().message();
  return taken ? 1 : 0;
}
/// Updates the textures after the last message.
LAMBENT_EXPORT(lambent_follow) void lambent_follow(Client* client) {
  client->textures.follow();
}
LAMBENT_EXPORT(lambent_error) const char* lambent_error(const Client* client) {
  return client->error.c_str();
}

LAMBENT_EXPORT(lambent_needs_key) int lambent_needs_key(const Client* client) {
  return client->decoder.needs_key() ? 1 : 0;
}
LAMBENT_EXPORT(lambent_update) std::uint64_t lambent_update(const Client* client) {
  return client->decoder.update();
}
LAMBENT_EXPORT(lambent_geometry) std::uint64_t lambent_geometry(const Client* client) {
  return client->decoder.geometry();
}
LAMBENT_EXPORT(lambent_probes) int lambent_probes(const Client* client) {
  return client->decoder.probes();
}
LAMBENT_EXPORT(lambent_irradiance_texels) int lambent_irradiance_texels(const Client* client) {
  return client->decoder.irradiance_texels();
}
LAMBENT_EXPORT(lambent_distance_texels) int lambent_distance_texels(const Client* client) {
  return client->decoder.distance_texels();
}
LAMBENT_EXPORT(lambent_checksum) std::uint32_t lambent_checksum(const Client* client) {
  return client->textures.checksum();
}

LAMBENT_EXPORT(lambent_texture_width) int lambent_texture_width() {
  return LightTextures::kWidth;
}
LAMBENT_EXPORT(lambent_geometry_changes) std::uint32_t lambent_geometry_changes(const Client* c) {
  return c->textures.geometry_changes();
}
LAMBENT_EXPORT(lambent_irradiance) const void* lambent_irradiance(const Client* client) {
  return client->textures.irradiance().data();
}
LAMBENT_EXPORT(lambent_irradiance_words) std::size_t lambent_irradiance_words(const Client* c) {
  return c->textures.irradiance().size();
}
LAMBENT_EXPORT(lambent_distances) const void* lambent_distances(const Client* client) {
  return client->textures.distances().data();
}
LAMBENT_EXPORT(lambent_distances_words) std::size_t lambent_distances_words(const Client* c) {
  return c->textures.distances().size();
}
LAMBENT_EXPORT(lambent_places) const void* lambent_places(const Client* client) {
  return client->textures.places().data();
}
LAMBENT_EXPORT(lambent_places_count) std::size_t lambent_places_count(const Client* client) {
  return client->textures.places().size();
}
/// The list of ProbeGrid (src/field/probes/probe_grid.h), 31 words each.
LAMBENT_EXPORT(lambent_grids) const void* lambent_grids(const Client* client) {
  static_assert(sizeof(ProbeGrid) == 31 * sizeof(std::uint32_t));
  return client->textures.grids().data();
}
LAMBENT_EXPORT(lambent_grids_count) std::size_t lambent_grids_count(const Client* client) {
  return client->textures.grids().size();
}

/// Four floats: the direction of the sun's light at a time of day, and its irradiance as a share of
/// the full one.
LAMBENT_EXPORT(lambent_sun) const void* lambent_sun(float hours) {
  static glm::vec4 answer;
  answer = glm::vec4(sun_direction(hours), sun_share(hours));
  return &answer;
}

}  // namespace lambent::stream
