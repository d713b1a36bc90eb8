// SPDX-License-Identifier: Apache-2.0
// The program's help texts.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

/// The text that `lambent` prints without arguments.
std::string short_help();

/// Sets the format of --help for `app` and its subcommands: usage, description, the most important
/// options, examples, then all other options in groups, wrapped to a terminal's width.
void set_help_style(CLI::App& app);

/// The group whose options are listed first, before the examples.
inline constexpr const char* kMainGroup = "Most used";
/// The group that is listed last: options that each subcommand has.
inline constexpr const char* kProgramGroup = "Help and messages";

/// Groups of subcommands in the program's --help.
inline constexpr const char* kPictureGroup = "Pictures";
inline constexpr const char* kSceneGroup = "Scenes";
inline constexpr const char* kFieldGroup = "Fields";
inline constexpr const char* kStreamGroup = "Streams";
inline constexpr const char* kMachineGroup = "This machine";

/// Sets the examples of a subcommand: command lines, each followed by two or more spaces and its
/// description.
void set_examples(CLI::App& command, const std::string& examples);

}  // namespace lambent::cli
