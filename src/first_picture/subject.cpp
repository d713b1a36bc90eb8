// SPDX-License-Identifier: Apache-2.0
#include "first_picture/subject.h"

#include <algorithm>

namespace lambent {
namespace {

// A ground dwarfs the rest where the rest spans less than this share of it; and a sky, which
// encloses the rest, where it spans less than this share. Rooms seldom do.
constexpr float kDwarfedByGround = 0.3f, kDwarfedBySky = 0.1f;
// Greatest height of a ground, as a share of its width.
constexpr float kFlatGroundShare = 0.05f;
// Strays are at least this many diagonals of the rest, and of each of them, away from the rest: in
// a picture of all, there would be specks alone.
constexpr float kStrayDistance = 10.0f;
// Strays have fewer triangles than this share of the scene's.
constexpr double kMaxStrayShare = 0.5;

/// Among the `kept` smallest parts, the number of the largest ones that are grounds and skies and
/// dwarf the rest; 0: there are none. `around[i]` contains the parts order[0] to order[i].
std::size_t count_dwarfing(std::span<const Bounds> boxes, std::span<const std::uint32_t> order,
                           std::span<const Bounds> around, std::size_t kept) {
  bool sky = false;
  for (std::size_t left = kept; left-- > 1;) {
    const Bounds& rest = around[left - 1];
    const Bounds& largest = boxes[order[left]];
    const glm::vec3 size = largest.max - largest.min;
    const bool flat = size.y <= kFlatGroundShare * std::max(size.x, size.z);
    const bool encloses = glm::all(glm::lessThanEqual(largest.min, rest.min)) &&
                          glm::all(glm::greaterThanEqual(largest.max, rest.max));
    if (!flat && !encloses) return 0;
    sky = sky || !flat;
    const float share = diagonal(rest) / diagonal(around[kept - 1]);
    if (share == 0.0f) return 0;
    if (share < (sky ? kDwarfedBySky : kDwarfedByGround)) return kept - left;
  }
  return 0;
}

/// Removes grounds and skies from `members`, and adds their boxes to `site`.
void drop_backdrops(std::span<const Bounds> boxes, std::vector<std::uint32_t>& members,
                    Bounds& site) {
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
  while (const std::size_t dwarfing = count_dwarfing(boxes, members, around, kept)) {
    kept -= dwarfing;
  }
  for (std::size_t i = kept; i < members.size(); ++i) site.add(boxes[members[i]]);
  members.resize(kept);
}

double triangles_of(const Scene& scene, std::uint32_t instance) {
  return static_cast<double>(scene.meshes[scene.instances[instance].mesh].triangles.size());
}

/// The median of `value` over instances, each counting once for each of its triangles. Sorts them.
template <class Value>
float median_over_triangles(const Scene& scene, std::vector<std::uint32_t>& members,
                            const Value& value) {
  std::stable_sort(members.begin(), members.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return value(a) < value(b); });
  double total = 0.0, sum = 0.0;
  for (const std::uint32_t i : members) total += triangles_of(scene, i);
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
  double total = 0.0;
  for (const std::uint32_t i : members) total += triangles_of(scene, i);
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

}  // namespace

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
  const Scene& scene = world.scene();
  std::vector<Bounds> boxes(scene.instances.size());
  Subject subject;
  std::vector<std::uint32_t>& members = subject.instances;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = world.instance_bounds(static_cast<int>(i));
    if (!boxes[i].empty()) members.push_back(i);
  }
  // Repeat both: once strays are gone, a ground may dwarf the rest, and once a sky is gone that
  // encloses everything, there may be a gap between the rest and strays
  std::size_t before = 0;
  while (before != members.size()) {
    before = members.size();
    drop_strays(scene, boxes, members);
    drop_backdrops(boxes, members, subject.site);
  }
  for (const std::uint32_t i : members) subject.bounds.add(boxes[i]);
  if (!members.empty()) subject.site.add(subject.bounds);
  return subject;
}

}  // namespace lambent
