// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <string>
#include <vector>

#include "lambent/animation.h"
#include "lambent/error.h"
#include "lambent/fog.h"
#include "lambent/image.h"

namespace lambent {

/// One MIP level of a texture: 8-bit RGBA, rows from the top.
struct TextureLevel {
  int width = 0;                   ///< Texels, >= 1.
  int height = 0;                  ///< Texels, >= 1.
  std::vector<std::uint8_t> rgba;  ///< width * height * 4 bytes.
};

/// An 8-bit RGBA texture with a full MIP chain. Alpha is always linear.
struct Texture {
  std::string name;   ///< For display, as all names here; need not be unique, may be empty.
  bool srgb = false;  ///< Red, green and blue are sRGB-encoded (colour), not linear (data).
  std::vector<TextureLevel> levels;  ///< Full size first, then halves down to 1x1. Never empty.
  std::uint32_t revision = 0;        ///< Raise it after an edit: World::update compares this alone.
};

/// How texels count in the means of coarser MIP levels: all alike, or by their alpha, in textures
/// of materials that are cut out or blended, where what is not covered may have any colour.
enum class MipWeights : std::uint8_t { equal, alpha };

/// Fills `texture.levels` below the first by box-filtering in linear light. Alpha itself is always
/// the plain mean. Throws std::invalid_argument where the first level lacks texels.
void build_mips(Texture& texture, MipWeights weights = MipWeights::equal);
/// The same for a normal map, whose texels are not sRGB-encoded, of any length and, as usual,
/// interpolated where they are seen. The vectors of MIPs are means of unit normals; surfaces that
/// show shorter ones receive less light. Overwrites alpha: with 1 at the first level, and below
/// with 1 minus the standard deviation, 0 to 1, of the slopes of a texel's normals along each axis,
/// leaving out nearly half of them if these are steeper than the rest. Coats are rougher by it in
/// views that average over normals: flat tiles stay flat between steep joints. Alpha is read so at
/// every level; where it is 1, coats are no rougher. Throws std::invalid_argument as build_mips
/// does, and where the texels are sRGB-encoded.
void build_normal_mips(Texture& texture);

/// How a texture continues beyond its edges.
enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };

/// How a material reads a texture.
struct TextureView {
  int texture = -1;            ///< Index into Scene::textures; -1: none, only the factor applies.
  int uv_set = 0;              ///< Index of the mesh's texture coordinate set: 0 or 1.
  Wrap wrap_u = Wrap::repeat;  ///< Beyond the left and right edges.
  Wrap wrap_v = Wrap::repeat;  ///< Beyond the top and bottom edges.
  bool nearest = false;        ///< Point sampling instead of bilinear filtering.
  glm::vec2 uv_offset{0.0f};   ///< Added last (KHR_texture_transform) [textures].
  float uv_rotation = 0.0f;    ///< Counter-clockwise about the origin [rad].
  glm::vec2 uv_scale{1.0f};    ///< Applied to texture coordinates first.

  bool operator==(const TextureView&) const = default;
};

