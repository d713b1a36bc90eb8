// SPDX-License-Identifier: Apache-2.0
#include "first_picture/subject.h"

#include <algorithm>

#include "raytracing/boxes.h"
#include "raytracing/trace_rays.h"

namespace lambent {
namespace {

// A ground or another backdrop dwarfs the rest where the rest spans less than this share of it; and
// a sky, which encloses the rest, where it spans less than this share. Rooms seldom do.
constexpr float kDwarfedByGround = 0.3f, kDwarfedBySky = 0.1f;
// Greatest thickness of a ground or a wall, as a share of its width.
constexpr float kThinShare = 0.05f;
// Things are sunk into the ground below them by at most the first share of the ground's diagonal,
// or the second share of their own height: posts, roots and what was put down carelessly.
constexpr float kSunkShare = 0.02f, kMaxSunkHeight = 0.5f;
// Number of rays from above the rest, half of which go up, and the largest share of these that end
// at a backdrop: the sweep of a photographer's studio is behind and below what stands on it,
// whereas walls and skies are around it.
constexpr int kRaysAround = 128;
constexpr float kMaxBackdrop = 0.5f;
// Panels of light have at most as many triangles as a box.
constexpr std::size_t kMaxPanelTriangles = 12;
// Housings of panels of light are at most this far from them, and between these sizes, as shares of
// the panel's diagonal: a bottle that stands on a panel is smaller.
constexpr float kMaxHousingDistance = 0.25f, kMinHousing = 0.6f, kMaxHousing = 1.6f;
// A studio has no more panels of light than this. Towns have thousands, and no housings are sought.
constexpr std::size_t kMaxStudioPanels = 64;
// Strays are at least this many diagonals of the rest, and of each of them, away from the rest: in
// a picture of all, there would be specks alone.
constexpr float kStrayDistance = 10.0f;
// Strays, and things that stand apart from a room, have fewer triangles than this share of all.
constexpr double kMaxStrayShare = 0.5;

/// Whether a box is flat along an axis.
bool is_flat(const Bounds& box, int axis) {
  const glm::vec3 size = box.max - box.min;
  return size[axis] <= kThinShare * std::max(size[(axis + 1) % 3], size[(axis + 2) % 3]);
}

/// Whether a box reaches as far as `rest`, or farther, along an axis. `rest` may be sunk into it.
bool spans(const Bounds& box, const Bounds& rest, int axis) {
  const float height = rest.max.y - rest.min.y;
  const float sunk =
      axis == 1 ? std::max(kSunkShare * diagonal(box), kMaxSunkHeight * height) : 0.0f;
  return box.min[axis] - sunk <= rest.min[axis] && box.max[axis] >= rest.max[axis];
}

/// Whether a box stands upright and flat beside `rest`, and behind all of it.
bool is_wall_beside(const Bounds& box, const Bounds& rest) {
  for (const int axis : {0, 2}) {
    if (!is_flat(box, axis) || !spans(box, rest, 1) || !spans(box, rest, 2 - axis)) continue;
    if (rest.min[axis] >= box.min[axis] || rest.max[axis] <= box.max[axis]) return true;
  }
  return false;
}

bool encloses(const Bounds& box, const Bounds& rest) {
  return spans(box, rest, 0) && spans(box, rest, 1) && spans(box, rest, 2);
}

/// Whether most of the space above `rest` is free of the instances `backdrop`.
bool is_open_above(const World& world, const Bounds& rest,
                   std::span<const std::uint32_t> backdrop) {
  glm::vec3 place = 0.5f * (rest.min + rest.max);
  place.y = rest.max.y + kSunkShare * diagonal(rest);
  std::vector<Ray> rays;
  for (const Ray& ray : rays_around(place, kRaysAround)) {
    if (ray.direction.y > 0.0f) rays.push_back(ray);
  }
  const std::vector<Hit> hits = trace(world, rays);
  const auto met = std::count_if(hits.begin(), hits.end(), [&](const Hit& hit) {
    return !hit.missed() &&
           std::find(backdrop.begin(), backdrop.end(), hit.instance) != backdrop.end();
  });
  return static_cast<float>(met) <= kMaxBackdrop * static_cast<float>(rays.size());
}

/// Among the `kept` smallest parts, the number of the largest ones that are grounds, skies and
/// other backdrops and dwarf the rest; 0: there are none. `around[i]` contains the parts order[0]
/// to order[i].
std::size_t count_dwarfing(const World& world, std::span<const Bounds> boxes,
                           std::span<const std::uint32_t> order, std::span<const Bounds> around,
                           std::size_t kept) {
  bool grounds = true, skies = true, has_ground_or_shell = false;
  for (std::size_t left = kept; left-- > 1;) {
    const Bounds& rest = around[left - 1];
    const Bounds& largest = boxes[order[left]];
    const bool ground = is_flat(largest, 1);
    const bool around_rest = encloses(largest, rest);
    if (!ground && !around_rest && !is_wall_beside(largest, rest)) return 0;
    grounds = grounds && ground;
    has_ground_or_shell = has_ground_or_shell || ground || around_rest;
    skies = skies && (ground || around_rest);
    const float share = diagonal(rest) / diagonal(around[kept - 1]);
    if (!(share > 0.0f)) return 0;
    if (skies && share < kDwarfedBySky) return kept - left;
    if (share >= kDwarfedByGround || !has_ground_or_shell) continue;
    if (grounds || is_open_above(world, rest, order.subspan(left, kept - left))) return kept - left;
  }
  return 0;
}

/// Removes grounds, skies and other backdrops from `members`, and adds their boxes to `site`.
void drop_backdrops(const World& world, std::span<const Bounds> boxes,
                    std::vector<std::uint32_t>& members, Bounds& site) {
  std::stable_sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return diagonal(boxes[a]) < diagonal(boxes[b]);
  });
  // Compute boxes around the smallest instances, one more at a time
  std::vector<Bounds> around(members.size());
  Bounds sum;
  for (std::size_t i = 0; i < members.size(); ++i) {
    sum.add(boxes[members[i]]);
    around[i] = sum;
  }
  std::size_t kept = members.size();
  while (const std::size_t dwarfing = count_dwarfing(world, boxes, members, around, kept)) {
    kept -= dwarfing;
  }
  for (std::size_t i = kept; i < members.size(); ++i) site.add(boxes[members[i]]);
  members.resize(kept);
}

