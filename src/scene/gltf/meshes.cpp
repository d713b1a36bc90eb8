// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/meshes.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numeric>

#include "scene/animation/pose.h"
#include "scene/gltf/deform.h"
#include "scene/gltf/document/accessors.h"
#include "scene/gltf/document/draco.h"
#include "scene/gltf/rounding.h"
#include "scene/limits.h"
#include "scene/mesh_repair.h"

namespace lambent::gltf {
namespace {

std::string primitive_place(int mesh, int primitive) {
  return entry("meshes", mesh) + "." + entry("primitives", primitive);
}

// A primitive's attributes and indices, from accessors or from its Draco stream.
class PrimitiveReader {
 public:
  static Expected<PrimitiveReader> open(const Document& document, int mesh, int primitive) {
    PrimitiveReader reader(document, mesh, primitive);
    const auto* draco = find_extension(reader.source_.extensions, "KHR_draco_mesh_compression");
    if (draco) {
      LAMBENT_TRY(decoded, decode_draco(document, reader.source_, *draco, reader.place()));
      reader.draco_ = std::move(decoded);
    }
    return reader;
  }

  const std::string& place() const { return place_; }

  // An attribute with one element a vertex, of one of two numbers of components; without elements
  // where the primitive lacks it. Numbers that are not finite are an error.
  Expected<Elements> attribute(const std::string& name, int components, int alternative) const {
    LAMBENT_TRY(elements, raw_attribute(name, components, alternative));
    LAMBENT_CHECK(check_finite(*document_, elements, place_of(name)));
    return std::move(elements);
  }

  // The same of an attribute that surfaces can do without. Exporters that divide by 0 write some
  // elements as NaN: all numbers of such an element become `stand_in`.
  Expected<Elements> attribute_or(const std::string& name, int components, int alternative,
                                  float stand_in, Document& document) const {
    LAMBENT_TRY(elements, raw_attribute(name, components, alternative));
    std::size_t replaced = 0;
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (is_finite(elements, i)) continue;
      std::fill_n(elements.values.data() + i * elements.components, elements.components, stand_in);
      ++replaced;
    }
    document.repaired("attributes of vertices were not finite and were replaced", replaced,
                      place_of(name));
    return std::move(elements);
  }

  void expect_vertices(std::size_t vertices) { vertices_ = vertices; }

  // The primitive's mode. Draco streams contain triangles, also for strips.
  int mode() const { return draco_ ? TINYGLTF_MODE_TRIANGLES : source_.mode; }

  // The primitive's vertex indices; 0, 1, 2, ... if it has none.
  Expected<std::vector<std::uint32_t>> indices() const {
    if (draco_) return checked(draco_->indices, place_);
    const int accessor = document_->primitive_indices[mesh_][primitive_];
    if (accessor >= 0) {
      LAMBENT_TRY(indices, read_indices(*document_, accessor));
      return checked(std::move(indices), entry("accessors", accessor));
    }
    std::vector<std::uint32_t> indices(vertices_);
    for (std::size_t i = 0; i < vertices_; ++i) indices[i] = static_cast<std::uint32_t>(i);
    return indices;
  }

 private:
  std::string place_of(const std::string& attribute) const {
    const bool streamed = draco_ && draco_->attributes.contains(attribute);
    const auto found = source_.attributes.find(attribute);
    if (streamed || found == source_.attributes.end()) return place_ + ".attributes." + attribute;
    return entry("accessors", found->second);
  }

  Expected<Elements> raw_attribute(const std::string& name, int components, int alternative) const {
    Elements elements;
    if (draco_ && draco_->attributes.contains(name)) {
      elements = draco_->attributes.at(name);
    } else if (const auto found = source_.attributes.find(name);
               found != source_.attributes.end()) {
      LAMBENT_TRY(decoded, read_raw_elements(*document_, found->second));
      elements = std::move(decoded);
    } else {
      return elements;
    }
    const std::string place = place_ + ".attributes." + name;
    if (vertices_ != 0 && elements.size() != vertices_) {
      return document_->fail_at(place, "has " + std::to_string(elements.size()) + " elements for " +
                                           std::to_string(vertices_) + " vertices");
    }
    const bool fits = elements.components == components || elements.components == alternative;
    if (elements.size() != 0 && !fits) {
      return document_->fail_at(place, "has " + std::to_string(elements.components) +
                                           " components where " + std::to_string(components) +
                                           " are needed");
    }
    return elements;
  }

