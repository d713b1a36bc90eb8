// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace lambent {

/// Why an operation on input or files failed. Bugs in Lambent are asserts, never Errors.
struct Error {
  enum class Kind {
    bad_input,  ///< The caller's data or arguments are wrong; the same call will fail again.
    failed,     ///< The environment failed: a full disk, a missing device, lack of memory.
  };

  std::string file;   ///< File (or stream) concerned; empty where there is none.
  std::string place;  ///< Where in the file, e.g. "accessors[3]"; may be empty.
  std::string cause;  ///< What is wrong, in a sentence a user understands.
  Kind kind = Kind::bad_input;

  /// "file: place: cause", leaving out what is empty.
  std::string message() const;
};

/// A value of type T, or the Error because of which there is none.
template <class T, class E = Error>
using Expected = tl::expected<T, E>;

/// Shorthand for `return fail(file, place, cause);` in a function that returns an Expected.
inline tl::unexpected<Error> fail(std::string file, std::string place, std::string cause,
                                  Error::Kind kind = Error::Kind::bad_input) {
  return tl::unexpected<Error>(Error{std::move(file), std::move(place), std::move(cause), kind});
}

}  // namespace lambent
