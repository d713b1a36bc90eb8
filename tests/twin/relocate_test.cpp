// SPDX-License-Identifier: Apache-2.0
// Compares the relocation of probes by the kernel maintain_probes with the processor's, for the
// same hits.
#include "field/placement/relocate.h"

#include <algorithm>

#include "field/probes/volumes.h"
#include "field/vulkan/recorded_state.h"
#include "raytracing/world_access.h"
#include "shared/random.h"
#include "support/box_scenes.h"
#include "support/field_scenes.h"
#include "support/vulkan_device.h"

namespace lambent::relocate_test {
namespace {

using vulkan::Buffer, vulkan::Memory;

// The steps by which stored offsets may differ because of rounding, and the share of probes for
// which it may lead to another result, for example where two surfaces are equally near.
constexpr int kOffsetTolerance = 1;
constexpr double kMaxOtherwise = 0.02;

/// Random boxes that intersect each other: with all kinds of corners, and probes in solid matter.
Scene clutter() {
  RandomStream random = make_random_stream(7, 8, 9);
  std::vector<Mesh> boxes;
  for (int i = 0; i < 120; ++i) {
    const vec3 low = 4.0f * vec3(next_uniform2(random), next_uniform(random));
    const vec3 size = 0.1f + 0.8f * vec3(next_uniform2(random), next_uniform(random));
    boxes.push_back(test::box_mesh(low, low + size));
  }
  return test::scene_of(std::move(boxes));
}

RayResult ray_result(const FixedRayHit& hit, const mat3& axes) {
  if (missed(hit)) return ray_left(vec3(0.0f));
  const vec3 normal = axes * hit.normal;
  if (hit.from_inside != 0) return ray_met_back_face(hit.distance, normal);
  return ray_met_surface(hit.distance, normal, normal, vec3(0.5f), vec3(0.0f), vec3(0.0f));
}

/// The same probes on the processor and on the device.
class Relocated {
 public:
  Relocated(const vulkan::Device& device, const test::Stage& stage)
      : device_(device),
        stage_(stage),
        store_(grid(), settings_),
        probes_(store_.probes()),
        kernels_(device, settings_, 1),
        grids_(vulkan::upload(device, store_.grids(), "grids")),
        standing_(device, probes_ * sizeof(RecordedProbe), Memory::upload, "standing"),
        states_(device, probes_ * sizeof(uint), Memory::readback, "states"),
        list_(device, probes_ * sizeof(int), Memory::upload, "list"),
        rays_(device, rays() * sizeof(RayRecord), Memory::upload, "rays"),
        results_(device, rays() * sizeof(RayResult), Memory::upload, "results") {
    for (std::size_t k = 0; k < probes_; ++k) {
      list_.as<int>()[k] = static_cast<int>(k);
      standing_.as<RecordedProbe>()[k].samples = 1.0f;
    }
  }

  /// Takes a step of relocation on both, from the positions of the processor's probes. Returns for
  /// how many probes the results differ.
  int step(uint placed, uint placing_updates) {
    look();
    const MaintainArguments arguments = {{grids_.address()},
                                         {{standing_.address()}, {states_.address()}},
                                         {list_.address()},
                                         {rays_.address()},
                                         {results_.address()},
                                         static_cast<int>(probes_),
                                         static_cast<int>(fixed_ray_directions().size()),
                                         placing_updates,
                                         1u};
    device_.run([&](vulkan::Recorder& to) {
      to.run(kernels_.maintain, arguments,
             static_cast<std::uint32_t>(probes_) * kernels_.maintain.group_size(0));
    });
    int otherwise = 0;
    for (std::size_t k = 0; k < probes_; ++k) {
      otherwise += step_on_cpu(k, placing_step(placed, placing_updates)) ? 0 : 1;
      standing_.as<RecordedProbe>()[k].placed = placed + 1;
    }
    return otherwise;
  }

  std::size_t probes() const { return probes_; }
  int moved() const { return moved_; }
  int in_matter() const { return in_matter_; }

 private:
  std::size_t rays() const { return probes_ * fixed_ray_directions().size(); }

  /// A rotated grid, so that a confusion of frames is found.
  static ProbeGrid grid() {
    const float c = cos(0.4f), s = sin(0.4f);
    return still_grid({vec3(0.6f, 0.1f, 0.9f), vec3(0.5f, 0.6f, 0.55f), ivec3(5, 6, 5),
                       mat3(vec3(c, 0.0f, -s), vec3(0.0f, 1.0f, 0.0f), vec3(s, 0.0f, c))});
  }

