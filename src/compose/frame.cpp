// SPDX-License-Identifier: Apache-2.0
// The order of a frame's passes, for all backends, and the state of a renderer between frames.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

#include "compose/adaptive/further_samples.h"
#include "compose/check_frame.h"
#include "compose/frame_passes.h"
#include "compose/glossy/glossy_frame.h"
#include "compose/history/moved_parts.h"
#include "compose/motion/motion.h"
#include "lambent/world.h"
#include "raytracing/world_access.h"

namespace lambent {
namespace {

std::unique_ptr<FramePasses> make_frame_passes(const World& world) {
#if LAMBENT_VULKAN
  if (const DeviceWorld* there = device_world_of(world)) return make_frame_passes_vulkan(*there);
#else
  static_cast<void>(world);  // no device can be opened
#endif
  return make_frame_passes_cpu();
}

/// Takes one of `settings.samples` samples of the pixels, all of which count the same in the end.
void run_sample(const FrameRequest& request, int sample, const ProgressFn& progress,
                FramePasses& passes) {
  const FrameSettings& settings = request.settings;
  const IndirectSources& sources = request.sources;
  const Band all = traced_rows(request);
  const float share = 1.0f / static_cast<float>(settings.samples);
  const int band_rows = rows_of_a_band(settings.width);
  for (int row = 0; row < all.rows; row += band_rows) {
    const Band band{all.first_row + row, std::min(band_rows, all.rows - row)};
    passes.gbuffer(band, sample);
    if (wants_motion(settings) && request.round.skipped.empty()) passes.motion();
    passes.direct();
    if (asks_lights_in_sub_images(request)) passes.rsm_direct();
    if (looks_up(request)) passes.indirect();
    if (gathers(request)) passes.gather();
    if (sources.field != nullptr) passes.glossy();
    if (gathers_in_mirrors(request)) passes.gather_in_mirrors();
    if (tracer_of(request.world).has_glass()) passes.transmission();
    if (gathers_behind_glass(request)) passes.gather_behind_glass();
    if (sources.rsm) passes.rsm_upsample();
    if (has_fog(request)) passes.fog();
    passes.compose(share);
    if (progress) progress("frame", static_cast<double>(row + band.rows) / all.rows);
  }
  if (settings.denoise) passes.denoise(share);
}

// Cost of a further sample over that of one of the first, for progress alone. It was 0.2 in a room
// where a quarter of the pixels take some, which is more than usual.
constexpr double kFurtherCost = 0.1;

/// How far a frame has come, from the share done of one of its samples.
ProgressFn progress_of_sample(const FrameSettings& settings, int sample,
                              const ProgressFn& progress) {
  if (!progress) return {};
  const int first = settings.samples;
  const int further = takes_further_samples(settings) ? settings.most_samples - first : 0;
  const double cost = sample < first ? 1.0 : kFurtherCost;
  const double before = std::min(sample, first) + kFurtherCost * std::max(sample - first, 0);
  return [=, &progress](std::string_view stage, double done) {
    progress(stage, (before + cost * done) / (first + kFurtherCost * further));
  };
}

/// `continues`: the frame is a part of the same picture as the previous one.
void run_passes(const FrameRequest& request, bool continues, const ProgressFn& progress,
                FramePasses& passes) {
  const FrameSettings& settings = request.settings;
  if (request.sources.rsm && !continues) passes.rsm();
  if (guides_gathers(request) && !continues) passes.guide();
  if (has_fog(request)) passes.light_fog();
  FurtherSamples further(request, passes);
  const auto run = [&](const FrameRequest& round, int first) {
    for (int sample = first; sample < round.settings.samples; ++sample) {
      run_sample(round, sample, progress_of_sample(settings, sample, progress), passes);
      further.note_sample();
    }
  };
  run(request, 0);
  while (const FrameRequest* round = further.start_round()) run(*round, round->round.first);
  if (progress) progress("frame", 1.0);
  if (settings.temporal_antialiasing) passes.antialias();
  passes.finish();
}

/// The inputs of a picture that its successor is compared with.
struct PictureView {
  Camera camera;
  int width = 0, height = 0;
  std::uint64_t world_revision = 0;
  std::shared_ptr<const ScenePose> pose;  // null: there was no picture
  bool antialiased = false;               // temporally
  std::vector<FogVolume> fog;
  std::optional<std::uint32_t> guide_seed;  // empty: no guide was made
};

bool is_same(const Camera& a, const Camera& b) {
  return a.world_from_view == b.world_from_view && a.orthographic == b.orthographic &&
         a.vertical_fov == b.vertical_fov && a.vertical_extent == b.vertical_extent;
}

bool is_same(const PictureView& a, const PictureView& b) {
  return is_same(a.camera, b.camera) && a.width == b.width && a.height == b.height &&
         a.world_revision == b.world_revision && a.guide_seed == b.guide_seed;
}

/// The previous frame as these settings need it; none where its size differed.
std::optional<FrameBefore> frame_before(const PictureView& before, const World& world,
                                        const FrameSettings& settings) {
  const bool same_size = before.width == settings.width && before.height == settings.height;
  const bool wanted = wants_motion(settings) || averages(settings);
  if (before.pose == nullptr || !same_size || !wanted) return std::nullopt;
  FrameBefore frame{before.camera, before.pose == pose_of(world), {}};
  if (!frame.at_rest) {
    frame.instances = instances_before(*before.pose, *pose_of(world), world.scene());
  }
  return frame;
}

/// How a picture differs from the previous one. Where changes are too old to be on record, light is
/// taken to have changed, and all to have moved.
FrameChange change_of(const PictureView& before, const PictureView& now, const World& world) {
  FrameChange change;
  change.same_size = before.width == now.width && before.height == now.height;
  change.moved = !is_same(before.camera, now.camera);
  change.edited = before.world_revision != now.world_revision;
  const auto edits = world.changes_since(before.world_revision);
  if (!edits) change.moving = std::numeric_limits<std::size_t>::max();
  for (const WorldChanges& edit : edits.value_or(std::vector<WorldChanges>{})) {
    change.moving = std::max(change.moving, edit.moved.size());
  }
  change.relit =
      !edits || std::ranges::any_of(*edits, &WorldChanges::relights) || before.fog != now.fog;
  return change;
}

}  // namespace

struct Renderer::State {
  const World& world;
  IndirectSources sources;
  std::unique_ptr<FramePasses> passes;  // null before the first frame
  PictureView last;                     // of the last picture; valid where there are passes
  PictureView before_last;              // of the picture before, where pictures come in parts
  TaaSequence sequence;                 // of the last picture, if it is anti-aliased
  std::uint64_t frames = 0;

