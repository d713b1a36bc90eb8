// SPDX-License-Identifier: Apache-2.0
// How the program explains itself.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace lambent::cli {

/// What `lambent` alone prints: what it is, and what to type.
std::string short_help();

/// Has --help of `app` and its subcommands print: usage, what it does, the options that matter
/// most, examples, then all others in groups, in lines of a terminal's width.
void set_help_style(CLI::App& app);

/// The group whose options stand first, before the examples.
inline constexpr const char* kMainGroup = "Most used";
/// The group that stands last: what each subcommand has.
inline constexpr const char* kProgramGroup = "Help and messages";

/// Groups of subcommands in the program's --help.
inline constexpr const char* kPictureGroup = "Pictures";
inline constexpr const char* kSceneGroup = "Scenes";
inline constexpr const char* kFieldGroup = "Fields";
inline constexpr const char* kStreamGroup = "Streams";
inline constexpr const char* kMachineGroup = "This machine";

/// Examples of a subcommand: command lines, each with what it does after two spaces or more.
void set_examples(CLI::App& command, const std::string& examples);

}  // namespace lambent::cli
