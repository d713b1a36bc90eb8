// SPDX-License-Identifier: Apache-2.0
// What a field is like, and how it is brought to its light: shared by subcommands that make fields.
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

// After so many bounces no surface that we accept has light left to send on.
inline constexpr int kMaxBounces = 1000;
inline constexpr int kMaxUpdates = 100'000;

struct FieldOptions {
  FieldSettings settings;  // without what the others say
  std::string probes, bounds;
  std::vector<std::string> volumes;
  std::string irradiance_format = "rgb9e5";
  std::string distance_format = "rg16f";
  std::string visibility;                    // empty: of the quality, else moments
  std::vector<const CLI::Option*> of_shape;  // what a field's file has decided
};

/// Declares the options on `command`; `options` must outlive it.
void add_field_options(CLI::App& command, FieldOptions& options);

/// What the options call a format.
std::string name_of(IrradianceFormat format);

/// What the options say, with the volumes that the scene brings.
Expected<FieldSettings> field_settings(const FieldOptions& options, const Scene& scene,
                                       std::uint32_t seed, int bounces);

/// An error that the library has about a field's settings, told of the options that the user typed.
Error in_options(Error error, const FieldOptions& options);

/// Where updates of a field led.
struct FieldProgress {
  int updates = 0;
  double change = 0.0;   ///< Of the light, by the last of them.
  bool settled = false;  ///< It changed less than what counts as settled.
};

/// Updates the field so often, each time as requested, and books what it cost in `stats`.
FieldProgress update_field(const World& world, int updates, const UpdateRequest& request,
                           IrradianceField& field, const ProgressFn& progress,
                           nlohmann::ordered_json& stats);

/// Likewise, at least so often, until the standard error of its light is below 2.5 %, at most 80
/// times: what small bright patches leave of noise in it shows in mirrors and on walls. Updates
/// after the least ones trace half the rays, from the noisiest probes.
FieldProgress calm_field(const World& world, int least, const UpdateRequest& request,
                         IrradianceField& field, const ProgressFn& progress,
                         nlohmann::ordered_json& stats);

/// Likewise, until an update changes the field by less than 0.2 %, at most 256 times.
FieldProgress settle_field(const World& world, const UpdateRequest& request, IrradianceField& field,
                           const ProgressFn& progress, nlohmann::ordered_json& stats);

/// What a bake does beside updating.
struct BakeLoop {
  int updates = 0;  ///< Of the field in all; 0: until it has settled, as settle_field has it.
  ProgressFn progress;
  /// Called after each update but the last.
  std::function<void(const FieldProgress&)> after_update;
};

/// Updates a field, which may have had updates before, until it is baked. FieldProgress counts
/// those, too; `stats` does so in "updates" alone.
FieldProgress bake_field(const World& world, const UpdateRequest& request, const BakeLoop& loop,
                         IrradianceField& field, nlohmann::ordered_json& stats);

}  // namespace lambent::cli
