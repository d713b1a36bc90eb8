// SPDX-License-Identifier: Apache-2.0
// Bodies of messages of geometry.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "lambent/error.h"
#include "stream/light/geometry.h"

namespace lambent::stream {

/// Writes all of a geometry.
std::vector<std::byte> write_geometry(const FieldGeometry& geometry);

/// Reads all of a geometry. Fails on what no encoder wrote, and where the client's state would take
/// more than `most_bytes`, before it takes any.
Expected<FieldGeometry> read_geometry(std::span<const std::byte> body, std::size_t most_bytes);

/// Writes the grids, some probes, in ascending order, and where they changed all corrections, of a
/// geometry that was `before`.
std::vector<std::byte> write_changes(const FieldGeometry& before, const FieldGeometry& now,
                                     std::span<const int> probes, bool with_corrections);

/// What write_changes told of.
struct GeometryChanges {
  std::vector<int> probes;
  bool corrections = false;
};

/// Reads what write_changes wrote, and changes the geometry. Where it fails, the geometry is as it
/// was.
Expected<GeometryChanges> read_changes(std::span<const std::byte> body, FieldGeometry& geometry);

}  // namespace lambent::stream
