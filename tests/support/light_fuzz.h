// SPDX-License-Identifier: Apache-2.0
// What the fuzzer of light streams, and the test of its corpus, feed a decoder with.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/little_endian.h"
#include "lambent/stream.h"
#include "stream/light/geometry_coding.h"
#include "stream/light/light_coding.h"
#include "stream/light/message.h"
#include "stream/regions/region_encoder.h"
#include "support/light_states.h"

namespace lambent::test {

// A client of the fuzzer may take this much memory.
inline constexpr std::size_t kFuzzBytes = std::size_t{64} << 20;
inline constexpr std::uint32_t kFuzzStream = 1;

/// A body as a message of that kind: a change that follows on update 1, or whole geometry.
inline std::vector<std::byte> fuzz_message(stream::LightMessageKind kind,
                                           std::span<const std::byte> body) {
  // Changes of geometry are of their own update, and say which geometry they change
  ByteReader base(body);
  const bool changes = kind == stream::LightMessageKind::geometry &&
                       body.size() >= sizeof(std::uint64_t) && base.u64() != 0;
  return stream::make_message(
             {kind, kFuzzStream, 2, stream::geometry_number(kFuzzStream, changes ? 2 : 1)}, body)
      .bytes;
}

/// A body of geometry, told as all there is (base 0), or as a change of update 1's.
inline std::vector<std::byte> geometry_body(bool changes, std::span<const std::byte> rest) {
  ByteWriter out;
  out.u64(changes ? stream::geometry_number(kFuzzStream, 1) : 0);
  out.raw(rest);
  return out.take();
}

/// In place of a video codec: pictures that are what their bytes are.
class FuzzReader : public stream::TextureReader {
 public:
  Expected<void> read(std::span<const std::byte> bytes, bool /*key*/,
                      stream::TexturePicture& picture) override {
    if (bytes.empty()) return fail("picture", "", "is empty");
    const std::size_t pixels = static_cast<std::size_t>(picture.width) * picture.height;
    for (std::vector<std::uint16_t>& plane : picture.planes) {
      plane.resize(pixels);
      for (std::size_t i = 0; i < pixels; ++i) {
        plane[i] = static_cast<std::uint16_t>(4 * std::to_integer<int>(bytes[i % bytes.size()]));
      }
    }
    return {};
  }
};

/// Gives a decoder that has a key the bytes as they are, and as the body of a message of the kind
/// that the first byte names. Returns what is wrong with how it takes that; empty: nothing.
inline std::string feed_light_decoder(std::span<const std::byte> bytes) {
  using stream::LightMessageKind;
  std::mt19937 random(1);
  stream::FieldGeometry geometry = made_geometry(random);
  geometry.corrections_number = stream::geometry_number(kFuzzStream, 1);
  const stream::LightLayout layout = stream::layout_of(geometry);
  stream::LightState state = dark_state(layout);
  stream::write_delta(layout, made_levels(layout, random), state);
  stream::StreamedField client(kFuzzBytes);
  const auto give = [&](LightMessageKind kind, std::span<const std::byte> body) {
    return client.receive(
        stream::make_message({kind, kFuzzStream, 1, stream::geometry_number(kFuzzStream, 1)}, body)
            .bytes);
  };
  stream::GeometrySections sections;
  const std::vector<std::byte> part = stream::write_geometry(geometry, sections).front();
  if (!give(LightMessageKind::geometry, geometry_body(false, part)) ||
      !give(LightMessageKind::key, stream::write_key(layout, state))) {
    return "refuses what an encoder wrote";
  }
  const auto light = [&] {
    std::vector<glm::vec3> all, tile(4);
    for (int probe = 0; probe < client.decoder().probes(); ++probe) {
      tile.resize(client.decoder().irradiance_texels() * client.decoder().irradiance_texels());
      client.decoder().irradiance(probe, tile);
      all.insert(all.end(), tile.begin(), tile.end());
    }
    return all;
  };
  const std::vector<glm::vec3> before = light();
  const auto pieces = stream::write_corrections(0, geometry.corrections);
  if (!give(LightMessageKind::corrections, pieces)) return "refuses corrections";
  if (light() != before) return "has other light by corrections";
  if (client.receive(bytes)) return "takes a message without a checksum for one";
  if (light() != before) return "changed without a message";
  if (bytes.empty()) return "";
  const auto kind = static_cast<LightMessageKind>(1 + std::to_integer<int>(bytes[0]) % 7);
  client.read_textures(std::make_unique<FuzzReader>());
  if (kind == LightMessageKind::regions) {
    // What follows on regions alone
    stream::RegionEncoder regions;
    stream::FollowedRegions has;
    regions.follow(client.decoder());
    if (!client.receive(regions.update_for(client.decoder(), {}, true, has).bytes)) {
      return "refuses regions that an encoder wrote";
    }
    if (light() != before) return "has other light by regions";
  }
  const Expected<void> taken = client.receive(fuzz_message(kind, bytes.subspan(1)));
  if (!taken && taken.error().cause.empty()) return "refuses without a cause";
  if (!taken && light() != before) return "changed by a message that it refused";
  for (const glm::vec3& e : light()) {
    if (!(e.x >= 0.0f && e.y >= 0.0f && e.z >= 0.0f)) return "holds light that there cannot be";
  }
  // Once a delta was taken, what follows must not be refused for what came before
  return client.decoder().update() < 1 ? "lost its light" : "";
}

}  // namespace lambent::test
