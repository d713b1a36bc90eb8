// SPDX-License-Identifier: Apache-2.0
#include "stream/light/light_textures.h"

#include <span>

#include "core/checksum.h"
#include "field/probes/tile.h"
#include "stream/light/decoder_state.h"

namespace lambent::stream {
namespace {

constexpr float kNearest = 0.5f;  // encoders round to nearest

std::size_t tiles_in_row(int texels) {
  return static_cast<std::size_t>(LightTextures::kWidth / (texels + 2));
}

/// Texels of whole rows of tiles, with gutters.
std::size_t atlas_texels(int probes, int texels) {
  const std::size_t in_row = tiles_in_row(texels);
  const std::size_t rows = (static_cast<std::size_t>(probes) + in_row - 1) / in_row;
  return rows * static_cast<std::size_t>(texels + 2) * LightTextures::kWidth;
}

/// Writes a probe's tile with its gutter. `words` has those of the tile without it.
void write_tile(int probe, int texels, std::span<const std::uint32_t> words,
                std::vector<std::uint32_t>& atlas) {
  const auto number = static_cast<std::size_t>(probe), in_row = tiles_in_row(texels);
  const std::size_t edge = static_cast<std::size_t>(texels) + 2;
  std::uint32_t* first =
      &atlas[number / in_row * edge * LightTextures::kWidth + number % in_row * edge];
  for (int y = 0; y < texels + 2; ++y) {
    for (int x = 0; x < texels + 2; ++x) {
      const ivec2 source = tile_source(ivec2(x, y), texels);
      first[y * LightTextures::kWidth + x] = words[source.y * texels + source.x];
    }
  }
}

template <class T>
std::uint32_t add_checksum(std::uint32_t before, const std::vector<T>& values) {
  return crc32_of(std::as_bytes(std::span(values)), before);
}

}  // namespace

void LightTextures::store_irradiance(int probe) {
  decoder_.irradiance(probe, light_);
  std::array<std::uint32_t, kMaxTileTexels> words;
  for (std::size_t t = 0; t < light_.size(); ++t) {
    words[t] = encode_rgb9e5(light_[t], vec3(kNearest));
  }
  write_tile(probe, decoder_.irradiance_texels(), words, irradiance_);
}

void LightTextures::store_distances(int probe, float unit) {
  decoder_.distances(probe, moments_);
  std::vector<std::uint32_t> words;
  for (const glm::vec2& moments : moments_) {
    words.push_back(encode_half2(moments / vec2(unit, unit * unit), vec2(kNearest)));
  }
  write_tile(probe, decoder_.distance_texels(), words, distances_);
}

void LightTextures::follow_geometry() {
  const FieldGeometry& geometry = decoder_.state_->current->geometry;
  const int probes = decoder_.probes();
  irradiance_.resize(atlas_texels(probes, geometry.irradiance_texels));
  distances_.resize(atlas_texels(probes, geometry.distance_texels));
  light_.resize(static_cast<std::size_t>(geometry.irradiance_texels) * geometry.irradiance_texels);
  moments_.resize(geometry.tile());
  grids_.clear();
  for (const Volume& volume : geometry.volumes) grids_.push_back(volume.grid);
  // When volumes scroll, probes move that the decoder does not list as changed
  places_.resize((static_cast<std::size_t>(probes) + kWidth - 1) / kWidth * kWidth);
  for (int probe = 0; probe < probes; ++probe) {
    places_[probe] = glm::vec4(decoder_.position_ws(probe), 0.0f);
  }
  for (const int probe : decoder_.changed()) {
    store_distances(probe, distance_unit(geometry.grid_of(probe)));
  }
  ++geometry_changes_;
}

void LightTextures::follow() {
  const auto& current = decoder_.state_->current;
  if (!current) return;
  if (geometry_ != current->version) {
    follow_geometry();
    geometry_ = current->version;
  }
  for (const int probe : decoder_.changed()) store_irradiance(probe);
}

std::uint32_t LightTextures::checksum() const {
  std::uint32_t sum = add_checksum(0, decoder_.state_->light.coefficients);
  for (const auto* words : {&irradiance_, &distances_}) sum = add_checksum(sum, *words);
  return add_checksum(sum, places_);
}

}  // namespace lambent::stream
