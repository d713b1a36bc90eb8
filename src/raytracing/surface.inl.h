// SPDX-License-Identifier: Apache-2.0
// The surface at a hit, for shading, in the common subset of C++ and GLSL. Included after
// attributes.inl.h. The includer provides, besides what that asks for, the type
//   HitRef  with instance, triangle, barycentrics and front_face
// and
//   vec3 fetch_normal(MeshRef mesh, uint vertex)
//   vec4 fetch_tangent(MeshRef mesh, uint vertex)
//   bool has_tangents(MeshRef mesh)
//   bool is_lambert(MaterialRef material)
//   bool receives_gi(InstanceRef instance)
//   bool is_transmissive(MaterialRef material)
//   bool bounds_volume(MaterialRef material)
//   bool has_layers(MaterialRef material)
//   bool has_film(MaterialRef material)

/// Tangent with handedness, in object space, for the layout of a texture.
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

/// What a normal map holds at a point, and how much of it is a mean: 0 at full size, where vectors
/// that are shorter than 1 are not means of several, 1 from the first MIP level on.
struct MapTexel {
  vec4 texel;
  float averaged;
};

/// Where the footprint covers all of the map, it is the map's mean.
LAMBENT_FN MapTexel map_texel_at(SceneRef scene, MeshRef mesh, TextureViewRef view,
                                 TrianglePointRef p, ConeShare cone_share, bool mean_alone) {
  MapTexel found;
  if (mean_alone) {
    found.texel = fetch_texel(fetch_level(scene, view, level_count(scene, view) - 1), 0, 0);
    found.averaged = 1.0f;
    return found;
  }
  TextureRead read = texture_read(scene, mesh, view, p, cone_share);
  found.texel = precise_texel(scene, view, read);
  found.averaged = clamp(read.level, 0.0f, 1.0f);
  return found;
}

/// A normal in object space, of any length, bent by a normal map; the length of the mean of the
/// map's normals over the footprint, 0 to 1; and how far most of them scatter.
struct BentNormal {
  vec3 normal;
  float mean_length;
  float spread;
};

LAMBENT_FN BentNormal bent_normal_at(SceneRef scene, MeshRef mesh, TextureViewRef view, float scale,
                                     TrianglePointRef p, vec3 edge1, vec3 edge2, vec3 normal,
                                     ConeShare cone_share) {
  BentNormal bent = {normal, 1.0f, 0.0f};
  if (view.texture < 0) return bent;
  bool mean_alone = shows_mean_alone(scene, mesh, view, p, cone_share);
  MapTexel map = map_texel_at(scene, mesh, view, p, cone_share, mean_alone);
  float length_of_mean = length(map_vector(vec3(map.texel), 1.0f));
  bent.mean_length = mix(1.0f, scaled_mean_length(length_of_mean, scale), map.averaged);
  bent.spread = 1.0f - map.texel.w;
  // Where the footprint averages over all bumps, the surface is flat
  if (mean_alone) return bent;
  vec4 tangent = tangent_at(mesh, view, p, edge1, edge2);
  bent.normal = normalize_or(normal, vec3(0.0f, 0.0f, 1.0f));
  vec3 t = orthogonal_tangent(bent.normal, vec3(tangent));
  vec3 bump = map_vector(vec3(map.texel), scale);
  if (t != vec3(0.0f)) bent.normal = mapped_normal(bent.normal, t, tangent.w, bump);
  return bent;
}

/// A surface's reflectance for light from outside, and its tint: the share of entering light that
/// is transmitted.
struct Optics {
  Reflectance reflectance;
  vec3 tint;
};

