// SPDX-License-Identifier: Apache-2.0
// Bodies of messages of geometry.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "lambent/stream.h"
#include "stream/light/geometry.h"
#include "stream/light/message.h"

namespace lambent::stream {

/// Probes' records are in sections, each with models of its own, so that all cores code them, and
/// those that have not changed need not be coded again.
inline constexpr int kSectionProbes = 128;
/// A message has so many sections at most, so that clients decode these while the next ones come.
inline constexpr std::size_t kPartSections = 4;
/// The coded sections of a geometry; an empty one is to be coded.
using GeometrySections = std::vector<std::vector<std::byte>>;
/// Has the sections of these probes coded again.
void forget_sections(std::span<const int> probes, GeometrySections& sections);

/// Writes all of a geometry, in one or several parts, but for its corrections, of which it tells
/// that they come. Codes those sections that are to be coded; no sections: all of them.
std::vector<std::vector<std::byte>> write_geometry(const FieldGeometry& geometry,
                                                   GeometrySections& sections);

/// The same as messages.
std::vector<LightMessage> geometry_messages(const MessageHeader& header,
                                            const FieldGeometry& geometry,
                                            GeometrySections& sections);

/// A geometry of which some parts may not have come yet.
struct PartialGeometry {
  FieldGeometry geometry;          ///< Corrections are as many as will come, and hold nothing.
  std::vector<std::uint8_t> here;  ///< Of each section: 1 where its probes' records have come.
};

/// Reads a part, of a geometry that has begun to come, or else of a new one. Sections that are
/// there stay as they are. Fails on what no encoder wrote, and where the client's state would take
/// more than `most_bytes`, before it takes any.
Expected<void> read_geometry(std::span<const std::byte> body, std::size_t most_bytes,
                             PartialGeometry& geometry);

/// Writes the grids and some probes, in ascending order, of a geometry that was `before`, and where
/// it has other corrections, that these come.
std::vector<std::byte> write_changes(const FieldGeometry& before, const FieldGeometry& now,
                                     std::span<const int> probes, bool other_corrections);

/// What write_changes told of.
struct GeometryChanges {
  std::vector<int> probes;
  bool corrections = false;  ///< There are others; the geometry's hold nothing.
};

/// Reads what write_changes wrote, and changes the geometry. Where it fails, the geometry is as it
/// was.
Expected<GeometryChanges> read_changes(std::span<const std::byte> body, std::size_t most_bytes,
                                       FieldGeometry& geometry);

}  // namespace lambent::stream
