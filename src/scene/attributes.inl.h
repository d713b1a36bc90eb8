// SPDX-License-Identifier: Apache-2.0
// The properties of a mesh and its material at a point of a triangle, in the common subset of C++
// and GLSL: interpolated attributes, textures, colour, coverage, emission. Included after
// texture.inl.h. The includer provides, in addition to what that file requires, the types
//   InstanceRef, MeshRef, MaterialRef    with members as in scene.h
//   TrianglePointRef                     a TrianglePoint, below
// and
//   InstanceRef fetch_instance(SceneRef scene, uint instance)
//   MeshRef fetch_mesh(SceneRef scene, uint mesh)
//   MaterialRef fetch_material(SceneRef scene, uint material)
//   uvec3 fetch_triangle(MeshRef mesh, uint triangle)    its vertices
//   vec3 fetch_position(MeshRef mesh, uint vertex)
//   vec4 fetch_color(MeshRef mesh, uint vertex)
//   bool has_colors(MeshRef mesh)
//   bool has_uvs(MeshRef mesh, TextureViewRef view)
//   vec2 fetch_uv(MeshRef mesh, TextureViewRef view, uint vertex)
//   bool is_unlit(MaterialRef material)
//   bool may_emit(MaterialRef material)
//   float luminance(vec3)
//   vec4 sample_texture(SceneRef scene, TextureViewRef view, vec2 uv, float level)
//       like blended_texel(), with the device's filter

/// A point of a triangle: its three vertices and their weights, which sum to 1.
struct TrianglePoint {
  uvec3 vertices;
  vec3 weights;
};

LAMBENT_FN TrianglePoint triangle_point(MeshRef mesh, uint triangle, vec2 barycentrics) {
  TrianglePoint point = {
      fetch_triangle(mesh, triangle),
      vec3(1.0f - barycentrics.x - barycentrics.y, barycentrics.x, barycentrics.y)};
  return point;
}

LAMBENT_FN vec2 interpolate(vec2 a, vec2 b, vec2 c, vec3 weights) {
  return a * weights.x + b * weights.y + c * weights.z;
}
LAMBENT_FN vec3 interpolate(vec3 a, vec3 b, vec3 c, vec3 weights) {
  return a * weights.x + b * weights.y + c * weights.z;
}
LAMBENT_FN vec4 interpolate(vec4 a, vec4 b, vec4 c, vec3 weights) {
  return a * weights.x + b * weights.y + c * weights.z;
}

/// Position in object space [m].
LAMBENT_FN vec3 position_at(MeshRef mesh, TrianglePointRef p) {
  return interpolate(fetch_position(mesh, p.vertices.x), fetch_position(mesh, p.vertices.y),
                     fetch_position(mesh, p.vertices.z), p.weights);
}

/// The mesh's colour at a point.
LAMBENT_FN vec4 color_at(MeshRef mesh, TrianglePointRef p) {
  return interpolate(fetch_color(mesh, p.vertices.x), fetch_color(mesh, p.vertices.y),
                     fetch_color(mesh, p.vertices.z), p.weights);
}

/// Texture coordinates of a triangle's corners; all 0 where the mesh has none.
struct CornerUvs {
  bool present;
  vec2 a;
  vec2 b;
  vec2 c;
};

LAMBENT_FN CornerUvs corner_uvs(MeshRef mesh, TextureViewRef view, TrianglePointRef p) {
  CornerUvs uvs = {has_uvs(mesh, view), vec2(0.0f), vec2(0.0f), vec2(0.0f)};
  if (!uvs.present) return uvs;
  uvs.a = fetch_uv(mesh, view, p.vertices.x);
  uvs.b = fetch_uv(mesh, view, p.vertices.y);
  uvs.c = fetch_uv(mesh, view, p.vertices.z);
  return uvs;
}

/// The MIP level at which a cone covers about one texel.
LAMBENT_FN int mip_level(SceneRef scene, TextureViewRef view, CornerUvs uvs, ConeShare cone_share) {
  TextureLevelRef base = fetch_level(scene, view, 0);
  return mip_level(uvs.b - uvs.a, uvs.c - uvs.a, view.uv_scale, base.width, base.height,
                   cone_share.of_triangle);
}

/// The MIP level without rounding; see blended_level() of mip_level.h.
LAMBENT_FN float blended_level(SceneRef scene, TextureViewRef view, CornerUvs uvs,
                               ConeShare cone_share) {
  TextureLevelRef base = fetch_level(scene, view, 0);
  return blended_level(uvs.b - uvs.a, uvs.c - uvs.a, view.uv_scale, base.width, base.height,
                       cone_share.of_triangle);
}

/// Where and how a texture is read.
struct TextureRead {
  vec2 uv;
  float level;   ///< MIP level; an integer where `nearest` is set.
  bool nearest;  ///< The nearest texel is enough.
};

LAMBENT_FN TextureRead texture_read(SceneRef scene, MeshRef mesh, TextureViewRef view,
                                    TrianglePointRef p, ConeShare cone_share) {
  CornerUvs uvs = corner_uvs(mesh, view, p);
  TextureRead read = {interpolate(uvs.a, uvs.b, uvs.c, p.weights), 0.0f, false};
  if (uvs.present && cone_share.of_triangle > 0.0f) {
    read.nearest = cone_share.blended == 0u;
    read.level = read.nearest ? float(mip_level(scene, view, uvs, cone_share))
                              : blended_level(scene, view, uvs, cone_share);
  }
  return read;
}