/// How coverage affects rays: `opaque` surfaces stop all of them, `mask` stops those where coverage
/// reaches Material::alpha_cutoff, and `blend` stops a share of them equal to the coverage. The two
/// latter cost a texture lookup at every surface that a ray passes.
enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// A glTF metallic-roughness material. Factors multiply the values of textures.
struct Material {
  std::string name;
  glm::vec4 base_color{1.0f};  ///< Linear reflectance and coverage, each 0 to 1.
  float metallic = 1.0f;       ///< 0 (dielectric) to 1 (metal).
  float roughness = 1.0f;      ///< Perceptual roughness, 0 to 1; GGX alpha is its square.
  glm::vec3 emission{0.0f};    ///< Radiance emitted by both sides [W/(m^2 sr)], 0 to 1e10.
  float normal_scale = 1.0f;   ///< Factor on the normal map's tilt, -1e6 to 1e6.
  float ior = 1.5f;            ///< Index of refraction, 1 to 1e6 (KHR_materials_ior).
  float specular = 1.0f;  ///< Strength of dielectric reflection, 0 to 1 (KHR_materials_specular).
  glm::vec3 specular_color{1.0f};  ///< Tint of dielectric F0, 0 to 1e6.
  /// Share of the light entering a dielectric that is transmitted, tinted by base_color, instead of
  /// being reflected diffusely; 0 to 1 (KHR_materials_transmission).
  float transmission = 0.0f;
  /// The surface bounds a volume, which refracts by `ior`: the mesh must be closed, with triangles
  /// that run counter-clockwise as seen from outside. Else it is a thin pane, which light crosses
  /// straight (KHR_materials_volume).
  bool bounds_volume = false;
  /// Absorption coefficient a of that volume [1/m], 0 to 1e6: transmittance is e^(-a d) over d.
  glm::vec3 absorption{0.0f};
  /// Share of the surface that is covered by a clearcoat of index of refraction 1.5, 0 to 1
  /// (KHR_materials_clearcoat). Pixels that show one cost a second reflection ray.
  float clearcoat = 0.0f;
  float clearcoat_roughness = 0.0f;     ///< Perceptual roughness, 0 to 1.
  float clearcoat_normal_scale = 1.0f;  ///< As normal_scale, for clearcoat_normal_texture.
  glm::vec3 sheen_color{0.0f};          ///< Colour of the sheen, 0 to 1 (KHR_materials_sheen).
  float sheen_roughness = 0.0f;         ///< Perceptual, 0 to 1; lower: closer to silhouettes.
  /// Share of the surface that a thin film covers, whose colours are those of interference, 0 to 1
  /// (KHR_materials_iridescence).
  float iridescence = 0.0f;
  float iridescence_ior = 1.3f;  ///< Index of refraction of the film, 1 to 1e6.
  /// Thickness of the film where its texture is 0, and where that is 1 or absent [nm], 0 to 1e6.
  float iridescence_thickness_min = 100.0f, iridescence_thickness_max = 400.0f;
  AlphaMode alpha_mode = AlphaMode::opaque;  ///< What base_color.a does.
  float alpha_cutoff = 0.5f;  ///< Coverage below which AlphaMode::mask lets rays through.
  /// A probe ray that hits the back of a single-sided surface returns no light.
  bool double_sided = false;
  bool unlit = false;    ///< base_color is emitted radiance; nothing is reflected.
  bool lambert = false;  ///< Exact Lambert of albedo base_color * (1 - metallic); nothing specular.

  TextureView base_color_texture;           ///< RGBA, sRGB.
  TextureView metallic_roughness_texture;   ///< G roughness, B metallic.
  TextureView normal_texture;               ///< Tangent space, +Y up; see build_normal_mips().
  TextureView emission_texture;             ///< RGB, sRGB.
  TextureView specular_texture;             ///< A strength.
  TextureView specular_color_texture;       ///< RGB, sRGB.
  TextureView transmission_texture;         ///< R transmission.
  TextureView clearcoat_texture;            ///< R clearcoat.
  TextureView clearcoat_roughness_texture;  ///< G clearcoat roughness.
  TextureView clearcoat_normal_texture;     ///< Tangent space, +Y up; none: the mesh's own normals.
  TextureView sheen_color_texture;          ///< RGB, sRGB.
  TextureView sheen_roughness_texture;      ///< A sheen roughness.
  TextureView iridescence_texture;          ///< R share that the film covers.
  /// G thickness of the film, from its minimum to its maximum.
  TextureView iridescence_thickness_texture;

  bool operator==(const Material&) const = default;
};

/// Triangles of one material in object space. Every non-empty attribute has one entry a vertex.
struct Mesh {
  std::string name;
  std::vector<glm::vec3> positions;  ///< [m], each coordinate within 1e9.
  std::vector<glm::vec3> normals;    ///< Unit length; never empty after loading.
  /// xyz has unit length, w is +1 or -1 (bitangent = w * cross(n, t)); may be empty.
  std::vector<glm::vec4> tangents;
  /// Texture coordinate sets; each may be empty. Coordinates are within 1e8.
  std::array<std::vector<glm::vec2>, 2> uvs;
  std::vector<glm::vec4> colors;      ///< Linear, multiplied with base_color, 0 to 1e6; or empty.
  std::vector<glm::uvec3> triangles;  ///< Vertex indices, each < positions.size().
  int material = 0;                   ///< Index into Scene::materials.
  /// Raise it after an edit of vertices or triangles: World::update compares this alone.
  std::uint32_t revision = 0;
};