/// The layers above a surface's base and coat.
LAMBENT_FN SurfaceLayers layers_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                                   TrianglePointRef p, ConeShare cone_share) {
  vec3 sheen = material.sheen_color;
  if (material.sheen_color_texture.texture >= 0) {
    sheen *= vec3(texture_at(scene, mesh, material.sheen_color_texture, p, cone_share));
  }
  float sheen_roughness = material.sheen_roughness;
  if (material.sheen_roughness_texture.texture >= 0) {
    sheen_roughness *= texture_at(scene, mesh, material.sheen_roughness_texture, p, cone_share).w;
  }
  float clearcoat = clearcoat_at(scene, mesh, material, p, cone_share);
  float clearcoat_roughness = material.clearcoat_roughness;
  if (material.clearcoat_roughness_texture.texture >= 0) {
    clearcoat_roughness *=
        precise_texture_at(scene, mesh, material.clearcoat_roughness_texture, p, cone_share).y;
  }
  return layers_of(sheen, sheen_roughness, clearcoat, clearcoat_roughness);
}

/// The thin film on a surface; share 0: there is none.
LAMBENT_FN ThinFilm film_at(SceneRef scene, MeshRef mesh, MaterialRef material, TrianglePointRef p,
                            ConeShare cone_share) {
  ThinFilm film = {material.iridescence, material.iridescence_ior,
                   material.iridescence_thickness_max};
  if (material.iridescence_texture.texture >= 0) {
    film.share *= texture_at(scene, mesh, material.iridescence_texture, p, cone_share).x;
  }
  if (material.iridescence_thickness_texture.texture >= 0) {
    float thick =
        precise_texture_at(scene, mesh, material.iridescence_thickness_texture, p, cone_share).y;
    film.thickness_nm =
        mix(material.iridescence_thickness_min, material.iridescence_thickness_max, thick);
  }
  return film;
}

LAMBENT_FN Optics optics_at(SceneRef scene, MeshRef mesh, MaterialRef material, TrianglePointRef p,
                            ConeShare cone_share) {
  Optics optics = {lambert_reflectance(vec3(0.0f)), vec3(0.0f)};
  if (is_unlit(material)) return optics;
  vec3 base = clamp(base_color_at(scene, mesh, material, p, cone_share), 0.0f, 1.0f);
  float metallic = material.metallic;
  float roughness = material.roughness;
  bool needs_texel = !is_lambert(material) || metallic > 0.0f;
  if (needs_texel && material.metallic_roughness_texture.texture >= 0) {
    vec4 texel =
        precise_texture_at(scene, mesh, material.metallic_roughness_texture, p, cone_share);
    roughness *= texel.y;
    metallic *= texel.z;
  }
  if (is_lambert(material)) {
    optics.reflectance = lambert_reflectance(base * (1.0f - metallic));
    return optics;
  }

  float specular = material.specular;
  if (material.specular_texture.texture >= 0) {
    specular *= texture_at(scene, mesh, material.specular_texture, p, cone_share).w;
  }
  vec3 specular_color = material.specular_color;
  if (material.specular_color_texture.texture >= 0) {
    specular_color *= vec3(texture_at(scene, mesh, material.specular_color_texture, p, cone_share));
  }
  optics.reflectance =
      coated_reflectance(base, metallic, roughness, specular, specular_color, material.ior);
  if (has_layers(material)) {
    optics.reflectance.layers = layers_at(scene, mesh, material, p, cone_share);
  }
  if (is_transmissive(material)) {
    float transmission = material.transmission;
    if (material.transmission_texture.texture >= 0) {
      transmission *= texture_at(scene, mesh, material.transmission_texture, p, cone_share).x;
    }
    optics.tint = transmission * optics.reflectance.diffuse;
    optics.reflectance.diffuse *= 1.0f - transmission;
  }
  return optics;
}

