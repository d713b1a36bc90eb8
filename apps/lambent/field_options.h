// SPDX-License-Identifier: Apache-2.0
// The options of fields, shared by subcommands that make fields.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lambent/error.h"
#include "lambent/field.h"

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

}  // namespace lambent::cli
