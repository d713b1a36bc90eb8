// SPDX-License-Identifier: Apache-2.0
#include "scene/attributes.h"

#include <algorithm>
#include <cmath>

#include "scene/texture.h"

namespace lambent {
namespace {

// The MIP level at which the cone covers about one texel: half the logarithm of the texels it
// covers. After Akenine-Moeller et al., "Texture Level of Detail Strategies for Real-Time Ray
// Tracing", Ray Tracing Gems, 2019, Eq. 2.
int mip_level(const Scene& scene, const std::vector<glm::vec2>& uvs, const TextureView& view,
              const TrianglePoint& point, TextureFootprint footprint) {
  const glm::vec2 uv0 = uvs[point.vertices.x];
  const glm::vec2 edge1 = uvs[point.vertices.y] - uv0;
  const glm::vec2 edge2 = uvs[point.vertices.z] - uv0;
  const TextureLevel& base = scene.textures[view.texture].levels.front();
  const float triangle_texels =
      0.5f * std::abs((edge1.x * edge2.y - edge1.y * edge2.x) * view.uv_scale.x * view.uv_scale.y) *
      static_cast<float>(base.width) * static_cast<float>(base.height);
  const float cone_texels = triangle_texels * footprint.share_of_triangle;
  // round(log2(t) / 2) = floor(log2(2 t) / 2)
  return cone_texels > 1.0f ? std::ilogb(2.0f * cone_texels) / 2 : 0;
}

}  // namespace

glm::vec4 texture_at(const Scene& scene, const Mesh& mesh, const TextureView& view,
                     const TrianglePoint& point, TextureFootprint footprint) {
  if (view.texture < 0) return glm::vec4(1.0f);
  const std::vector<glm::vec2>& uvs = mesh.uvs[view.uv_set];
  if (uvs.empty()) return sample_texture(scene, view, glm::vec2(0.0f));
  const glm::vec2 uv = interpolate(uvs, point);
  if (footprint.share_of_triangle <= 0.0f) return sample_texture(scene, view, uv);
  return nearest_texel(scene, view, uv, mip_level(scene, uvs, view, point, footprint));
}

bool shows_mean_alone(const Scene& scene, const Mesh& mesh, const TextureView& view,
                      const TrianglePoint& point, TextureFootprint footprint) {
  // Details are averaged over, and few such averages fit into the texture
  constexpr int kMinLevel = 2;
  constexpr int kMaxLevelsToCoarsest = 4;
  const std::vector<glm::vec2>& uvs = mesh.uvs[view.uv_set];
  if (uvs.empty() || footprint.share_of_triangle <= 0.0f) return false;
  const int level = mip_level(scene, uvs, view, point, footprint);
  const int coarsest = static_cast<int>(scene.textures[view.texture].levels.size()) - 1;
  return level >= kMinLevel && coarsest - level <= kMaxLevelsToCoarsest;
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
