// SPDX-License-Identifier: Apache-2.0
#include "stream/textures/h265.h"

namespace lambent::stream {
namespace {

tl::unexpected<Error> missing() {
  return fail("H.265", "", "is not in this build (LAMBENT_STREAM_H265)", Error::Kind::failed);
}

}  // namespace

Expected<std::unique_ptr<TextureWriter>> make_h265_writer() {
  return missing();
}
Expected<std::unique_ptr<TextureReader>> make_h265_reader() {
  return missing();
}
bool has_h265() {
  return false;
}

}  // namespace lambent::stream