  PrimitiveReader(const Document& document, int mesh, int primitive)
      : document_(&document),
        mesh_(mesh),
        primitive_(primitive),
        source_(document.model.meshes[mesh].primitives[primitive]),
        place_(primitive_place(mesh, primitive)) {}

  Expected<std::vector<std::uint32_t>> checked(std::vector<std::uint32_t> indices,
                                               const std::string& place) const {
    for (std::size_t i = 0; i < indices.size(); ++i) {
      if (indices[i] < vertices_) continue;
      return document_->fail_at(place, "index " + std::to_string(indices[i]) + " at " +
                                           std::to_string(i) + " is out of range: " + place_ +
                                           " has " + std::to_string(vertices_) + " vertices");
    }
    return indices;
  }

  const Document* document_;
  int mesh_;
  int primitive_;
  const tinygltf::Primitive& source_;
  std::string place_;
  std::size_t vertices_ = 0;
  std::optional<DracoPrimitive> draco_;
};

// Specification, sec. 3.7.2.1: the vertices of each triangle, by mode.
std::vector<glm::uvec3> triangles_of(int mode, const std::vector<std::uint32_t>& v) {
  std::vector<glm::uvec3> triangles;
  if (v.size() < 3) return triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    triangles.reserve(v.size() / 3);
    for (std::size_t i = 0; i + 2 < v.size(); i += 3) {
      triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
    }
  } else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
    triangles.reserve(v.size() - 2);
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      triangles.emplace_back(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
    }
  } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
    triangles.reserve(v.size() - 2);
    for (std::size_t i = 0; i + 2 < v.size(); ++i) {
      triangles.emplace_back(v[i + 1], v[i + 2], v[0]);
    }
  }
  return triangles;
}

template <class Vector>
std::vector<Vector> vectors_of(const Elements& elements) {
  std::vector<Vector> vectors(elements.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    for (int k = 0; k < Vector::length(); ++k) vectors[i][k] = elements[i][k];
  }
  return vectors;
}

std::vector<glm::vec4> colors_of(const Elements& elements) {
  std::vector<glm::vec4> colors(elements.size(), glm::vec4(1.0f));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    for (int k = 0; k < elements.components; ++k) {
      colors[i][k] = std::clamp(elements[i][k], 0.0f, 1.0f);
    }
  }
  return colors;
}

// What a vertex lacks becomes 0, which is repaired later as what has no direction is, or white.
constexpr float kNoValue = 0.0f, kWhite = 1.0f;

Expected<void> read_vertices(Document& document, PrimitiveReader& reader, Mesh& mesh) {
  LAMBENT_TRY(positions, reader.attribute("POSITION", 3, 3));
  mesh.positions = vectors_of<glm::vec3>(positions);
  if (mesh.positions.empty()) return {};
  reader.expect_vertices(mesh.positions.size());
  LAMBENT_TRY(normals, reader.attribute_or("NORMAL", 3, 3, kNoValue, document));
  mesh.normals = vectors_of<glm::vec3>(normals);
  LAMBENT_TRY(tangents, reader.attribute_or("TANGENT", 4, 4, kNoValue, document));
  mesh.tangents = vectors_of<glm::vec4>(tangents);
  LAMBENT_TRY(uv0, reader.attribute_or("TEXCOORD_0", 2, 2, kNoValue, document));
  mesh.uvs[0] = vectors_of<glm::vec2>(uv0);
  LAMBENT_TRY(uv1, reader.attribute_or("TEXCOORD_1", 2, 2, kNoValue, document));
  mesh.uvs[1] = vectors_of<glm::vec2>(uv1);
  LAMBENT_TRY(colors, reader.attribute_or("COLOR_0", 4, 3, kWhite, document));
  mesh.colors = colors_of(colors);
  return {};
}

