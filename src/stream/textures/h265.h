// SPDX-License-Identifier: Apache-2.0
// Light through H.265 (10 bits, 4:4:4), without delay. Encoded by libx265 and decoded by
// libavcodec, which only these files include. Both are built with LAMBENT_STREAM_H265: x265 is
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

/// Fail where this was built without H.265, or the codec does not support the format.
Expected<std::unique_ptr<TextureWriter>> make_h265_writer();
Expected<std::unique_ptr<TextureReader>> make_h265_reader();

/// Whether this was built with H.265.
bool has_h265();

}  // namespace lambent::stream
