// SPDX-License-Identifier: Apache-2.0
// The layout of a mesh in one block of memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "lambent/scene.h"
#include "raytracing/vulkan/scene_records.h"

namespace lambent {

/// Which optional attributes a mesh has: kMeshHasTangents, ...
std::uint32_t attributes_of(const Mesh& mesh);

/// Size of a mesh's block [bytes].
std::size_t bytes_of(const Mesh& mesh);

/// Writes a mesh's attributes, each at a multiple of 16 bytes.
void write_mesh(const Mesh& mesh, std::span<std::byte> bytes);

/// The record of a mesh that was written to this address.
MeshRecord record_of(const Mesh& mesh, std::uint64_t address);

}  // namespace lambent
