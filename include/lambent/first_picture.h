// SPDX-License-Identifier: Apache-2.0
// Chooses a camera and lights for the first picture of a scene that has none.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lambent/error.h"
#include "lambent/scene.h"

namespace lambent {

class World;
struct FieldGrid;

struct FirstViewSettings {
  /// Full vertical angle of the view [rad], 0 to pi; none: 45 degrees for objects, 60 for rooms,
  /// streets and sites.
  std::optional<float> vertical_fov;
  float aspect = 16.0f / 9.0f;  ///< Width over height of the picture, > 0.
};

/// A camera that shows a scene.
struct FirstView {
  Camera camera;
  /// The camera is in a room, in a street or on the ground of a site; else it shows all from
  /// outside.
  bool inside = false;
  float distance = 1.0f;  ///< Median distance to what the middle of the picture shows, > 0 [m].
};

/// Finds a camera by what it would show: a three-quarter view of the whole object from outside, or,
/// where the scene is a shell around most of its contents, a view at eye height in its open space,
/// or, on a wide ground, one of what stands there (docs/cli.md has the rules). Traces 20,000 to
/// 500,000 rays. The same world gives the same view. Fails on settings out of range.
Expected<FirstView> first_view(const World& world, const FirstViewSettings& settings = {});

/// Poses of an animated scene, which a sequence shows from one camera.
struct Poses {
  int count = 1;  ///< >= 1.
  /// Poses the scene (see lambent/animation.h) and updates its world, for an index below `count`;
  /// not called for a single pose, which is the one that the scene is in.
  std::function<Expected<void>(int)> take;
};

/// As first_view(), for a sequence: a view from outside is chosen by what it shows in all poses,
/// and has the object in its frame in each of them. Whether it is one, and views from inside, are
/// chosen in pose 0, which the world must be in, and is in afterwards. Traces 13,000 rays more for
/// each pose. Fails where a pose cannot be taken, too.
Expected<FirstView> first_view(const World& world, const FirstViewSettings& settings,
                               const Poses& poses);

/// Whether a picture of this aspect, width over height, shows any surface: by a grid of rays, 128
/// of them along each row.
bool sees_a_surface(const World& world, const Camera& camera, float aspect);

/// Light for scenes that have none.
enum class FirstLight : std::uint8_t {
  scene,   ///< The scene's own light.
  sky,     ///< The scene's lights under a sky in proportion to its suns, black if it has none.
  studio,  ///< Soft boxes as key, fill and rim, in a neutral surrounding: for objects.
  sun,     ///< Sun and sky: for open scenes.
  lamps,   ///< Lamps below the ceiling: for closed rooms.
};

/// "scene", "sky", "studio", "sun" or "lamps".
std::string_view name_of(FirstLight light);

/// Chooses the light for a camera's view: the scene's, where it has lights or a sky or where its
/// emissive surfaces light what the camera sees; otherwise one that suits the camera's
/// surroundings. Suns without a sky get one where it would be seen or felt: outdoors, over courts,
/// and in rooms with openings. Traces some 10,000 rays.
FirstLight choose_first_light(const World& world, const Camera& camera);

/// Replaces the scene's lights and environment by those of `light`, set up for the camera's view;
/// emissive surfaces are not changed, FirstLight::sky replaces the environment alone, and
/// FirstLight::scene changes nothing. `scene` is the world's scene; call World::update afterwards.
void set_first_light(FirstLight light, const World& world, const Camera& camera, Scene& scene);

/// Replaces the scene's environment, with any map, by the sky of FirstLight::sky: blue above and
/// hazy at the horizon, the same all around, and in proportion to the scene's suns as they are now;
/// black without suns. Raises its revision, but changes nothing where it is this sky already. Call
/// World::update afterwards.
void adjust_first_sky(Scene& scene);

/// Removes the sky that a scene brings as a mesh: a dome or a box of emissive or unlit triangles
/// that is far around most of the rest, or 100 m from its middle. As a surface, it would take
/// nearly all samples of emitters from lamps indoors, stop the light of suns, and stretch the
/// field's grid. Returns the dome as a scene of its own with the same lights, for sky_of_dome; none
/// where there is no such mesh, where it moves or does not cover the sky, or where all else is
/// unlit. Its instance stays, with an empty mesh. Looks at all vertices where any surface emits,
/// and copies the dome's texture.
std::optional<Scene> take_sky_dome(Scene& scene);

/// A dome's radiance in all directions as seen from `eye_ws`, as a latitude-longitude map with as
/// many columns as its texture, 256 to 4,096; black where there is no dome. What is unlit emits its
/// colours [W/(m^2 sr)], or in the light of suns so much more that white is as bright as a clear
/// sky beside them. Traces a ray for each texel, up to 8.4 million. `eye_ws` [m].
Environment sky_of_dome(const Scene& dome, const glm::vec3& eye_ws);

/// Adds the sun of FirstLight::sun, set up for the camera's view, to a scene under a painted sky,
/// such as that of sky_of_dome, and makes this sky as bright as the one of FirstLight::sun. Returns
/// whether it did: where the scene has a map as its sky and no lights, where the map shows a clear
/// day, blue and nowhere brighter than white, as a sun would be, and where emissive surfaces do not
/// light the view. `scene` is the world's scene; call World::update afterwards. Traces some 10,000
/// rays.
bool add_sun_to_sky(const World& world, const Camera& camera, Scene& scene);

/// The box that surrounds a camera, where a grid is too coarse for it, since the scene is larger
/// than the room or the yard in which the camera stands: around the surfaces about it, or around
/// the nearer part of what it sees from the open, a house in its grounds. None where the grid has
/// cells enough, where the camera sees far into the open and where it is orthographic. `grid`: that
/// of the field, as fit_grid() makes it. Traces some 1,000 rays.
std::optional<Bounds> near_box(const World& world, const Camera& camera, const FieldGrid& grid);

/// Volumes of about 4,096 probes each for fields whose grid is too coarse for a camera: one in its
/// near_box(), and larger ones around that, each with a spacing of about 2.5 times that of the one
/// before, up to the grid's. Finest first; none where they would be less than twice as fine, or
/// outside of the grid.
std::vector<ProbeVolume> near_volumes(const World& world, const Camera& camera,
                                      const FieldGrid& grid);

/// near_volumes() for a camera that travels, from its near_box() at places along its path [m], in
/// order, none of them empty. The finest volume holds all of them, and has up to four times as many
/// probes. Where these would be less than twice as fine as the grid, as along a road, the volumes
/// are those of the first box alone. None for no boxes, and where the grid has none of them.
std::vector<ProbeVolume> near_volumes(std::span<const Bounds> boxes, const FieldGrid& grid);

}  // namespace lambent