/// A mesh placed in the world. Meshes are shared, not copied.
struct Instance {
  std::string name;
  int mesh = 0;  ///< Index into Scene::meshes.
  /// Affine and invertible; may mirror. Scales by at most 1e10, and places the mesh within 1e9 m of
  /// the origin along each axis.
  glm::mat4 world_from_object{1.0f};
  // The following three flags affect the light of fields, maps and frames, but not the reference
  // path tracer.

  /// Its surfaces bounce light and block indirect light. false: rays that gather indirect light
  /// pass through it, but the camera sees it and it casts shadows of lights.
  bool casts_gi = true;
  bool receives_gi = true;  ///< Indirect light reaches its surfaces; false: direct light alone.
  /// Probe rays pass through it, but other rays that gather indirect light do not: for small moving
  /// objects, and for objects that enclose a probe.
  bool ignored_by_probes = false;
  /// It is expected to move: it gets an acceleration structure of its own from the start, which
  /// makes moving it cheap and rays slightly more expensive, and probes near it stay awake. An
  /// instance that moves without this flag costs one full rebuild, once.
  bool dynamic = false;
};

/// Directional, point or spot light without extent.
struct Light {
  enum class Type : std::uint8_t { directional, point, spot };
  std::string name;
  Type type = Type::point;  ///< Each light costs a shadow ray per shaded point.
  /// Directional: irradiance on a perpendicular surface [W/m^2], 0 to 1e10. Else radiant intensity
  /// [W/sr], 0 to 1e12; its irradiance must nowhere exceed 1e10 W/m^2.
  glm::vec3 intensity{1.0f};
  glm::vec3 position_ws{0.0f};  ///< Point and spot [m], each coordinate within 1e9.
  /// The direction in which the light travels; unit. Directional and spot.
  glm::vec3 direction_ws{0.0f, 0.0f, -1.0f};
  /// Distance at which KHR_lights_punctual's window reaches 0 [m]; 0: infinite.
  float range = 0.0f;
  float inner_cone_angle = 0.0f;  ///< Full intensity within [rad, from the axis].
  float outer_cone_angle =
      0.785398163f;  ///< No light beyond [rad, from the axis], inner cone to pi/2; 45 degrees.

  bool operator==(const Light&) const = default;
};

/// A pinhole camera, perspective or orthographic.
struct Camera {
  std::string name;
  /// Looks along its -Z, +Y up. No scale; located within 1e12 m of the origin along each axis.
  glm::mat4 world_from_view{1.0f};
  bool orthographic = false;  ///< Parallel rays.
  /// Full angle [rad], 0.001 to pi - 0.001, perspective only; 45 degrees.
  float vertical_fov = 0.785398163f;
  float vertical_extent = 1.0f;  ///< Full height of the view [m], 1e-6 to 2e9, orthographic only.
  /// Width over height that the file specifies, 1/16384 to 16384; 0: that of the image.
  float aspect = 0.0f;
};

/// A camera at `eye` that looks at `target` with +Y up (-Z where it looks straight up or down;
/// along -Z where both are one point). `vertical_fov` in radians.
Camera look_at(const glm::vec3& eye, const glm::vec3& target, float vertical_fov);

/// The light from infinity.
struct Environment {
  /// Constant sky [W/(m^2 sr)]; multiplies `map` where there is one. Factor, map and their product
  /// are within 0 to 1e10.
  glm::vec3 radiance{0.0f};
  Image map;  ///< Latitude-longitude radiance, 3 channels, +Y at the top row; empty: constant.
  float rotation = 0.0f;       ///< Of the map about +Y [rad].
  std::uint32_t revision = 0;  ///< Raise it after an edit of the map: World::update looks here.
};