double triangles_of(const Scene& scene, std::uint32_t instance) {
  return static_cast<double>(scene.meshes[scene.instances[instance].mesh].triangles.size());
}

double triangles_of(const Scene& scene, std::span<const std::uint32_t> instances) {
  double sum = 0.0;
  for (const std::uint32_t i : instances) sum += triangles_of(scene, i);
  return sum;
}

/// The median of `value` over instances, each counting once for each of its triangles. Sorts them.
template <class Value>
float median_over_triangles(const Scene& scene, std::vector<std::uint32_t>& members,
                            const Value& value) {
  std::stable_sort(members.begin(), members.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return value(a) < value(b); });
  const double total = triangles_of(scene, members);
  double sum = 0.0;
  for (const std::uint32_t i : members) {
    sum += triangles_of(scene, i);
    if (sum >= 0.5 * total) return value(i);
  }
  return 0.0f;
}

/// Distance between two boxes [m]; 0 where they overlap.
float distance_between(const Bounds& a, const Bounds& b) {
  return glm::length(glm::max(glm::max(a.min - b.max, b.min - a.max), glm::vec3(0.0f)));
}

/// Removes strays from `members`: in the order of distance from the middle, all that comes after a
/// wide gap.
void drop_strays(const Scene& scene, std::span<const Bounds> boxes,
                 std::vector<std::uint32_t>& members) {
  const double total = triangles_of(scene, members);
  const glm::vec3 middle = find_middle(scene, boxes, members).position_ws;
  const Bounds point{middle, middle};
  std::stable_sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return distance_between(boxes[a], point) < distance_between(boxes[b], point);
  });
  std::vector<float> largest_left(members.size(), 0.0f);
  float largest = 0.0f;
  for (std::size_t i = members.size(); i-- > 0;) {
    largest = std::max(largest, diagonal(boxes[members[i]]));
    largest_left[i] = largest;
  }
  Bounds rest;
  double inside = 0.0;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Bounds& next = boxes[members[i]];
    const float gap = i > 0 ? distance_between(rest, next) : 0.0f;
    if (gap > kStrayDistance * std::max(diagonal(rest), largest_left[i]) &&
        total - inside < kMaxStrayShare * total) {
      members.resize(i);
      return;
    }
    rest.add(next);
    inside += triangles_of(scene, members[i]);
  }
}

/// Whether an instance is a simple shape that emits light.
bool is_panel_of_light(const Scene& scene, std::uint32_t instance) {
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  return mesh.triangles.size() <= kMaxPanelTriangles &&
         scene.materials[mesh.material].emission != glm::vec3(0.0f);
}

/// Removes panels of light, and what they are mounted in.
void drop_lights(const Scene& scene, std::span<const Bounds> boxes,
                 std::vector<std::uint32_t>& members) {
  std::vector<Bounds> panels;
  std::erase_if(members, [&](std::uint32_t i) {
    if (!is_panel_of_light(scene, i)) return false;
    panels.push_back(boxes[i]);
    return true;
  });
  if (panels.size() > kMaxStudioPanels) return;
  std::erase_if(members, [&](std::uint32_t i) {
    const float size = diagonal(boxes[i]);
    return std::any_of(panels.begin(), panels.end(), [&](const Bounds& panel) {
      const float panel_size = diagonal(panel);
      return size >= kMinHousing * panel_size && size <= kMaxHousing * panel_size &&
             distance_between(boxes[i], panel) <= kMaxHousingDistance * panel_size;
    });
  });
}

