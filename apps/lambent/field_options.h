// SPDX-License-Identifier: Apache-2.0
// The options of fields and of their updates, shared by subcommands that make fields.
#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/field.h"
#include "lambent/progress.h"
#include "lambent/world.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

// With FieldSettings::max_albedo of at most 0.99, no light is left after this many bounces.
inline constexpr int kMaxBounces = 1000;
inline constexpr int kMaxUpdates = 100'000;

struct FieldOptions {
  FieldSettings settings;  // does not include the options below
  std::string probes, bounds;
  std::vector<std::string> volumes;
  std::string irradiance_format = "rgb9e5";
  std::string distance_format = "rg16f";
  std::string visibility;                    // empty: that of the quality, else moments
  std::vector<const CLI::Option*> of_shape;  // options that a field's file determines
};

/// Declares the options on `command`; `options` must outlive it.
void add_field_options(CLI::App& command, FieldOptions& options);

/// The name of a format in options.
std::string name_of(IrradianceFormat format);

/// The settings from the options and the scene's volumes.
Expected<FieldSettings> field_settings(const FieldOptions& options, const Scene& scene,
                                       std::uint32_t seed, int bounces);

/// Converts an error of the library about a field's settings to one about the options that the user
/// typed.
Error in_options(Error error, const FieldOptions& options);

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

/// Updates the field at least `least` times, until the standard error of its light is below 2.5 %
/// (up to 4 % with more probes than by default), at most 80 times: otherwise noise from small
/// bright patches is visible in mirrors and on walls. Gives up after 32 where 80 would not bring
/// the error below kNoisyField. Updates after the first `least` trace half as many rays, from the
/// noisiest probes.
FieldProgress calm_field(const World& world, int least, const UpdateRequest& request,
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