/// An oriented box to be filled with probes, in which light has a finer resolution.
struct ProbeVolume {
  std::string name;            ///< For display and error messages; may be empty.
  glm::vec3 centre{0.0f};      ///< [m]
  glm::vec3 size{1.0f};        ///< Extent along its axes [m], >= 0.
  glm::mat3 axes{1.0f};        ///< Columns: its axes in world space, a rotation.
  glm::ivec3 probe_count{0};   ///< Along its axes, each >= 2; or all 0: from the spacing.
  float probe_spacing = 0.0f;  ///< [m], > 0; 0: chosen for about 512 probes.
  int priority = 0;            ///< Of overlapping volumes, the highest is used first.
};

/// What else a file contains besides the loaded scene; for `lambent info` and for display.
struct SceneSource {
  std::string path;                     ///< As given to load_scene; empty for scenes made by hand.
  std::string generator;                ///< As the file names it; may be empty.
  std::vector<std::string> extensions;  ///< Used by the file, supported or not.
  /// One sentence each: what was ignored or repaired, and where.
  std::vector<std::string> warnings;
  /// Where the scene's origin is in the file's coordinates [m]. Scenes far from the file's origin
  /// are moved to an origin of their own, since 32-bit coordinates are coarse there. Everything in
  /// the scene, including animations, is in the moved coordinates.
  glm::dvec3 origin{0.0};
  /// Numbers of these in the whole file, not only in the scene that was loaded.
  int nodes = 0, animations = 0, skins = 0, morph_targets = 0, scenes = 0;
};

/// Everything that a frame is computed from. Plain data: fill it by hand or with load_scene.
struct Scene {
  std::vector<Texture> textures;    ///< Read by materials.
  std::vector<Material> materials;  ///< Used by meshes.
  std::vector<Mesh> meshes;         ///< Visible only through instances.
  std::vector<Instance> instances;
  std::vector<Light> lights;    ///< Emissive surfaces are lights too, but not in this list.
  std::vector<Camera> cameras;  ///< In the order of the file's nodes.
  Environment environment;
  std::vector<Animation> animations;  ///< The scene is in its rest pose until `animate`.
  Rig rig;                            ///< What animations move.
  std::vector<ProbeVolume> volumes;   ///< Where the author wants finer light; for FieldSettings.
  std::vector<FogVolume> fog;         ///< At most kMaxFogVolumes. Edits affect the next frame.
  SceneSource source;                 ///< Not used for rendering.
};

/// How load_scene reads a file.
struct LoadOptions {
  int scene = -1;           ///< Index of the glTF scene; -1: the file's default, else the first.
  bool lambert = false;     ///< Reduce every material to exact Lambert (Material::lambert).
  bool normal_maps = true;  ///< false: drop normal maps, and with them tangents.
};

/// Reads .gltf or .glb. Errors name the file, the place in it and the cause; Scene::source.warnings
/// lists what was repaired or ignored.
Expected<Scene> load_scene(const std::string& path, const LoadOptions& options = {});

/// Reads a latitude-longitude environment, .hdr or .exr, into an Environment of unit factor.
Expected<Environment> load_environment(const std::string& path);

/// Checks what every pass relies on (indices and numbers in range, shapes that agree).
/// load_scene calls it; call it on scenes made by hand. Fails with the first thing wrong.
Expected<void> validate(const Scene& scene);

/// Axis-aligned box [m]; empty when min > max.
struct Bounds {
  glm::vec3 min{std::numeric_limits<float>::max()};
  glm::vec3 max{std::numeric_limits<float>::lowest()};
  /// Whether nothing was added.
  bool empty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  /// Grows the box until it holds `p`.
  void add(const glm::vec3& p) {
    min = glm::min(min, p);
    max = glm::max(max, p);
  }
  /// Grows the box until it holds `box`; an empty one adds nothing.
  void add(const Bounds& box) {
    min = glm::min(min, box.min);
    max = glm::max(max, box.max);
  }
  bool operator==(const Bounds&) const = default;
};

/// World-space bounds of the vertices of one of the scene's instances [m]; looks at all of them.
Bounds instance_bounds(const Scene& scene, const Instance& instance);

/// World-space bounds of all instances' vertices.
Bounds world_bounds(const Scene& scene);

/// Triangles over all instances (a shared mesh counts once per instance).
std::size_t triangle_count(const Scene& scene);

}  // namespace lambent