/// The subject among the instances `members`.
Subject find_subject_among(const World& world, std::span<const Bounds> boxes,
                           std::vector<std::uint32_t> members) {
  Subject subject;
  // Repeat both: once strays are gone, a ground may dwarf the rest, and once a sky is gone that
  // encloses everything, there may be a gap between the rest and strays
  std::size_t before = 0;
  while (before != members.size()) {
    before = members.size();
    drop_strays(world.scene(), boxes, members);
    drop_backdrops(world, boxes, members, subject.site);
  }
  for (const std::uint32_t i : members) subject.bounds.add(boxes[i]);
  if (!members.empty()) subject.site.add(subject.bounds);
  subject.instances = std::move(members);
  return subject;
}

/// The bounds of all instances; empty where one has no surface.
std::vector<Bounds> instance_boxes(const World& world) {
  std::vector<Bounds> boxes(world.scene().instances.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = world.instance_bounds(static_cast<int>(i));
  }
  return boxes;
}

/// The instances that have a surface.
std::vector<std::uint32_t> visible_instances(std::span<const Bounds> boxes) {
  std::vector<std::uint32_t> instances;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].empty()) instances.push_back(i);
  }
  return instances;
}

/// The subject among the instances `all`, with panels of light or without.
Subject find_subject_in_light(const World& world, std::span<const Bounds> boxes,
                              const std::vector<std::uint32_t>& all) {
  Subject subject = find_subject_among(world, boxes, all);
  std::vector<std::uint32_t> others = all;
  drop_lights(world.scene(), boxes, others);
  if (others.size() == all.size()) return subject;
  // Panels of light that keep a backdrop from being found hang around what stands before it
  const std::size_t dropped = all.size() - subject.instances.size();
  const std::size_t count_without = others.size();
  Subject without = find_subject_among(world, boxes, std::move(others));
  const bool any = !without.instances.empty();
  if (any && count_without - without.instances.size() > dropped) {
    subject.instances = std::move(without.instances);
    subject.bounds = without.bounds;
  }
  return subject;
}

}  // namespace

std::optional<Subject> without_things_apart(const World& world, const Subject& subject) {
  const std::vector<Bounds> boxes = instance_boxes(world);
  Subject near = subject;
  std::vector<std::uint32_t>& members = near.instances;
  std::stable_sort(members.begin(), members.end(), [&](std::uint32_t a, std::uint32_t b) {
    return diagonal(boxes[a]) < diagonal(boxes[b]);
  });
  while (members.size() > 1) {
    Bounds rest;
    for (std::size_t i = 0; i + 1 < members.size(); ++i) rest.add(boxes[members[i]]);
    const Bounds& largest = boxes[members.back()];
    if (diagonal(largest) <= diagonal(rest) || distance_between(rest, largest) <= 0.0f) break;
    members.pop_back();
    near.bounds = rest;
  }
  const Scene& scene = world.scene();
  const double least = (1.0 - kMaxStrayShare) * triangles_of(scene, subject.instances);
  if (members.size() == subject.instances.size() || triangles_of(scene, members) < least) {
    return std::nullopt;
  }
  return near;
}

Middle find_middle(const Scene& scene, std::span<const Bounds> boxes,
                   std::vector<std::uint32_t> instances) {
  const auto centre = [&](std::uint32_t i) { return 0.5f * boxes[i].min + 0.5f * boxes[i].max; };
  Middle middle;
  for (int axis = 0; axis < 3; ++axis) {
    middle.position_ws[axis] =
        median_over_triangles(scene, instances, [&](std::uint32_t i) { return centre(i)[axis]; });
  }
  middle.reach = median_over_triangles(scene, instances, [&](std::uint32_t i) {
    return glm::distance(centre(i), middle.position_ws) + 0.5f * diagonal(boxes[i]);
  });
  return middle;
}

Subject find_subject(const World& world) {
  const std::vector<Bounds> boxes = instance_boxes(world);
  return find_subject_in_light(world, boxes, visible_instances(boxes));
}

Subject find_subject_near(const World& world, const glm::vec3& viewer_ws) {
  const std::vector<Bounds> boxes = instance_boxes(world);
  std::vector<std::uint32_t> left = visible_instances(boxes);
  const Subject first = find_subject_in_light(world, boxes, left);
  Subject subject = first;
  while (!left.empty()) {
    if (contains(subject.site, viewer_ws)) return subject;
    std::erase_if(left, [&](std::uint32_t i) { return overlap(boxes[i], subject.site); });
    if (!left.empty()) subject = find_subject_in_light(world, boxes, left);
  }
  return first;
}

}  // namespace lambent