/// A texture of a mesh at a point; white where the view is empty.
LAMBENT_FN vec4 texture_at(SceneRef scene, MeshRef mesh, TextureViewRef view, TrianglePointRef p,
                           ConeShare cone_share) {
  if (view.texture < 0) return vec4(1.0f);
  TextureRead read = texture_read(scene, mesh, view, p, cone_share);
  if (read.nearest) return nearest_texel(scene, view, read.uv, int(read.level));
  return sample_texture(scene, view, read.uv, read.level);
}

/// A texel, filtered with weights of full precision. Devices may filter with weights of 8 bits, and
/// some with results of 8 bits. Textures on which ray directions depend need more: mirrors would
/// show the steps.
LAMBENT_FN vec4 precise_texel(SceneRef scene, TextureViewRef view, TextureRead read) {
  if (read.nearest) return nearest_texel(scene, view, read.uv, int(read.level));
  return blended_texel(scene, view, read.uv, read.level);
}

/// A texture of a mesh at a point, filtered by precise_texel(); white where the view is empty.
LAMBENT_FN vec4 precise_texture_at(SceneRef scene, MeshRef mesh, TextureViewRef view,
                                   TrianglePointRef p, ConeShare cone_share) {
  if (view.texture < 0) return vec4(1.0f);
  return precise_texel(scene, view, texture_read(scene, mesh, view, p, cone_share));
}

/// Whether a footprint covers so much of a texture that the result is nearly the texture's mean;
/// false for footprints whose levels are blended.
LAMBENT_FN bool shows_mean_alone(SceneRef scene, MeshRef mesh, TextureViewRef view,
                                 TrianglePointRef p, ConeShare cone_share) {
  CornerUvs uvs = corner_uvs(mesh, view, p);
  if (!uvs.present || cone_share.of_triangle <= 0.0f || cone_share.blended != 0u) return false;
  return shows_mean_alone(mip_level(scene, view, uvs, cone_share), level_count(scene, view) - 1);
}

/// Linear base colour: factor, texture and vertex colour.
LAMBENT_FN vec3 base_color_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                              TrianglePointRef p, ConeShare cone_share) {
  vec3 color = vec3(material.base_color);
  if (material.base_color_texture.texture >= 0) {
    color *= vec3(texture_at(scene, mesh, material.base_color_texture, p, cone_share));
  }
  if (has_colors(mesh)) color *= vec3(color_at(mesh, p));
  return color;
}

/// Emitted radiance [W/(m^2 sr)]; an unlit surface emits its base colour.
LAMBENT_FN vec3 emission_at(SceneRef scene, MeshRef mesh, MaterialRef material, TrianglePointRef p,
                            ConeShare cone_share) {
  if (!may_emit(material)) return vec3(0.0f);
  if (is_unlit(material)) return base_color_at(scene, mesh, material, p, cone_share);
  vec3 emission = material.emission;
  if (material.emission_texture.texture >= 0) {
    emission *= vec3(texture_at(scene, mesh, material.emission_texture, p, cone_share));
  }
  return emission;
}

/// The material of an instance.
LAMBENT_FN MaterialRef material_of(SceneRef scene, uint instance) {
  return fetch_material(scene, fetch_mesh(scene, fetch_instance(scene, instance).mesh).material);
}

/// Luminance that a material emits without textures and vertex colours [W/(m^2 sr)]: about its
/// brightest.
LAMBENT_FN float emission_luminance(MaterialRef material) {
  if (!may_emit(material)) return 0.0f;
  return luminance(is_unlit(material) ? vec3(material.base_color) : vec3(material.emission));
}

/// Share of the surface that is covered by a clearcoat, 0 to 1.
LAMBENT_FN float clearcoat_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                              TrianglePointRef p, ConeShare cone_share) {
  float clearcoat = material.clearcoat;
  if (material.clearcoat_texture.texture >= 0) {
    clearcoat *= texture_at(scene, mesh, material.clearcoat_texture, p, cone_share).x;
  }
  return clearcoat;
}

/// Coverage, 0 to 1, which decides for kAlphaMask and kAlphaBlend whether a ray is stopped. It is
/// filtered in full precision, so that all devices decide the same.
LAMBENT_FN float coverage_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                             TrianglePointRef p) {
  float alpha = material.base_color.w;
  if (material.base_color_texture.texture >= 0) {
    CornerUvs uvs = corner_uvs(mesh, material.base_color_texture, p);
    vec2 uv = interpolate(uvs.a, uvs.b, uvs.c, p.weights);
    alpha *= filtered_texel(scene, material.base_color_texture, uv).w;
  }
  if (has_colors(mesh)) alpha *= color_at(mesh, p).w;
  return alpha;
}

/// The coverage of a triangle at these barycentrics.
LAMBENT_FN HitCoverage hit_coverage_at(SceneRef scene, uint instance, uint triangle,
                                       vec2 barycentrics) {
  MeshRef mesh = fetch_mesh(scene, fetch_instance(scene, instance).mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  HitCoverage found;
  found.mode = uint(material.alpha_mode);
  found.cutoff = material.alpha_cutoff;
  found.alpha = coverage_at(scene, mesh, material, triangle_point(mesh, triangle, barycentrics));
  return found;
}