// Handles numbers of vertices beyond the ranges of limits.h: coordinates are an error, since
// nothing can replace a position; texture coordinates become 0, as if there were none.
Expected<void> check_ranges(Document& document, const std::string& place, Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (is_in_reach(mesh.positions[i])) continue;
    return document.fail_at(place, "vertex " + std::to_string(i) +
                                       " has a coordinate that is not within -1e9 to 1e9 m");
  }
  std::size_t far = 0;
  for (auto& uvs : mesh.uvs) {
    for (glm::vec2& uv : uvs) {
      const glm::vec2 size = glm::abs(uv);
      if (size.x <= kMaxTextureCoordinate && size.y <= kMaxTextureCoordinate) continue;
      uv = glm::vec2(0.0f);
      ++far;
    }
  }
  document.repaired("texture coordinates beyond 1e8 were set to 0", far, place);
  return {};
}

// Moves vertices that are far from the origin to it, and returns the offset.
glm::dvec3 move_to_origin(Mesh& mesh) {
  const glm::dvec3 centre = origin_of(mesh_bounds(mesh));
  if (centre == glm::dvec3(0.0)) return centre;
  for (glm::vec3& position : mesh.positions) position = glm::vec3(glm::dvec3(position) - centre);
  return centre;
}

Expected<std::vector<SkinInfluences>> read_influences(const PrimitiveReader& reader) {
  std::vector<SkinInfluences> sets;
  for (int set = 0;; ++set) {
    const std::string suffix = std::to_string(set);
    LAMBENT_TRY(joints, reader.attribute("JOINTS_" + suffix, 4, 4));
    LAMBENT_TRY(weights, reader.attribute("WEIGHTS_" + suffix, 4, 4));
    if (joints.size() == 0 || weights.size() == 0) break;
    sets.push_back({std::move(joints), std::move(weights)});
  }
  return sets;
}

// Reads the data that deform the file's vertices in other poses.
Expected<RigMesh> read_rig(const Document& document, const tinygltf::Primitive& source,
                           const Mesh& unbent, const std::vector<SkinInfluences>& sets,
                           std::size_t joints) {
  RigMesh rig;
  rig.positions = unbent.positions;
  rig.normals = unbent.normals;
  // Stored tangents are undefined without normals
  if (!unbent.normals.empty()) rig.tangents = unbent.tangents;
  for (const auto& target : source.targets) {
    RigMesh::MorphTarget& made = rig.targets.emplace_back();
    const auto read = [&](const char* name, std::vector<glm::vec3>& offsets) -> Expected<void> {
      const auto accessor = target.find(name);
      if (accessor == target.end()) return {};
      LAMBENT_TRY(elements, read_elements(document, accessor->second, 3));
      offsets = vectors_of<glm::vec3>(elements);
      if (offsets.size() == unbent.positions.size()) return {};
      return document.fail_at(entry("accessors", accessor->second),
                              "a morph target has not one element a vertex");
    };
    LAMBENT_CHECK(read("POSITION", made.positions));
    LAMBENT_CHECK(read("NORMAL", made.normals));
    LAMBENT_CHECK(read("TANGENT", made.tangents));
  }
  rig.influences = joints == 0 ? 0 : static_cast<int>(4 * sets.size());
  for (std::size_t v = 0; rig.influences > 0 && v < unbent.positions.size(); ++v) {
    for (const SkinInfluences& set : sets) {
      for (int k = 0; k < 4; ++k) {
        // A joint without weight need not exist
        const float joint = set.joints[v][k];
        const bool exists = joint >= 0.0f && joint < static_cast<float>(joints);
        rig.joints.push_back(exists ? static_cast<std::uint32_t>(joint) : 0u);
        rig.weights.push_back(set.weights[v][k]);
      }
    }
  }
  return rig;
}

template <class T>
void gather(std::vector<T>& values, const VertexOrigins& origins, std::size_t a_vertex = 1) {
  if (values.empty()) return;
  std::vector<T> gathered;
  gathered.reserve(origins.size() * a_vertex);
  for (const std::uint32_t origin : origins) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(origin * a_vertex);
    gathered.insert(gathered.end(), first, first + static_cast<std::ptrdiff_t>(a_vertex));
  }
  values = std::move(gathered);
}

