// SPDX-License-Identifier: Apache-2.0
#include "scene/attributes.h"

#include "scene/texture.h"
#include "scene/texture_lookup.h"

namespace lambent {
namespace {

// The MIP level at which the cone covers about one texel.
int level_of(const Scene& scene, const std::vector<glm::vec2>& uvs, const TextureView& view,
             const TrianglePoint& point, TextureFootprint footprint) {
  const glm::vec2 uv0 = uvs[point.vertices.x];
  const TextureLevel& base = scene.textures[view.texture].levels.front();
  return mip_level(uvs[point.vertices.y] - uv0, uvs[point.vertices.z] - uv0, view.uv_scale,
                   base.width, base.height, footprint.share_of_triangle);
}

}  // namespace

glm::vec4 texture_at(const Scene& scene, const Mesh& mesh, const TextureView& view,
                     const TrianglePoint& point, TextureFootprint footprint) {
  if (view.texture < 0) return glm::vec4(1.0f);
  const std::vector<glm::vec2>& uvs = mesh.uvs[view.uv_set];
  if (uvs.empty()) return sample_texture(scene, view, glm::vec2(0.0f));
  const glm::vec2 uv = interpolate(uvs, point);
  if (footprint.share_of_triangle <= 0.0f) return sample_texture(scene, view, uv);
  return nearest_texel(scene, view, uv, level_of(scene, uvs, view, point, footprint));
}

bool shows_mean_alone(const Scene& scene, const Mesh& mesh, const TextureView& view,
                      const TrianglePoint& point, TextureFootprint footprint) {
  const std::vector<glm::vec2>& uvs = mesh.uvs[view.uv_set];
  if (uvs.empty() || footprint.share_of_triangle <= 0.0f) return false;
  const int level = level_of(scene, uvs, view, point, footprint);
  const int coarsest = static_cast<int>(scene.textures[view.texture].levels.size()) - 1;
  return shows_mean_alone(level, coarsest);
}

glm::vec4 base_color_at(const Scene& scene, const Mesh& mesh, const Material& material,
                        const TrianglePoint& point, TextureFootprint footprint) {
  glm::vec4 color = material.base_color;
  if (material.base_color_texture.texture >= 0) {
    color *= texture_at(scene, mesh, material.base_color_texture, point, footprint);
  }
  if (!mesh.colors.empty()) color *= interpolate(mesh.colors, point);
  return color;
}

glm::vec3 emission_at(const Scene& scene, const Mesh& mesh, const Material& material,
                      const TrianglePoint& point, TextureFootprint footprint) {
  if (!may_emit(material)) return glm::vec3(0.0f);
  if (material.unlit) return base_color_at(scene, mesh, material, point, footprint);
  glm::vec3 emission = material.emission;
  if (material.emission_texture.texture >= 0) {
    emission *= glm::vec3(texture_at(scene, mesh, material.emission_texture, point, footprint));
  }
  return emission;
}

}  // namespace lambent
