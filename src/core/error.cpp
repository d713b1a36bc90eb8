// SPDX-License-Identifier: Apache-2.0
#include "lambent/error.h"

namespace lambent {

std::string Error::message() const {
  std::string text;
  for (const std::string* part : {&file, &place, &cause}) {
    if (part->empty()) continue;
    if (!text.empty()) text += ": ";
    text += *part;
  }
  return text;
}

}  // namespace lambent