// Converts the rig of the file's vertices to that of the repaired mesh's vertices.
void follow_repairs(const VertexOrigins& origins, const Mesh& mesh, RigMesh& rig) {
  gather(rig.positions, origins);
  gather(rig.normals, origins);
  gather(rig.tangents, origins);
  if (mesh.tangents.empty()) rig.tangents.clear();
  for (RigMesh::MorphTarget& target : rig.targets) {
    gather(target.positions, origins);
    gather(target.normals, origins);
    gather(target.tangents, origins);
  }
  gather(rig.joints, origins, static_cast<std::size_t>(rig.influences));
  gather(rig.weights, origins, static_cast<std::size_t>(rig.influences));
}

// Fills in and repairs normals and tangents.
void complete(Document& document, const std::string& place, int tangent_uv_set, Mesh& mesh,
              VertexOrigins& origins) {
  if (mesh.normals.empty()) {
    // Stored tangents are undefined without their normals (specification, sec. 3.7.2.1)
    mesh.tangents.clear();
    make_flat_normals(mesh, &origins);
  }
  document.repaired("normals without direction were replaced", repair_normals(mesh), place);
  const bool wanted = tangent_uv_set >= 0 && !mesh.uvs[tangent_uv_set].empty();
  if (!wanted) {
    mesh.tangents.clear();
  } else if (mesh.tangents.empty()) {
    make_tangents(mesh, tangent_uv_set, &origins);
  } else {
    document.repaired("tangents without direction were replaced", repair_tangents(mesh), place);
  }
}

}  // namespace

Expected<std::optional<ImportedMesh>> import_primitive(Document& document, int mesh_index,
                                                       int primitive,
                                                       const Deformation& deformation,
                                                       bool recentre, int tangent_uv_set,
                                                       RigMesh* rig) {
  const tinygltf::Mesh& source_mesh = document.model.meshes[mesh_index];
  const tinygltf::Primitive& source = source_mesh.primitives[primitive];
  const std::string place = primitive_place(mesh_index, primitive);
  if (source.mode < TINYGLTF_MODE_TRIANGLES) {
    document.repaired("primitives of points or lines were left out", 1, place);
    return std::nullopt;
  }

  LAMBENT_TRY(reader, PrimitiveReader::open(document, mesh_index, primitive));
  ImportedMesh imported;
  Mesh& mesh = imported.mesh;
  mesh.name = source_mesh.name;
  mesh.material = source.material;
  LAMBENT_CHECK(read_vertices(document, reader, mesh));
  if (mesh.positions.empty()) {
    document.repaired("primitives without positions were left out", 1, place);
    return std::nullopt;
  }
  LAMBENT_CHECK(check_ranges(document, place, mesh));
  if (recentre) imported.centre = move_to_origin(mesh);
  LAMBENT_TRY(indices, reader.indices());
  mesh.triangles = triangles_of(reader.mode(), indices);

  std::vector<SkinInfluences> influences;
  if (!deformation.joint_matrices.empty()) {
    LAMBENT_TRY(sets, read_influences(reader));
    influences = std::move(sets);
  }
  if (rig != nullptr) {
    LAMBENT_TRY(made,
                read_rig(document, source, mesh, influences, deformation.joint_matrices.size()));
    *rig = std::move(made);
  }
  LAMBENT_CHECK(bend_by_morph_targets(document, source, place, deformation.morph_weights, mesh));
  if (!deformation.joint_matrices.empty()) {
    std::vector<glm::mat4> world_from_vertex;
    for (const glm::dmat4& world_from_bind : deformation.joint_matrices) {
      world_from_vertex.emplace_back(glm::translate(world_from_bind, imported.centre));
    }
    LAMBENT_CHECK(bend_by_joints(document, place, influences, world_from_vertex, mesh));
  }
  const DroppedTriangles dropped = drop_degenerate_triangles(mesh);
  // Where a mesh bends, triangles that are points now may grow later
  document.repaired("triangles without area were dropped",
                    rig != nullptr ? dropped.all : dropped.slivers, place);
  if (mesh.triangles.empty()) return std::nullopt;
  VertexOrigins origins(mesh.positions.size());
  std::iota(origins.begin(), origins.end(), 0u);
  drop_unused_vertices(mesh, &origins);
  complete(document, place, tangent_uv_set, mesh, origins);
  if (rig != nullptr) follow_repairs(origins, mesh, *rig);
  return imported;
}

}  // namespace lambent::gltf
