// SPDX-License-Identifier: Apache-2.0
// Light emitted by points of emissive triangles, in the common subset of C++ and GLSL. Included
// after attributes.inl.h. The includer provides, in addition to what that file requires,
//   bool has_layers(MaterialRef material)

/// Emission of a point of an emissive triangle: the radiance below a clearcoat, multiplied by the
/// probability that its coverage stops rays [W/(m^2 sr)], and the share that is covered by a
/// clearcoat.
struct PointEmission {
  vec3 radiance;
  float clearcoat;
};

/// Barycentrics are those of the emitter, here and below.
LAMBENT_FN PointEmission emission_of(SceneRef scene, EmitterRecord emitter, vec2 barycentrics) {
  MeshRef mesh = fetch_mesh(scene, fetch_instance(scene, emitter.instance).mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  TrianglePoint p =
      triangle_point(mesh, emitter.triangle, barycentrics_in_triangle(emitter, barycentrics));
  PointEmission sent = {emission_at(scene, mesh, material, p, full_resolution()), 0.0f};
  if (uint(material.alpha_mode) != kAlphaOpaque) {
    sent.radiance *= stopping_probability(uint(material.alpha_mode), material.alpha_cutoff,
                                          coverage_at(scene, mesh, material, p));
  }
  if (has_layers(material)) {
    sent.clearcoat = clearcoat_at(scene, mesh, material, p, full_resolution());
  }
  return sent;
}

/// Emitted radiance along a unit direction, above the clearcoat [W/(m^2 sr)]. The clearcoat has the
/// triangle's geometric normal here, since smooth normals and normal maps hardly change the mean.
LAMBENT_FN vec3 emitted_radiance(SceneRef scene, EmitterRecord emitter, vec2 barycentrics,
                                 vec3 direction_ws) {
  PointEmission sent = emission_of(scene, emitter, barycentrics);
  if (sent.clearcoat <= 0.0f) return sent.radiance;
  vec3 normal_ws = triangle_normal(emitter.edge1_ws, emitter.edge2_ws);
  return sent.radiance * clearcoat_transmittance(sent.clearcoat, abs(dot(normal_ws, direction_ws)));
}
