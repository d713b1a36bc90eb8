// SPDX-License-Identifier: Apache-2.0
#include "lambent/console.h"

#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "lambent/words.h"

namespace lambent::cli {
namespace {

using Clock = std::chrono::steady_clock;

bool quiet_asked = false;
bool muted = false;
const Clock::time_point kProgramStart = Clock::now();

}  // namespace

void set_quiet(bool quiet) {
  quiet_asked = quiet;
}

bool is_quiet() {
  return quiet_asked;
}

void set_mute() {
  quiet_asked = true;
  muted = true;
}

void tell(const std::string& text) {
  if (!quiet_asked) tell_error(text);
}

void warn(const std::string& text) {
  tell("warning: " + text);
}

void tell_error(const std::string& text) {
  if (!muted) std::fprintf(stderr, "lambent: %s\n", text.c_str());
}

void tell_written(const std::string& path, const std::string& what, const std::string& more) {
  tell_written(std::vector<std::string>{path}, what, more);
}

void tell_written(const std::vector<std::string>& paths, const std::string& what,
                  const std::string& more) {
  double bytes = 0.0;
  for (const std::string& path : paths) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error) bytes += static_cast<double>(size);
  }
  const std::string name = paths.size() == 1 ? paths[0]
                                             : std::to_string(paths.size()) + " files, " +
                                                   paths.front() + " to " + paths.back();
  // Devices and pipes have no size
  const std::string size = bytes > 0.0 ? ", " + bytes_text(bytes) : "";
  const double seconds = std::chrono::duration<double>(Clock::now() - kProgramStart).count();
  tell("wrote " + name + ": " + what + size + ", in " + seconds_text(seconds) +
       (more.empty() ? "" : "; " + more));
}

Expected<void> finish_stdout() {
  errno = 0;
  const bool sent = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (sent) return {};
  const std::string cause =
      errno != 0 ? ": " + std::generic_category().message(errno) : std::string();
  return fail("standard output", "", "cannot write" + cause, Error::Kind::failed);
}

}  // namespace lambent::cli