  void look() {
    std::vector<Viewpoint> viewpoints;
    for (std::size_t k = 0; k < probes_; ++k) {
      viewpoints.push_back({store_.probe_position_ws(static_cast<int>(k)), store_.grid(0).axes});
    }
    fixed_hits_.resize(rays());
    const SolidSides sides = solid_sides_by_winding(stage_.scene);
    trace_fixed_rays({stage_.scene, tracer_of(stage_.world), sides, {}}, viewpoints, fixed_hits_);
    const std::span<const vec3> directions = fixed_ray_directions();
    for (std::size_t i = 0; i < rays(); ++i) {
      rays_.as<RayRecord>()[i] = {viewpoints[i / directions.size()].position_ws, 0.0f,
                                  directions[i % directions.size()], 1.0f, kRayMeetsAll};
      results_.as<RayResult>()[i] = ray_result(fixed_hits_[i], store_.grid(0).axes);
    }
  }

  /// Whether a probe's step has the same result as the device's. The device's next step starts from
  /// the processor's result.
  bool step_on_cpu(std::size_t k, uint place) {
    const auto probe = static_cast<int>(k);
    const std::size_t n = fixed_ray_directions().size();
    const std::span<const FixedRayHit> around(&fixed_hits_[k * n], n);
    RecordedProbe& standing = standing_.as<RecordedProbe>()[k];
    const vec3 spacing = store_.grid(0).spacing, offset = store_.probe_offset(probe);
    RelocationState& relocation = relocations_[k];
    if (place == kPlaceFirstStep) relocation = begin_relocation(offset);
    const uint blocked = inside_geometry(around) ? 1u : 0u;
    if (relocation.converged == 0) {
      const vec3 position = offset * spacing;
      const vec3 better = better_position(around, position, vec3(0.0f), spacing,
                                          is_odd_probe(store_.grid(0), probe));
      const float margin = kSurfaceMargin * smallest_spacing(store_.grid(0));
      const float cost = placement_cost(position, better, margin, blocked);
      vec3 next =
          relocation_step(relocation, offset, better == position ? offset : better / spacing, cost);
      if (place == kPlaceEnd) next = relocation.best;
      store_.set_probe_offset(probe, next);
    }
    const bool has_moved = store_.probe_offset(probe) != offset;
    const vec3 off = abs(decode_probe_offset(standing.offset) - store_.probe_offset(probe));
    const float step = kMaxProbeOffset / kOffsetSteps;
    bool same = std::max({off.x, off.y, off.z}) <= (kOffsetTolerance + 0.5f) * step;
    same = same && states_.as<uint>()[k] == (blocked != 0 ? kProbeOff : kProbeOn);
    same = same && (standing.samples == 0.0f) == has_moved;
    moved_ += has_moved ? 1 : 0;
    in_matter_ += blocked != 0 ? 1 : 0;
    standing = {1.0f, store_.offset_words()[k], relocation, 0u, 1u};
    return same;
  }

  const vulkan::Device& device_;
  const test::Stage& stage_;
  FieldSettings settings_;
  ProbeStore store_;
  std::size_t probes_;
  vulkan::RecordedKernels kernels_;
  Buffer grids_, standing_, states_, list_, rays_, results_;
  std::vector<FixedRayHit> fixed_hits_;
  std::vector<RelocationState> relocations_ = std::vector<RelocationState>(probes_);
  int moved_ = 0, in_matter_ = 0;
};

using RelocationKernel = test::OnDevice;

TEST_F(RelocationKernel, HasProbesStandWhereTheProcessorDoes) {
  const test::Stage stage(clutter());
  Relocated probes(device(), stage);
  constexpr uint kSteps = 5;
  int otherwise = 0;
  for (uint step = 0; step < kSteps; ++step) otherwise += probes.step(step, kSteps);
  EXPECT_LE(otherwise, kMaxOtherwise * static_cast<double>(probes.probes()) * kSteps);
  EXPECT_GT(probes.moved(), 50);
  EXPECT_GT(probes.in_matter(), 10);
}

}  // namespace
}  // namespace lambent::relocate_test
