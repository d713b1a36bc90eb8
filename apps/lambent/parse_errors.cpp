// SPDX-License-Identifier: Apache-2.0
#include "lambent/parse_errors.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "core/nearest_word.h"
#include "lambent/words.h"

namespace lambent::cli {
namespace {

/// The innermost subcommand that was being parsed: "field info" rather than "field".
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

/// The full name of a subcommand: "lambent field info".
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands({})) names.push_back(sub->get_name());
  return names;
}

/// The first unexpected argument; empty: there is none.
std::string unknown_word(const CLI::App& command) {
  const std::vector<std::string> extras = command.remaining();
  // Prefer an unknown flag, since words after it may be its value
  const auto flag = std::find_if(extras.begin(), extras.end(), [](const std::string& word) {
    return word.size() > 1 && word[0] == '-';
  });
  if (flag != extras.end()) {
    const std::string name = flag->substr(0, flag->find('='));
    return "unknown option '" + name + "'" + did_you_mean(name, option_names(command));
  }
  if (extras.empty()) return "";
  const std::vector<std::string> known = subcommand_names(command);
  if (known.empty()) return "unexpected argument '" + extras.front() + "'";
  return "unknown subcommand '" + extras.front() + "'" + did_you_mean(extras.front(), known);
}

/// A required argument that is missing; empty: there is none.
std::string missing_word(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    if (option->get_positional()) return option->get_name(true) + " is missing";
    const std::string name =
        option->get_snames().empty() ? option->get_name() : "-" + option->get_snames().front();
    return name + " " + option->get_type_name() + " is missing";
  }
  const std::vector<std::string> known = subcommand_names(command);
  if (!known.empty() && command.get_subcommands().empty()) {
    return "a subcommand is missing: " + list_text(known);
  }
  return "";
}

/// An option that was given too often, or without its value; empty: there is none.
std::string miscounted(const CLI::App& command, const std::string& said) {
  for (const CLI::Option* option : command.get_options()) {
    const auto most = static_cast<std::size_t>(option->get_items_expected_max());
    if (option->get_type_size() > 0 && option->count() > most) {
      return option->get_name() + ": was given " + std::to_string(option->count()) +
             " times, and goes once";
    }
  }
  // CLI11's message begins with the option's name
  const std::string name = said.substr(0, said.find(':'));
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_name() != name) continue;
    return name + ": needs a value, " + option->get_type_name();
  }
  return "";
}

}  // namespace

std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost(app);
  std::string cause = unknown_word(command);
  const bool count = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr;
  if (cause.empty() && count) cause = miscounted(command, error.what());
  const bool missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
  if (cause.empty() && missing) cause = missing_word(command);
  if (cause.empty()) cause = error.what();
  return cause + " (see " + full_name(command) + " --help)";
}

}  // namespace lambent::cli
