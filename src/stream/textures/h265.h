// SPDX-License-Identifier: Apache-2.0
// Light through H.265 (10 bits, 4:4:4), without delay. Encoded by libx265 and decoded by
// libavcodec, which these files alone include. Both exist where LAMBENT_STREAM_H265 is on: x265 is
// under the GPL, and so is a program that is linked with it.
#pragma once

#include <memory>
#include <string>

#include "lambent/error.h"
#include "lambent/stream.h"

namespace lambent::stream {

inline tl::unexpected<Error> h265_failed(const std::string& why) {
  return fail("H.265", "", why, Error::Kind::failed);
}

/// Fails where this was built without H.265, or the codec cannot do it.
Expected<std::unique_ptr<TextureWriter>> make_h265_writer();
Expected<std::unique_ptr<TextureReader>> make_h265_reader();

/// Whether this was built with H.265.
bool has_h265();

}  // namespace lambent::stream
