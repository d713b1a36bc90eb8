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

/// Geometry that was received, and what follows from it.
struct ReceivedGeometry : PartialGeometry {
  ReceivedGeometry(const MessageHeader& header, PartialGeometry received)
      : PartialGeometry(std::move(received)),
        stream(header.stream),
        version(header.geometry),
        basis(geometry.irradiance_texels) {
    lay_out();
    forget_corrections();
  }
  /// Brings `layout` and `grids` up to date with the geometry.
  void lay_out() {
    layout = layout_of(geometry);
    grids.clear();
    for (const Volume& volume : geometry.volumes) grids.push_back(field_grid(volume.grid));
  }

  std::uint32_t stream;
  std::uint64_t version;
  /// Has no pieces of its corrections any more.
  void forget_corrections() { pieces.assign(correction_pieces(geometry.corrections.size()), {}); }
  bool is_whole() const {
    return std::all_of(here.begin(), here.end(), [](std::uint8_t one) { return one != 0; });
  }
  bool has_corrections() const {
    return std::none_of(pieces.begin(), pieces.end(), [](const auto& one) { return one.empty(); });
  }
  /// Takes the pieces that another one has of the same corrections.
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
  CorrectionPieces pieces;  ///< As they came.
};

struct LightDecoder::State {
  std::size_t most_bytes = 0;
  std::optional<ReceivedGeometry> current;  ///< Of `light`; empty before the first key.
  std::optional<ReceivedGeometry> next;     ///< Of a key that is still to come; or parts of it.
  LightState light;
  bool lost = false;                      ///< A change is missing.
  std::unique_ptr<TextureReader> reader;  ///< Null: textures are refused.
  TexturePicture picture;                 ///< The last texture's.
  /// How the light came; what follows must come in the same way.
  enum class Way : std::uint8_t { coded, textures, regions };
  Way way = Way::coded;
  std::optional<RegionStates> regions;  ///< Where it came by regions.
  std::uint64_t geometries = 0;         ///< Keys so far that were of another geometry.
  std::vector<int> changed;
  bool corrected = false;  ///< With the last message there are other corrections, all of them.
  std::vector<std::int32_t> levels;
  GeometrySections sections;  ///< Of `current`, for others: those that were coded and still are so.

  Expected<void> receive(std::span<const std::byte> bytes);

 private:
  Expected<void> receive_geometry(const OpenedMessage& message);
  Expected<void> receive_corrections(const OpenedMessage& message);
  Expected<void> receive_key(const OpenedMessage& message);
  Expected<void> receive_texture(const OpenedMessage& message);
  Expected<void> receive_regions(const OpenedMessage& message);
  Expected<void> receive_whole_regions(const MessageHeader& header, const RegionBody& body);
  /// Whether a change goes on in the way in which the light came.
  Expected<void> check_way(const MessageHeader& header, Way now);
  /// Whether a key can be taken: its geometry is here, and it does not come too late.
  Expected<void> check_key(const MessageHeader& header);
  bool is_of_next(const MessageHeader& header) const {
    return next && next->is_whole() && next->stream == header.stream &&
           next->version == header.geometry;
  }
  /// The state of a key, of the geometry that is next where it is of that.
  void take_key(const MessageHeader& header, LightState key);
  Expected<void> receive_delta(const OpenedMessage& message);
  /// Whether a change leads on from this state, with this version of the geometry.
  Expected<void> check_follows(const MessageHeader& header, std::uint64_t base_geometry);
};

}  // namespace lambent::stream
