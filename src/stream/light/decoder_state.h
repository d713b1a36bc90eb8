// SPDX-License-Identifier: Apache-2.0
// The private state of LightDecoder.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lambent/stream.h"
#include "stream/light/geometry_coding.h"
#include "stream/light/light_signal.h"
#include "stream/light/message.h"
#include "stream/regions/region_states.h"
#include "stream/textures/texture_atlas.h"

namespace lambent::stream {

/// Geometry that was received, and data derived from it.
struct ReceivedGeometry : PartialGeometry {
  ReceivedGeometry(const MessageHeader& header, PartialGeometry received)
      : PartialGeometry(std::move(received)),
        stream(header.stream),
        version(header.geometry),
        basis(geometry.irradiance_texels) {
    lay_out();
    forget_corrections();
  }
  /// Updates `layout` and `grids` from the geometry.
  void lay_out() {
    layout = layout_of(geometry);
    grids.clear();
    for (const Volume& volume : geometry.volumes) grids.push_back(field_grid(volume.grid));
  }

  std::uint32_t stream;
  std::uint64_t version;
  /// Discards all pieces of its corrections.
  void forget_corrections() { pieces.assign(correction_pieces(geometry.corrections.size()), {}); }
  bool is_whole() const {
    return std::all_of(here.begin(), here.end(), [](std::uint8_t one) { return one != 0; });
  }
  bool has_corrections() const {
    return std::none_of(pieces.begin(), pieces.end(), [](const auto& one) { return one.empty(); });
  }
  /// Copies the pieces of the same corrections from another geometry.
  void take_corrections(const ReceivedGeometry& other) {
    if (other.stream != stream || other.pieces.size() != pieces.size() ||
        other.geometry.corrections_number != geometry.corrections_number ||
        other.geometry.corrections.size() != geometry.corrections.size()) {
      return;
    }
    geometry.corrections = other.geometry.corrections;
    pieces = other.pieces;
  }

  LightLayout layout;
  TileBasis basis;
  std::vector<FieldGrid> grids;
  CorrectionPieces pieces;  ///< As received.
};

struct LightDecoder::State {
  std::size_t most_bytes = 0;
  /// The geometry of `light`; empty before the first key.
  std::optional<ReceivedGeometry> current;
  std::optional<ReceivedGeometry> next;  ///< The geometry of the next key, or parts of it.
  LightState light;
  bool lost = false;                      ///< A change is missing.
  std::unique_ptr<TextureReader> reader;  ///< Null: textures are refused.
  TexturePicture picture;                 ///< The last decoded texture.
  /// The form in which light was received; later messages must have the same.
  enum class Way : std::uint8_t { coded, textures, regions };
  Way way = Way::coded;
  std::optional<RegionStates> regions;  ///< If received by regions.
  std::uint64_t geometries = 0;         ///< Number of keys so far with a new geometry.
  std::vector<int> changed;
  bool corrected = false;  ///< The last message completed new corrections.
  std::vector<std::int32_t> levels;
  /// Coded sections of `current`, for `join`; empty where not coded, or changed since.
  GeometrySections sections;

  Expected<void> receive(std::span<const std::byte> bytes);

 private:
  Expected<void> receive_geometry(const OpenedMessage& message);
  Expected<void> receive_corrections(const OpenedMessage& message);
  Expected<void> receive_key(const OpenedMessage& message);
  Expected<void> receive_texture(const OpenedMessage& message);
  Expected<void> receive_regions(const OpenedMessage& message);
  Expected<void> receive_whole_regions(const MessageHeader& header, const RegionBody& body);
  /// Fails where a change has another form than the light so far.
  Expected<void> check_way(const MessageHeader& header, Way now);
  /// Fails where a key cannot be applied: its geometry is missing, or it is too late.
  Expected<void> check_key(const MessageHeader& header);
  bool is_of_next(const MessageHeader& header) const {
    return next && next->is_whole() && next->stream == header.stream &&
           next->version == header.geometry;
  }
  /// Sets the state to that of a key, and the geometry to `next` if the key belongs to it.
  void take_key(const MessageHeader& header, LightState key);
  Expected<void> receive_delta(const OpenedMessage& message);
  /// Fails where a change does not follow this state, with this version of the geometry.
  Expected<void> check_follows(const MessageHeader& header, std::uint64_t base_geometry);
};

}  // namespace lambent::stream
