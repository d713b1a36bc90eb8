// SPDX-License-Identifier: Apache-2.0
#include "lambent/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <system_error>

#include "core/nearest_word.h"
#include "scenes/builtin.h"

namespace lambent::cli {
namespace {

/// Subcommands that later versions will have.
constexpr const char* kPlanned[] = {"view"};
/// Subcommands that exist only in builds with LAMBENT_STREAM.
constexpr const char* kOfStreams[] = {"serve", "connect"};

bool is_one_of(const std::string& word, const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Whether a word looks like a path, or is the name of an existing file.
bool may_be_scene(const std::string& word) {
  std::error_code error;
  return scenes::is_name(word) || word.find_first_of("./") != std::string::npos ||
         std::filesystem::exists(word, error);
}

}  // namespace

Expected<std::vector<std::string>> complete_arguments(const CLI::App& app,
                                                      std::vector<std::string> arguments) {
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands({})) known.push_back(command->get_name());

  // Options of the program itself may come first
  const auto first =
      std::find_if(arguments.begin(), arguments.end(), [&app](const std::string& argument) {
        return !argument.starts_with("-") || app.get_option_no_throw(argument) == nullptr;
      });
  if (first == arguments.end() || is_one_of(*first, known)) return arguments;
  const std::string word = *first;
  if (word == "help") {
    const auto about = arguments.erase(first);
    if (about != arguments.end() && !about->starts_with("-") && !is_one_of(*about, known)) {
      return fail("", "",
                  "'" + *about + "' is no subcommand" + did_you_mean(*about, known) +
                      " (see lambent --help)");
    }
    arguments.push_back("--help");
    return arguments;
  }
  for (const char* left_out : kOfStreams) {
    if (word != left_out) continue;
    return fail("", "",
                "'" + word +
                    "' is left out of this build: it needs Boost, OpenSSL and OpenH264 "
                    "(LAMBENT_STREAM)");
  }
  for (const char* planned : kPlanned) {
    if (word != planned) continue;
    return fail("", "",
                "'" + word +
                    "' is not part of this version yet; `lambent SCENE` renders a "
                    "picture (see lambent --help)");
  }
  if (word.starts_with("-") || may_be_scene(word)) {
    arguments.insert(first, "render");
    return arguments;
  }
  std::vector<std::string> words = known;
  for (const std::string& name : scenes::names()) words.push_back(name);
  return fail("", "",
              "'" + word + "' is neither a subcommand nor a scene" + did_you_mean(word, words) +
                  " (see lambent --help)");
}

}  // namespace lambent::cli
