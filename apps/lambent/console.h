// SPDX-License-Identifier: Apache-2.0
// What the program says: data on stdout; on stderr what was done, warnings and errors.
#pragma once

#include <string>
#include <vector>

#include "lambent/error.h"

namespace lambent::cli {

/// With --quiet nothing but errors goes to stderr: no line of success, no warning, no progress.
/// There is one stderr, hence one such choice.
void set_quiet(bool quiet);
bool is_quiet();
/// From now on, not even errors are told: another process of the same job does.
void set_mute();

/// Prints "lambent: TEXT" on stderr, unless the program is quiet.
void tell(const std::string& text);

/// Prints "lambent: warning: TEXT" on stderr, unless the program is quiet.
void warn(const std::string& text);

/// Prints "lambent: TEXT" on stderr.
void tell_error(const std::string& text);

/// Tells that a file was written: its name, what is in it ("640x360 pixels"), its size, and the
/// time that the program ran. `more` is what else is worth knowing, or empty.
void tell_written(const std::string& path, const std::string& what, const std::string& more = "");

/// The same of several files, such as the pictures of a sequence; there is at least one.
void tell_written(const std::vector<std::string>& paths, const std::string& what,
                  const std::string& more = "");

/// Sends off what is left of stdout. Fails where any of it could not be written.
Expected<void> finish_stdout();

}  // namespace lambent::cli
