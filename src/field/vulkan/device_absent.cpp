// SPDX-License-Identifier: Apache-2.0
// Where the library is built without Vulkan no world is on a device.
#include "field/field_device.h"

namespace lambent {

std::unique_ptr<FieldDevice> make_field_device(const World&, const FieldSettings&,
                                               const ProbeStore&) {
  return nullptr;
}

}  // namespace lambent