  /// Advances the sequence to a picture, or ends it.
  const TaaSequence* next_of_sequence(const PictureView& view) {
    if (!last.antialiased) sequence.restart();
    if (!view.antialiased) return nullptr;
    sequence.advance(view.width, view.height, change_of(last, view, world));
    return &sequence;
  }
};

Renderer::Renderer(const World& world, const IndirectSources& sources)
    : state_(new State{world, sources, nullptr, {}, {}, {}, 0}) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Expected<void> Renderer::render(const Camera& camera, const FrameSettings& settings,
                                RenderedFrame& frame, const ProgressFn& progress) {
  State& s = *state_;
  FrameRequest request{s.world, s.sources, camera, settings};
  if (const Expected<void> fine = check(request); !fine) return fine;

  // Rows below the first continue the previous picture, whose maps and guide are still valid
  PictureView view{camera,
                   settings.width,
                   settings.height,
                   s.world.revision(),
                   pose_of(s.world),
                   settings.temporal_antialiasing,
                   s.world.scene().fog,
                   std::nullopt};
  if (guides_gathers(request)) view.guide_seed = settings.seed;
  const bool continues = settings.first_row > 0 && s.passes != nullptr && is_same(view, s.last);
  if (!continues) s.before_last = s.last;
  const std::optional<FrameBefore> before = frame_before(s.before_last, s.world, settings);
  if (before) request.before = &*before;
  request.sequence = s.next_of_sequence(view);
  std::optional<ChangedLight> changed;
  if (averages(settings)) {
    if (before && s.before_last.fog == view.fog) {
      request.light_continues = s.before_last.world_revision == view.world_revision;
      if (!request.light_continues) {
        changed = light_changed_since(s.world, s.before_last.world_revision);
      }
      if (changed) request.changed = &*changed;
    }
    request.first_sample = static_cast<std::uint32_t>(s.frames);
  }
  if (s.passes == nullptr) s.passes = make_frame_passes(s.world);
  try {
    s.passes->begin(request, frame);
    run_passes(request, continues, progress, *s.passes);
  } catch (...) {
    s.passes.reset();  // the next frame cannot start from an unfinished one
    s.last = {};
    throw;
  }
  s.last = view;
  ++s.frames;
  return {};
}

Expected<RenderedFrame> Renderer::render(const Camera& camera, const FrameSettings& settings,
                                         const ProgressFn& progress) {
  RenderedFrame frame;
  if (const Expected<void> done = render(camera, settings, frame, progress); !done) {
    return tl::unexpected(done.error());
  }
  return frame;
}

std::uint64_t Renderer::frames() const {
  return state_->frames;
}

}  // namespace lambent
