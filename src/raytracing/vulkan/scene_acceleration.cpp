// SPDX-License-Identifier: Apache-2.0
#include "raytracing/vulkan/scene_acceleration.h"

#include <utility>

#include "core/checksum.h"
#include "raytracing/ray_records.h"
#include "raytracing/refit.h"
#include "scene/transmission.h"
#include "vulkan/device.h"

namespace lambent {
namespace {

std::uint32_t hash_of_triangles(const Mesh& mesh) {
  return crc32_of(std::as_bytes(std::span(mesh.triangles)));
}

}  // namespace

SceneAcceleration::SceneAcceleration(const vulkan::Device& device, const Scene& scene,
                                     GeometryOfMesh geometry_of)
    : device_(device),
      scene_(scene),
      geometry_of_(std::move(geometry_of)),
      builder_(device),
      instances_(device) {
  build_missing();
  device.run([&](vulkan::Recorder& recorder) { place_instances(recorder); });
}

vulkan::TriangleGeometry SceneAcceleration::geometry(std::size_t mesh) const {
  vulkan::TriangleGeometry geometry = geometry_of_(mesh);
  geometry.opaque = stops_all_rays(scene_.materials[scene_.meshes[mesh].material]);
  geometry.deforms = shapes_[mesh].deforms;
  return geometry;
}

/// Builds the missing structures of meshes that have instances.
void SceneAcceleration::build_missing() {
  shapes_.resize(scene_.meshes.size());
  std::vector<std::uint8_t> missing(shapes_.size(), 0);
  for (const Instance& instance : scene_.instances) {
    const bool built = shapes_[instance.mesh].structure.address() != 0;
    missing[instance.mesh] = !built && !scene_.meshes[instance.mesh].triangles.empty();
  }
  std::vector<std::size_t> meshes;
  std::vector<vulkan::TriangleGeometry> geometries;
  for (std::size_t mesh = 0; mesh < missing.size(); ++mesh) {
    if (missing[mesh] == 0) continue;
    meshes.push_back(mesh);
    geometries.push_back(geometry(mesh));
  }
  std::vector<vulkan::AccelerationStructure> built = builder_.build(geometries);
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    Shape& shape = shapes_[meshes[k]];
    shape.structure = std::move(built[k]);
    if (!shape.deforms) continue;
    shape.half_area = half_area(scene_.meshes[meshes[k]]);
    shape.triangles_hash = hash_of_triangles(scene_.meshes[meshes[k]]);
  }
}

void SceneAcceleration::place_instances(vulkan::Recorder& recorder) {
  std::vector<vulkan::PlacedStructure> placed;
  placed.reserve(scene_.instances.size());
  for (const Instance& instance : scene_.instances) {
    placed.push_back({instance.world_from_object, shapes_[instance.mesh].structure.address(),
                      static_cast<std::uint32_t>(placed.size()),
                      static_cast<std::uint8_t>(device_mask(instance_mask(scene_, instance)))});
  }
  instances_.build(recorder, placed);
}

void SceneAcceleration::update(const GeometryEdits& edits) {
  shapes_.resize(scene_.meshes.size());
  for (const std::uint32_t mesh : edits.remade) shapes_[mesh].structure = {};
  std::vector<vulkan::TriangleBuilder::Deformed> deformed;
  for (const std::uint32_t mesh : edits.deformed) {
    Shape& shape = shapes_[mesh];
    // On the first deformation, rebuild the structure as one that can be refitted
    if (!std::exchange(shape.deforms, true)) shape.structure = {};
    if (shape.structure.address() == 0) continue;
    const float area = half_area(scene_.meshes[mesh]);
    const std::uint32_t hash = hash_of_triangles(scene_.meshes[mesh]);
    const bool anew = outgrown(shape.half_area, area) || hash != shape.triangles_hash;
    if (anew) {
      shape.half_area = area;
      shape.triangles_hash = hash;
    }
    deformed.push_back({&shape.structure, geometry(mesh), anew});
  }
  build_missing();
  device_.run([&](vulkan::Recorder& recorder) {
    builder_.fit(recorder, deformed);
    recorder.barrier();
    place_instances(recorder);
  });
}

std::size_t SceneAcceleration::bytes() const {
  std::size_t bytes = instances_.bytes();
  for (const Shape& shape : shapes_) bytes += shape.structure.bytes();
  return bytes;
}

}  // namespace lambent