/// Share of the light along a straight ray that passes a triangle of a transmissive material. Inner
/// reflection at the far side of a volume is not subtracted, as that light leaves the volume
/// elsewhere: reflection and transmission of a volume together conserve energy.
LAMBENT_FN vec3 straight_share_at(SceneRef scene, uint instance_index, uint triangle,
                                  vec2 barycentrics, bool from_front, vec3 direction_ws) {
  InstanceRef instance = fetch_instance(scene, instance_index);
  MeshRef mesh = fetch_mesh(scene, instance.mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  TrianglePoint p = triangle_point(mesh, triangle, barycentrics);
  vec3 p0 = fetch_position(mesh, p.vertices.x);
  vec3 face_normal =
      cross(fetch_position(mesh, p.vertices.y) - p0, fetch_position(mesh, p.vertices.z) - p0);
  vec3 normal_ws = normalize_or(cofactors(instance.world_from_object) * face_normal, -direction_ws);
  Optics optics = optics_at(scene, mesh, material, p, full_resolution());
  if (bounds_volume(material) && !from_front) return optics.tint;
  if (has_film(material)) {
    put_film(optics.reflectance, film_at(scene, mesh, material, p, full_resolution()),
             abs(dot(normal_ws, direction_ws)));
  }
  return straight_share(optics.tint, optics.reflectance, dot(normal_ws, direction_ws));
}

/// Whether a triangle of a transmissive material scatters or refracts the light that passes it.
LAMBENT_FN bool bends_light_at(SceneRef scene, uint instance_index, uint triangle,
                               vec2 barycentrics) {
  MeshRef mesh = fetch_mesh(scene, fetch_instance(scene, instance_index).mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  if (bounds_volume(material)) return true;
  TrianglePoint p = triangle_point(mesh, triangle, barycentrics);
  return optics_at(scene, mesh, material, p, full_resolution()).reflectance.alpha > kStraightAlpha;
}

/// A random number in [0, 1) for a ray at a triangle. It does not depend on a hit's rounding, so
/// that rays of probes, which start at the same places everywhere, are decided alike on all
/// devices.
LAMBENT_FN float uniform_of_ray(vec3 origin_ws, vec3 direction_ws, uint triangle) {
  uint salt = kGlassSalt ^ (triangle * kTriangleHashStep);
  uvec3 from = hash_pcg3d(uvec3(floatBitsToUint(origin_ws.x) ^ salt, floatBitsToUint(origin_ws.y),
                                floatBitsToUint(origin_ws.z)));
  uvec3 mixed = hash_pcg3d(uvec3(floatBitsToUint(direction_ws.x) ^ from.x,
                                 floatBitsToUint(direction_ws.y) ^ from.y,
                                 floatBitsToUint(direction_ws.z) ^ from.z));
  return uniform_from_bits(mixed.x);
}

/// Whether a ray for which crosses_glass() holds passes a triangle that transmits this share of
/// light.
LAMBENT_FN bool passes_glass(vec3 share, uint triangle, vec3 origin_ws, vec3 direction_ws) {
  return passing_probability(share) > uniform_of_ray(origin_ws, direction_ws, triangle);
}

/// How a surface transmits light to a ray that sees its front or its back.
LAMBENT_FN Transmission transmission_of(MaterialRef material, Optics optics, bool from_outside) {
  Transmission through = {optics.tint, kCrossesPane, vec3(0.0f), 1.0f, optics.reflectance.alpha};
  if (optics.tint == vec3(0.0f) || !bounds_volume(material)) return through;
  through.kind = from_outside ? kEntersVolume : kLeavesVolume;
  through.eta = from_outside ? 1.0f / material.ior : material.ior;
  if (!from_outside) through.absorption = material.absorption;
  return through;
}

/// Cross section of a footprint over the area of a triangle, given twice that area.
LAMBENT_FN ConeShare cone_share_of(Footprint footprint, float double_area) {
  ConeShare share = {share_of_triangle(footprint.width, double_area), footprint.blended};
  return share;
}

/// optics_at() of a surface that is seen at the cosine `n_dot_v`: with a coat that is rougher where
/// bumps are averaged over, and with its thin film.
LAMBENT_FN Optics seen_optics_at(SceneRef scene, MeshRef mesh, MaterialRef material,
                                 TrianglePointRef p, ConeShare cone_share, BentNormal bent,
                                 float n_dot_v) {
  Optics optics = optics_at(scene, mesh, material, p, cone_share);
  if (cone_share.blended != 0u) {
    optics.reflectance.alpha =
        widened_alpha(optics.reflectance.alpha, bent.spread * material.normal_scale);
  }
  optics.reflectance.mean_normal_length = bent.mean_length;
  if (has_film(material)) {
    put_film(optics.reflectance, film_at(scene, mesh, material, p, cone_share), n_dot_v);
  }
  return optics;
}

/// The orientation of a triangle relative to a ray.
struct FacingTriangle {
  vec3 geometric_normal_ws;  ///< Faces the ray's origin; unit.
  vec3 direction_ws;         ///< Direction of the ray; unit.
  bool along_winding;        ///< See normal_towards_viewer().
  bool from_front;           ///< See normal_towards_viewer().
};

/// The shading normal, given the normal of vertices and normal map, which is of any length.
LAMBENT_FN vec3 seen_normal(FacingTriangle seen, vec3 normal, TextureViewRef map) {
  vec3 of_front = seen.from_front ? seen.geometric_normal_ws : -seen.geometric_normal_ws;
  vec3 facing = normal_towards_viewer(normalize_or(normal, of_front), seen.along_winding,
                                      seen.from_front, seen.direction_ws, seen.geometric_normal_ws);
  if (map.texture >= 0) return facing;
  return reflecting_normal(facing, seen.direction_ws, seen.geometric_normal_ws);
}

/// The surface at a hit (not a miss) of a ray with this direction. `footprint`: that of the ray's
/// cone there; width 0 reads textures at full resolution.
LAMBENT_FN Surface surface_at(SceneRef scene, vec3 direction_ws, HitRef hit, Footprint footprint) {
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
  ConeShare cone_share = cone_share_of(footprint, length(area_normal));
  Surface surface;
  surface.position_ws = transform_point(instance.world_from_object, position);
  surface.geometric_normal_ws = normalize_or(area_normal, -direction_ws);

  // Compute the normal on the side that the winding declares the front
  vec3 normal = interpolate(fetch_normal(mesh, p.vertices.x), fetch_normal(mesh, p.vertices.y),
                            fetch_normal(mesh, p.vertices.z), p.weights);
  bool along_winding = dot(normal, face_normal) >= 0.0f;
  BentNormal bent = bent_normal_at(scene, mesh, material.normal_texture, material.normal_scale, p,
                                   edge1, edge2, normal, cone_share);

  // Turn both normals to the side that the ray came from
  bool from_front = dot(surface.geometric_normal_ws, direction_ws) <= 0.0f;
  if (!from_front) surface.geometric_normal_ws = -surface.geometric_normal_ws;
  FacingTriangle facing = {surface.geometric_normal_ws, direction_ws, along_winding, from_front};
  surface.normal_ws =
      seen_normal(facing, normal_from_object * bent.normal, material.normal_texture);

  Optics optics = seen_optics_at(scene, mesh, material, p, cone_share, bent,
                                 -dot(surface.normal_ws, direction_ws));
  surface.reflectance = optics.reflectance;
  surface.emission = emission_at(scene, mesh, material, p, cone_share);
  if (has_clearcoat(surface.reflectance.layers)) {
    BentNormal coat =
        bent_normal_at(scene, mesh, material.clearcoat_normal_texture,
                       material.clearcoat_normal_scale, p, edge1, edge2, normal, cone_share);
    vec3 coat_normal =
        seen_normal(facing, normal_from_object * coat.normal, material.clearcoat_normal_texture);
    place_clearcoat(surface.reflectance.layers, surface.normal_ws, coat_normal, direction_ws);
    surface.emission *= clearcoat_transmittance(surface.reflectance.layers,
                                                surface.reflectance.layers.clearcoat_cosine);
  }
  surface.transmission = transmission_of(material, optics, bool(hit.front_face));
  surface.material = uint(mesh.material);
  surface.gi_share =
      receives_gi(instance)
          ? horizon_share(bent.mean_length, dot(surface.normal_ws, surface.geometric_normal_ws))
          : 0.0f;
  if (surface.transmission.kind == kLeavesVolume) {
    // Rays that go on account for inner reflection; no light of the room arrives inside
    surface.reflectance = lambert_reflectance(vec3(0.0f));
    surface.gi_share = 0.0f;
  }
  return surface;
}
