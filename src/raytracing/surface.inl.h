// SPDX-License-Identifier: Apache-2.0
// From a hit to the surface that shading sees, in the common subset of C++ and GLSL. Included after
// attributes.inl.h. The includer provides, besides what that asks for, the type
//   HitRef  with instance, triangle, barycentrics and front_face
// and
//   vec3 fetch_normal(MeshRef mesh, uint vertex)
//   vec4 fetch_tangent(MeshRef mesh, uint vertex)
//   bool has_tangents(MeshRef mesh)
//   bool is_lambert(MaterialRef material)
//   bool is_double_sided(MaterialRef material)
//   bool receives_gi(InstanceRef instance)

/// Tangent with handedness, in object space, that a texture is laid out by.
LAMBENT_FN vec4 tangent_at(MeshRef mesh, TextureViewRef view, TrianglePointRef p, vec3 edge1,
                           vec3 edge2) {
  if (has_tangents(mesh)) {
    return interpolate(fetch_tangent(mesh, p.vertices.x), fetch_tangent(mesh, p.vertices.y),
                       fetch_tangent(mesh, p.vertices.z), p.weights);
  }
  CornerUvs uvs = corner_uvs(mesh, view, p);
  if (!uvs.present) return vec4(0.0f);
  return tangent_from_uvs(edge1, edge2, uvs.b - uvs.a, uvs.c - uvs.a);
}

/// The normal that the material's map says, in object space.
LAMBENT_FN vec3 mapped_normal_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                                 TrianglePointRef p, float cone_share, vec3 normal, vec4 tangent) {
  vec3 t = orthogonal_tangent(normal, vec3(tangent));
  if (t == vec3(0.0f)) return normal;
  return mapped_normal(normal, t, tangent.w,
                       vec3(texture_at(scene, mesh, material.normal_texture, p, cone_share)),
                       material.normal_scale);
}

LAMBENT_FN Reflectance reflectance_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                                      TrianglePointRef p, float cone_share) {
  if (is_unlit(material)) return lambert_reflectance(vec3(0.0f));
  vec3 base = clamp(base_color_at(scene, mesh, material, p, cone_share), 0.0f, 1.0f);
  float metallic = material.metallic;
  float roughness = material.roughness;
  bool needs_texel = !is_lambert(material) || metallic > 0.0f;
  if (needs_texel && material.metallic_roughness_texture.texture >= 0) {
    vec4 texel = texture_at(scene, mesh, material.metallic_roughness_texture, p, cone_share);
    roughness *= texel.y;
    metallic *= texel.z;
  }
  if (is_lambert(material)) return lambert_reflectance(base * (1.0f - metallic));

  float specular = material.specular;
  if (material.specular_texture.texture >= 0) {
    specular *= texture_at(scene, mesh, material.specular_texture, p, cone_share).w;
  }
  vec3 specular_color = material.specular_color;
  if (material.specular_color_texture.texture >= 0) {
    specular_color *= vec3(texture_at(scene, mesh, material.specular_color_texture, p, cone_share));
  }
  return coated_reflectance(base, metallic, roughness, specular, specular_color, material.ior);
}

/// The surface at a hit (not a miss) of a ray along a direction. `footprint` is the width that the
/// ray's cone has there [m]; 0 reads textures at full resolution.
LAMBENT_FN Surface surface_at(SceneRef scene, vec3 direction_ws, HitRef hit, float footprint) {
  InstanceRef instance = fetch_instance(scene, hit.instance);
  MeshRef mesh = fetch_mesh(scene, instance.mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  TrianglePoint p = triangle_point(mesh, hit.triangle, hit.barycentrics);

  // Compute the position and the geometric normal, whose length is twice the triangle's area
  vec3 p0 = fetch_position(mesh, p.vertices.x);
  vec3 edge1 = fetch_position(mesh, p.vertices.y) - p0;
  vec3 edge2 = fetch_position(mesh, p.vertices.z) - p0;
  vec3 position = p0 + edge1 * p.weights.y + edge2 * p.weights.z;
  mat3 normal_from_object = cofactors(instance.world_from_object);
  vec3 face_normal = cross(edge1, edge2);
  vec3 area_normal = normal_from_object * face_normal;
  float cone_share = share_of_triangle(footprint, length(area_normal));
  Surface surface;
  surface.position_ws = transform_point(instance.world_from_object, position);
  surface.geometric_normal_ws = normalize_or(area_normal, -direction_ws);

  // Compute the shading normal on the side that the vertices call the front
  vec3 normal = interpolate(fetch_normal(mesh, p.vertices.x), fetch_normal(mesh, p.vertices.y),
                            fetch_normal(mesh, p.vertices.z), p.weights);
  bool along_winding = dot(normal, face_normal) >= 0.0f;
  // Bumps that the footprint averages over leave the surface flat
  if (material.normal_texture.texture >= 0 &&
      !shows_mean_alone(scene, mesh, material.normal_texture, p, cone_share)) {
    vec4 tangent = tangent_at(mesh, material.normal_texture, p, edge1, edge2);
    normal = mapped_normal_at(scene, mesh, material, p, cone_share,
                              normalize_or(normal, vec3(0.0f, 0.0f, 1.0f)), tangent);
  }
  normal = normalize_or(normal_from_object * normal, surface.geometric_normal_ws);

  // Turn both normals to the side the ray came from
  bool from_front = dot(surface.geometric_normal_ws, direction_ws) <= 0.0f;
  if (!from_front) surface.geometric_normal_ws = -surface.geometric_normal_ws;
  surface.normal_ws = normal_towards_viewer(normal, along_winding, from_front, direction_ws,
                                            surface.geometric_normal_ws);

  surface.reflectance = reflectance_at(scene, mesh, material, p, cone_share);
  surface.emission = emission_at(scene, mesh, material, p, cone_share);
  surface.material = uint(mesh.material);
  surface.front_face = bool(hit.front_face);
  surface.double_sided = is_double_sided(material);
  surface.receives_gi = receives_gi(instance);
  return surface;
}
