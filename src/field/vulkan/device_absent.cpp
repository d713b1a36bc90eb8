// SPDX-License-Identifier: Apache-2.0
// Where the library is built without Vulkan no world is on a device.
#include "field/field_backend.h"

namespace lambent {

std::unique_ptr<FieldBackend> make_field_backend(const World&, const FieldSettings&,
                                                 const ProbeStore&) {
  return nullptr;
}

}  // namespace lambent
