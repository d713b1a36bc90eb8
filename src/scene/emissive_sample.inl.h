// SPDX-License-Identifier: Apache-2.0
// What points of emissive triangles send, in the common subset of C++ and GLSL. Included after
// attributes.inl.h.

/// What a point of an emissive triangle sends, as far as its coverage stops rays
/// [W/(m^2 sr)].
LAMBENT_FN vec3 emitted_radiance(SceneRef scene, EmitterRecord emitter, vec2 barycentrics) {
  MeshRef mesh = fetch_mesh(scene, fetch_instance(scene, emitter.instance).mesh);
  MaterialRef material = fetch_material(scene, mesh.material);
  TrianglePoint p = triangle_point(mesh, emitter.triangle, barycentrics);
  vec3 radiance = emission_at(scene, mesh, material, p, full_resolution());
  if (uint(material.alpha_mode) != kAlphaOpaque) {
    radiance *= stopping_probability(uint(material.alpha_mode), material.alpha_cutoff,
                                     coverage_at(scene, mesh, material, p));
  }
  return radiance;
}
