// SPDX-License-Identifier: Apache-2.0
// Coding of the bodies of geometry messages.
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

/// Number of probes in a section. Each section has models of its own, so that sections are coded in
/// parallel, and unchanged ones are not coded again.
inline constexpr int kSectionProbes = 128;
/// Maximum number of sections in a message, so that clients decode these while the next ones
/// arrive.
inline constexpr std::size_t kPartSections = 4;
/// The coded sections of a geometry; an empty one is not coded yet.
using GeometrySections = std::vector<std::vector<std::byte>>;
/// Clears the sections of these probes, so that they are coded again.
void forget_sections(std::span<const int> probes, GeometrySections& sections);

/// Writes all of a geometry, in one or several parts. Of its corrections, only the number of blocks
/// is written. Codes empty sections; an empty list means all.
std::vector<std::vector<std::byte>> write_geometry(const FieldGeometry& geometry,
                                                   GeometrySections& sections);

/// write_geometry() as messages.
std::vector<LightMessage> geometry_messages(const MessageHeader& header,
                                            const FieldGeometry& geometry,
                                            GeometrySections& sections);

/// A geometry of which some parts may not have been received yet.
struct PartialGeometry {
  FieldGeometry geometry;          ///< Corrections have their final number, but no values.
  std::vector<std::uint8_t> here;  ///< Per section: 1 if its probes' records were received.
};

/// Reads a part of a geometry that was partly received, or of a new one. Sections that were already
/// received are not changed. Fails on data that no encoder wrote, and where the client's state
/// would take more than `most_bytes`, before any is allocated.
Expected<void> read_geometry(std::span<const std::byte> body, std::size_t most_bytes,
                             PartialGeometry& geometry);

/// Writes the changes that led to the geometry `now`: the grids, some probes, and whether there are
/// other corrections, which follow in messages of their own.
std::vector<std::byte> write_changes(const UpdatedProbes& updated, const FieldGeometry& now,
                                     bool other_corrections);

/// The contents of a message of write_changes.
struct GeometryChanges {
  std::vector<int> probes;
  bool corrections = false;  ///< There are others, which the geometry does not have yet.
};

/// Reads the output of write_changes, and updates the geometry. On failure the geometry is
/// unchanged.
Expected<GeometryChanges> read_changes(std::span<const std::byte> body, std::size_t most_bytes,
                                       FieldGeometry& geometry);

}  // namespace lambent::stream
