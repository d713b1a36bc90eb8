// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/mesh_layout.h"

#include <cassert>
#include <cstring>

namespace lambent {
namespace {

// Alignment of the widest attribute, four floats.
constexpr std::size_t kAlignment = 16;

/// Calls visit(bytes of the attribute, its offset, its address in the record) for each attribute of
/// the mesh. Returns the total number of bytes.
template <class Visit>
std::size_t for_each_attribute(const Mesh& mesh, MeshRecord& record, Visit visit) {
  std::size_t offset = 0;
  const auto attribute = [&](const auto& values, std::uint64_t& address) {
    if (values.empty()) return;
    const std::span bytes = std::as_bytes(std::span(values));
    visit(bytes, offset, address);
    offset += (bytes.size() + kAlignment - 1) / kAlignment * kAlignment;
  };
  attribute(mesh.positions, record.positions.address);
  attribute(mesh.normals, record.normals.address);
  attribute(mesh.tangents, record.tangents.address);
  attribute(mesh.uvs[0], record.uvs0.address);
  attribute(mesh.uvs[1], record.uvs1.address);
  attribute(mesh.colors, record.colors.address);
  attribute(mesh.triangles, record.triangles.address);
  return offset;
}

}  // namespace

std::uint32_t attributes_of(const Mesh& mesh) {
  return (mesh.tangents.empty() ? 0 : kMeshHasTangents) |
         (mesh.colors.empty() ? 0 : kMeshHasColors) | (mesh.uvs[0].empty() ? 0 : kMeshHasUvs0) |
         (mesh.uvs[1].empty() ? 0 : kMeshHasUvs1);
}

std::size_t bytes_of(const Mesh& mesh) {
  MeshRecord record{};
  return for_each_attribute(mesh, record, [](auto, auto, auto&) {});
}

void write_mesh(const Mesh& mesh, std::span<std::byte> out) {
  MeshRecord record{};
  for_each_attribute(mesh, record,
                     [&](std::span<const std::byte> bytes, std::size_t offset, std::uint64_t&) {
                       assert(offset + bytes.size() <= out.size());
                       std::memcpy(out.data() + offset, bytes.data(), bytes.size());
                     });
}

MeshRecord record_of(const Mesh& mesh, std::uint64_t address) {
  MeshRecord record{};
  for_each_attribute(mesh, record,
                     [&](std::span<const std::byte>, std::size_t offset, std::uint64_t& attribute) {
                       attribute = address + offset;
                     });
  record.material = static_cast<uint>(mesh.material);
  record.attributes = attributes_of(mesh);
  return record;
}

}  // namespace lambent
