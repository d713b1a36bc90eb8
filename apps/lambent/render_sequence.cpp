// SPDX-License-Identifier: Apache-2.0
#include "lambent/render_sequence.h"

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lambent/console.h"
#include "lambent/interrupts.h"
#include "lambent/output.h"
#include "lambent/render_output.h"
#include "lambent/words.h"

namespace lambent::cli {

Expected<void> render_sequence(const RenderOptions& options, const PosedScene& posed,
                               const View& view, FrameRenderer& renderer,
                               nlohmann::ordered_json& stats) {
  const InterruptGuard guard;
  Expected<SequenceSurvey> survey = survey_sequence(options, posed, view, renderer.size(), guard);
  if (!survey) return tl::unexpected(survey.error());
  renderer.set_path_boxes(std::move(survey->path_boxes));
  std::optional<float> stops = survey->stops;
  if (stops) tell("exposure: the median of the frames', as the first one's does not suit them");
  stats["fps"] = options.fps;
  nlohmann::ordered_json& list = stats["frames"] = nlohmann::ordered_json::array();
  std::vector<std::string> written;
  for (int i = 0; i < options.frames; ++i) {
    if (guard.interrupted()) {
      return fail("", "", "interrupted after " + std::to_string(i) + " frames",
                  Error::Kind::failed);
    }
    const double time = time_of_frame(options, i);
    const Expected<WorldChanges> changes = pose_at(posed, time);
    if (!changes) return tl::unexpected(changes.error());
    const Expected<Camera> camera = camera_of_pose(options, view, posed.scene);
    if (!camera) return tl::unexpected(camera.error());
    nlohmann::ordered_json& frame = list.emplace_back();
    frame["frame"] = i;
    frame["time_s"] = time;
    frame["world_update_ms"] = changes->refit_ms;
    frame["moved_boxes"] = changes->moved.size();
    frame["changed_lights"] = changes->lights.size();
    written.push_back(frame_path(options.output, i));
    if (const auto made = make_folders(written.back()); !made) return made;
    const auto done = renderer.paint_to_file(*camera, written.back(), stops, frame);
    if (!done) return done;
  }
  tell_written(written, pixels_text(renderer.size().x, renderer.size().y),
               stops ? exposure_text(*stops) : "");
  return {};
}

}  // namespace lambent::cli
