// SPDX-License-Identifier: Apache-2.0
// The updates of fields, shared by subcommands that make fields.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>

#include "lambent/field.h"
#include "lambent/progress.h"
#include "lambent/world.h"

namespace lambent::cli {

/// A standard error of the field's light above this is visible as patches on plain walls.
inline constexpr double kNoisyField = 0.05;

/// The result of updates of a field.
struct FieldProgress {
  int updates = 0;
  double change = 0.0;   ///< Relative change of the light in the last update.
  bool settled = false;  ///< The change is below the limit for settled light.
};

/// Updates the field `updates` times, each time with `request`, and adds the costs to `stats`.
FieldProgress update_field(const World& world, int updates, const UpdateRequest& request,
                           IrradianceField& field, const ProgressFn& progress,
                           nlohmann::ordered_json& stats);

/// Updates the field until the standard error of its light is below 2.5 % (up to 4 % with more
/// probes than by default): otherwise noise from small bright patches is visible in mirrors and on
/// walls. Ends without that after 80 updates, or once probes have traced 8 million rays, and 32
/// million unless the picture `gathers` light; but never before `least` updates. Updates after the
/// third trace half as many rays, from the probes with the most noise, unless
/// FieldSettings::max_bounces is 0 or more: single bounces need all probes.
FieldProgress calm_field(const World& world, int least, bool gathers, const UpdateRequest& request,
                         IrradianceField& field, const ProgressFn& progress,
                         nlohmann::ordered_json& stats);

/// Updates the field until an update changes it by less than 0.2 %, at most 256 times.
FieldProgress settle_field(const World& world, const UpdateRequest& request, IrradianceField& field,
                           const ProgressFn& progress, nlohmann::ordered_json& stats);

/// How bake_field updates a field.
struct BakeLoop {
  int updates = 0;  ///< Total number; 0: until it has settled, as in settle_field.
  ProgressFn progress;
  /// Called after each update except the last.
  std::function<void(const FieldProgress&)> after_update;
};

/// Updates a field, which may have had updates before, until it is baked. FieldProgress includes
/// earlier updates; `stats` includes them only in "updates".
FieldProgress bake_field(const World& world, const UpdateRequest& request, const BakeLoop& loop,
                         IrradianceField& field, nlohmann::ordered_json& stats);

}  // namespace lambent::cli
